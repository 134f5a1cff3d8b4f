#!/usr/bin/env bash
# night_test.sh SOURCE_DIR: counts of two nights add up, and a part that takes too long is stopped with what it started.
set -euo pipefail
cd "$1"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "$*"; exit 1; }

page=$folder/nightly.md
cp docs/nightly.md "$page"
printf 'fuzz\t10\t9:30\t1:02\tpassed\nasan\t24\t9:00\t1:00\tfailed\nslow\t22\t22:00\t0:01\tout of time\n' >"$folder/results.tsv"
printf '%s\n' '96% tests passed, 1 tests failed out of 25' '100% tests passed, 0 tests failed out of 7' >"$folder/asan.log"
printf 'csv             1200 executions     100/s  past parser 50 %%\n' >"$folder/fuzz.log"
printf '%s\n' 'kill       first            7       5        4        1          0        0      0' \
  'timer      first            3       2        2        0          0        0      0' \
  'io         first            9       8        8        0          0        0      0' >"$folder/slow.log"
total() { sed -n "s/^| $1 | \([^|]*\) |.*/\1/p" "$page" | tr -d ' '; }
totals() {
  total 'executions of csv' && total kills && total 'I\/O errors' && scripts/nightly.py --nights slow "$page"
}
mapfile -t before < <(totals)
for commit in first second; do scripts/nightly.py "$folder/results.tsv" "$commit" "$page"; done
mapfile -t after < <(totals)
grown=(2400 14 16 2)
for i in "${!grown[@]}"; do
  ((after[i] - before[i] == grown[i])) || fail "from ${before[i]} to ${after[i]}, not by ${grown[i]}"
done
grep -q '^| slow | 22 | 22:00 | 0:01 | out of time | - | second |' "$page" || fail "the last night of a part is not on the page"

grep -q '^| asan | 24 | 9:00 | 1:00 | failed | 31 of 32 | second |' "$page" || fail "the tests of a part do not add up"

for target in $(sed -n 's/^kith_fuzz_target(\([a-z_0-9]*\).*/\1/p' tests/fuzz/CMakeLists.txt); do
  grep -q "^| executions of $target |" docs/nightly.md || fail "docs/nightly.md does not count executions of $target"
done

# shellcheck disable=SC2034  # both are read by in_time
deadline=$((SECONDS + 3)) log=$folder/part.log
say() { echo "$*"; }
eval "$(sed -n '/^in_time() {/,/^}/p' test.sh)"
too_long() { sleep 600 & echo "$!" >"$folder/pid"; sleep 600 | cat; }
status=0
in_time too_long >/dev/null || status=$?
((status == 124)) || fail "a part that runs over ends with $status, not 124"
alive() { [[ $(ps -o stat= -p "$(cat "$folder/pid")") == [!Z]* ]]; }  # ended, though nobody may have asked how
for _ in {1..100}; do alive || break; sleep 0.1; done
! alive || fail "what a stopped part had started goes on"
status=0 deadline=$((SECONDS + 600))
in_time sh -c 'exit 3' || status=$?
((status == 3)) || fail "a part that fails with 3 ends with $status"

# shellcheck disable=SC2034  # read by build
build_minutes=1 building=5 deadline=$((SECONDS + 7))
eval "$(sed -n '/^build() {/,/^}/p' test.sh)"
part() { SECONDS=$((SECONDS + 100)); return 4; }
status=0
build any preset || status=$?
((status == 4)) || fail "a build that fails with 4 ends with $status"
((building >= 105 && deadline - SECONDS >= 5)) || fail "a build takes from the time of its part: $((deadline - SECONDS)) s"
