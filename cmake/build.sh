#!/usr/bin/env bash
# Builds a target with Ninja: build.sh TARGET [BUILD [CMAKE_OPTION...]]. BUILD is a folder in build/, by default release.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
target=$1
build="$root/build/${2-release}"
[ -f "$build/build.ninja" ] || cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release "${@:3}"
echo "building $build: $target"
cmake --build "$build" --target "$target"
