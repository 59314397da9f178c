#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# systemd_units_test.sh UNITS PROGRAMS: systemd finds nothing wrong with the units of folder UNITS, whose programs are in
# folder PROGRAMS, and they may do little; what is spoiled on purpose is found.
set -eu
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
for unit in "$1"/rds-slam*; do sed "s|/usr/local/bin/|$2/|" "$unit" >"$scratch/${unit##*/}"; done

services=$(grep -oh 'rds-slam@[a-z-]*.service' "$1/rds-slam.target")
[ "$(echo "$services" | wc -l)" = 5 ] || { echo "rds-slam.target: expected five services: $services"; exit 1; }

# What systemd says about the units of a folder that must be well.
verify() { (cd "$1" && SYSTEMD_UNIT_PATH=$1: systemd-analyze verify --man=no rds-slam.target $services 2>&1) || true; }
said=$(verify "$scratch")
[ -z "$said" ] || { echo "systemd-analyze verify: expected silence, found: $said"; exit 1; }

(cd "$scratch" && systemd-analyze security --offline=true --no-pager --threshold=20 'rds-slam@.service' >security) ||
  { tail -n 1 "$scratch/security"; exit 1; }

# expect_found SED WORD: the change is noticed, in this word.
expect_found() {
  mkdir "$scratch/spoiled"
  cp "$scratch/rds-slam.target" "$scratch/spoiled"
  sed "$1" "$scratch/rds-slam@.service" >"$scratch/spoiled/rds-slam@.service"
  verify "$scratch/spoiled" | grep -q "$2" || { echo "spoiled by $1: not found"; exit 1; }
  rm -r "$scratch/spoiled"
}
expect_found 's/^WatchdogSec=/WatchdogSecs=/' 'Unknown key'
expect_found 's|/rds-%i|/rds-no-%i|' 'is not executable'
expect_found 's/^Type=notify/Type=notified/' 'Failed to parse'
