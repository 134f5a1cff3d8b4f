#!/usr/bin/env bash
# compare.sh KITH SOURCE_DIR
#
# Analyses tables with kith, runs the R scripts that it writes, and compares every number that both have. Exit 77
# (skipped) where R or one of its packages is missing.
set -euo pipefail
kith=$1
here=$2/tests/r

if ! command -v Rscript >/dev/null; then
  echo "skipped: there is no Rscript"
  exit 77
fi
for package in car emmeans lme4 lmerTest MASS survival; do
  if ! Rscript -e "quit(status = !requireNamespace('$package', quietly = TRUE))" >/dev/null 2>&1; then
    echo "skipped: R has no package $package"
    exit 77
  fi
done

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$kith" study paper -o run --quiet --set replicates=4 >/dev/null
"$kith" study paper -o others --quiet --set replicates=4 --set 'design.pairing="none"' >/dev/null
# Unbalanced tables: some teams are left out. The second has other people in every team.
awk -F, 'NR == 1 || NR % 7 != 0' run/tables/teams.csv >unbalanced.csv
awk -F, 'NR == 1 || NR % 7 != 0' others/tables/teams.csv >others.csv
# Two combinations of strategy and composition have no teams.
for table in run/tables/teams others; do
  awk -F, 'NR == 1 || !($1 == "joint" && $2 == "PPP" || $1 == "common" && $2 == "NNP")' "$table.csv" >"gaps-${table##*/}.csv"
done
# The same, with names that have to be quoted in formulas.
sed '1s/^strategy,/teaching strategy,/; 1s/,composition,/,if,/' gaps-others.csv >names.csv
# Ratings from 1 to 5 that depend on the group.
awk 'BEGIN { print "g;h;ease"; for (i = 0; i < 120; ++i) print "g" i % 3 ";h" int(i / 3) % 2 ";" 1 + (i * i * 7 + i % 3 * 2) % 11 % 5 }' >ratings.csv

failed=0
# compare NAME ARGS: the analysis `kith analyze ARGS` in kith and in R.
compare() {
  local name=$1
  shift
  "$kith" analyze "$@" --brief --csv "$name/kith" --r "$name/r" >/dev/null
  if ! (cd "$name/r" && Rscript --vanilla analysis.R >output.txt 2>&1); then
    echo "$name: the script fails"
    tail -n 20 "$name/r/output.txt"
    failed=1
    return
  fi
  printf '%s: ' "$name"
  if ! Rscript --vanilla "$here/compare.R" "$name/kith" "$name/r/r-results"; then
    echo "$name: R and kith differ"
    failed=1
  fi
}

compare balanced run --model 'knowledge ~ strategy*composition' --where 'strategy!=baseline' --by composition \
  --contrast 'team beliefs: joint + common - individual-low - individual-high' --contrast 'joint - common'
compare unbalanced unbalanced.csv --model 'knowledge ~ strategy + composition' --where 'strategy!=baseline'
compare linear others --model 'knowledge ~ strategy*composition' --where 'strategy!=baseline' --by composition \
  --contrast 'team beliefs: joint + common - individual-low - individual-high' --contrast 'joint - common'
compare linear-unbalanced others.csv --model 'knowledge ~ strategy + composition' --where 'strategy!=baseline'
compare linear-single others.csv --model 'knowledge ~ composition'
compare gaps gaps-teams.csv --model 'knowledge ~ strategy*composition' --where 'strategy!=baseline' \
  --contrast 'joint - common'
compare linear-gaps gaps-others.csv --model 'knowledge ~ strategy*composition' --where 'strategy!=baseline'
compare names names.csv --model 'knowledge ~ `teaching strategy`*if' --where 'teaching strategy!=baseline'
compare ratings ratings.csv --model 'ease ~ g + h' --ordinal
compare single unbalanced.csv --model 'knowledge ~ composition'
compare members run --table learners --model 'p_bec ~ strategy*type' --where 'strategy!=baseline'
compare periods run --table progress --model 'p_bec ~ type' --where 'strategy!=baseline'
compare counts others --model 'periods ~ strategy + composition' --where 'strategy!=baseline' --observed completed
compare counts-same run --model 'periods ~ strategy + composition' --where 'strategy!=baseline' --observed completed
exit $failed
