#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build_crate.sh CARGO LIBRARY: builds the crate in crate/ and copies it to LIBRARY.
#
# What takes minutes is Zenoh itself, which seldom changes, so that work is kept in the user's cache, for all build folders and checkouts:
# cargo's target folder, and the library under a name made of all that it is made of.
set -euo pipefail
cargo=$1 library=$2
cache=${XDG_CACHE_HOME:-$HOME/.cache}/rds-slam/zenoh
cd "$(dirname "${BASH_SOURCE[0]}")/crate"
export PATH=$(dirname "$cargo"):$PATH

made_of=$({ rustc --version --verbose; cat Cargo.toml Cargo.lock src/*.rs; } | sha256sum | cut -c 1-32)
kept=$cache/librds_zenoh-$made_of.so
mkdir -p "$cache" "$(dirname "$library")"
if [ ! -f "$kept" ]; then
  CARGO_TARGET_DIR=$cache/target "$cargo" build --release --locked --quiet
  cp "$cache/target/release/librds_zenoh.so" "$kept.$$"
  mv "$kept.$$" "$kept"
fi
cp "$kept" "$library.$$"
mv "$library.$$" "$library"
