#!/usr/bin/env bash
# Shows that run_blocks.sh fails where it has to, with documents made here and a stand-in for kith.
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/bin" "$folder/domains"
printf '#!/bin/sh\n[ "$1" = works ]\n' >"$folder/bin/kith"
chmod +x "$folder/bin/kith"
failures=0

expect() {  # expect EXIT_CODE WHAT LINE...
  printf '%s\n' "${@:3}" >"$folder/document.md"
  bash "$here/run_blocks.sh" "$folder" document.md "$folder/bin" >"$folder/log" 2>&1
  local got=$?
  if ((got != $1)); then
    echo "$2: exit $got, not $1"
    cat "$folder/log"
    failures=$((failures + 1))
  fi
}

expect 0 'a block that works' '```sh' 'kith works' './run.sh works' 'test -d domains' '```'
expect 1 'a command that fails' '```sh' 'kith fails' '```'
expect 1 'a failure before the last command' '```sh' './run.sh fails' 'kith works' '```'
expect 1 'a failure in the second block' '```sh' 'kith works' '```' 'text' '```sh' 'kith fails' '```'
expect 0 'blocks share one folder' '```sh' 'touch a' '```' '```sh' 'test -e a' '```'
expect 77 'other languages are not run' '```toml' 'kith fails' '```' '```' 'kith fails' '```'
expect 0 'a block that runs until it is stopped' '```sh stopped: waits' 'sleep 60' '```'
expect 1 'a block that ends before it is stopped' '```sh stopped: waits' 'kith works' '```'
expect 77 'a skipped block with its reason' '```sh skip: needs the network' 'kith fails' '```'
expect 1 'a skipped block without a reason' '```sh skip:' 'kith fails' '```'
expect 1 'a block that never ends' '```sh' 'kith works'
((failures == 0))
