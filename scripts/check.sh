#!/usr/bin/env bash
# What a compiler and the tests do not see: the format of every source, clang-tidy on what is ours, and the tests of the
# libraries under the address and undefined-behaviour sanitizers; with sanitizers-python those of the Python
# package, too; with threads what is parallel under the thread sanitizer. Installs what these take.
#   check.sh [format|tidy|tidy-all|sanitizers|sanitizers-python|threads ...]     format, tidy and sanitizers without a word
# tidy looks at what differs from main and at what includes that; tidy-all at everything, without the one check that takes as long
# as all others.
set -euo pipefail
cd "$(dirname "$0")/.."

format() {
  echo "Format (clang-format) ..."
  git ls-files -z '*.hpp' '*.cpp' | xargs -0 clang-format --dry-run -Werror
}

sources() {
  git ls-files "$@" ':!benchmarks' ':!examples' ':!python' ':!testing' ':!tests' ':!backends/pointcloud/pcl' ':!*/pcl_*' \
    ':!*/no_*.cpp' ':!*/stb.cpp' ':!*/pack.cpp'
}

# Without precompiled headers: each source must include what it needs. Nothing has to be built for it.
run_tidy() {
  cmake -S . -B build/tidy -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DAHM_WITH_PCL=OFF \
    -DAHM_BUILD_TESTS=OFF -DAHM_BUILD_EXAMPLES=OFF -DAHM_INSTALL=OFF >/dev/null
  xargs -r -n 1 -P "$(nproc)" clang-tidy -p build/tidy --quiet --warnings-as-errors='*' "$@"
}

tidy() {
  echo "clang-tidy on what differs from main ..."
  local base changed; base="$(git merge-base HEAD main 2>/dev/null || git rev-parse HEAD)"
  mapfile -t changed < <(git diff --name-only --diff-filter=d "$base" -- '*.cpp' '*.hpp')
  {
    for file in "${changed[@]}"; do
      case "$file" in
        *.hpp) sources '*.cpp' | xargs grep -lF "$(basename "$file")\"" || true ;;
        *) sources '*.cpp' | grep -Fx "$file" || true ;;  # git forgets a path beside several exclusions
      esac
    done
  } | sort -u | run_tidy
}

tidy-all() {
  echo "clang-tidy ..."
  sources '*.cpp' | run_tidy --checks=-performance-unnecessary-value-param
}

sanitizers() {
  echo "Sanitizers (build/asan) ..."
  cmake --preset asan >/dev/null
  cmake --build --preset asan
  local cores; cores="$(nproc)"
  for test in build/asan/bin/test_*; do
    echo "$test"
    seq 0 $((cores - 1)) |
      GTEST_TOTAL_SHARDS="$cores" xargs -P "$cores" -I '{}' env GTEST_SHARD_INDEX='{}' "$test" --gtest_brief=1
  done
}

sanitizers-python() {
  echo "Sanitizers, the Python package (build/asan) ..."
  cmake --preset asan >/dev/null
  cmake --build build/asan --target ahm_python
  ctest --test-dir build/asan -R '^Python\.' --no-tests=error --output-on-failure --parallel "$(nproc)"
}

threads() {
  echo "Thread sanitizer (build/tsan) ..."
  cmake --preset tsan >/dev/null
  cmake --build --preset tsan
  build/tsan/bin/test_threads --gtest_brief=1
}

for check in "${@:-format tidy sanitizers}"; do
  for one in $check; do
    case "$one" in
      format | tidy | tidy-all | sanitizers | sanitizers-python | threads) ;;
      *) echo "error: check.sh [format|tidy|tidy-all|sanitizers|sanitizers-python|threads ...]" >&2; exit 2 ;;
    esac
  done
done
scripts/install_packages.sh checks
for check in "${@:-format tidy sanitizers}"; do
  for one in $check; do "$one"; done
done
