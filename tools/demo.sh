#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# demo.sh: from a bare Debian 12 to people removed from a map: sets up, builds, renders a room with walking people, runs all
# services on it, and scores the result against the exact truth. Everything lies below build/demo.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

demo=$root/build/demo
rds=$root/build/release/bin/rds
simulate=(--path xyz --people 2 --seconds 20 --seed 1)

"$root/tools/setup.sh"
build release rds rds-tracker rds-detector rds-transformer rds-mapper rds-loop-closer

if [ "$(cat "$demo/sequence/made_by" 2>/dev/null)" != "${simulate[*]}" ]; then
  say "render a room with people (about a minute)"
  "$rds" simulate --out "$demo/sequence" --force "${simulate[@]}"
  echo "${simulate[*]}" >"$demo/sequence/made_by"
fi
say "run the services on it"
"$rds" run --dataset "$demo/sequence" --out "$demo/run" --rate max --force
say "run them again as plain RGB-D SLAM, for comparison"
"$rds" run --dataset "$demo/sequence" --out "$demo/run_without" --rate max --no-dynamics --force

say ""
say "scores, people removed:"
"$rds" eval "$demo/sequence" "$demo/run"
say ""
say "scores, plain RGB-D SLAM:"
"$rds" eval "$demo/sequence" "$demo/run_without"
say ""
say "map (any OctoMap tool reads it): $demo/run/map.ot"
say "pictures:"
ls "$demo/run"/*.png "$demo/run"/overlay/*.jpg | sed 's/^/  /'
