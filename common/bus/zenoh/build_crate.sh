#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build_crate.sh CARGO LIBRARY: builds the crate in crate/, with the lock of tls/ for links by TLS, and copies it to LIBRARY.
#
# What takes minutes is Zenoh itself, which seldom changes, so that work is kept in the user's cache, for all build folders and checkouts:
# cargo's target folder, and the library under a name made of all that it is made of.
set -euo pipefail
cargo=$1 library=$2
cache=${XDG_CACHE_HOME:-$HOME/.cache}/rds-slam/zenoh
cd "$(dirname "${BASH_SOURCE[0]}")"
export PATH=$(dirname "$cargo"):$PATH

hash_of() { sha256sum | cut -c 1-32; }

# Makes $1: zenoh-link-tls as crates.io has it, but one thread at a time uses its stream.
lock_tls() {
  local original
  original=$("$cargo" metadata --locked --format-version 1 --manifest-path crate/Cargo.toml | grep -o '"manifest_path":"[^"]*/zenoh-link-tls-[^"]*"' | cut -d '"' -f 4)
  rm -rf "$1.new"
  cp -R "$(dirname "$original")" "$1.new"
  cp tls/shared_stream.rs "$1.new/src"
  sed -i -f tls/use_shared_stream.sed "$1.new/src/unicast.rs"
  sed -i 's/^mod unicast;/mod shared_stream;\n&/' "$1.new/src/lib.rs"
  if grep -n 'UnsafeCell<\|unsafe {\|unsafe impl' "$1.new/src/unicast.rs"; then
    echo "common/bus/zenoh/tls does not fit this version of zenoh-link-tls" >&2
    exit 1
  fi
  mv "$1.new" "$1"
}

build() {
  local tls
  tls=$cache/zenoh-link-tls-$(cat tls/*.rs tls/*.sed crate/Cargo.lock | hash_of)
  [ -d "$tls" ] || lock_tls "$tls"
  rm -rf "$cache/crate"
  cp -R crate "$cache/crate"
  printf '\n[patch.crates-io]\nzenoh-link-tls = { path = "%s" }\n' "$tls" >>"$cache/crate/Cargo.toml"
  sed -i '/^name = "zenoh-link-tls"/,/^$/{/^source/d;/^checksum/d}' "$cache/crate/Cargo.lock"
  CARGO_TARGET_DIR=$cache/target "$cargo" build --release --locked --quiet --manifest-path "$cache/crate/Cargo.toml"
  cp "$cache/target/release/librds_zenoh.so" "$kept.$$"
  mv "$kept.$$" "$kept"
}

mkdir -p "$cache" "$(dirname "$library")"
exec {one_at_a_time}>"$cache/lock"
flock "$one_at_a_time"
kept=$cache/librds_zenoh-$({ rustc --version --verbose; cat build_crate.sh crate/Cargo.toml crate/Cargo.lock crate/src/*.rs tls/*.rs tls/*.sed; } | hash_of).so
[ -f "$kept" ] || build
cp "$kept" "$library.$$"
mv "$library.$$" "$library"
