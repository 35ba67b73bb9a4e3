#!/usr/bin/env bash
# What the tests of model/ and sim/ run of the lines of each (gcov, gcovr): a table of files and a total for each folder.
# Fails where one has less than 90 %. Builds in build/coverage.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build="$root/build/coverage"
"$root/cmake/install_packages.sh"
for folder in model sim; do
  "$root/cmake/build.sh" ${folder}_tests coverage -DSPLATSCOPE_COVERAGE=ON
done
find "$build" -name '*.gcda' -delete
for folder in model sim; do
  "$build/${folder}_tests" --gtest_brief=1
done
status=0
for folder in model sim; do
  gcovr --root "$root" --filter "$folder/" --exclude '.*_(test|bench|fuzz)\.cpp' --exclude '.*/testing/.*' \
    --fail-under-line 90 --print-summary "$build" || status=1
done
exit $status
