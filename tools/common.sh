# SPDX-License-Identifier: Apache-2.0
# Sourced by the scripts of this folder: messages, privileges, long steps, the build's environment.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf '%s\n' "$*"; }
fail() { printf '%s\n' "$*" >&2; exit 1; }

# as_root COMMAND...: as it is for root, else by sudo.
as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

# long_step NAME FILTER COMMAND...: runs the command into build/log/NAME.log and shows what FILTER makes of its lines.
# On failure the log's last lines and one sentence.
long_step() {
  local name=$1 filter=$2 log=$root/build/log/$1.log
  shift 2
  mkdir -p "$root/build/log"
  if ! "$@" 2>&1 | tee "$log" | "$filter"; then
    tail -n 25 "$log" >&2
    fail "$name: failed, its whole output is in $log"
  fi
}

# Every tenth of what ninja says about itself ("[12/345] …").
ninja_progress() {
  awk 'match($0, /^\[[0-9]+\/[0-9]+\]/) {
         split(substr($0, 2, RLENGTH - 2), n, "/"); tenth = int(10 * n[1] / n[2])
         if (tenth != shown) { shown = tenth; printf "  %s of %s\n", n[1], n[2]; fflush() }
       }'
}

# Every hundredth package that apt sets up.
apt_progress() {
  awk '/^[0-9]+ upgraded/ { print "  " $0; fflush() }
       /^Setting up/ { if (++n % 100 == 0) { print "  " n " set up"; fflush() } }'
}

quiet() { cat >/dev/null; }

# A compiler of two cores' worth of jobs, and objects found again from any clone.
export CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_BASEDIR=$root CCACHE_MAXSIZE=${CCACHE_MAXSIZE:-10G}
jobs() {
  local by_memory=$(($(awk '/MemTotal/ {print $2}' /proc/meminfo) / 2500000))
  local by_cores
  by_cores=$(nproc)
  echo $((by_memory < 1 ? 1 : by_memory < by_cores ? by_memory : by_cores))
}

# build PRESET TARGET...: configures and builds (all targets if none is named).
build() {
  local preset=$1
  shift
  say "configure $preset"
  (cd "$root" && long_step "configure-$preset" quiet cmake --preset "$preset")
  say "build $preset (from nothing some minutes, else seconds)"
  (cd "$root" && long_step "build-$preset" ninja_progress \
    cmake --build --preset "$preset" -j "$(jobs)" ${1:+--target "$@"})
}
