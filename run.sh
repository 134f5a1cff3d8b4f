#!/usr/bin/env bash
# Builds kith and runs it; see usage below.
#
# Running the study again is left to kith: results of the same study in the output
# folder are replaced, by the same bytes. This script deletes nothing; the folder of a
# different study is refused.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")" || exit 1
root=$PWD
. scripts/packages.sh

usage() {
  cat <<'TEXT'
usage: ./run.sh            build kith, run the paper's study into results/paper, print its table and
                           what was found, and write results/paper/report.html
       ./run.sh --setup    install what is missing and build, no more
       ./run.sh --lesson   the same, with the engine that `kith lesson` puts into pages; needs Emscripten
       ./run.sh ARGS...    the same, then `kith ARGS...` (./run.sh help: what kith can do)

Installs missing Debian packages first, and says which and how large; that needs
root or sudo, and the network, once. Builds into build/release.
TEXT
}

case ${1:-} in
  -h | --help)
    usage
    exit
    ;;
esac

packages=("${packages_to_build[@]}")
[[ ${1:-} == --lesson ]] && packages+=("${packages_for_lesson[@]}")
ensure_packages "${packages[@]}"
tests=()
# Without GoogleTest there is nothing to test with; a folder that test.sh has made stays as it is.
[[ -e build/release/build.ninja ]] || tests=(-DKITH_BUILD_TESTS=OFF)
[[ ${1:-} == --lesson ]] && tests+=(-DKITH_LESSON=ON)
configure_and_build release "${tests[@]}" -- kith kith_manual  # all that cmake --install installs
kith=$root/build/release/bin/kith

case ${1:-} in
  --setup | --lesson)
    say "Ready: build/release/bin/kith"
    ;;
  '')
    say "Running the paper's study: kith study studies/paper.toml -o results/paper"
    "$kith" study studies/paper.toml -o results/paper || exit
    say
    say "What it found: kith analyze results/paper --brief (without --brief: every table)"
    "$kith" analyze results/paper --brief || exit
    say
    say "Figures, tables, methods: kith report results/paper -o results/paper/report.html"
    "$kith" report results/paper -o results/paper/report.html || exit
    say "Tables: results/paper/tables/*.csv, every column explained in results/paper/tables/codebook.json"
    say "Report: $root/results/paper/report.html"
    ;;
  *)
    cd "${OLDPWD:-$root}" && exec "$kith" "$@"
    ;;
esac
