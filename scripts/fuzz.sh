#!/usr/bin/env bash
# Fuzzes: fuzz.sh SECONDS [NAME ...], each NAME of tests/fuzz (all without) for SECONDS of time on one core, as many at once as
# there are cores. A finding ends it and is left in build/asan/findings; build/asan/bin/fuzz_NAME FILE runs it again. Starts from
# generated seeds and tests/fuzz/corpus; what is new is kept in build/asan/corpus. FUZZ_SEED other than 0 makes the same choices
# each time.
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
  # A case may take minutes on a busy machine; 4 GB are more than the inputs' bounds allow.
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
