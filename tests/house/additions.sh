#!/usr/bin/env bash
# What the compiler says when an event of a room, a column of a table or an outcome of teams is added and nothing else:
# it must name every file that docs/architecture.md sends people to, and no other. Run from the root of the repository.
#
#   tests/house/additions.sh COMPILER OPTION...
set -u
export LC_ALL=C

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/libs"
cp -r libs/live libs/store "$work/libs"

# The sources that a compiler complains about when all those of a layer are compiled as one file.
named_by_compiler() {  # LAYER
  local layer=$1 source
  for source in "$work/libs/$layer"/src/*.cpp; do echo "#include \"$source\""; done >"$work/$layer.cpp"
  "${compile[@]}" "$work/$layer.cpp" >"$work/$layer.log" 2>&1
  grep -E 'error|required from|in instantiation' "$work/$layer.log" | grep -oE "libs/$layer/src/[a-z_]+\.cpp" | sort -u
}
# The sources that a row of the map names.
named_by_map() {  # ROW
  grep -E "^\| $1 \|" docs/architecture.md | grep -oE '`[a-z_]+\.cpp`' | tr -d '`' | sort -u
}
failed=0
compare() {  # WHAT ROW FILES
  local got want
  got=$(sed 's|.*/||' <<<"$3" | sort -u)
  want=$(named_by_map "$2")
  echo "$1: the compiler names $(tr '\n' ' ' <<<"$got")"
  [[ -n $got && $got == "$want" ]] && return
  echo "$1: docs/architecture.md, row '$2', names $(tr '\n' ' ' <<<"$want")"
  failed=1
}

# The changed headers come first. The compiler knows /usr/include, and is misled if it is told.
compile=("$1" -fsyntax-only -Werror=switch)
for layer in live store; do compile+=(-I"$work/libs/$layer/src" -I"$work/libs/$layer/include"); done
for option in "${@:2}"; do [[ $option == -I/usr/include ]] || compile+=("$option"); done

# One that people send and one that the facilitator sends, each like one that there is.
header=$work/libs/live/include/kith/live/room_event.hpp
for like in Continued Resumed; do
  awk -v like="$like" '$0 == "struct " like " {" { copying = 1 }
    copying { copy = copy $0 "\n" }
    { print }
    copying && /^};/ {
      copying = 0
      gsub(like, "Added" like, copy)
      sub(/kKind\{"/, "kKind{\"added-", copy)
      sub(/", "/, "\", \"added-", copy)
      printf "\n%s", copy
    }' "$header" | sed "s/happening::Joined,/happening::Joined, happening::Added$like,/" >"$work/header"
  cp "$work/header" "$header"
  grep -q "struct Added$like" "$header" || { echo "happening::$like is not in room_event.hpp"; exit 1; }
done
compare 'events' 'event of a room' "$(named_by_compiler live; named_by_compiler store)"

# A column of a table: a member of a record and one line. What makes and reads tables, codebook and journal compiles as
# it is. An outcome of teams: a row.
cp -r libs/study libs/runs "$work/libs"
for layer in study runs; do compile=("${compile[0]}" -I"$work/libs/$layer/include" -I"$work/libs/$layer/src" "${compile[@]:1}"); done
records=$work/libs/study/include/kith/study
sed -i '/^struct ProgressRecord {/a\  double added = 0.0;' "$records/records.hpp"
sed -i '/Declared<ProgressRecord>) {/a\  fields.column(\&ProgressRecord::added, {"added", "What was added."}, {.since = 9});' "$records/record_columns.hpp"
[[ $(grep -c 'added' "$records/records.hpp" "$records/record_columns.hpp" | grep -c ':1$') == 2 ]] ||
  { echo "ProgressRecord is not where it was"; exit 1; }
outcome='StudyOutcome{.column = "added", .of = [](const TeamRecord\& team) { return team.knowledge; }},'
sed -i "/^constexpr std::array kOutcomes{/a $outcome" "$work/libs/study/src/outcomes.cpp"
grep -q '"added"' "$work/libs/study/src/outcomes.cpp" || { echo "kOutcomes is not where it was"; exit 1; }
for file in "$work"/libs/study/src/{tables,read_records,outcomes}.cpp "$work/libs/runs/src/team_codec.cpp"; do
  "${compile[@]}" "$file" && continue
  echo "a column or an outcome: $(basename "$file") has to be changed too"
  failed=1
done
exit $failed
