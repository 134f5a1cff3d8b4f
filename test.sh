#!/usr/bin/env bash
# Installs, builds and tests everything; see usage below.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")" || exit 1
. scripts/packages.sh

usage() {
  cat <<'TEXT'
usage: ./test.sh             what has to pass before anything is merged:
                             all tests in build/release, and the tests of the
                             lowest layers under ASan and UBSan in build/asan
       ./test.sh --quick     the same without the sanitizers
       ./test.sh --nightly [FUZZING]
                             also the slow tests, every header alone, all layers
                             under ASan and UBSan, those that use threads under
                             ThreadSanitizer, clang-tidy, the benchmarks built,
                             and every fuzz target: FUZZING minutes (12) in all.
                             Ends with how long each part took

Installs missing Debian packages first, as ./run.sh does. To run a part of the
tests again: ctest --preset release -R Cone
TEXT
}

mode=${1:-normal} fuzzing=${2:-12}
case $mode in
  normal | --quick) [[ $# -le 1 ]] || mode=wrong ;;
  --nightly) [[ $# -le 2 && $fuzzing =~ ^[1-9][0-9]*$ ]] || mode=wrong ;;
esac
case $mode in
  normal | --quick | --nightly) ;;
  -h | --help)
    usage
    exit
    ;;
  *)
    usage >&2
    exit 2
    ;;
esac

packages=("${packages_to_build[@]}" "${packages_to_test[@]}")
if [[ $mode == --nightly ]]; then packages+=("${packages_for_nightly[@]}"); fi
ensure_packages "${packages[@]}"

jobs=$(nproc)
run_tests() {
  say
  say "== tests in build/$1"
  ctest --preset "$1" -j "$jobs" "${@:2}" || die "tests in build/$1 failed (again: ctest --preset $1 --rerun-failed)"
}

# Where files are read and indices are computed; what is built on that takes most of the time and is left to the night.
sanitized=(core files random toml geometry mdp domains table)

if [[ $mode != --nightly ]]; then
  configure_and_build release -DKITH_BUILD_TESTS=ON -- all
  if [[ $mode == normal ]]; then
    targets=("${sanitized[@]/#/kith_}")
    configure_and_build asan -- "${targets[@]/%/_tests}"
    run_tests asan -L "^($(IFS='|' && printf '%s' "${sanitized[*]}"))\$"
  fi
  # Last, so that the log ends with the summary of the whole suite.
  run_tests release
  exit
fi

# The night: what most likely fails first, what takes long last, nothing twice. A part that fails does not keep the
# others from running, except that tests are not run where their build failed.
parts='' failed=0
part() {  # NAME COMMAND...
  local name=$1 start=$SECONDS outcome=''
  shift
  if ! ("$@"); then
    outcome=' FAILED'
    failed=$((failed + 1))
  fi
  parts+=$(printf '%6d min %02d s  %s' $(((SECONDS - start) / 60)) $(((SECONDS - start) % 60)) "$name$outcome")$'\n'
  [[ -z $outcome ]]
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
  say "== fuzzing with build/fuzz for $fuzzing minutes"
  tests/fuzz/run.sh -s $((60 * fuzzing)) -j "$jobs" >&2 ||
    die "fuzzing found something: see build/fuzz/findings and build/fuzz/logs"
}
# The benchmarks are built with the libraries of the release; the corpora are replayed by the fuzz targets themselves.
layers=(libs/*/tests)
layers=("${layers[@]#libs/}")
layers=("${layers[@]%/tests}")
all_tests=("${layers[@]/#/kith_}")

if part "release: build" configure_and_build release -DKITH_BUILD_TESTS=ON -DKITH_BUILD_BENCHMARKS=ON -- all; then
  part "release: tests" run_tests release
fi
part "headers alone" configure_and_build release -- all_verify_interface_header_sets
part "ASan: build" configure_and_build asan -- "${all_tests[@]/%/_tests}" && part "ASan: tests" run_tests asan
part "TSan: build" configure_and_build tsan -- kith_{core,mdp,bec,teaching,study,runs,server}_tests && part "TSan: tests" run_tests tsan
part "fuzzing: build" configure_and_build fuzz -- kith_fuzzers && part "fuzzing" fuzz
part "slow tests" slow_tests
part "clang-tidy" configure_and_build tidy -- all
say
say "The night:"
printf '%s' "$parts" >&2
((failed == 0)) || die "parts that failed: $failed"
say "All passed"
