#!/usr/bin/env bash
# transcripts.sh compare|update KITH FOLDER: the transcript of one team per strategy, learner model and way of talking
# that kith knows against (or into) FOLDER/STRATEGY.txt, learner-KIND.txt and discussion-MODEL.txt. Of each, the first
# and the last period are kept, and a digest of all of it.
set -uo pipefail
mode=$1 kith=$2 folder=$3
unset "${!KITH_@}"
status=0
declare -A command  # by the name of the transcript
# `kith explain TOPIC` begins the lines of names, and only these, with a small letter.
names_of() { "$kith" explain "$1" | grep -o '^[a-z][a-z0-9-]*$'; }
for strategy in $(names_of strategies); do command[$strategy]="--strategy $strategy"; done
# With "bayesian", the first kind, as the teacher assumes: that is what the strategies have.
for kind in $(names_of learners | tail -n +2); do
  command[learner-$kind]="--strategy joint --set stop.max_periods=6 --set learner.N.kind=\"$kind\" --set learner.P.kind=\"$kind\""
done
for model in $(names_of discussions | tail -n +2); do
  command[discussion-$model]="--strategy joint --set stop.max_periods=4 --set group.discussion.model=\"$model\""
done
if (( ${#command[@]} < 2 )); then
  echo "kith explain strategies does not list strategies"
  exit 1
fi
short_transcript() {  # WORD...
  local text
  text=$("$kith" teach item-delivery --group NNP --seed 1 "$@") || return
  printf '%s\n' "$text" | awk -v digest="$(printf '%s\n' "$text" | sha256sum | cut -c1-16)" '
    /^=+$/ { ++n }
    { part[n] = part[n] $0 "\n" }
    END { printf "%s(all %d lines: %s)\n", part[1], NR, digest; if (n > 2) printf "%s", part[n - 1]; printf "%s", part[n] }'
}
for name in $(printf '%s\n' "${!command[@]}" | sort); do
  file=$folder/$name.txt
  read -ra arguments <<<"${command[$name]}"
  if [[ $mode == update ]]; then
    short_transcript "${arguments[@]}" >"$file" || exit
  elif [[ ! -f $file ]]; then
    echo "$name has no transcript; to write it, run: cmake --build BUILD --target update_transcripts"
    status=1
  elif ! short_transcript "${arguments[@]}" | diff -u "$file" -; then
    echo "the transcript of $name has changed; if it should, run: cmake --build BUILD --target update_transcripts"
    status=1
  fi
done
for file in "$folder"/*.txt; do
  name=$(basename "$file" .txt)
  [[ -n ${command[$name]:-} ]] && continue
  echo "there is neither a strategy nor a learner model of the name $name, but a transcript: remove $file"
  status=1
done
exit $status
