#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# compose_test.sh [--build] [VENDOR...]: starts compose/compose.yaml, plays a recording, and sees a map arrive outside the
# containers, on each vendor (default: fastdds cyclonedds). Needs what tools/test.sh has built; stops what it started.
#
# --build     compiles in the image instead of taking build/release/bin and lib.
# RDS_SHARED  folder with recordings; without it a short sequence is rendered.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
source "$(dirname "${BASH_SOURCE[0]}")/container_engine.sh"

export RDS_IMAGE_STAGE=prebuilt
if [ "${1:-}" = --build ]; then RDS_IMAGE_STAGE=built; shift; fi
vendors=("$@")
[ ${#vendors[@]} -gt 0 ] || vendors=(fastdds cyclonedds)
rds=$root/build/release/bin/rds
[ -x "$rds" ] || fail "$rds: expected, build the release preset first (tools/test.sh or tools/demo.sh)"
export ROS_DOMAIN_ID=${ROS_DOMAIN_ID:-$((100 + $$ % 100))}

compose() { docker compose --ansi never -p rds-test -f "$root/compose/compose.yaml" --profile player "$@"; }
clean_up() {
  compose down --timeout 5 >/dev/null 2>&1 || true
  stop_engine
}
trap clean_up EXIT

# Sets RDS_DATASET, and RDS_MODELS to the folder that holds the network.
provide_input() {
  export RDS_DATASET=${RDS_SHARED:+$RDS_SHARED/data/7scenes_kitchen}
  export RDS_MODELS=${RDS_SHARED:+$RDS_SHARED/models}
  : "${RDS_MODELS:=${XDG_CACHE_HOME:-$HOME/.cache}/rds-slam/models}"
  [ -z "$RDS_DATASET" ] || return 0
  RDS_DATASET=$root/build/compose/sequence
  [ -f "$RDS_DATASET/groundtruth.txt" ] || "$rds" simulate --out "$RDS_DATASET" --path xyz --people 1 --seconds 5 --force
}

# One whole run on a vendor; the map is asked for from this machine, outside the containers.
try_vendor() {
  export RDS_BUS=$1
  local started=$SECONDS
  say "$RDS_BUS: starting the services"
  compose up --detach --wait --wait-timeout 180 tracker detector transformer mapper loop-closer >"$log" 2>&1 ||
    { cat "$log" >&2; compose logs --tail 20 >&2; fail "$RDS_BUS: the services did not become healthy"; }
  say "$RDS_BUS: healthy after $((SECONDS - started)) s; playing"
  compose up --no-recreate --exit-code-from player player >"$log" 2>&1 ||
    { tail -n 30 "$log" >&2; fail "$RDS_BUS: the player failed"; }
  local map
  map=$("$rds" map info --bus "$RDS_BUS" --timeout 30) ||
    { compose logs --tail 20 >&2; fail "$RDS_BUS: no map arrived outside the containers"; }
  say "$RDS_BUS: the map arrived:"
  sed 's/^/  /' <<<"$map"
  compose down --timeout 5 >/dev/null 2>&1
}

begun=$SECONDS
mkdir -p "$root/build/compose" "$root/build/log"
log=$root/build/log/compose-test.log
start_engine
provide_compose
provide_base debian:bookworm-slim
provide_input
say "image ($RDS_IMAGE_STAGE)"
long_step compose-build quiet compose build tracker
say "  $(docker image inspect --format '{{.Size}}' "${RDS_IMAGE:-rds-slam}" | awk '{printf "%.0f MB", $1 / 1e6}'), after $((SECONDS - begun)) s"
for vendor in "${vendors[@]}"; do try_vendor "$vendor"; done
say "compose test: ${#vendors[@]} passed, 0 failed in $((SECONDS - begun)) s"
