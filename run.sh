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
       ./run.sh --lesson   the same with the engine that `kith lesson` puts into pages
       ./run.sh --python   the same with the module for Python, into build/release/python
       ./run.sh --packages the same with packages for Debian, into build/packages
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

packages=("${packages_to_build[@]}") module=() targets=(kith kith_manual)  # all that cmake --install installs
case ${1:-} in
  --lesson)
    packages+=("${packages_for_lesson[@]}")
    module=(-DKITH_LESSON=ON)
    ;;
  --python)
    packages+=("${packages_for_python[@]}")
    module=(-DKITH_PYTHON=ON -DPython3_EXECUTABLE=/usr/bin/python3)
    targets+=(kith_python)
    ;;
  --packages)
    packages+=("${packages_for_python[@]}" "${packages_for_site[@]}" "${packages_to_pack[@]}")
    module=(-DKITH_PYTHON=ON -DPython3_EXECUTABLE=/usr/bin/python3 -DKITH_SITE=ON -DKITH_MPI=ON)
    targets+=(kith_python kith_site)
    ;;
esac
ensure_packages "${packages[@]}"
tests=()
# Without GoogleTest there is nothing to test with; a folder that test.sh has made stays as it is.
[[ -e build/release/build.ninja ]] || tests=(-DKITH_BUILD_TESTS=OFF)
# A folder that has the module keeps it, so that cmake --install finds it up to date.
if [[ ${1:-} != --python ]] && grep -qs '^KITH_PYTHON:BOOL=ON' build/release/CMakeCache.txt; then
  targets+=(kith_python)
fi
configure_and_build release "${tests[@]}" "${module[@]}" -- "${targets[@]}"
kith=$root/build/release/bin/kith

case ${1:-} in
  --setup | --lesson)
    say "Ready: build/release/bin/kith"
    ;;
  --packages)
    run_logged "packing" cpack --config build/release/CPackConfig.cmake -B build/packages
    rm -rf build/packages/_CPack_Packages
    say "Ready:"
    du -h build/packages/*.deb >&2
    say "Install them on Debian 12: apt install ./build/packages/*.deb"
    ;;
  --python)
    say "Ready: PYTHONPATH=$root/build/release/python python3"
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
