#!/usr/bin/env bash
# Runs the fuzzers (libFuzzer, address and undefined-behaviour sanitizers) for so many seconds each, one after the other:
# fuzz.sh SECONDS [NAME...]. Stops at the first finding. Builds in build/fuzz.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build="$root/build/fuzz"
seconds=${1:?usage: fuzz.sh SECONDS [NAME...]}
names=("${@:2}")
[ ${#names[@]} -gt 0 ] || mapfile -t names < <(find "$root/model" "$root/traces" "$root/studies" -name '*_fuzz.cpp' -printf '%f\n' |
  sed 's/_fuzz.cpp$//' | sort)
"$root/cmake/install_packages.sh"
for name in "${names[@]}"; do
  "$root/cmake/build.sh" "${name}_fuzz" fuzz -DCMAKE_CXX_COMPILER=clang++-22 -DSPLATSCOPE_FUZZ=ON
done
for name in "${names[@]}"; do
  mkdir -p "$build/corpus/$name"
  echo "fuzzing: $name, $seconds s"
  "$build/${name}_fuzz" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$build/$name-" "$build/corpus/$name" "$root/tests/fuzz/$name"
done
