#!/usr/bin/env bash
# Runs fuzzers of tests/fuzz: fuzz.sh SECONDS [NAME ...]     default: all fuzzers
# Each fuzzer runs for SECONDS on one core, and as many run at once as there are cores. A fuzzer ends at its first finding, which it
# stores in build/asan/findings; build/asan/bin/fuzz_NAME FILE repeats it. Fuzzers start from generated seeds and tests/fuzz/corpus,
# and store new inputs in build/asan/corpus. A FUZZ_SEED other than 0 makes runs repeatable.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds="${1:?fuzz.sh SECONDS [NAME ...]}"
shift

cmake --preset asan >/dev/null
if [ "$#" -eq 0 ]; then
  cmake --build build/asan --target fuzzers
  mapfile -t names < <(cd build/asan/bin && printf '%s\n' fuzz_* | sed 's/^fuzz_//')
else
  names=("$@")
  cmake --build build/asan --target make_seeds "${names[@]/#/fuzz_}"
fi
cd build/asan
bin/make_seeds seeds
mkdir -p findings
fuzz() {
  name="$1"
  folders=("corpus/$name" "seeds/$name")
  [ ! -d "../../tests/fuzz/corpus/$name" ] || folders+=("../../tests/fuzz/corpus/$name")
  mkdir -p "${folders[@]:0:2}" "findings/$name"
  # An input may take minutes on a busy machine. No input within the limits of the fuzzers needs 4 GB.
  if ! "bin/fuzz_$name" -max_total_time="$2" -seed="${FUZZ_SEED:-0}" -timeout=300 -rss_limit_mb=4096 -malloc_limit_mb=2048 -max_len=16384 \
    -print_final_stats=1 -artifact_prefix="findings/$name/" "${folders[@]}" >"findings/$name.log" 2>&1; then
    echo "$name: a finding"
    tail -n 40 "findings/$name.log"
    return 1
  fi
  echo "$name: $(sed -n 's/^stat::number_of_executed_units: *//p' "findings/$name.log") runs, no finding"
}
export -f fuzz
printf '%s\n' "${names[@]}" | xargs -P "$(nproc)" -I '{}' bash -c "fuzz '{}' $seconds"
