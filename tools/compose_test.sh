#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# compose_test.sh [--build] [VENDOR...]: starts compose/compose.yaml, plays a recording, and sees a map arrive outside the
# containers, on each vendor (default: fastdds cyclonedds); looks at what the containers may do, and kills and stops a service
# in one of them. Needs what tools/test.sh has built; stops what it started.
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
  compose down --volumes --timeout 5 >/dev/null 2>&1 || true
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

services=(tracker detector transformer mapper loop-closer)

# expect WHAT EXPECTED FOUND
expect() { [ "$2" = "$3" ] || fail "$1: '$3', expected '$2'"; }

# inside SERVICE COMMAND: in the service's container, as its own user.
inside() { compose exec -T "$1" sh -c "$2"; }

# signal_service SERVICE SIGNAL: to its program, whose parent is the container's init.
signal_service() {
  inside "$1" "for p in /proc/[0-9]*; do [ \"\$(cat \$p/comm 2>/dev/null)\" != rds-$1 ] || kill -$2 \${p#/proc/}; done"
}

# What a service's container may do, as the engine was told and as the kernel says of a process in it.
check_confinement() {
  local service=$1 id
  id=$(compose ps --quiet "$service")
  inspect() { docker inspect --format "$1" "$id"; }
  expect "$service: file system read-only" true "$(inspect '{{.HostConfig.ReadonlyRootfs}}')"
  expect "$service: log" "local 10m 3" "$(inspect '{{with .HostConfig.LogConfig}}{{.Type}} {{index .Config "max-size"}} {{index .Config "max-file"}}{{end}}')"
  expect "$service: shares /dev/shm with the host" no "$([ "$(inspect '{{.HostConfig.IpcMode}}')" = host ] && echo yes || echo no)"
  expect "$service: memory limited" yes "$([ "$(inspect '{{.HostConfig.Memory}}')" -gt 0 ] && echo yes || echo no)"
  expect "$service: a user without privileges" no "$(inside "$service" '[ "$(id -u)" = 0 ] && echo yes || echo no')"
  expect "$service: capabilities" "CapBnd: 0000000000000000 CapEff: 0000000000000000 CapPrm: 0000000000000000 NoNewPrivs: 1" \
    "$(inside "$service" 'grep -hE "^(CapPrm|CapEff|CapBnd|NoNewPrivs)" /proc/1/status' | tr '\t' ' ' | sort | paste -sd ' ')"
  expect "$service: folders that it can write to" "" \
    "$(inside "$service" 'for f in / /etc /usr/local/bin /var/lib/rds; do touch "$f/x" 2>/dev/null && echo "$f"; done; true')"
}

status() { "$rds" status --bus "$RDS_BUS" "$@"; }

# wait_for SECONDS WHAT COMMAND...
wait_for() {
  local limit=$1 what=$2 end=$((SECONDS + $1))
  shift 2
  until "$@" >/dev/null 2>&1; do
    [ "$SECONDS" -lt "$end" ] || { compose ps >&2; compose logs --tail 20 >&2; fail "$RDS_BUS: $what: not within $limit s"; }
    sleep 1
  done
}
is_unhealthy() { [ "$(docker inspect --format '{{.State.Health.Status}}' "$(compose ps --quiet "$1")")" = unhealthy ]; }

# A service that is stopped is seen, from outside and by its container; one that is killed comes back by itself.
disturb() {
  say "$RDS_BUS: the mapper is stopped"
  signal_service mapper STOP
  wait_for 60 "a stopped mapper is seen" eval '! status --service mapper'
  wait_for 180 "its container is unhealthy" is_unhealthy mapper
  signal_service mapper CONT
  wait_for 60 "it is well again" status --service mapper --wait 20
  say "$RDS_BUS: the loop closer is killed"
  signal_service loop-closer KILL
  wait_for 60 "it comes back" status --wait 20
}

# The live map as `rds map info` tells it: its epoch and how many nodes it has.
map_epoch() { "$rds" map info --bus "$RDS_BUS" --timeout 60 | awk '$1 == "map_epoch" {print $2}'; }

# All containers, and an engine of our own, end at once, as when the power fails; `up` goes on in the same map.
cut_power() {
  local epoch containers
  epoch=$(map_epoch)
  [ -n "$epoch" ] || fail "$RDS_BUS: no map to go on in"
  say "$RDS_BUS: the engine is killed, and all containers with it"
  containers=$(compose ps --quiet)
  if [ -n "$engine_pid" ]; then kill_engine; launch_engine; else docker kill $containers >/dev/null; fi
  compose up --detach --wait --wait-timeout 180 "${services[@]}" >"$log" 2>&1 ||
    { cat "$log" >&2; fail "$RDS_BUS: the services did not come back"; }
  expect "$RDS_BUS: epoch of the map after the engine was killed" "$epoch" "$(map_epoch)"
}

# One whole run on a vendor; the map is asked for from this machine, outside the containers.
try_vendor() {
  export RDS_BUS=$1
  local started=$SECONDS
  say "$RDS_BUS: starting the services"
  compose up --detach --wait --wait-timeout 180 "${services[@]}" >"$log" 2>&1 ||
    { cat "$log" >&2; compose logs --tail 20 >&2; fail "$RDS_BUS: the services did not become healthy"; }
  say "$RDS_BUS: healthy after $((SECONDS - started)) s"
  status --wait 20 || fail "$RDS_BUS: not seen from outside the containers"
  local service
  for service in "${services[@]}"; do check_confinement "$service"; done
  say "$RDS_BUS: playing"
  compose up --no-recreate --exit-code-from player player >"$log" 2>&1 ||
    { tail -n 30 "$log" >&2; fail "$RDS_BUS: the player failed"; }
  local map
  map=$("$rds" map info --bus "$RDS_BUS" --timeout 30) ||
    { compose logs --tail 20 >&2; fail "$RDS_BUS: no map arrived outside the containers"; }
  say "$RDS_BUS: the map arrived:"
  sed 's/^/  /' <<<"$map"
  disturb
  cut_power
  compose down --volumes --timeout 5 >/dev/null 2>&1
}

# What rds hosts compose writes starts on each machine what belongs there, and nothing else.
check_machines() {
  local folder machine
  folder=$(mktemp -d)
  printf 'machines: {robot: {services: [tracker]}, desk: {services: [detector, transformer]}, nas: {services: [mapper, loop_closer]}}' >"$folder/hosts.yaml"
  "$rds" hosts compose "$folder/hosts.yaml" --out "$folder/machines" >/dev/null
  for machine in robot:tracker desk:detector,transformer nas:loop-closer,mapper; do
    expect "services of ${machine%:*}" "${machine#*:}" \
      "$(docker compose -f "$root/compose/compose.yaml" -f "$folder/machines/${machine%:*}.yaml" config --services | sort | paste -sd ,)"
  done
  rm -r "$folder"
}

begun=$SECONDS
mkdir -p "$root/build/compose" "$root/build/log"
log=$root/build/log/compose-test.log
start_engine
provide_compose
check_machines
provide_base debian:bookworm-slim
provide_input
say "image ($RDS_IMAGE_STAGE)"
long_step compose-build quiet compose build tracker
say "  $(docker image inspect --format '{{.Size}}' "${RDS_IMAGE:-rds-slam}" | awk '{printf "%.0f MB", $1 / 1e6}'), after $((SECONDS - begun)) s"
for vendor in "${vendors[@]}"; do try_vendor "$vendor"; done
say "compose test: ${#vendors[@]} passed, 0 failed in $((SECONDS - begun)) s"
