#!/usr/bin/env bash
# Shows that check.sh finds what it looks for: each rule passes on a tidy little
# tree and fails once that tree breaks it.
set -u
check=$(cd "$(dirname "$0")" && pwd)/check.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
cd "$tree" || exit 1
failures=0

tidy_tree() {
  rm -rf ./*
  mkdir -p libs/low/include libs/high libs/live/include/kith/live libs/live/src docs
  printf 'add_subdirectory(low)\nadd_subdirectory(high)\n' >libs/CMakeLists.txt
  printf 'kith_module(low)\n' >libs/low/CMakeLists.txt
  printf 'kith_module(high DEPENDS kith::low\n  PRIVATE_DEPENDS z)\n' >libs/high/CMakeLists.txt
  printf 'add_subdirectory(live)\nadd_subdirectory(files)\nadd_subdirectory(report)\n' >>libs/CMakeLists.txt
  printf 'kith_module(live)\n' >libs/live/CMakeLists.txt
  mkdir -p libs/files/include/kith/files libs/report/src
  printf 'kith_module(files)\n' >libs/files/CMakeLists.txt
  printf 'kith_module(report)\n' >libs/report/CMakeLists.txt
  printf '## Layers\n\n```text\nlow high  what is below\nlive files report  people\n```\n\n## Read first\n' >docs/architecture.md
  printf '#pragma once\nstruct Left {\n  constexpr Kind kKind{"left", "leave"};\n};\n' >libs/live/include/kith/live/room_event.hpp
  printf '// Tells kinds apart.\nconst bool is_there = std::ranges::any_of(people, here);\n' >libs/live/src/room.cpp
  mkdir -p apps/lesson/src
  printf 'set(layers low live)\n' >apps/lesson/CMakeLists.txt
  printf '#pragma once\nconstexpr bool any_of(int range);\n' >apps/lesson/src/portability.hpp
  printf '#pragma once\ninline constexpr char kTeam[] = "team";\n' >libs/files/include/kith/files/column_names.hpp
  printf '// Reads tables.\n' >libs/report/src/run_data.cpp
  printf '#pragma once\n\n// A claim [known2001, section 2].\nint x();\n' >libs/low/include/x.hpp
  printf '@misc{known2001,\n}\n' >docs/references.bib
  printf '```cpp libs/low/include/x.hpp\nint x();\n```\n' >docs/quotes.md
  printf 'See [this](docs/references.bib) and [that](https://example.org).\n' >README.md
}

expect() {  # expect EXIT_CODE RULE WHAT
  bash "$check" "$2" >log 2>&1
  local got=$?
  if ((got != $1)); then
    echo "$2, $3: exit $got, not $1"
    cat log
    failures=$((failures + 1))
  fi
  rm -f log
}

breaks() {  # breaks RULE FILE TEXT: the tree fails the rule once the text is appended to the file
  tidy_tree
  printf '%b' "$3" >>"$2"
  expect 1 "$1" "after appending '$3' to $2"
}

tidy_tree
for rule in ascii places pragma ranges layers newline links marks map quotes citations types rows columns; do expect 0 "$rule" 'a tidy tree'; done
expect 2 nonsense 'an unknown rule'
breaks ascii libs/low/include/x.hpp '// \xc3\xa9\n'
breaks places README.md 'see /home''/somebody/kith\n'
breaks pragma libs/low/include/y.hpp '// first\n#pragma once\n'
breaks marks README.md 'It rose by\n<!--f rise-->2 %<!--/f-->.\n'
breaks ranges libs/live/src/room.cpp 'std::ranges::shuffle(people);\n'
breaks layers libs/low/CMakeLists.txt 'kith_module(low DEPENDS kith::high)\n'
breaks layers libs/low/CMakeLists.txt 'kith_module(low PRIVATE_DEPENDS kith::high)\n'
breaks newline README.md 'no end'
breaks columns libs/report/src/run_data.cpp 'auto team = data.factor("team");\n'
breaks newline libs/low/include/x.hpp 'int y();  \n'
breaks links README.md '[gone](docs/gone.md)\n'
breaks map docs/architecture.md 'see x.hpp, libs/low/include/x.hpp and libs/low/x.hpp\n'
breaks map docs/architecture.md 'gone.cpp\n'
breaks citations libs/low/include/x.hpp '// [unknown1999]\n'
breaks quotes README.md '```cpp libs/low/include/x.hpp\nint y();\n```\n'
breaks rows libs/live/src/room.cpp 'if (event.type == "left") return;\n'
breaks rows libs/live/src/room.cpp 'if (command.type != "leave") return;\n'
breaks rows libs/live/src/room.cpp '    default:\n'
breaks types libs/low/include/x.hpp 'namespace kith {\nstruct A {};\n}  // namespace kith\nnamespace kith {\nclass A final : B {\n'
tidy_tree
expect 1 budget 'a tree without budgets'
{
  printf '\n## Budget\n\n'
  for part in low high live files report; do
    printf '| %s | what | %s | %s |\n' $part "$(cat $(find libs/$part -type f) | wc -l)" 50
  done
  printf '| apps | what | %s | 50 |\n' "$(cat $(find apps -type f) | wc -l)"
  printf '| %s | what | 0 | 0 |\n' web python research tests
} >>docs/architecture.md
printf '| words | what | %s | 500 |\n' $(($(find . -name '*.md' -print0 | xargs -0 cat | wc -w) + 9)) >>docs/architecture.md
expect 0 budget 'a tree within its budgets'
seq 60 | sed 's|^|// |' >>libs/low/include/x.hpp
expect 1 budget 'a part that has outgrown its budget'
tidy_tree
mkdir libs/stray
expect 1 layers 'a folder that is not in the list'
tidy_tree
sed -i 's/^low high /high low /' docs/architecture.md
expect 1 layers 'layers that are drawn in another order'
if command -v clang-format >/dev/null && clang-format --version | grep -q 'version 14\.'; then
  tidy_tree
  expect 0 format 'a tidy tree'
  breaks format libs/low/include/x.hpp 'int   y( );\n'
fi
((failures == 0))
