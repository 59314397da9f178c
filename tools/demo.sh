#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# demo.sh: from a bare Debian 12 to people removed from a map: sets up, builds, renders a room with walking people, runs all
# services on it, and scores the result against the exact truth. Everything lies below build/demo.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

demo=$root/build/demo
rds=$root/build/release/bin/rds
room=(--path xyz --seconds 20 --seed 1)

"$root/tools/setup.sh" --no-zenoh
build release rds rds-tracker rds-detector rds-transformer rds-mapper rds-loop-closer rds-viewer

# render NAME OPTION...: a sequence below build/demo, unless it is there already.
render() {
  local folder=$demo/$1
  shift
  [ "$(cat "$folder/made_by" 2>/dev/null)" != "$*" ] || return 0
  "$rds" simulate --out "$folder" --force "$@"
  echo "$*" >"$folder/made_by"
}

say "render a room with people, and the same room without, to judge the map by (half a minute each)"
render sequence "${room[@]}" --people 2
render background "${room[@]}" --people 0
say "run the services on it"
"$rds" run --dataset "$demo/sequence" --out "$demo/run" --rate max --force
say "run them again as plain RGB-D SLAM, for comparison"
"$rds" run --dataset "$demo/sequence" --out "$demo/run_without" --rate max --no-dynamics --force

say ""
say "scores, people removed:"
"$rds" eval "$demo/sequence" "$demo/run" --background "$demo/background"
say ""
say "scores, plain RGB-D SLAM:"
"$rds" eval "$demo/sequence" "$demo/run_without" --background "$demo/background"
say ""
say "map (any OctoMap tool reads it): $demo/run/map.ot"
say "pictures (run_without holds the same without removal):"
ls "$demo/run"/*.png "$demo/run"/overlay/*.jpg | sed 's/^/  /'
