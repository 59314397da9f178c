#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# docs.sh: builds the site of all documents into build/docs/site; a dead link is an error. Needs Debian's mkdocs and
# mkdocs-material, and the program rds of the release build, which has the table of topics.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

command -v mkdocs >/dev/null || fail "mkdocs: expected on the PATH (apt-get install mkdocs mkdocs-material)"
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
/usr/bin/python3 -B "$root/tools/docs/pages.py" "$root" "$out"
(cd "$out" && long_step mkdocs quiet mkdocs build --quiet --config-file "$out/mkdocs.yml")
/usr/bin/python3 -B "$root/tools/docs/links.py" "$out/site" || fail "dead links, see above"
say "the site: $out/site/index.html"
