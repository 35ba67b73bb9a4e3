#!/usr/bin/env bash
# Builds the given target in build/release (Ninja, Release).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build="$root/build/release"
[ -f "$build/build.ninja" ] || cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release
echo "building $build: $1"
cmake --build "$build" --target "$1"
