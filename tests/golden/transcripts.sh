#!/usr/bin/env bash
# transcripts.sh compare|update KITH FOLDER: the transcript of one team per
# strategy against (or into) FOLDER/STRATEGY.txt.
set -uo pipefail
mode=$1 kith=$2 folder=$3
unset "${!KITH_@}"
status=0
for strategy in baseline individual-low individual-high common joint; do
  file=$folder/$strategy.txt
  if [[ $mode == update ]]; then
    "$kith" teach item-delivery --group NNP --strategy "$strategy" --seed 1 >"$file" || exit
  elif ! "$kith" teach item-delivery --group NNP --strategy "$strategy" --seed 1 | diff -u "$file" -; then
    echo "the transcript of $strategy has changed; if it should, run: cmake --build BUILD --target update_transcripts"
    status=1
  fi
done
exit $status
