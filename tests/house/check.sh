#!/usr/bin/env bash
# Checks one rule of the repository; run from its root. Exit 0: kept, 1: broken
# (the places are printed), 77: cannot be checked on this machine.
set -u
export LC_ALL=C

# The files of the repository, those not yet added included, one a line; paths hold no line breaks.
files() {
  if git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
    git ls-files --cached --others --exclude-standard -- "$@" | while IFS= read -r file; do
      [[ -f $file ]] && printf '%s\n' "$file"
    done
  else
    local name=() pattern
    for pattern in "$@"; do name+=(-o -path "./$pattern"); done
    find . \( -path ./build -o -path ./results -o -path ./.git \) -prune -o -type f \
      ${name[@]+\( "${name[@]:1}" \)} -print | sed 's|^\./||'
  fi
}
sources() { files '*.cpp' '*.hpp' '*.in' '*.cmake' 'CMakeLists.txt' '*.sh' '*.json' '*.toml'; }
texts() { files | grep -vE '\.(png|gz|sqlite)$|^tests/fuzz/corpus/'; }

# grep in the files that it reads the names of, errors included in what it finds.
search() { xargs -r -d '\n' grep -H "$@" 2>&1; }
# Prints what it reads, and fails if that was anything. The last command of a rule, so it decides.
none() { ! grep .; }

check_ascii() {  # sources are ASCII, so that every tool and terminal agrees about columns
  sources | search -nP '[^\x00-\x7F]' | none
}

check_places() {  # no absolute path of one particular machine
  texts | search -nE '(^|[^[:alnum:]_.}*/])/(home|root|work|farm|mnt|media|Users|scratch)/[[:alnum:]_.]' | none
}

check_pragma() {  # every header begins with #pragma once
  files '*.hpp' | xargs -r -d '\n' awk -v q="'" 'FNR == 1 && $0 != "#pragma once" {
    print FILENAME ": the first line is not " q "#pragma once" q }' 2>&1 | none
}

# What lessons in files are made of.
lesson_sources() {
  local layer
  sed -n 's/^set(layers \(.*\))$/\1/p' apps/lesson/CMakeLists.txt | tr ' ' '\n' | while IFS= read -r layer; do
    files "libs/$layer/include/*" "libs/$layer/src/*"
  done
}

# Its library has no std::ranges: each algorithm is in portability.hpp.
check_ranges() {
  local own=apps/lesson/src/portability.hpp
  lesson_sources | search -noE 'std::ranges::[a-z_]+\(' | while IFS= read -r use; do
    grep -qF " ${use##*::}" "$own" || echo "${use%(}: not in $own"
  done | none
}

check_math() {  # results have the same bits everywhere: by kith/core/math.hpp, as libraries of C round differently
  lesson_sources | search -nE 'std::(a?(sin|cos|tan)h?|atan2|expm?[12]?|log(2|10|1p)?|pow|hypot|cbrt|[lt]gamma|erf|fma)\(' |
    none
}

# A layer needs only layers that come before it in libs/CMakeLists.txt, and the map of the project has them all in order.
check_layers() {
  local seen=' ' layer need
  sed -n 's/^ *add_subdirectory(\([a-z_]*\)).*/\1/p' libs/CMakeLists.txt | {
    while IFS= read -r layer; do
      for need in $(tr '\n' ' ' <"libs/$layer/CMakeLists.txt" | grep -oE 'kith_module\([^)]*' |
        sed 's/TEST_DEPENDS.*//' | grep -oE 'kith::[a-z_]+' | sed 's/kith:://'); do
        [[ $seen == *" $need "* ]] || echo "libs/$layer needs $need, which does not come before it in libs/CMakeLists.txt"
      done
      seen+="$layer "
    done
  } | none
  local kept=$?
  for layer in libs/*/; do
    layer=$(basename "$layer")
    grep -q "add_subdirectory($layer)" libs/CMakeLists.txt || { echo "libs/$layer is not in libs/CMakeLists.txt"; kept=1; }
  done
  local listed drawn
  listed=$(sed -n 's/^ *add_subdirectory(\([a-z_]*\)).*/\1/p' libs/CMakeLists.txt | tr '\n' ' ')
  drawn=$(sed -n '/^## Layers/,/^## Read/p' docs/architecture.md | sed -n '/^```text/,/^```$/p' | grep -v '^```' |
    sed 's/  .*//' | tr '\n' ' ')
  [[ $drawn == "$listed" ]] || { echo "docs/architecture.md draws the layers ${drawn}but libs/CMakeLists.txt has $listed"; kept=1; }
  return $kept
}

