#!/usr/bin/env bash
# Installs, builds and tests everything; see usage below.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")" || exit 1
. scripts/packages.sh

night=(release ratios headers asan tsan python lesson fuzz slow tidy)
usage() {
  cat <<TEXT
usage: ./test.sh             what has to pass before anything is merged:
                             all tests in build/release, and the tests of the
                             lowest layers under ASan and UBSan in build/asan
       ./test.sh --quick     the same without the sanitizers
       ./test.sh --nightly [PART...] [MINUTES]
                             all parts of the night, or those that are named:
                               release  all tests, and the benchmarks built
                               ratios   speed against plain implementations
                               headers  every public header compiled alone
                               asan     all layers under ASan and UBSan
                               tsan     those that use threads, under TSan
                               python   the module for Python: its tests, notebooks
                               fuzz     every fuzz target, MINUTES (12) in all
                               slow     the slow tests
                               lesson   lessons in a file: the engine, and people in a browser
                               tidy     clang-tidy

Every form ends with a table of how long each part took. Missing Debian packages
are installed first, as ./run.sh does. To run some tests again:
ctest --preset release -R NAME
TEXT
}

mode=normal minutes=12 chosen=()
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

packages=("${packages_to_build[@]}" "${packages_to_test[@]}")
if [[ $mode == nightly ]]; then
  packages+=("${packages_for_nightly[@]}" "${packages_for_lesson[@]}" "${packages_for_python[@]}")
fi
ensure_packages "${packages[@]}"

jobs=$(nproc)
table='' failed=0
part() {  # NAME COMMAND...: a part that fails does not keep the others from running
  local name=$1 start=$SECONDS outcome=''
  shift
  if ! ("$@"); then
    outcome=' FAILED'
    failed=$((failed + 1))
  fi
  table+=$(printf '%6d min %02d s  %s' $(((SECONDS - start) / 60)) $(((SECONDS - start) % 60)) "$name$outcome")$'\n'
  [[ -z $outcome ]]
}
run_tests() {  # PRESET [OPTION...]
  say
  say "== tests in build/$1"
  ctest --preset "$1" -j "$jobs" "${@:2}" || die "tests in build/$1 failed (again: ctest --preset $1 --rerun-failed)"
}
tests_of() { printf 'kith_%s_tests\n' "$@"; }
labels_of() { printf '^(%s)$' "$(IFS='|' && printf '%s' "$*")"; }

# Where files are read and indices are computed; what is built on that takes most of the time and is left to the night.
sanitized=(core files random toml geometry mdp domains table)
threaded=(core mdp bec teaching study runs server)
layers=(libs/*/tests)
layers=("${layers[@]#libs/}")
layers=("${layers[@]%/tests}")

release() {
  part "release: build" configure_and_build release -DKITH_BUILD_TESTS=ON "$@" -- all &&
    part "release: tests" run_tests release
}
asan() {  # LAYER...
  part "ASan: build" configure_and_build asan -- $(tests_of "$@") &&
    part "ASan: tests" run_tests asan -L "$(labels_of "$@")"
}
slow_tests() {
  say
  say "== slow tests in build/release"
  # validation.error_rates runs FalsePositivesSlow itself.
  ctest --test-dir build/release -L '^slow$' -E '^analysis\.FalsePositivesSlow' --output-on-failure -j "$jobs" ||
    die "slow tests failed"
}
fuzz() {
  say
  say "== fuzzing with build/fuzz for $minutes minutes"
  tests/fuzz/run.sh -s $((60 * minutes)) -j "$jobs" >&2 ||
    die "fuzzing found something: see build/fuzz/findings and build/fuzz/logs"
}

nightly() {  # PART
  case $1 in
    release) release -DKITH_BUILD_BENCHMARKS=ON ;;
    ratios)
      part "ratios: build" configure_and_build release -DKITH_BUILD_TESTS=ON -DKITH_BUILD_BENCHMARKS=ON -- all &&
        part "ratios" tests/rivals/ratios.py build/release/bin/kith_rivals_bench build/release/bin/kith
      ;;
    headers) part "headers alone" configure_and_build release -- all_verify_interface_header_sets ;;
    asan) asan "${layers[@]}" ;;
    tsan)
      part "TSan: build" configure_and_build tsan -- $(tests_of "${threaded[@]}") && part "TSan: tests" run_tests tsan
      ;;
    python)
      part "Python: build" configure_and_build release -DKITH_BUILD_TESTS=ON -DKITH_PYTHON=ON \
        -DPython3_EXECUTABLE=/usr/bin/python3 -- kith kith_python && part "Python: tests" run_tests release -L python
      configure_and_build release -DKITH_PYTHON=OFF -- kith  # ./test.sh by day has no module
      ;;
    # The corpora are replayed by the fuzz targets themselves.
    fuzz) part "fuzzing: build" configure_and_build fuzz -- kith_fuzzers && part "fuzzing" fuzz ;;
    slow)
      part "slow tests: build" configure_and_build release -DKITH_BUILD_TESTS=ON -- all && part "slow tests" slow_tests
      ;;
    lesson)
      part "lesson files: build" configure_and_build release -DKITH_BUILD_TESTS=ON -DKITH_LESSON=ON -- kith kith_web_packages &&
        part "lesson files: tests" run_tests release -R '^web\.LessonFile$'
      ;;
    tidy) part "clang-tidy" configure_and_build tidy -- all ;;
  esac
}

# What most likely fails first, what takes long last.
case $mode in
  normal) asan "${sanitized[@]}"; release ;;
  quick) release ;;
  nightly) for name in "${chosen[@]}"; do nightly "$name"; done ;;
esac
say
say "Time taken:"
printf '%s' "$table" >&2
((failed == 0)) || die "parts that failed: $failed"
say "All passed"
