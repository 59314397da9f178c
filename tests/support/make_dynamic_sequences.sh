#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# make_dynamic_sequences.sh FOLDER: puts people into the static recordings of $RDS_SHARED, with its own tool and its presets.
# A sequence that was made whole is left alone. Exit status 77 (skipped) without RDS_SHARED.
set -euo pipefail

folder=$1
[ -n "${RDS_SHARED:-}" ] || { echo "RDS_SHARED is not set, so there are no recordings"; exit 77; }

# make NAME BACKGROUND OPTION...
make() {
  local name=$1 background=$RDS_SHARED/data/$2
  shift 2
  [ ! -f "$folder/$name/made" ] || { echo "$name: is there"; return; }
  rm -rf "${folder:?}/$name"
  /usr/bin/python3 "$RDS_SHARED/tools/make_dynamic.py" --background "$background" --people "$RDS_SHARED/data/people" \
    --out "$folder/$name" --masks "$@" >"$folder/$name.log"
  cp "$background/camera.yaml" "$folder/$name/"
  touch "$folder/$name/made"
  echo "$name: made"
}

mkdir -p "$folder"
made=()
make kitchen_walkers 7scenes_kitchen --camera 7scenes --factor 1000 --seed 2 --speed 0.7 & made+=($!)
make kitchen_crowd 7scenes_kitchen --camera 7scenes --factor 1000 --seed 3 --walkers 3 & made+=($!)
make fr1_walkers tum_fr1_rpy --camera fr1 --seed 3 --speed 0.6 --cover .26 --walkers 3 & made+=($!)
for process in "${made[@]}"; do wait "$process"; done