check_newline() {  # text files end with a line break, and lines with what one sees
  {
    texts | search -LzP '\n\z' | while IFS= read -r file; do
      [[ -f $file && ! -s $file ]] || echo "$file: no line break at the end"
    done
    files '*.cpp' '*.hpp' '*.cmake' 'CMakeLists.txt' '*.sh' '*.toml' '*.md' | search -nE '[[:space:]]+$'
  } | none
}

check_links() {  # relative links in documents lead somewhere
  files '*.md' | while IFS= read -r file; do
    grep -oE '\]\([^)# ]+' "$file" | sed 's/^](//' | grep -vE '^(https?|mailto):' | while IFS= read -r target; do
      [[ -e $(dirname "$file")/$target ]] || echo "$file: $target does not exist"
    done
  done | none
}

check_marks() {  # a line that begins with a comment is no part of a paragraph, so the mark of a figure or a claim does not
  files '*.md' | search -nE '^ *<!--(f|holds) ' | none
}

check_map() {  # sources that the map of the project names exist; without a folder, somewhere
  files docs/architecture.md | while IFS= read -r page; do
    grep -oE '[A-Za-z0-9_./-]+\.(cpp|hpp|tsx?)\b' "$page" | grep -v '^_' | sort -u | while IFS= read -r source; do
      [[ $source == */* && -e $source ]] || { [[ $source != */* ]] && files "*/$source" | grep -q .; } ||
        echo "$page: there is no $source"
    done
  done | none
}

check_citations() {  # every [key2024] cited in sources and documents is in docs/references.bib, where no key is twice
  {
    files '*.cpp' '*.hpp' '*.md' '*.toml' | search -noE '\[[a-z]+(18|19|20)[0-9]{2}[a-z]*' |
      while IFS=: read -r file line key; do
        grep -q "{${key#[}," docs/references.bib || echo "$file:$line: ${key#[} is not in docs/references.bib"
      done
    grep -oE '^@[a-z]+\{[^,]+' docs/references.bib | sort -t'{' -k2 | uniq -d | sed 's/$/ is twice in docs\/references.bib/'
  } | none
}

# A type has one definition: of two in one namespace the linker keeps the functions of either.
check_types() {
  files '*.cpp' '*.hpp' | grep -E '^(libs/[a-z_]+/(include|src)|apps/[a-z_]+/src)/' | xargs -r -d '\n' awk '
      FNR == 1 { depth = 0 }
      /^namespace/ { space[++depth] = $2 == "{" ? "" : $2; next }
      /^} *\/\/ namespace/ { delete space[depth--]; next }
      /^(struct|class|enum class|enum) [A-Za-z0-9_]+( final)?( *:[^:][^;]*)? *\{/ {
        name = ""
        for (i = 1; i <= depth; ++i) { if (space[i] == "") next; name = name space[i] "::" }
        sub(/^(enum class|struct|class|enum) /, ""); sub(/[ :{].*/, "")
        print name $0, FILENAME
      }' | sort | awk '$1 == last { print $1 " is defined by " where " and by " $2 } { last = $1; where = $2 }' | none
}

# A block of a document whose first line names a file (```cpp examples/a.cpp) is a part of that file, line by line.
check_quotes() {
  files '*.md' | while IFS= read -r page; do
    awk -v page="$page" '
      function compare(  text, line, got) {
        text = "\n"
        while ((got = (getline line < source)) > 0) text = text line "\n"
        close(source)
        if (got < 0 || index(text, "\n" quote) == 0) print page ":" begin ": this is not in " source
      }
      /^```[a-z]+ [^ ]+\/[^ ]+\.(cpp|hpp|txt|toml)$/ { source = $2; quote = ""; begin = NR; next }
      source != "" && /^```$/ { compare(); source = ""; next }
      source != "" { quote = quote $0 "\n" }
    ' "$page"
  done | none
}

# Kinds of events are compared by their rows, not by their words, and nothing is the default over phases and events.
check_rows() {
  local words
  words=$(files '*.hpp' | grep '^libs/live/include/kith/live/room_event.hpp$' | xargs -r cat | tr '\n' ' ' |
    grep -oE 'kKind\{ *"[a-z]+", *"[a-z]*"' | grep -oE '"[a-z]+"' | tr -d '"' | sort -u | paste -sd'|')
  {
    files '*.cpp' '*.hpp' | grep -E '^libs/(live|store|service)/src/' | search -nE "type [!=]= \"(${words:-none})\""
    files '*.cpp' '*.hpp' | grep '^libs/live/src/' | search -nE '^ *default:'
  } | none
}

# What reads a column names it by the constant that the column is declared with.
check_columns() {
  local names
  names=$(files '*.hpp' | grep '^libs/files/include/kith/files/column_names.hpp$' | xargs -r cat |
    grep -oE '"[a-z_0-9]+"' | tr -d '"' | sort -u | paste -sd'|')
  files '*.cpp' | grep -E '^libs/(analysis|fit|report)/src/' |
    search -nE "(\\.|required_)(factor|numbers|texts|cells|boolean|integer|text|count|has)\\(([a-z]+, )?\"(${names:-none})\"" | none
}

# Lines of source that it reads the names of.
source_lines() { grep -E '\.(cpp|hpp|ts|tsx|mjs|js|css|html|sh|py|R|cmake)$|CMakeLists\.txt$' | xargs -r -d '\n' cat | wc -l; }
of_tests='^(tests/|libs/[^/]+/tests/|apps/[^/]+/tests/|web/(tests|sample)/|python/tests/)'
lines_of() {  # a part of the table
  case $1 in
    tests) files | grep -E "$of_tests" | source_lines ;;
    words) files '*.md' | grep -vE "$of_tests|CHANGELOG" | xargs -r -d '\n' cat | wc -w ;;
    apps | web | python | research) files | grep "^$1/" | grep -vE "$of_tests|package-lock" | source_lines ;;
    *) files | grep "^libs/$1/" | grep -vE "$of_tests" | source_lines ;;
  esac
}

