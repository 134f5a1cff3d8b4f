#!/usr/bin/env bash
# transcripts.sh compare|update KITH FOLDER: the transcript of one team per
# strategy that kith knows against (or into) FOLDER/STRATEGY.txt.
set -uo pipefail
mode=$1 kith=$2 folder=$3
unset "${!KITH_@}"
status=0
# `kith explain strategies` begins the lines of names, and only these, with a small letter.
mapfile -t strategies < <("$kith" explain strategies | grep -o '^[a-z][a-z0-9-]*$')
if (( ${#strategies[@]} < 2 )); then
  echo "kith explain strategies does not list strategies"
  exit 1
fi
for strategy in "${strategies[@]}"; do
  file=$folder/$strategy.txt
  if [[ $mode == update ]]; then
    "$kith" teach item-delivery --group NNP --strategy "$strategy" --seed 1 >"$file" || exit
  elif [[ ! -f $file ]]; then
    echo "the strategy $strategy has no transcript; to write it, run: cmake --build BUILD --target update_transcripts"
    status=1
  elif ! "$kith" teach item-delivery --group NNP --strategy "$strategy" --seed 1 | diff -u "$file" -; then
    echo "the transcript of $strategy has changed; if it should, run: cmake --build BUILD --target update_transcripts"
    status=1
  fi
done
for file in "$folder"/*.txt; do
  name=$(basename "$file" .txt)
  [[ " ${strategies[*]} " == *" $name "* ]] && continue
  echo "there is no strategy $name, but a transcript: remove $file"
  status=1
done
exit $status
