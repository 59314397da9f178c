#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# test.sh [--preset release|dev|asan|tsan] [--no-skip] [CTEST OPTIONS]: sets up, builds, runs the preset's tests.
#
# -L soak     the long tests alone, which no preset has: half an hour in one room, every fault of the table (asan, tsan: its first moment).
# --no-skip   a skipped test is a failure.
# RDS_SHARED  folder with recordings and models; where it is not set tests render a room instead, and what needs the recordings of a
#             real camera is skipped by name.
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

tests=$preset
case " $* " in *" -L soak "*)
  case $preset in
    release) tests=soak ;;
    asan | tsan) tests=${preset}_soak ;;
    *) fail "-L soak: expected the preset release, asan or tsan" ;;
  esac
  ;;
esac

"$root/tools/setup.sh"
build "$preset"
results=$root/build/$preset/results.xml
rm -f "$results"
status=0
(cd "$root" && ctest --preset "$tests" -j "$(jobs)" --output-junit "$results" "$@") || status=$?
[ -f "$results" ] || fail "ctest left no results (exit status $status)"
skipped=0
/usr/bin/python3 "$root/tools/test_summary.py" "$results" "$tests" || skipped=$?
[ "$status" = 0 ] || exit "$status"
$may_skip || [ "$skipped" = 0 ] || fail "no test may be skipped here"
