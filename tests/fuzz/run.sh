#!/usr/bin/env bash
# Fuzzes with the programs of build/fuzz; see usage below.
set -uo pipefail

usage() {
  cat <<'TEXT'
usage: tests/fuzz/run.sh [-s SECONDS] [-n RUNS] [-j JOBS] [-t TIMEOUT] [-b BUILD] [TARGET...]
       tests/fuzz/run.sh --minimize [-b BUILD] TARGET...
       tests/fuzz/run.sh --coverage [-b BUILD] [TARGET...]

Fuzzes the targets (all of them without any) for SECONDS (720) in all, which
they share, JOBS at a time (1), each for RUNS executions (10000000) at most; the
time that one leaves goes to the others. Inputs come from tests/fuzz/corpus and
what earlier runs found in BUILD/fuzz/corpus. An execution of more than TIMEOUT
seconds (5) or 512 MiB is a finding, as is a crash, a leak or a claim that does
not hold. Prints a line per target:

  NAME EXECUTIONS EXECUTIONS/S past parser SHARE read SHARE edges COVERED corpus INPUTS findings NUMBER

and leaves the inputs that were found in BUILD/fuzz/findings, the logs in
BUILD/fuzz/logs. Exit 1 if there is a finding. To see one again:
build/fuzz/bin/fuzz_TARGET FILE. Put what was mended into the corpus.
With KITH_FUZZ_BYTES set, inputs are mutated byte by byte only, for comparison.

--minimize replaces the inputs of a corpus but seed-* and found-* by the
smallest set that reaches as many edges as all inputs known, those of BUILD
included.

--coverage prints how many lines of the parsers, the record codec and the
journal these inputs reach, per target and in all.

BUILD is build/fuzz (make it with: cmake --preset fuzz; cmake --build --preset fuzz).
TEXT
}

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
runs=10000000 seconds=720 jobs=1 timeout=5 build=$root/build/fuzz mode=fuzz
while (($#)); do
  case $1 in
    -n) runs=$2; shift 2 ;;
    -s) seconds=$2; shift 2 ;;
    -j) jobs=$2; shift 2 ;;
    -t) timeout=$2; shift 2 ;;
    -b) build=$2; shift 2 ;;
    --minimize) mode=minimize; shift ;;
    --coverage) mode=coverage; shift ;;
    -h | --help) usage; exit ;;
    -*) usage >&2; exit 2 ;;
    *) break ;;
  esac
