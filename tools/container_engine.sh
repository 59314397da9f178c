# SPDX-License-Identifier: Apache-2.0
# Sourced by compose_test.sh after common.sh: a Docker engine, Compose v2 and a Debian base image, also on a machine that has
# neither an engine nor a registry. An engine of our own lives in build/compose, changes nothing on the host and is stopped by
# stop_engine; its images stay for the next time.

engine_folder=$root/build/compose
engine_pid=

# install_missing COMMAND PACKAGE...
install_missing() {
  local command=$1
  shift
  ! PATH=$PATH:/usr/sbin command -v "$command" >/dev/null || return 0
  say "  installing $*"
  local -a apt=(as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300)
  long_step apt-update quiet "${apt[@]}" update
  long_step "apt-$command" quiet "${apt[@]}" install -y --no-install-recommends -o Dpkg::Use-Pty=0 "$@"
}

start_engine() {
  if docker info >/dev/null 2>&1; then say "engine: the one that runs here"; return; fi
  [ "$(id -u)" = 0 ] || fail "no Docker engine answers: start one, or run this as root so that it can start one of its own"
  install_missing dockerd docker.io
  if docker info >/dev/null 2>&1; then say "engine: the one that Debian has started"; return; fi
  mkdir -p "$engine_folder"
  exec 8>"$engine_folder/lock"
  flock -n 8 || fail "an engine already runs on $engine_folder/engine: wait for the compose test that started it"
  # A socket's path may have 107 characters at most.
  engine_run=$(mktemp -d)
  export DOCKER_HOST=unix://$engine_run/docker.sock
  launch_engine
  say "engine: one of our own"
}

# Waits until it answers.
launch_engine() {
  PATH=$PATH:/usr/sbin dockerd --iptables=false --ip6tables=false --bridge=none --ip-forward=false \
    --data-root "$engine_folder/engine" --exec-root "$engine_run/exec" -p "$engine_run/pid" -H "$DOCKER_HOST" \
    >>"$engine_folder/engine.log" 2>&1 &
  engine_pid=$!
  for _ in $(seq 60); do
    ! docker info >/dev/null 2>&1 || return 0
    kill -0 "$engine_pid" 2>/dev/null || break
    sleep 0.5
  done
  tail -n 5 "$engine_folder/engine.log" >&2
  fail "the Docker engine did not start, see $engine_folder/engine.log"
}

# Ends the engine and every process of its containers with SIGKILL, as when the power fails.
kill_engine() {
  local shim
  kill -9 "$engine_pid"
  for shim in $(pgrep -f "containerd-shim.*$engine_run"); do pkill -9 -P "$shim" || true; done
  pkill -9 -f "containerd.*$engine_run" || true
  wait "$engine_pid" 2>/dev/null || true
  forget_run
}

stop_engine() {
  [ -n "$engine_pid" ] || return 0
  kill "$engine_pid" 2>/dev/null || true
  wait "$engine_pid" 2>/dev/null || true
  forget_run
  rm -rf "$engine_run"
}

# What an engine that has ended leaves in memory, mounts too: it outlasts no failure of the power.
forget_run() {
  findmnt --raw --noheadings --output TARGET | grep -E "^($engine_folder|$engine_run)/" | sort --reverse |
    xargs --no-run-if-empty umount --lazy || true
  rm -rf "${engine_run:?}"/*
}

# Where Debian's packages come from on this machine.
debian_mirror() {
  apt-get indextargets --format '$(REPO_URI) $(RELEASE)' | awk '$2 == "bookworm" {print $1; exit}'
}

# Compose v2 as a plugin of the client: Debian 13 has it, and its program runs on Debian 12.
provide_compose() {
  if docker compose version >/dev/null 2>&1; then return; fi
  export DOCKER_CONFIG=$engine_folder/client
  if docker compose version >/dev/null 2>&1; then return; fi
  say "compose: Debian 13's docker-compose, as a plugin"
  local apt_folder=$engine_folder/trixie
  mkdir -p "$apt_folder/lists/partial" "$DOCKER_CONFIG/cli-plugins"
  echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $(debian_mirror) trixie main" >"$apt_folder/sources.list"
  local -a apt=(apt-get -q -o Dir::Etc::sourcelist="$apt_folder/sources.list" -o Dir::Etc::sourceparts=-
    -o Dir::State::lists="$apt_folder/lists" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= -o APT::Sandbox::User=root)
  long_step compose-update quiet "${apt[@]}" update
  (cd "$apt_folder" && long_step compose-download quiet "${apt[@]}" download docker-compose)
  dpkg-deb --fsys-tarfile "$apt_folder"/docker-compose_*.deb |
    tar -xO ./usr/libexec/docker/cli-plugins/docker-compose >"$DOCKER_CONFIG/cli-plugins/docker-compose"
  chmod +x "$DOCKER_CONFIG/cli-plugins/docker-compose"
  docker compose version >/dev/null || fail "the compose plugin does not run"
}

# provide_base IMAGE: made with debootstrap where our own engine lacks it; another engine has its registries.
provide_base() {
  if [ -z "$engine_pid" ] || docker image inspect "$1" >/dev/null 2>&1; then return; fi
  install_missing debootstrap debootstrap
  say "base image: $1 by debootstrap"
  local rootfs
  rootfs=$(mktemp -d)
  long_step debootstrap quiet env PATH="$PATH:/usr/sbin" debootstrap --variant=minbase bookworm "$rootfs" "$(debian_mirror)"
  rm -rf "$rootfs"/var/cache/apt/archives/*.deb
  tar -C "$rootfs" -c . | docker import - "$1" >/dev/null
  rm -rf "$rootfs"
}
