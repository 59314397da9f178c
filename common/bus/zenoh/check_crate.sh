#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_crate.sh CARGO: rustfmt and clippy find nothing to change in crate/ and patches/, and the crate's own tests pass. Needs what build_crate.sh has built.
set -euo pipefail
cargo=$1
cd "$(dirname "${BASH_SOURCE[0]}")"
source patches/patched_crate.sh

"$cargo" fmt --check --manifest-path crate/Cargo.toml
rustfmt --check --edition 2021 --config-path crate patches/*.rs
lock_cache
copy_crate
"$cargo" clippy --release --locked --offline --quiet --no-deps --manifest-path "$cache/crate/Cargo.toml" -- -D warnings
"$cargo" test --release --locked --offline --quiet --manifest-path "$cache/crate/Cargo.toml"