done
mkdir -p "$build"/fuzz/{logs,findings}
targets=("$@")
if ((${#targets[@]} == 0)); then
  for file in "$build"/fuzz/*.options; do targets+=("$(basename "$file" .options)"); done
fi
export ASAN_OPTIONS=quarantine_size_mb=32:detect_stack_use_after_return=0:${ASAN_OPTIONS:-}
export UBSAN_OPTIONS=print_stacktrace=1:${UBSAN_OPTIONS:-}

flags_of() {  # TARGET: what is said of it in tests/fuzz/CMakeLists.txt
  sed 's/\(^\| \)\([a-z_]*=\)/\1-\2/g' "$build/fuzz/$1.options"
}

figure() {  # LOG NAME: of the statistics at the end
  local found
  found=$(grep -aoE "^stat::$2: +[0-9]+" "$1" | tail -n 1)
  echo "${found##* }"
}

share() {  # PART WHOLE: in percent
  if (($2 > 0)); then echo "$((100 * $1 / $2)) %"; else echo -; fi
}

fuzz() {  # TARGET SECONDS
  local name=$1 log=$build/fuzz/logs/$1.log found flags malformed refused read
  mkdir -p "$build/fuzz/corpus/$name"
  read -ra flags < <(flags_of "$name")
  "$build/bin/fuzz_$name" "${flags[@]}" -runs="$runs" -max_total_time="$2" -timeout="$timeout" -reload=0 \
    -rss_limit_mb=512 -print_final_stats=1 -artifact_prefix="$build/fuzz/findings/$name-" \
    "$build/fuzz/corpus/$name" "$here/corpus/$name" >"$log" 2>&1
  found=$(($? != 0))
  malformed=$(figure "$log" malformed_inputs) refused=$(figure "$log" refused_inputs) read=$(figure "$log" read_inputs)
  local all=$((${malformed:-0} + ${refused:-0} + ${read:-0}))
  printf '%-12s %10s executions %7s/s  past parser %5s  read %5s  edges %s  corpus %s  findings %s\n' "$name" \
    "$(figure "$log" number_of_executed_units)" "$(figure "$log" average_exec_per_sec)" \
    "$(share $((all - ${malformed:-0})) $all)" "$(share "${read:-0}" $all)" \
    "$(grep -aoE 'cov: [0-9]+' "$log" | tail -n 1 | cut -d ' ' -f 2)" \
    "$(find "$build/fuzz/corpus/$name" "$here/corpus/$name" -type f | wc -l)" "$found"
  return "$found"
}

# What is left of the time, on all jobs and without what the running ones will use, goes to those that still wait.
fuzz_all() {
  local deadline=$((SECONDS + seconds)) failed=0 waiting=${#targets[@]} name free pid
  local -A ends=()
  for name in "${targets[@]}"; do
    if ((${#ends[@]} >= jobs)); then
      wait -n -p pid || failed=1
      unset "ends[$pid]"
    fi
    free=$((jobs * (deadline - SECONDS)))
    for pid in "${!ends[@]}"; do free=$((free - (ends[$pid] - SECONDS))); done
    local slice=$((free / waiting)) left=$((deadline - SECONDS))
    slice=$((slice > left ? left : slice))
    slice=$((slice < 1 ? 1 : slice))
    fuzz "$name" "$slice" &
    ends[$!]=$((SECONDS + slice))
    waiting=$((waiting - 1))
  done
  for pid in "${!ends[@]}"; do wait "$pid" || failed=1; done
  return "$failed"
}

minimize() {  # TARGET
  local name=$1 corpus=$here/corpus/$1 flags smallest
  smallest=$(mktemp -d)
  mkdir -p "$build/fuzz/corpus/$name"
  read -ra flags < <(flags_of "$name")
  # Without counters: an edge that is taken twice as often is not worth a file.
  "$build/bin/fuzz_$name" -merge=1 -use_counters=0 "${flags[@]}" "$smallest" "$corpus" "$build/fuzz/corpus/$name" \
    >/dev/null 2>&1 || { echo "cannot merge the corpus of $name" >&2; return 1; }
  find "$corpus" -type f ! -name 'seed-*' ! -name 'found-*' -delete
  local file
  for file in "$smallest"/*; do
    # The seeds are there already, under their names.
    find "$corpus" -type f -exec cmp -s {} "$file" \; -print -quit | grep -q . || cp "$file" "$corpus"
  done
  rm -rf "$smallest"
}

# Which lines count, by group; patterns of awk. tests/fuzz/CMakeLists.txt has the layers.
groups='
TOML             libs/files/src/
tables           libs/files/src/csv_re
domain files     libs/domains/src/(domain_file|read_|condition|exact_vector|reward|wording|grid_map|layers|rasters)
explicit models  libs/domains/src/(.*model|explicit_family)
policies         libs/domains/src/policy_file
study files      libs/study/src/(study_file|read_study_spec|read_prior)
tables of runs   libs/study/src/read_records
targets files    libs/analysis/src/(findings|effect)
logs of people   libs/fit/src/(import_|open_table)
record codec     libs/(runs/src/team_codec|files/src/bytes)
journal          libs/(runs/src/journal|files/src/sqlite)
'

coverage_table() {  # TITLE PROFILE OBJECT...
  local title=$1 profile=$2 object objects=()
  shift 2
  for object in "$@"; do objects+=(-object "$object"); done
  echo "== $title"
  llvm-cov export -format=lcov -instr-profile="$profile" "${objects[@]}" 2>/dev/null | awk -v groups="$groups" '
    BEGIN {
      n = split(groups, rows, "\n")
      for (i = 1; i <= n; ++i) if (match(rows[i], / +libs/)) {
        name[++count] = substr(rows[i], 1, RSTART - 1); pattern[count] = substr(rows[i], RSTART + RLENGTH - 4)
      }
    }
    /^SF:/ { group = 0; for (i = 1; i <= count; ++i) if ($0 ~ pattern[i]) group = i }
    /^LF:/ { lines[group] += substr($0, 4) }
    /^LH:/ { hit[group] += substr($0, 4) }
    END {
      for (i = 1; i <= count; ++i) if (hit[i] > 0) {
        printf "%-16s %6d lines %6.1f %%\n", name[i], lines[i], 100 * hit[i] / lines[i]
        all += lines[i]; reached += hit[i]
      }
      if (all > 0) printf "%-16s %6d lines %6.1f %%\n", "together", all, 100 * reached / all
    }'
}

coverage() {
  local folder name program flags programs=()
  folder=$(mktemp -d)
  for name in "${targets[@]}"; do
    program=$build/bin/fuzz_$name
    mkdir -p "$build/fuzz/corpus/$name"
    read -ra flags < <(flags_of "$name")
    LLVM_PROFILE_FILE=$folder/$name.raw "$program" "${flags[@]}" -runs=0 "$here/corpus/$name" \
      "$build/fuzz/corpus/$name" >/dev/null 2>&1 || { echo "$name fails on its corpus" >&2; return 1; }
    llvm-profdata merge -sparse "$folder/$name.raw" -o "$folder/$name.profile" || return 1
    coverage_table "$name" "$folder/$name.profile" "$program"
    programs+=("$program")
  done
  llvm-profdata merge -sparse "$folder"/*.raw -o "$folder/all" || return 1
  coverage_table "all targets" "$folder/all" "${programs[@]}"
  rm -rf "$folder"
}

case $mode in
  fuzz) fuzz_all ;;
  minimize) for name in "${targets[@]}"; do minimize "$name" || exit 1; done ;;
  coverage) coverage ;;
esac
