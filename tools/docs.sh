#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# docs.sh: builds the site of all documents into build/docs/site; a dead link is an error. Needs what `tools/setup.sh --docs`
# installs, and the program rds of the release build, which has the table of topics.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

for program in mkdocs doxygen; do
  command -v $program >/dev/null || fail "$program: expected on the PATH (tools/setup.sh --docs)"
done
rds=$root/build/release/bin/rds
[ -x "$rds" ] || fail "$rds: expected a build (cmake --preset release && cmake --build --preset release --target rds)"
out=$root/build/docs
rm -rf "$out"
mkdir -p "$out/pages/docs"
{
  printf '# Topics\n\nMade by `rds topic table` from [topics.hpp](../common/topics/topics.hpp). DDS names have `rt/` before them; `/` is below no namespace.\n\n'
  "$rds" topic table
} >"$out/pages/docs/topics.md"
mkdir -p "$out/pages/common/topics" && cp "$root/common/topics/topics.hpp" "$out/pages/common/topics/"
(cd "$root" && long_step doxygen quiet doxygen tools/docs/Doxyfile)
/usr/bin/python3 -B "$root/tools/docs/pages.py" "$root" "$out"
(cd "$out" && long_step mkdocs quiet mkdocs build --quiet --config-file "$out/mkdocs.yml")
/usr/bin/python3 -B "$root/tools/docs/links.py" "$out/site" || fail "dead links, see above"
say "the site: $out/site/index.html"
