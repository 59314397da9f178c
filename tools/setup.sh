#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# setup.sh [--ros] [--viewer] [--docs] [--no-zenoh]: installs on Debian 12 what building, running and testing needs: Debian packages (packages.txt), PyPI packages
# (requirements.txt) in .venv, and a network for the detector. What is there already is left alone.
#
# --no-zenoh  without the compiler and sources of Zenoh (100 MB), so --bus zenoh is left out of the build.
# --ros       also ROS 2 Jazzy's and Kilted's rclpy in .venv-jazzy and .venv-kilted, for the test beside ROS 2 programs, and readers of
#             ROS 2's recordings in .venv-records, and other people's Zenoh in .venv-zenoh and .venv-zenoh-1.5.
# --viewer    also Chromium, Node.js and, in tests/viewer/node_modules, npm packages, for the tests of the viewer's page.
# --docs      also mkdocs-material and doxygen, for the site of all documents (tools/docs.sh).
# RDS_SHARED  folder whose models/ holds the paper's network; without it NanoDet-g is fetched.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

check_system() {
  local name
  name=$(. /etc/os-release 2>/dev/null && echo "${ID:-} ${VERSION_ID:-}") || true
  [ "$name" = "debian 12" ] || fail "this system is '${name:-unknown}': expected Debian 12 (bookworm)"
  [ "$(id -u)" = 0 ] || command -v sudo >/dev/null || fail "sudo: expected on the PATH, or run this as root"
}

is_installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

# Names in packages.txt that are not installed and not made unnecessary by a command.
missing_packages() {
  local package condition
  sed 's/#.*//' "$root/tools/packages.txt" | while read -r package condition; do
    [ -n "$package" ] || continue
    ! is_installed "$package" || continue
    [ -z "$condition" ] || ! command -v "${condition#unless:}" >/dev/null || continue
    echo "$package"
  done
}

install_packages() {
  local -a apt=(as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300)
  say "  package lists"
  long_step apt-update quiet "${apt[@]}" update
  long_step apt-install apt_progress "${apt[@]}" install -y --no-install-recommends -o Dpkg::Use-Pty=0 "$@"
}

set_up_packages() {
  local -a missing
  mapfile -t missing < <(missing_packages)
  if [ ${#missing[@]} = 0 ]; then
    say "[1/4] Debian packages: all there"
  else
    say "[1/4] Debian packages: installing ${missing[*]}"
    install_packages "${missing[@]}"
  fi
}

# set_up_venv NAME LABEL FILE...: the packages of FILE, the first of the files that say what there has to be, in a virtual environment.
set_up_venv() {
  local venv=$root/$1 label=$2 wanted
  shift 2
  wanted=$(cat "$@" | sha256sum)
  if [ "$(cat "$venv/requirements.sha256" 2>/dev/null)" = "$wanted" ] && "$venv/bin/python" -c '' 2>/dev/null; then
    say "$label: all there"
    return
  fi
  say "$label: installing into $(basename "$venv")"
  rm -rf "$venv"
  long_step venv quiet /usr/bin/python3 -m venv "$venv"
  long_step pip quiet "$venv/bin/pip" install --no-input --no-deps -r "$1"
  echo "$wanted" >"$venv/requirements.sha256"
}

set_up_ros() {
  local distribution
  for distribution in jazzy kilted; do
    set_up_venv ".venv-$distribution" "ROS 2 $distribution" "$root/tests/ros/requirements-$distribution.txt"
  done
  set_up_venv .venv-records "readers of recordings" "$root/tests/records/requirements.txt"
  set_up_venv .venv-zenoh "other programs on Zenoh" "$root/tests/integration/bus/zenoh_requirements.txt"
  set_up_venv .venv-zenoh-1.5 "Zenoh 1.5" "$root/tests/integration/bus/zenoh_requirements_1.5.txt"
}

# A cargo of the user's own, else Debian's, with what checks the crate; what it is built of comes from crates.io.
set_up_zenoh() {
  local cargo
  export PATH=$PATH:$HOME/.cargo/bin
  if ! command -v cargo >/dev/null || { is_installed cargo-web && ! is_installed rust-web-clippy; }; then
    install_packages rustc-web cargo-web rust-web-clippy rustfmt-web
  fi
  cargo=$(command -v cargo)
  say "[4/4] Zenoh: $("$cargo" --version)"
  long_step cargo-fetch quiet "$cargo" fetch --locked --manifest-path "$root/common/bus/zenoh/crate/Cargo.toml"
}

# Programs that are there already, of Debian or not, are left alone.
set_up_viewer() {
  local -a missing=()
  command -v chromium >/dev/null || missing+=(chromium)
  command -v npm >/dev/null || missing+=(nodejs npm)
  if [ ${#missing[@]} != 0 ]; then
    say "the page's tests: installing ${missing[*]}"
    install_packages "${missing[@]}"
  fi
  local folder=$root/tests/viewer wanted
  wanted=$(sha256sum <"$folder/package-lock.json")
  if [ "$(cat "$folder/node_modules/lock.sha256" 2>/dev/null)" = "$wanted" ]; then
    say "the page's tests: all there"
    return
  fi
  say "the page's tests: installing into tests/viewer/node_modules"
  long_step npm quiet npm --prefix "$folder" ci --no-audit --no-fund
  echo "$wanted" >"$folder/node_modules/lock.sha256"
}

set_up_docs() {
  if command -v mkdocs >/dev/null && command -v doxygen >/dev/null; then
    say "the documents' site: all there"
  else
    say "the documents' site: installing mkdocs-material and doxygen"
    install_packages mkdocs-material doxygen
  fi
}

set_up_network() {
  local shared=${RDS_SHARED:+$RDS_SHARED/models/mobilenetv2_ssdlite_voc.onnx}
  if [ -n "$shared" ] && [ -f "$shared" ]; then
    say "[3/4] network: $shared"
    return
  fi
  say "[3/4] network: NanoDet-g"
  if ! "$root/tools/networks/fetch_nanodet_g.sh" 2>/dev/null; then
    command -v npm >/dev/null || { say "  npm, to fetch it"; install_packages npm; }
    "$root/tools/networks/fetch_nanodet_g.sh"
  fi
}

with_ros=false
with_viewer=false
with_docs=false
with_zenoh=true
for option in "$@"; do
  case $option in
    --ros) with_ros=true ;;
    --viewer) with_viewer=true ;;
    --docs) with_docs=true ;;
    --no-zenoh) with_zenoh=false ;;
    *) fail "$option: expected --ros, --viewer, --docs, --no-zenoh or nothing" ;;
  esac
done
check_system
set_up_packages
set_up_venv .venv "[2/4] PyPI packages" "$root/tools/requirements.txt" "$root/tools/networks/requirements.txt"
set_up_network
! $with_zenoh || set_up_zenoh
! $with_ros || set_up_ros
! $with_viewer || set_up_viewer
! $with_docs || set_up_docs
