#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# fresh_system_test.sh BUILD: the Debian packages, made from BUILD, in a Debian 12 that has nothing else: they install, run a rendered
# recording with its page, have their documents, build a program of a user, and leave nothing but maps when they are purged.
#
# Needs root, mmdebstrap and lintian (apt-get install mmdebstrap lintian), and Debian's packages as this machine's apt reaches them.
# RDS_SHARED  folder whose models/ holds a network for the detector; without it the one in ~/.cache/rds-slam.
set -euo pipefail
build=$(cd "$1" && pwd) here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
place=$(mktemp -d)
fresh=$place/fresh
trap 'rm -rf --one-file-system "$place"' EXIT
fail() { printf '%s\n' "$*" >&2; exit 1; }
quietly() { "$@" >"$place/log" 2>&1 || { tail -n 30 "$place/log" >&2; fail "$1: failed"; }; }
[ "$(id -u)" = 0 ] || fail "expected root"
for program in mmdebstrap lintian unshare ip; do command -v $program >/dev/null || fail "$program: expected on the PATH"; done

# inside COMMAND [--net]: a shell of the fresh system, with processes and mounts of its own; with --net alone on its network, too.
inside() {
  unshare --mount --pid --fork ${2:-} sh -c 'mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && mount -t tmpfs tmpfs "$0/run" && ip link set lo up &&
    exec chroot "$0" /usr/bin/env -i HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive PATH=/usr/sbin:/usr/bin:/sbin:/bin sh -euc "$1"' "$fresh" "$1"
}

(cd "$build" && quietly cpack -G DEB -B "$place/packages")
packages=("$place"/packages/*.deb)
[ ${#packages[@]} = 3 ] || fail "${#packages[@]} packages, expected 3"
lintian --fail-on error --tag-display-limit 0 "${packages[@]}" >"$place/lintian" 2>&1 || { grep '^E' "$place/lintian"; fail "lintian found errors"; }

mapfile -t sources < <(find /etc/apt/sources.list.d -name 'debian.sources' -o -name 'debian.list')
[ -s /etc/apt/sources.list ] && sources=(/etc/apt/sources.list)
quietly mmdebstrap --variant=minbase --include=ca-certificates bookworm "$fresh" "${sources[@]}"
cp --dereference /etc/resolv.conf "$fresh/etc/resolv.conf"
cp "${packages[@]}" "$fresh/root/"
quietly inside 'apt-get -q update'

quietly inside 'apt-get install -y --no-install-recommends /root/rds-slam*.deb'
inside 'rds --version' | grep -q '^Fast DDS [0-9]' || fail "rds --version: no Fast DDS"
for models in "${RDS_SHARED:+$RDS_SHARED/models}" "${HOME:-/root}/.cache/rds-slam/models"; do
  [ -d "$models" ] || continue
  mkdir -p "$fresh/root/shared" && cp -r "$models" "$fresh/root/shared/models" && break
done
# The page is there while the run lasts, and its figures are those of the map that is left.
inside 'cd /root && export RDS_SHARED=/root/shared
  rds simulate --out room --people 1 --seconds 4 >/dev/null
  rds run room --out results --rate max --view=18080 --view-keep >run.log 2>&1 & run=$!
  for _ in $(seq 600); do ! grep -q "the page stays" run.log || break; kill -0 $run || { cat run.log; exit 1; }; sleep 0.5; done
  perl -MIO::Socket::INET -e '\''for (["/", "page.html"], ["/metrics", "metrics"]) {
    my $s = IO::Socket::INET->new("127.0.0.1:18080") or die "no page"; print $s "GET $_->[0] HTTP/1.1\r\nHost: 127.0.0.1:18080\r\nConnection: close\r\n\r\n";
    open my $out, ">", $_->[1]; print {$out} <$s>; }'\''
  kill -INT $run; wait $run
  grep -q "<!doctype html>" page.html
  voxels=$(rds map info --map results | sed -n "s/^occupied_voxels *//p")
  [ "$voxels" -gt 10000 ] && grep -q "^rds_map_occupied_voxels $voxels" metrics
  rds eval room results' --net >"$place/run" 2>&1 || { tail -n 30 "$place/run" >&2; fail "rds run --view: failed"; }
for program in rds rds-tracker rds-detector rds-transformer rds-mapper rds-loop-closer rds-viewer; do
  inside "$program --help >/dev/null && test -s /usr/share/man/man1/$program.1.gz && test -s /usr/share/bash-completion/completions/$program" ||
    fail "$program: no help, manual page or completion"
done

cp -r "$here/consumer" "$fresh/root/consumer"
quietly inside 'apt-get install -y --no-install-recommends /root/librds-slam-dev*.deb g++ cmake make
  cmake -S /root/consumer -B /root/consumer/build && cmake --build /root/consumer/build'
[ "$(inside /root/consumer/build/consumer)" = "revision 3, 17 nodes" ] || fail "the consumer says something else"

inside 'mkdir -p /var/lib/rds-slam/maps /var/lib/rds-slam/models /etc/rds-slam
  touch /var/lib/rds-slam/maps/kitchen.rds /var/lib/rds-slam/models/n.onnx /etc/rds-slam/mapper.yaml'
quietly inside 'apt-get purge -y librds-slam-dev rds-slam rds-slam-tools'
left=$(inside 'find / -xdev \( -path /root -o -path /tmp -o -path /dev -o -path /var/cache/apt \) -prune -o \
  \( -path "*/rds-slam/*" -o -path "*/rds_slam/*" -o -name "rds" -o -name "rds[-_]*" -o -name "rds.1*" -o -name "_rds*" -o -name "librds*" \) ! -type d -print')
[ "$left" = /var/lib/rds-slam/maps/kitchen.rds ] || fail "left behind: $left"
echo "3 packages, $(wc -l <"$place/lintian") lines of lintian, no error"
