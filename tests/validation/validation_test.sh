#!/usr/bin/env bash
# validation_test.sh NODE KITH: shows that validation.mjs --check fails where it has to, on copies of the page.
set -uo pipefail
node=$1 kith=$2
here=$(cd "$(dirname "$0")" && pwd)
page=$here/../../docs/validation.md
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0

# expect EXIT_CODE TEXT_THAT_IS_PRINTED SED_SCRIPT: of the check of a page that was changed so.
expect() {
  sed "$3" "$page" >"$folder/validation.md"
  "$node" "$here/validation.mjs" "$kith" --check --only facts,version,facts-agree --keep "$folder/runs" \
    --page "$folder/validation.md" >"$folder/log" 2>&1
  local got=$?
  if ((got != $1)) || ! grep -qF -- "$2" "$folder/log"; then
    echo "after '$3': exit $got, not $1, or nothing like '$2' in:"
    cat "$folder/log"
    failures=$((failures + 1))
  fi
}

expect 0 '' ''
expect 1 'facts, its solid angle with the prior, sr, value: the page has 0.0260957, now 0.0260947' \
  '/solid angle with the prior, sr/s/0.0260947 |$/0.0260957 |/'
expect 1 'facts, mask counters, value: the page has 9 481, 1 767, 15 979, now 9 480' '/mask counters/s/9 480/9 481/'
expect 1 'facts: the page has 10 lines, now 11 lines' '/| coverage sets/d'
expect 1 'version: the page has 9.9.9, now' 's/<!--f version-->[^<]*</<!--f version-->9.9.9</'
expect 1 'the figure 7.77 is typed by hand' 's/^## In short$/&\n\nPeriods were 7.77./'
expect 1 'the figure 12 % is typed by hand' 's/^## In short$/&\n\nIt was 12 %./'
expect 1 'a mark that is not closed or not known' 's/<!--f version-->/<!--f version/'

# --write mends what --check finds.
sed '/mask counters/s/9 480/1 234/' "$page" >"$folder/validation.md"
"$node" "$here/validation.mjs" "$kith" --write --only facts --keep "$folder/runs" --page "$folder/validation.md" >"$folder/log" 2>&1
if ! cmp -s "$page" "$folder/validation.md"; then
  echo '--write does not restore the table:'
  diff "$page" "$folder/validation.md"
  failures=$((failures + 1))
fi

# Runs of the same name and other commands are other runs, and so are runs of them.
"$node" --input-type=module -e "
  import assert from 'node:assert/strict';
  const { Runs } = await import('$here/runs.mjs');
  const of = (seed) => new Runs({ a: ['study', seed], b: ['analyze', 'DIR(a)'] }, '$kith', '.', '$folder/names', () => {});
  for (const name of ['a', 'b']) {
    assert.equal(of('1').directory(name), of('1').directory(name));
    assert.notEqual(of('1').directory(name), of('2').directory(name));
  }" || failures=$((failures + 1))
((failures == 0))
