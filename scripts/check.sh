#!/usr/bin/env bash
# What a compiler and the tests do not see: the format of every source, clang-tidy on what is ours, and the tests of the
# library and of io under the address and undefined-behaviour sanitizers.
#   check.sh [format|tidy|sanitizers ...]     all three without a word
set -euo pipefail
cd "$(dirname "$0")/.."

format() {
  echo "Format (clang-format) ..."
  git ls-files -z '*.hpp' '*.cpp' | xargs -0 clang-format --dry-run -Werror
}

# In the build of the sanitizers, which knows how every source is compiled.
tidy() {
  echo "clang-tidy ..."
  cmake --preset asan >/dev/null
  git ls-files -z 'libahm/core/src/*.cpp' 'libahm/surface/src/*.cpp' 'io/src/*.cpp' ':!io/src/*/pcl_*' ':!io/src/image/stb.cpp' |
    xargs -0 -n 4 -P "$(nproc)" clang-tidy -p build/asan --quiet --warnings-as-errors='*' \
      --extra-arg=-Wno-unknown-warning-option
}

sanitizers() {
  echo "Sanitizers (build/asan) ..."
  cmake --preset asan >/dev/null
  cmake --build --preset asan
  for test in build/asan/bin/test_*; do
    echo "$test"
    "$test" --gtest_brief=1
  done
}

for check in "${@:-format tidy sanitizers}"; do
  for one in $check; do "$one"; done
done
