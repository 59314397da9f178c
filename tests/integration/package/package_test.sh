#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# package_test.sh BUILD RECORDING: what is installed works without the tree: a program that finds it by find_package(rds), the
# programs themselves, their manual pages and completions.
set -eu
build=$1 recording=$2 here=$(cd "$(dirname "$0")" && pwd)
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
prefix=$place/usr
fail() { echo "$*" >&2; exit 1; }
quietly() { "$@" >"$place/log" 2>&1 || { cat "$place/log"; fail "$1: failed"; }; }

quietly cmake --install "$build" --prefix "$prefix" --strip

quietly cmake -S "$here/consumer" -B "$place/consumer" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release
! grep -q "$build" "$place/consumer/CMakeCache.txt" || fail "the consumer found something in $build"
quietly cmake --build "$place/consumer"
said=$("$place/consumer/consumer")
[ "$said" = "revision 3, 17 nodes" ] || fail "consumer: $said"

mkdir "$place/home"
run() { env -i HOME="$place/home" PATH=/usr/bin:/bin ${RDS_SHARED:+RDS_SHARED="$RDS_SHARED"} "$@"; }
run "$prefix/bin/rds" --version | grep -q '^Fast DDS [0-9]' || fail "rds --version: no Fast DDS"
run "$prefix/bin/rds-mapper" --version | grep -q '^Cyclone DDS [0-9]' || fail "rds-mapper --version: no Cyclone DDS"
for program in rds rds-tracker rds-detector rds-transformer rds-mapper rds-loop-closer rds-viewer; do
  # What dpkg-shlibdeps and the loader see: private libraries beside the programs, nothing of the build.
  ! readelf -d "$prefix/bin/$program" | grep -q "$build" || fail "$program: looks for libraries in $build"
  zcat "$prefix/share/man/man1/$program.1.gz" | grep -q '^\.SH OPTIONS' || fail "$program: no manual page"
  bash -n "$prefix/share/bash-completion/completions/$program" || fail "$program: bash does not understand its completion"
  ! command -v zsh >/dev/null || zsh -n "$prefix/share/zsh/vendor-completions/_$program" || fail "$program: nor does zsh"
done
said=$(bash -c ". $prefix/share/bash-completion/completions/rds
  COMP_WORDS=(rds map export --form) COMP_CWORD=3; _rds; echo \${COMPREPLY[*]}
  COMP_WORDS=(rds record --compression l) COMP_CWORD=3; _rds; echo \${COMPREPLY[*]}")
[ "$said" = "--format
lz4" ] || fail "completion: $said"
grep -q "^ExecStart=$prefix/bin/rds-%i " "$prefix/lib/systemd/system/rds-slam@.service" || fail "the unit names no $prefix/bin"
for name in tracker detector transformer mapper loop_closer viewer; do
  [ -s "$prefix/share/rds-slam/settings/$name.yaml" ] || fail "$name.yaml: not installed"
done

[ -n "${RDS_SHARED:-}" ] || cp -r "${HOME:-/nonexistent}/.cache" "$place/home" 2>/dev/null || true  # the detector's network
(cd "$place" && quietly run "$prefix/bin/rds" run "$recording" --out out --rate max --frames 10)
grep -q '"restarts": 0' "$place/out/summary.json" || fail "a service has ended: $(cat "$place/out/summary.json")"
[ -s "$place/out/map.ot" ] || fail "the installed programs have left no map"
