#!/usr/bin/env bash
# Builds Debian's oneTBB with the thread sanitizer, which sees no order in what a library does that it did not compile: its
# tasks would all be races. thread_sanitized_tbb.sh FOLDER; prints the folder of the shared library.
set -euo pipefail
folder=$(realpath -m "$1")  # apt takes a relative one below folders of its own
built="$folder/built"
if [ ! -e "$built" ]; then
  rm -rf "$folder" && mkdir -p "$folder/parts" "$folder/lists"
  # The sources of the archives that the system has, without changing its list.
  for list in /etc/apt/sources.list /etc/apt/sources.list.d/debian.sources; do
    [ ! -e "$list" ] || sed 's/^Types: deb$/Types: deb-src/; s/^deb /deb-src /' "$list" >"$folder/parts/$(basename "$list")"
  done
  apt=(apt-get -qq -o "Dir::Etc::SourceList=/dev/null" -o "Dir::Etc::SourceParts=$folder/parts" -o "Dir::State::Lists=$folder/lists"
    -o "APT::Sandbox::User=root")
  (
    cd "$folder"
    "${apt[@]}" update
    "${apt[@]}" source --download-only onetbb
    mkdir source && tar xf onetbb_*.orig.tar.* -C source --strip-components 1
    cmake -S source -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DTBB_SANITIZE=thread -DTBB_TEST=OFF -DTBB_STRICT=OFF \
      -DTBBMALLOC_BUILD=OFF -DTBBMALLOC_PROXY_BUILD=OFF
    cmake --build build --target tbb
    dirname "$(find "$folder/build" -name libtbb.so.12)" >"$built"
  ) >&2
fi
cat "$built"
