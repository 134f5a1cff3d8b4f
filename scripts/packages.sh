# shellcheck shell=bash
# Sourced by run.sh and test.sh: installs the Debian packages that are missing,
# and builds quietly. All messages go to stderr; stdout belongs to kith.

say() { printf '%s\n' "$*" >&2; }
die() { say "$(basename "$0"): $*"; exit 1; }

packages_to_build=(
  g++ cmake ninja-build
  libeigen3-dev librandom123-dev libtomlplusplus-dev nlohmann-json3-dev libcli11-dev libfmt-dev
  libssl-dev libsqlite3-dev libqrencode-dev libyaml-dev libboost-math-dev libboost-dev
  nodejs npm
)
packages_for_python=(pybind11-dev python3-dev python3-numpy python3-pandas)
packages_for_site=(python3-sphinx python3-myst-parser doxygen)
packages_to_pack=(dpkg-dev file libopenmpi-dev)  # cpack asks `file` what needs shared libraries
packages_to_test=(libgtest-dev libgmock-dev chromium libopenmpi-dev openmpi-bin)
packages_for_lesson=(emscripten xz-utils)  # LLVM for WebAssembly; what packs the page
packages_for_nightly=(clang clang-tidy clang-format libclang-rt-14-dev llvm libbenchmark-dev
  firefox-esr
  mypy python3-matplotlib python3-pip python3-setuptools python3-wheel
  r-base-core r-cran-car r-cran-emmeans r-cran-jsonlite r-cran-lme4 r-cran-lmertest r-cran-mass r-cran-ordinal
  r-cran-survival)

# missing_packages NAME...: those that are neither installed as packages nor, where people often have another source than
# Debian, there as commands.
missing_packages() {
  local installed package
  installed=" $(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "$@" 2>/dev/null | sed -n 's/^installed //p' | tr '\n' ' ')"
  for package in "$@"; do
    case $package in
      nodejs) ! command -v node >/dev/null || continue ;;
      npm) ! command -v npm >/dev/null || continue ;;
    esac
    [[ $installed == *" $package "* ]] || echo "$package"
  done
}

# ensure_packages NAME...: installs those that are not installed; does nothing,
# offline too, if all are. Needs root or sudo; else names the command and stops.
ensure_packages() {
  if ! command -v dpkg-query >/dev/null; then
    say "This is not Debian: the build needs what these packages hold: $*"
    return
  fi
  local missing
  mapfile -t missing < <(missing_packages "$@")
  ((${#missing[@]})) || return 0

  local as_root=()
  if ((EUID != 0)); then
    if command -v sudo >/dev/null && { [[ -t 0 ]] || sudo -n true 2>/dev/null; }; then
      as_root=(sudo)
    else
      say "These packages are missing, and installing them needs root:"
      say "  apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"
      exit 1
    fi
  fi
  say "Missing packages: ${missing[*]}"
  run_logged "reading the package lists" "${as_root[@]}" apt-get update -qq
  apt_get_install "${missing[@]}"
}

# Uses as_root of ensure_packages. Says how much is coming before it comes.
apt_get_install() {
  local options=(-y --no-install-recommends -o DPkg::Lock::Timeout=120) size
  size=$(LC_ALL=C apt-get install --no-install-recommends --assume-no "$@" 2>/dev/null |
    sed -nE 's/^Need to get (.*) of archives.*/\1 to download/p; s/^After this operation, (.*) of additional.*/\1 on disk/p' |
    paste -sd ';' | sed 's/;/, /')
  say "Installing them and what they need: ${size:-size unknown}"
  run_logged "installing packages" "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive LC_ALL=C \
    apt-get install -qq -o Dpkg::Use-Pty=0 "${options[@]}" "$@"
}

# run_logged WHAT COMMAND...: a dot every few seconds; the output only if it fails.
run_logged() {
  local what=$1 log pid dots=$SECONDS
  shift
  log=$(mktemp)
  printf '%s ' "$what" >&2
  "$@" >"$log" 2>&1 </dev/null &
  pid=$!
  while kill -0 "$pid" 2>/dev/null; do
    sleep 0.1
    ((SECONDS - dots < 5)) || { dots=$SECONDS && printf . >&2; }
  done
  if ! wait "$pid"; then
    say "failed:"
    tail -n 40 "$log" >&2
    rm -f "$log"
    die "$what failed; are you online? The command was: $*"
  fi
  rm -f "$log"
  say "done"
}

# configure_and_build PRESET [-D...] -- TARGET...: nothing but a summary where
# nothing is to be done; progress, warnings and errors otherwise.
configure_and_build() {
  local preset=$1 definitions=() log
  shift
  while [[ $1 != -- ]]; do definitions+=("$1"); shift; done
  shift
  # A folder that was copied or moved cannot go on with its old cache.
  local cache=build/$preset/CMakeCache.txt
  if [[ -e $cache ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" "$cache"; then definitions+=(--fresh); fi

  log=$(mktemp)
  if ! cmake --preset "$preset" "${definitions[@]}" >"$log" 2>&1; then
    cat "$log" >&2
    rm -f "$log"
    die "configuring build/$preset failed"
  fi
  grep -A 8 'CMake Warning' "$log" >&2
  rm -f "$log"
  NINJA_STATUS='[%f/%t] ' cmake --build --preset "$preset" --target "$@" 2>&1 | some_progress "$preset" >&2 ||
    die "building build/$preset failed"
}

# From ninja's "[done/total] ..." lines every tenth part, on a terminal a counter; all other lines as they are.
# Looking whether anything has to be done takes a few steps itself, which nobody needs to see.
some_progress() {
  local line done total tenth shown='' counting=0
  while IFS= read -r line; do
    if [[ $line =~ ^\[([0-9]+)/([0-9]+)\]\  ]]; then
      done=${BASH_REMATCH[1]} total=${BASH_REMATCH[2]}
      if ((total <= 10)); then continue; fi
      tenth=$((10 * done / total))/$total
      if [[ -t 2 ]]; then
        printf '\r[%s %d/%d] ' "$1" "$done" "$total"
        counting=1
      elif [[ $tenth != "$shown" ]]; then
        printf '[%s %d/%d]\n' "$1" "$done" "$total"
      fi
      shown=$tenth
    elif [[ $line != 'ninja: no work to do.' ]]; then
      if ((counting)); then printf '\n'; fi
      counting=0
      printf '%s\n' "$line"
    fi
  done
  if ((counting)); then printf '\n'; fi
}
