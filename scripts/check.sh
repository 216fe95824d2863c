#!/usr/bin/env bash
# What a compiler and the tests do not see: the format of every source, clang-tidy on what is ours, and the tests of the
# library, its backends and io under the address and undefined-behaviour sanitizers. Installs what these take.
#   check.sh [format|tidy|sanitizers ...]     all three without a word
set -euo pipefail
cd "$(dirname "$0")/.."

format() {
  echo "Format (clang-format) ..."
  git ls-files -z '*.hpp' '*.cpp' | xargs -0 clang-format --dry-run -Werror
}

# In the build of the sanitizers, which knows how every source is compiled; nothing has to be built for it.
tidy() {
  echo "clang-tidy ..."
  cmake --preset asan >/dev/null
  git ls-files -z '*.cpp' ':!benchmarks' ':!examples' ':!testing' ':!tests' ':!backends/pointcloud/pcl' ':!io/src/*/pcl_*' \
    ':!*/no_*.cpp' ':!*/stb.cpp' ':!*/pack.cpp' |
    xargs -0 -n 1 -P "$(nproc)" clang-tidy -p build/asan --quiet --warnings-as-errors='*'
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

for check in "${@:-format tidy sanitizers}"; do
  for one in $check; do
    case "$one" in
      format | tidy | sanitizers) ;;
      *) echo "error: check.sh [format|tidy|sanitizers ...]" >&2; exit 2 ;;
    esac
  done
done
scripts/install_packages.sh checks
for check in "${@:-format tidy sanitizers}"; do
  for one in $check; do "$one"; done
done
