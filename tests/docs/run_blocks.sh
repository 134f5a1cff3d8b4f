#!/usr/bin/env bash
# run_blocks.sh SOURCE_DIR DOCUMENT BIN_DIR
#
# Runs the ```sh blocks of a document, in order, in one fresh folder that holds
# copies of domains/ and studies/, with BIN_DIR (kith) first on the PATH.
# `./run.sh ARGS` there is kith ARGS, as the real one is once everything is built.
# A command that fails ends the test. A block that cannot run in a test says why; one that runs until somebody stops it
# is stopped after a while, with what is said in its place:
#   ```sh skip: installs packages
#   ```sh stopped: runs until Ctrl-C
# Exit 77 (skipped) if the document has no block to run.
set -uo pipefail
source_dir=$(cd "$1" && pwd) document=$2 bin_dir=$3

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for part in domains studies; do
  if [[ -d $source_dir/$part ]]; then cp -r "$source_dir/$part" "$folder/"; fi
done
printf '#!/bin/sh\nexec kith "$@"\n' >"$folder/run.sh"
mkdir "$folder/bin" # kith serves at a free port, and opens no browser
printf '#!/bin/sh\n[ "$1" != serve ] || set -- "$@" --port 0\nexec "%s/kith" "$@"\n' "$bin_dir" >"$folder/bin/kith"
printf '#!/bin/sh\n' >"$folder/bin/xdg-open"
chmod +x "$folder/run.sh" "$folder/bin/"*

# One numbered file per block; the first line is a comment that says where the block stands.
blocks=$(mktemp -d)
trap 'rm -rf "$folder" "$blocks"' EXIT
awk -v to="$blocks" -v document="$document" '
  /^```sh([ \t]|$)/ && !open {
    open = 1
    if ($2 == "skip:" && NF > 2) { skipped = 1; print "skipped at line " NR ": " substr($0, index($0, "skip:") + 6); next }
    if ($2 == "stopped:" && NF > 2) { file = sprintf("%s/%03d-stopped", to, ++n); print "# " document ", line " NR > file; next }
    if ($2 != "") { print document ":" NR ": what is \"" $0 "\"? A skipped block needs a reason" > "/dev/stderr"; failed = 1; exit }
    file = sprintf("%s/%03d", to, ++n)
    print "# " document ", line " NR > file
    next
  }
  /^```/ { open = !open; file = ""; skipped = 0; next }
  open && file != "" { print > file }
  END { if (failed || (open && !failed)) exit 1 }' "$source_dir/$document" || exit 1

ran=0
cd "$folder" || exit 1
for block in "$blocks"/*; do
  [[ -e $block ]] || break
  head -n 1 "$block"
  [[ $block == *-stopped ]] && until=(timeout --signal INT 4) || until=()
  PATH=$folder/bin:$bin_dir:$PATH "${until[@]}" bash -xeuo pipefail "$block" </dev/null
  if (($? != (${#until[@]} > 0 ? 124 : 0))); then
    echo "$document: this block failed: $(head -n 1 "$block")"
    exit 1
  fi
  ran=$((ran + 1))
done
echo "$document: ran $ran blocks"
((ran > 0)) || exit 77
