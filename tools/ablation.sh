#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# ablation.sh DATASET [BACKGROUND [RUN-OPTION...]]: what each way of removing and predicting gives on one recording with moving things. Runs the
# services once for every row and prints a Markdown table; BACKGROUND (the same recording without them, "" for none) scores the map, too.
# RUN-OPTIONs go to `rds run` (--model nanodet_g). Results below build/ablation; the services must be built (tools/setup.sh, then the release preset).
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

[ $# -ge 1 ] || fail "usage: tools/ablation.sh DATASET [BACKGROUND [RUN-OPTION...]]"
dataset=$(realpath "$1")
background=${2:-}
shift $(($# < 2 ? $# : 2))
rds=$root/build/release/bin/rds
[ -x "$rds" ] || fail "$rds: expected the built program (cmake --preset release && cmake --build build/release)"
out=$root/build/ablation/$(basename "$dataset")
mkdir -p "$out"

# row REMOVAL MOTION PREDICTION: one run, one line of the table.
row() {
  local name=$1-$2-$3
  printf 'tracker:\n  removal: {method: %s, motion: %s}\n  prediction: {algorithm: %s}\n' "$1" "$2" "$3" >"$out/$name.yaml"
  "$rds" run --dataset "$dataset" --out "$out/$name" --rate max --force --config "$out/$name.yaml" "${@:4}" >"$out/$name.log" 2>&1 ||
    { tail -n 5 "$out/$name.log" >&2; fail "$name: the run failed, its output is in $out/$name.log"; }
  "$rds" eval "$dataset" "$out/$name" ${background:+--background "$background"} --json >"$out/$name.json"
  "$root/.venv/bin/python" - "$out/$name.json" "$@" <<'PYTHON'
import json, sys
with open(sys.argv[1]) as file:
    score = json.load(file)
def figure(name, digits=4):
    value = score.get(name)
    return "" if value is None else f"{value:.{digits}f}"
columns = ["tracked", "ate_live", "ate_final", "box_recall", "box_cover", "box_waste", "residue", "static_recall", "map_precision"]
print("| " + " | ".join(sys.argv[2:5] + [figure(c) for c in columns] + [figure("ms_total_median", 1)]) + " |", flush=True)
PYTHON
}

say "| removal | motion | prediction | tracked | ATE live [m] | ATE final [m] | boxes found | cover | waste | people left in map | static map kept | map precision | total ms |"
say "|---|---|---|---|---|---|---|---|---|---|---|---|---|"
row off false kalman3d "$@"
row box false paper "$@"
row box false kalman3d "$@"
row depth false paper "$@"
row depth false kalman3d "$@"
row depth true kalman3d "$@"
