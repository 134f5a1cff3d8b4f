#!/usr/bin/env bash
# Fuzzes with the programs of build/fuzz; see usage below.
set -uo pipefail

usage() {
  cat <<'TEXT'
usage: tests/fuzz/run.sh [-n RUNS] [-s SECONDS] [-j JOBS] [-t TIMEOUT] [-b BUILD] [TARGET...]
       tests/fuzz/run.sh --minimize [-b BUILD] TARGET...

Fuzzes the targets (all of them without any), JOBS at a time (1), each for RUNS
executions (10000000) but at most SECONDS (3600), from its corpus in
tests/fuzz/corpus and what earlier runs found in BUILD/fuzz/corpus. An execution
of more than TIMEOUT seconds (1) or 512 MiB is a finding, as is a crash, a leak
or a claim that does not hold. Prints a line per target:

  NAME EXECUTIONS EXECUTIONS/S edges COVERED corpus INPUTS findings NUMBER

and leaves the inputs that were found in BUILD/fuzz/findings, the logs in
BUILD/fuzz/logs. Exit 1 if there is a finding. To see one again:
build/fuzz/bin/fuzz_TARGET FILE. Put what was mended into the corpus.

--minimize replaces the inputs of a corpus but seed-* and found-* by the
smallest set that covers as much as all inputs known, those of BUILD included.

BUILD is build/fuzz (make it with: cmake --preset fuzz; cmake --build --preset fuzz).
TEXT
}

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
runs=10000000 seconds=3600 jobs=1 timeout=1 build=$here/../../build/fuzz minimize=0
while (($#)); do
  case $1 in
    -n) runs=$2; shift 2 ;;
    -s) seconds=$2; shift 2 ;;
    -j) jobs=$2; shift 2 ;;
    -t) timeout=$2; shift 2 ;;
    -b) build=$2; shift 2 ;;
    --minimize) minimize=1; shift ;;
    -h | --help) usage; exit ;;
    -*) usage >&2; exit 2 ;;
    *) break ;;
  esac
done
mkdir -p "$build"/fuzz/{logs,findings}
targets=("$@")
if ((${#targets[@]} == 0)); then
  for options in "$build"/fuzz/*.options; do targets+=("$(basename "$options" .options)"); done
fi
export ASAN_OPTIONS=quarantine_size_mb=32:detect_stack_use_after_return=0:${ASAN_OPTIONS:-}
export UBSAN_OPTIONS=print_stacktrace=1:${UBSAN_OPTIONS:-}

flags_of() {  # TARGET: what is said of it in tests/fuzz/CMakeLists.txt
  sed 's/\(max_len=\|dict=\)/-\1/g' "$build/fuzz/$1.options"
}

figure() {  # LOG NAME: of the statistics at the end
  sed -n "s/^stat::$2: *//p" "$1" | tail -n 1
}

fuzz() {
  local name=$1 log=$build/fuzz/logs/$1.log found flags
  mkdir -p "$build/fuzz/corpus/$name"
  read -ra flags < <(flags_of "$name")
  "$build/bin/fuzz_$name" "${flags[@]}" -runs="$runs" -max_total_time="$seconds" -timeout="$timeout" \
    -rss_limit_mb=512 -print_final_stats=1 -artifact_prefix="$build/fuzz/findings/$name-" \
    "$build/fuzz/corpus/$name" "$here/corpus/$name" >"$log" 2>&1
  found=$(($? != 0))
  printf '%-12s %10s executions %7s/s  edges %s  corpus %s  findings %s\n' "$name" "$(figure "$log" number_of_executed_units)" \
    "$(figure "$log" average_exec_per_sec)" "$(grep -oE 'cov: [0-9]+' "$log" | tail -n 1 | cut -d ' ' -f 2)" \
    "$(find "$build/fuzz/corpus/$name" "$here/corpus/$name" -type f | wc -l)" "$found"
  return "$found"
}

minimize() {
  local name=$1 corpus=$here/corpus/$1 flags smallest
  smallest=$(mktemp -d)
  mkdir -p "$build/fuzz/corpus/$name"
  read -ra flags < <(flags_of "$name")
  "$build/bin/fuzz_$name" -merge=1 "${flags[@]}" "$smallest" "$corpus" "$build/fuzz/corpus/$name" >/dev/null 2>&1 ||
    { echo "cannot merge the corpus of $name" >&2; return 1; }
  find "$corpus" -type f ! -name 'seed-*' ! -name 'found-*' -delete
  local file
  for file in "$smallest"/*; do
    # The seeds are there already, under their names.
    find "$corpus" -type f -exec cmp -s {} "$file" \; -print -quit | grep -q . || cp "$file" "$corpus"
  done
  rm -rf "$smallest"
}

if ((minimize)); then
  for name in "${targets[@]}"; do minimize "$name" || exit 1; done
  exit
fi
failed=0 running=0
for name in "${targets[@]}"; do
  if ((running >= jobs)); then
    wait -n || failed=1
    running=$((running - 1))
  fi
  fuzz "$name" &
  running=$((running + 1))
done
while ((running-- > 0)); do wait -n || failed=1; done
exit "$failed"
