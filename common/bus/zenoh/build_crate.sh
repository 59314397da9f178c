#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build_crate.sh CARGO LIBRARY: builds the crate in crate/, with Zenoh's own as patches/ changes them, and copies it to LIBRARY. It is kept
# under a name made of all that it is made of.
set -euo pipefail
cargo=$1 library=$2
cd "$(dirname "${BASH_SOURCE[0]}")"
source patches/patched_crate.sh

build() {
  copy_crate
  "$cargo" build --release --locked --quiet --manifest-path "$cache/crate/Cargo.toml"
  cp "$CARGO_TARGET_DIR/release/librds_zenoh.so" "$kept.$$"
  mv "$kept.$$" "$kept"
}

lock_cache
mkdir -p "$(dirname "$library")"
kept=$cache/librds_zenoh-$({ rustc --version --verbose; cat build_crate.sh patches/*.sh crate/Cargo.toml crate/Cargo.lock crate/src/*.rs patches/*.rs patches/*.sed; } | hash_of).so
[ -f "$kept" ] || build
cp "$kept" "$library.$$"
mv "$library.$$" "$library"
