#!/usr/bin/env bash
# Installs, builds and tests everything; see usage below.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")" || exit 1
. scripts/packages.sh

usage() {
  cat <<'TEXT'
usage: ./test.sh             what has to pass before anything is merged:
                             all tests in build/release, and the tests of the
                             layers up to learners under ASan and UBSan in build/asan
       ./test.sh --quick     the same without the sanitizers
       ./test.sh --nightly   also every header alone, the slow tests, all libraries
                             under ASan and UBSan,
                             ThreadSanitizer over the study layer, clang-tidy, the benchmarks built, and every
                             fuzz target for 10 million executions, at most an
                             hour each

Installs missing Debian packages first, as ./run.sh does. To run a part of the
tests again: ctest --preset release -R Cone
TEXT
}

mode=${1:-normal}
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

everything=(all)
if [[ $mode == --nightly ]]; then everything+=(all_verify_interface_header_sets); fi
configure_and_build release -DKITH_BUILD_TESTS=ON -- "${everything[@]}"
# Where pointers and indices are handled; studies and what is made of them take most of the time and are left to the night.
sanitized=(core files random toml geometry mdp domains bec belief teaching learners table explain)
case $mode in
  normal)
    targets=("${sanitized[@]/#/kith_}")
    configure_and_build asan -- "${targets[@]/%/_tests}"
    run_tests asan -L "^($(IFS='|' && printf '%s' "${sanitized[*]}"))\$"
    ;;
  --nightly)
    configure_and_build asan -- all
    run_tests asan
    ;;
esac
if [[ $mode == --nightly ]]; then
  configure_and_build tsan -- kith_study_tests
  run_tests tsan
  configure_and_build tidy -- all
  configure_and_build bench -- all
  configure_and_build fuzz -- all
  say
  say "== fuzzing with build/fuzz"
  tests/fuzz/run.sh -j "$jobs" >&2 || die "fuzzing found something: see build/fuzz/findings and build/fuzz/logs"
  say
  say "== slow tests in build/release"
  ctest --test-dir build/release -L '^slow$' --output-on-failure -j "$jobs" || die "slow tests failed"
fi
# Last, so that the log ends with the summary of the whole suite.
run_tests release
