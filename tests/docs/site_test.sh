#!/usr/bin/env bash
# site_test.sh SOURCE SPHINX [NODE MODULES CHROMIUM]: the documentation becomes a site without warnings, which loads
# nothing from elsewhere, has every page of docs/ in its navigation, and in a browser what narrow.mjs says.
set -euo pipefail
source=$1 sphinx=$2
shift 2
site=$(mktemp -d)
trap 'rm -rf "$site"' EXIT
fail() { echo "$*" >&2; exit 1; }

"$sphinx" -q -W --keep-going -E -b html -d "$site/cache" -c "$source/docs/site" "$source" "$site/html"
if grep -rhoE --include=*.html '(src|<link[^>]* href)="https?://[^"]*' "$site/html"; then fail "a page loads this from elsewhere"; fi
for page in "$source"/docs/*.md "$source"/docs/adr/*.md; do
  name=$(basename "$page" .md)
  [[ $name == README ]] && continue
  grep -q "class=\"toctree-l1\".*$name\.html" "$site/html/docs/README.html" || fail "the navigation has no $name"
done
if (($#)); then "$1" "$source/tests/docs/narrow.mjs" "$site/html" "${@:2}"; fi
