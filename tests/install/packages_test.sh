#!/usr/bin/env bash
# packages_test.sh BUILD: the packages for Debian hold what they should, and the program needs nothing that is large.
set -euo pipefail
build=$1
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
fail() { echo "$*" >&2; exit 1; }

cpack --config "$build/CPackConfig.cmake" -B "$out" >"$out/log" || { cat "$out/log"; exit 1; }
holds() {  # PACKAGE PATTERN...
  local package=("$out/$1"_*.deb) pattern
  shift
  dpkg-deb -c "${package[0]}" >"$out/list"
  for pattern in "$@"; do grep -qE "$pattern" "$out/list" || fail "${package[0]} has no $pattern"; done
}
holds kith ' ./usr/bin/kith$' 'man1/kith\.1' 'share/kith/domains/item_delivery\.toml$'
holds libkith-dev 'cmake/kith/kithConfig\.cmake$' 'include/kith/bec/atlas\.hpp$' 'libkith_bec\.a$'
[[ -e $build/lib/kith_mpi.so ]] && holds kith-mpi 'kith/kith_mpi\.so$'
grep -q '^KITH_PYTHON:BOOL=ON' "$build/CMakeCache.txt" && holds python3-kith 'kith/__init__\.py$' 'kith/_core\..*\.so$' 'kith/py\.typed$'
grep -q '^KITH_SITE:BOOL=ON' "$build/CMakeCache.txt" && holds kith 'html/docs/README\.html$'
if dpkg-deb -f "$out"/kith_*.deb Depends | grep -E 'mpi|python'; then fail "the package of the program needs this"; fi
