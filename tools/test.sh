#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# test.sh [--preset release|dev|asan|tsan] [--no-skip] [CTEST OPTIONS]: sets up, builds, runs the preset's tests.
#
# --no-skip   a skipped test is a failure.
# RDS_SHARED  folder with recordings and models; tests that need it are skipped by name where it is not set.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

preset=release
may_skip=true
while [ $# -gt 0 ]; do
  case $1 in
    --preset) preset=${2:?--preset: expected release, dev, asan or tsan}; shift 2 ;;
    --no-skip) may_skip=false; shift ;;
    *) break ;;
  esac
done
case $preset in release | dev | asan | tsan) ;; *) fail "--preset $preset: expected release, dev, asan or tsan" ;; esac
[ -z "${RDS_SHARED:-}" ] || RDS_SHARED=$(cd "$RDS_SHARED" 2>/dev/null && pwd) || fail "RDS_SHARED: expected a folder"
export RDS_SHARED RDS_PYTHON=$root/.venv/bin/python

# Attribute NAME of the results' first element.
count() { sed -n "0,/ $1=\"/s/.* $1=\"\([0-9]*\)\".*/\1/p" "$results" | head -n 1; }

"$root/tools/setup.sh"
build "$preset"
results=$root/build/$preset/results.xml
rm -f "$results"
status=0
(cd "$root" && ctest --preset "$preset" -j "$(jobs)" --output-junit "$results" "$@") || status=$?
[ -f "$results" ] || fail "ctest left no results (exit status $status)"
failed=$(count failures) skipped=$(($(count skipped) + $(count disabled)))
passed=$(($(count tests) - failed - skipped))
if [ "$skipped" -gt 0 ]; then
  say "skipped:"
  awk -F'"' '/<testcase / {name = $2} /SKIP_|Skipped|skipped/ && name != last {print "  " name; last = name}' "$results"
fi
say "$preset: $passed passed, $failed failed, $skipped skipped"
[ "$status" = 0 ] || exit "$status"
$may_skip || [ "$skipped" = 0 ] || fail "no test may be skipped here"
