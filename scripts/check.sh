#!/usr/bin/env bash
# Runs additional checks: the format of every source, the wording of pages and comments, clang-tidy, the tests under the sanitizers,
# and the libraries without their dependencies. Installs the packages that the checks require.
#   check.sh [format|words|tidy|tidy-all|sanitizers|threads|lean ...]     default: format, words, tidy and sanitizers
# tidy checks the files that differ from main, and the sources that include them. tidy-all checks all sources, except for the one
# check that takes as long as all others.
set -euo pipefail
cd "$(dirname "$0")/.."

format() {
  echo "Format (clang-format) ..."
  git ls-files -z '*.hpp' '*.cpp' | xargs -0 clang-format --dry-run -Werror
}

words() {
  echo "Wording (scripts/banned_words.txt) ..."
  python3 scripts/check_words.py
}

sources() {
  git ls-files "$@" ':!benchmarks' ':!examples' ':!python' ':!scripts' ':!libahm/conformance' ':!tests' ':!backends/pointcloud/pcl' ':!*/pcl_*' \
    ':!*/no_*.cpp' ':!*/stb.cpp' ':!*/pack.cpp' ':!*/memory_files.cpp' ':!web'
}

# Configures a build folder for clang-tidy; nothing has to be built.
configure_tidy() {
  cmake -S . -B "build/$1" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DAHM_WITH_PCL=OFF -DAHM_BUILD_TESTS=OFF -DAHM_BUILD_EXAMPLES=OFF \
    -DAHM_BUILD_PYTHON=OFF -DAHM_INSTALL=OFF "${@:2}" >/dev/null
}

run_tidy() {
  xargs -r -n 1 -P "$(nproc)" clang-tidy -p "build/$1" --quiet --warnings-as-errors='*' "${@:2}"
}

# Configures without precompiled headers: each source must include what it uses.
tidy() {
  echo "clang-tidy on files that differ from main ..."
  configure_tidy tidy -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON
  local base changed; base="$(git merge-base HEAD main 2>/dev/null || git rev-parse HEAD)"
  mapfile -t changed < <(git diff --name-only --diff-filter=d "$base" -- '*.cpp' '*.hpp')
  {
    for file in "${changed[@]}"; do
      case "$file" in
        *.hpp) sources '*.cpp' | xargs grep -lF "$(basename "$file")\"" || true ;;
        *) sources '*.cpp' | grep -Fx "$file" || true ;;  # git ls-files ignores a path combined with several exclusions
      esac
    done
  } | sort -u | run_tidy tidy
}

# Checks six sources as one (AHM_UNITY_BUILD), which halves the time.
tidy-all() {
  echo "clang-tidy ..."
  configure_tidy tidy-all -DAHM_UNITY_BUILD=ON
  sed -n 's/^ *"file": "\(.*\)".*/\1/p' build/tidy-all/compile_commands.json | sort -u |
    grep -Ev '/(conformance|cmake_pch|resources|stb|no_[a-z]*|pack)[./]' |
    run_tidy tidy-all --checks=-performance-unnecessary-value-param,-bugprone-suspicious-include
}

# Tests that take 20 seconds or more each under the sanitizers. Other tests cover the same lines.
slow=("CholeskyFactor.SolvesAsEigens*" CloudEdges.DoNotDependOnTheNumberOfThreads ExactMap.GoesFarAlongTubes ExactMap.IsRefusedWhereNeedlesLoseWindows ExactMap.NamesMeshesOnWhichWindowsDoNotEnd
  FactorFront.IsEigensOfEverySmallFrontAndOfLargeOnes Layers.AreNotReportedForNoiseBendsAndCorners LocalMaps.ApproachTheMapOfTheWholeGraphWithTheMargin
  LocalMaps.DoNotDependOnThreadsOrOnOtherSources LocalMaps.RefuseWhatFillsTheMemory March.AgreesWithTheGlobalSolve March.DoesNotDependOnThreads
  March.EndsWhereHeatDistancesAreBeyondAllNumbers March.HasNoHorizon March.TakesSeveralBands Normals.WithNoiseAreNoWorseThanNone
  Renderer.DoesNotDependOnTheNumberOfThreads SphereCloud.ConvergesOnRandomPointsInBothVariants
  Strategy.IsChosenFromTheNumberOfMapsAndTheMemory StreamedLogMap.ForgetsWhatTheFrontHasPassed StreamedLogMap.GoesOnFromTheEndOfAnyBand
  ToolPath.ABallRollsAroundSharpEdges ToolPath.ABallStaysOutOfAnAcuteGroove ToolPath.OfABallThatIsTooLargeIsRefused
  ToolPath.OfASmallDiscNeedsNothingElseOfTheSurface ToolPath.OffsetIsTheCenterOfABall
  ToolPath.SpiralsCoverAsSeparatePassesDo)

sanitizers() {
  echo "Sanitizers (build/asan) ..."
  cmake --preset asan >/dev/null
  cmake --build --preset asan
  local cores; cores="$(nproc)"
  for test in build/asan/bin/test_*; do
    for shard in $(seq 0 $((cores - 1))); do echo "GTEST_SHARD_INDEX=$shard $test"; done
  done | GTEST_FILTER="-$(IFS=:; echo "${slow[*]}")" GTEST_TOTAL_SHARDS="$cores" xargs -P "$cores" -I '{}' sh -c 'echo {}; env {} --gtest_brief=1'
}

threads() {
  echo "Thread sanitizer (build/tsan) ..."
  cmake --preset tsan >/dev/null
  cmake --build --preset tsan
  build/tsan/bin/test_threads --gtest_brief=1
}

# The libraries and the program without optional libraries, compared with the program of scripts/test.sh if that was built.
lean() {
  echo "Without optional libraries (build/lean) ..."
  cmake --preset lean >/dev/null
  cmake --build --preset lean
  for test in cholesky core one_thread; do
    GTEST_FILTER="-CostOfGraph.*:LocalMaps.*:March.*:StreamedLogMap.*" build/lean/bin/test_$test --gtest_brief=1  # these take a minute
  done
  /usr/bin/python3 tests/app/lean_test.py build/lean/bin/ahm build/release/bin/ahm
}

for check in "${@:-format words tidy sanitizers}"; do
  for one in $check; do
    case "$one" in
      format | words | tidy | tidy-all | sanitizers | threads | lean) ;;
      *) echo "error: check.sh [format|words|tidy|tidy-all|sanitizers|threads|lean ...]" >&2; exit 2 ;;
    esac
  done
done
scripts/install_packages.sh checks
for check in "${@:-format words tidy sanitizers}"; do
  for one in $check; do "$one"; done
done
