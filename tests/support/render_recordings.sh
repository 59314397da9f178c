#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# render_recordings.sh FOLDER RDS SOURCES NAME...: renders the recordings of these names with the program RDS (`rds simulate`).
# One that was made whole by the same simulator (SOURCES is its folder) is left alone.
set -euo pipefail

folder=$1 rds=$2 sources=$3
shift 3

options() {  # of NAME
  case $1 in
    room) echo --path xyz --people 2 --seconds 12 ;;
    room_empty) echo --path xyz --people 0 --seconds 12 ;;
    rpy | halfsphere | static) echo --path "$1" --people 2 --seconds 10 --fps 15 ;;
    rpy_empty | halfsphere_empty | static_empty) echo --path "${1%_empty}" --people 0 --seconds 10 --fps 5 ;;
    loop) echo --path loop --people 0 --seconds 28 --fps 15 ;;
    floor) echo --world floor --rooms 8 --people 0 --seconds 48 --fps 10 ;;
    *) echo "$1: expected room, rpy, halfsphere or static, alone or with _empty, loop or floor" >&2; return 1 ;;
  esac
}

mkdir -p "$folder"
exec 9>"$folder/lock"
flock 9
simulator=$(find "$sources" -name '*.?pp' | sort | xargs cat | sha256sum)
for name in "$@"; do
  wanted=$(options "$name")
  made="$wanted $simulator"
  if [ "$(cat "$folder/$name/made" 2>/dev/null)" = "$made" ]; then echo "$name: is there"; continue; fi
  rm -rf "${folder:?}/$name"
  # shellcheck disable=SC2086 # several words
  "$rds" simulate --out "$folder/$name" --seed 1 $wanted >"$folder/$name.log"
  echo "$made" >"$folder/$name/made"
  echo "$name: made"
done
