#!/usr/bin/env bash
# orders_test.sh SOURCE_DIR: what the scripts may be asked for in any order works in any order. The tools that they call
# are replaced by ones that write down what they are told; whatever is switched on has its packages when tests run.
set -euo pipefail
((EUID == 0)) || { echo "only root installs packages without being asked"; exit 77; }
source_dir=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { printf '%s\n' "$*"; exit 1; }

mkdir "$folder/bin"
stub() { printf '#!/usr/bin/env bash\n%s\n' "$2" >"$folder/bin/$1" && chmod +x "$folder/bin/$1"; }
stub apt-get 'for one in "$@"; do [[ $one == -* || $one == install ]] || echo "$one" >>"$STATE/installed"; done'
stub dpkg-query 'sed "s/^/installed /" "$STATE/installed"'
stub cmake '[[ $1 == --build ]] && exit
mkdir -p build/release/bin && touch build/release/build.ninja
printf "#!/bin/sh\n" >build/release/bin/kith && chmod +x build/release/bin/kith
for one in "$@"; do [[ $one == -DKITH_* ]] && echo "${one#-D}" | sed "s/=/:BOOL=/" >>build/release/CMakeCache.txt; done
echo "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" >>build/release/CMakeCache.txt'
stub ctest 'echo "$@" >>"$STATE/tests"'

needs() {  # PACKAGE...: fails unless all of them are installed
  local one
  for one in "$@"; do
    [[ $one == nodejs || $one == npm || " ${installed[*]} " == *" $one "* ]] || fail "after $order: $one is not installed"
  done
}
check() {
  local on installed
  mapfile -t installed <"$STATE/installed"
  on=$(sed -n 's/^\(KITH_[A-Z_]*\):BOOL=ON$/\1/p' build/release/CMakeCache.txt | sort -u)
  needs "${packages_to_build[@]}"
  [[ $on != *KITH_PYTHON* ]] || needs "${packages_for_python[@]}"
  [[ $on != *KITH_LESSON* ]] || needs "${packages_for_lesson[@]}"
  [[ $on != *KITH_BUILD_TESTS* ]] || needs "${packages_to_test[@]}"
}

. "$source_dir/scripts/packages.sh"
steps=("run.sh --setup" "run.sh --python" "run.sh --lesson" "test.sh --quick")
for first in "${steps[@]}"; do
  for second in "${steps[@]}"; do
    order="./$first, ./$second"
    export STATE=$folder/state
    rm -rf "$STATE" "$folder/tree"
    mkdir -p "$STATE" "$folder/tree/scripts" "$folder/tree/libs/core/tests"
    touch "$STATE/installed"
    cp "$source_dir"/{run.sh,test.sh,CMakePresets.json} "$folder/tree/"
    cp "$source_dir"/scripts/* "$folder/tree/scripts/"
    cd "$folder/tree"
    for step in "$first" "$second"; do
      PATH=$folder/bin:$PATH ./$step >"$STATE/log" 2>&1 || fail "after $order: $(cat "$STATE/log")"
      check
    done
    [[ $order != *python*python* ]] || continue
    [[ $order != *python* ]] || grep -q '^KITH_PYTHON:BOOL=ON' build/release/CMakeCache.txt || fail "after $order: no module"
  done
done

# The tests of the module run wherever the module was built: what they need beyond its packages, they look for first.
cd "$source_dir"
python3 - <<'PYTHON'
import ast, pathlib, sys
packaged = {"kith", "numpy", "pandas", "support"} | {path.stem for path in pathlib.Path("python/kith").glob("*.py")}
for path in sorted(pathlib.Path("python/tests").glob("test_*.py")):
    tree = ast.parse(path.read_text())
    imports = [n for n in tree.body if isinstance(n, (ast.Import, ast.ImportFrom))]
    names = [a.name for n in imports if isinstance(n, ast.Import) for a in n.names]
    names += [n.module for n in imports if isinstance(n, ast.ImportFrom)]
    for name in names:
        if name.split(".")[0] not in packaged | set(sys.stdlib_module_names):
            sys.exit(f"{path}: {name} comes with no package that ./run.sh --python installs")
    text = path.read_text()
    if "importlib.util" not in names and ("importlib.util." in text or '"importlib").util' in text):
        sys.exit(f"{path}: importlib.util is used, but not imported")
PYTHON
