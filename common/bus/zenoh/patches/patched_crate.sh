# SPDX-License-Identifier: Apache-2.0
# Sourced by ../build_crate.sh and ../check_crate.sh in their folder, with the path of a cargo in $cargo: a copy of crate/ in $cache/crate that takes Zenoh's own
# crates as patches/ changes them, and cargo's target folder in $cache/target. What takes minutes is Zenoh itself, which seldom changes, so both
# are in the user's cache, for all build folders and checkouts.
cache=${XDG_CACHE_HOME:-$HOME/.cache}/rds-slam/zenoh
export PATH=$(dirname "$cargo"):$PATH CARGO_TARGET_DIR=$cache/target

hash_of() { sha256sum | cut -c 1-32; }

# Where cargo keeps the sources of crate $1.
original_of() {
  local manifest
  manifest=$("$cargo" metadata --locked --format-version 1 --manifest-path crate/Cargo.toml | grep -o '"manifest_path":"[^"]*/'"$1"'-[0-9][^"]*"' | cut -d '"' -f 4)
  dirname "$manifest"
}

# Makes $2: crate $1 as crates.io has it, but for the lines that patches/$1.sed changes and says the number of.
patch_crate() {
  local original lines
  original=$(original_of "$1")
  lines=$(sed -n 's/^# \([0-9]*\) lines of .*/\1/p' "patches/$1.sed")
  cp -R "$original" "$2"
  find "$2/src" -name '*.rs' -exec sed -i -f "$PWD/patches/$1.sed" {} +
  if [ "$(diff -r "$original" "$2" | grep -c '^[<>]')" != "$lines" ]; then
    echo "common/bus/zenoh/patches does not fit this version of $1" >&2
    exit 1
  fi
}

# Makes $1: all crates that are changed, a folder for each.
patch_crates() {
  local script name
  rm -rf "$1.new"
  mkdir "$1.new"
  for script in patches/*.sed; do
    name=$(basename "$script" .sed)
    patch_crate "$name" "$1.new/$name"
  done
  cp patches/shared_stream.rs "$1.new/zenoh-link-tls/src"
  cp patches/bounded.rs "$1.new/zenoh-ext/src"
  cp patches/declared.rs "$1.new/zenoh/src/net/routing/dispatcher"
  mv "$1.new" "$1"
}

# Until the script ends nobody else is in the cache.
lock_cache() {
  mkdir -p "$cache"
  exec {one_at_a_time}>"$cache/lock"
  flock "$one_at_a_time"
}

copy_crate() {
  local patched folder name
  patched=$cache/patched-$(cat patches/*.rs patches/*.sed crate/Cargo.lock | hash_of)
  [ -d "$patched" ] || patch_crates "$patched"
  rm -rf "$cache/crate"
  cp -R crate "$cache/crate"
  printf '\n[patch.crates-io]\n' >>"$cache/crate/Cargo.toml"
  for folder in "$patched"/*; do
    name=$(basename "$folder")
    printf '%s = { path = "%s" }\n' "$name" "$folder" >>"$cache/crate/Cargo.toml"
    sed -i '/^name = "'"$name"'"/,/^$/{/^source/d;/^checksum/d}' "$cache/crate/Cargo.lock"
  done
}
