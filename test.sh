#!/usr/bin/env bash
# Installs, builds and tests everything; see usage below.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")" || exit 1
. scripts/packages.sh

# In minutes of two cores; a part that takes longer is stopped. What it builds first comes on top: minutes where the
# night before has built it, three quarters of an hour for all parts together where nobody has.
night=(release ratios headers asan tsan python lesson fuzz coverage slow tidy)
declare -A budget=([release]=12 [ratios]=3 [headers]=5 [asan]=16 [tsan]=5 [python]=4 [lesson]=5 [fuzz]=7 [coverage]=4
  [slow]=24 [tidy]=12)
usage() {
  cat <<TEXT
usage: ./test.sh             what has to pass before anything is merged:
                             all tests in build/release, and those of layers that
                             read files under ASan and UBSan in build/asan
       ./test.sh --quick     the same without the sanitizers
       ./test.sh --nightly [PART...] [MINUTES]
                             all parts of the night, or those that are named:
                               release  all tests, and the benchmarks built
                               ratios   speed against plain implementations
                               headers  every public header compiled alone
                               asan     all layers and the module for Python under ASan and UBSan
                               tsan     those that use threads, under TSan
                               python   the module for Python: its tests, notebooks
                               fuzz     every fuzz target, MINUTES (5) in all
                               coverage what the inputs of fuzzing reach
                               slow     the slow tests
                               lesson   lessons in a file: the engine, and people in a browser
                               tidy     clang-tidy

Every form ends with a table of how long each part took. Parts of the night have
budgets for all but what they build, and enter what they did into
docs/nightly.md. Missing Debian packages are installed first, as ./run.sh does.
To run some tests again:
ctest --preset release -R NAME
TEXT
}

mode=normal minutes=5 chosen=()
for argument in "$@"; do
  case $argument in
    -h | --help) usage; exit ;;
    --quick | --nightly) mode=${argument#--} ;;
    *)
      if [[ $mode == nightly && $argument =~ ^[1-9][0-9]*$ ]]; then
        minutes=$argument
      elif [[ $mode == nightly && " ${night[*]} " == *" $argument "* ]]; then
        chosen+=("$argument")
      else
        usage >&2
        exit 2
      fi
      ;;
  esac
done
((${#chosen[@]})) || chosen=("${night[@]}")
budget[fuzz]=$((minutes + 2))

packages=("${packages_to_build[@]}" "${packages_to_test[@]}")
if [[ $mode == nightly ]]; then
  packages+=("${packages_for_nightly[@]}" "${packages_for_lesson[@]}" "${packages_for_python[@]}"
    "${packages_for_site[@]}" "${packages_to_pack[@]}")
fi
ensure_packages "${packages[@]}"

jobs=$(nproc)
table='' failed=0
deadline='' log='' building=0  # of a part of the night
part() {  # NAME COMMAND...: a part that fails does not keep the others from running
  local name=$1 start=$SECONDS outcome=''
  shift
  if [[ -n $deadline ]]; then in_time "$@"; else ("$@"); fi
  case $? in
    0) ;;
    124) outcome=' RAN OVER ITS BUDGET' ;;
    *) outcome=' FAILED' ;;
  esac
  [[ -z $outcome ]] || failed=$((failed + 1))
  table+=$(printf '%6d min %02d s  %s' $(((SECONDS - start) / 60)) $(((SECONDS - start) % 60)) "$name$outcome")$'\n'
  [[ -z $outcome ]]
}
build_minutes=40
build() {  # NAME ARGUMENT...: of configure_and_build; the deadline moves on meanwhile
  local end=$deadline start=$SECONDS status
  [[ -z $end ]] || deadline=$((SECONDS + 60 * build_minutes))
  part "$1: build" configure_and_build "${@:2}"
  status=$?
  building=$((building + SECONDS - start))
  [[ -z $end ]] || deadline=$((end + SECONDS - start))
  return "$status"
}
in_time() {  # COMMAND...: 124 if it had to be stopped at the deadline, with all that it started
  local running status
  set -m
  ("$@") < /dev/null > >(tee -a "$log" >&2) 2>&1 &
  running=$!
  set +m
  trap 'kill -- "-$running"; exit 130' INT TERM
  while kill -0 "$running" 2>/dev/null; do
    if ((SECONDS >= deadline)); then
      say "== stopped: out of time"
      kill -- "-$running"
      wait "$running" 2>/dev/null
      trap - INT TERM
      return 124
    fi
    sleep 1
  done
  wait "$running"
  status=$?
  trap - INT TERM
  return "$status"
}
run_tests() {  # PRESET [OPTION...]
  say
  say "== tests in build/$1"
  ctest --preset "$1" -j $((jobs + 1)) "${@:2}" || die "tests in build/$1 failed (again: ctest --preset $1 --rerun-failed)"
}
tests_of() { printf 'kith_%s_tests\n' "$@"; }
labels_of() { printf '^(%s)$' "$(IFS='|' && printf '%s' "$*")"; }