# No part is larger than its budget in docs/architecture.md, and none is left out: who needs more lines names what goes.
check_budget() {
  local rows part said lines budget layer
  rows=$(files docs/architecture.md | xargs -r sed -n '/^## Budget/,/^## /p' |
    sed -nE 's/^\| ([a-z_]+) \| [^|]*\| ([0-9]+) \| ([0-9]+) \|$/\1 \2 \3/p')
  {
    while read -r part said budget; do
      lines=$(lines_of "$part")
      ((lines <= budget)) || echo "$part has $lines lines, $((lines - budget)) more than its budget: take some out"
      ((lines * 10 >= said * 9 && lines * 10 <= said * 11)) || echo "$part has $lines lines: docs/architecture.md says $said"
    done <<<"${rows:-none 0 0}"
    for layer in $(sed -n 's/^ *add_subdirectory(\([a-z_]*\)).*/\1/p' libs/CMakeLists.txt) apps web python research tests words; do
      grep -q "^$layer " <<<"$rows" || echo "$layer has no budget in docs/architecture.md"
    done
  } | none
}

# Every id of a diagnostic stands in a test. Three are of what no test brings about: a disk that loses rows of an export,
# a session of a later kith, a study that only people's words keep from them.
check_ids() {
  local named
  named=$(files '*.cpp' '*.hpp' '*.py' '*.mjs' | grep -E "$of_tests" | xargs -r -d '\n' grep -hoE '[EW][01][0-9]{3}' | sort -u)
  files '*.cpp' | grep -E '^(libs|apps)/[a-z]+/src/' | xargs -r -d '\n' grep -hoE '"[EW][01][0-9]{3}"' | tr -d '"' | sort -u |
    grep -vxE 'E1615|E1617|E1625' | grep -vxF -f <(echo "$named") | sed 's/$/: no test brings it about/' | none
}

check_format() {  # C++ is as clang-format 14 writes it
  if ! command -v clang-format >/dev/null; then
    echo "clang-format is not installed"
    return 77
  fi
  if ! clang-format --version | grep -q 'version 14\.'; then
    echo "clang-format is not version 14, Debian 12's"
    return 77
  fi
  files '*.cpp' '*.hpp' | xargs -r -d '\n' clang-format --dry-run --Werror 2>&1 || return 1
}

rule=${1:-}
if ! declare -F "check_$rule" >/dev/null; then
  echo "usage: $0 RULE, one of: $(declare -F | sed -n 's/^declare -f check_//p' | tr '\n' ' ')" >&2
  exit 2
fi
"check_$rule"