# Where files of others are read. Indices are checked in build/release too; the other layers are left to the night.
sanitized=(core files domains)
threaded=(core mdp bec teaching study runs service)
layers=(libs/*/tests)
layers=("${layers[@]#libs/}")
layers=("${layers[@]%/tests}")

release() {
  build release release -DKITH_BUILD_TESTS=ON "$@" -- all &&
    part "release: tests" run_tests release
}
asan() {  # LAYER...
  build ASan asan -- $(tests_of "$@") &&
    part "ASan: tests" run_tests asan -L "$(labels_of "$@")"
}
slow_tests() {
  say $'\n== slow tests in build/release'
  # validation.error_rates runs FalsePositivesSlow itself.
  ctest --test-dir build/release -L '^slow$' -E '^analysis\.FalsePositivesSlow' --output-on-failure -j "$jobs" ||
    die "slow tests failed"
}
fuzz() {
  say
  say "== fuzzing with build/fuzz for $minutes minutes"
  tests/fuzz/run.sh -s $((60 * minutes)) -j "$jobs" >&2 ||
    die "fuzzing found something: see build/fuzz/fuzz/findings and build/fuzz/fuzz/logs"
}

tidy() {  # libraries and command line, as they are compiled in build/release; none is a failure
  sed -n 's/^ *"file": "\(.*\)",*$/\1/p' build/release/compile_commands.json |
    grep -P '/(libs|apps)/\w+/(src|CMakeFiles/(?!\w*_tests\.)\w+\.dir)/' |
    xargs -t -d '\n' -P "$jobs" -n 1 clang-tidy -p build/release --quiet \
      --extra-arg=-Wno-unknown-warning-option >&2 || die "clang-tidy found something"
}

clock() { printf '%d:%02d' $(($1 / 60)) $(($1 % 60)); }  # SECONDS
nightly() {  # PART: what it did is a line of $results
  local start=$SECONDS failed_before=$failed outcome=passed
  log=$night_folder/$1.log building=0 deadline=$((SECONDS + 60 * ${budget[$1]}))
  : >"$log"
  run_part "$1"
  if ((SECONDS >= deadline)); then
    outcome='out of time'
  elif ((failed > failed_before)); then
    outcome=failed
  fi
  deadline=''
  printf '%s\t%d\t%s\t%s\t%s\n' "$1" "${budget[$1]}" "$(clock $((SECONDS - start - building)))" \
    "$(clock "$building")" "$outcome" >>"$results"
}
run_part() {
  case $1 in
    release) release -DKITH_BUILD_BENCHMARKS=ON ;;
    ratios)
      build ratios release -DKITH_BUILD_TESTS=ON -DKITH_BUILD_BENCHMARKS=ON -- all &&
        part "ratios" tests/rivals/ratios.py build/release/bin/kith_rivals_bench build/release/bin/kith
      ;;
    headers) part "headers alone" configure_and_build release -- all_verify_interface_header_sets ;;
    asan)
      asan "${layers[@]}" &&
        build "ASan, module" asan -DKITH_PYTHON=ON \
          -DPython3_EXECUTABLE=/usr/bin/python3 -- kith_python &&
        part "ASan: tests of the module" run_tests asan -L python
      ;;
    tsan)
      build TSan tsan -- $(tests_of "${threaded[@]}") && part "TSan: tests" run_tests tsan
      ;;
    python)
      build Python release -DKITH_BUILD_TESTS=ON -DKITH_PYTHON=ON \
        -DPython3_EXECUTABLE=/usr/bin/python3 -- kith kith_python && part "Python: tests" run_tests release -L python
      configure_and_build release -DKITH_PYTHON=OFF -- kith  # ./test.sh by day has no module
      ;;
    # The corpora are replayed by the fuzz targets themselves.
    fuzz) build fuzzing fuzz -- kith_fuzzers && part "fuzzing" fuzz ;;
    coverage)
      build coverage fuzz -- kith_fuzzers &&
        part "coverage" tests/fuzz/run.sh --coverage
      ;;
    slow)
      build "slow tests" release -DKITH_BUILD_TESTS=ON -- all && part "slow tests" slow_tests
      ;;
    lesson)
      build "lesson files" release -DKITH_BUILD_TESTS=ON -DKITH_LESSON=ON -- kith kith_web_packages &&
        part "lesson files: tests" run_tests release -R '^web\.Lesson(File|Doors|Firefox|Sessions)$'
      ;;
    tidy) build "files for clang-tidy" release -DKITH_BUILD_TESTS=ON -- all && part "clang-tidy" tidy ;;
  esac
}

# What most likely fails first, what takes long last.
case $mode in
  normal) asan "${sanitized[@]}"; release ;;
  quick) release ;;
  nightly)
    night_folder=build/nightly results=build/nightly/results.tsv
    mkdir -p "$night_folder"
    : >"$results"
    for name in "${chosen[@]}"; do nightly "$name"; done
    scripts/nightly.py "$results" "$(git describe --always --dirty 2>/dev/null || echo unknown)" ||
      failed=$((failed + 1))
    ;;
esac
say
say "Time taken:"
printf '%s' "$table" >&2
((failed == 0)) || die "parts that failed: $failed"
say "All passed"
