#!/usr/bin/env bash
# Reads the sources with clang-tidy (.clang-tidy): tidy.sh BUILD [FILES], the folder of a build that has been built, and
# a regular expression of files (all of them). Prints what is found, and fails where that is anything.
#
# Most of the time for a file goes into its headers, so files of one target are read together, through a file that
# includes them; those that define the same names are kept apart, and where that did not do, each is read alone. What was
# found clean is remembered by the content of the sources and of every header: only what changed is read again. Tests
# are read without the analyzer, which follows each of their macros: they run, under sanitizers too.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(cd "${1:?usage: tidy.sh BUILD [FILES]}" && pwd)
memory="${XDG_CACHE_HOME:-$HOME/.cache}/splatscope-tidy"
export tidy=clang-tidy-22 work="$build/tidy"
rm -rf "$work"
mkdir -p "$work" "$memory"

# Lines of file, object, flags.
awk -v root="$root/" -v build="$build/" '
  /^ *"command": / { command = $0; sub(/^ *"command": "[^ ]* /, "", command); sub(/",?$/, "", command)
                     gsub(/\\"/, "\"", command); gsub(/\\\\/, "\\", command) }
  /^ *"file": / { split($0, parts, "\""); file = parts[4]; object = command
                  sub(/.* -o /, "", object); sub(/ -c .*/, "", object); sub(/ -o .*/, "", command)
                  if (index(file, root) == 1 && index(file, build) != 1) print file "\t" object "\t" command }
' "$build/compile_commands.json" | sort | awk -F'\t' -v files="${2-.}" '$1 ~ files' >"$work/sources"

# The same lines, each after the number of its group. A name is what stands at the beginning of a line before what
# defines it.
awk -F'\t' -v together=12 '
  function read_names(file,   line) {
    split("", names)
    while ((getline line < file) > 0) {
      sub(/^(struct|class|union|enum class|enum|#define) /, "=", line)
      if (line !~ /^[=A-Za-z]/ || line ~ /^(namespace|using namespace|template)/) continue
      if (line ~ /^=/ ? match(line, /[A-Za-z_0-9]+/) : match(line, /[A-Za-z_0-9]*[a-z][A-Za-z_0-9]*( =|[({;[])/))
        names[substr(line, RSTART, match(substr(line, RSTART) " ", /[^A-Za-z_0-9]/) - 1)]
    }
    close(file)
  }
  function fits(group,   name) {
    if (flags[group] != $3 || size[group] == together || is_test[group] != ($1 ~ /_test\.cpp$/)) return 0
    for (name in names) if ((group, name) in taken) return 0
    return 1
  }
  { read_names($1)
    for (group = 1; group <= groups && !fits(group); ++group) {}
    if (group > groups) { groups = group; flags[group] = $3; is_test[group] = ($1 ~ /_test\.cpp$/) }
    ++size[group]
    for (name in names) taken[group, name]
    print group "\t" $0 }
' "$work/sources" >"$work/groups"

# By group: the hashes of all that its objects were built from, as Ninja knows it.
cd "$build"
ninja -t deps | awk '/^[^ ]/ { sub(/:.*/, ""); object = $0 } /^ / { print object "\t" $1 }' >"$work/deps"
cut -f2 "$work/deps" | sort -u | xargs -rd '\n' sha256sum >"$work/hashes"
awk -v work="$work" -v build="$build" '
  FILENAME ~ /hashes$/ { hash[$2] = $1; next }
  FILENAME ~ /groups$/ { split($0, parts, "\t"); group[parts[3]] = parts[1]; unbuilt[parts[3]]
                         gsub(build, "", parts[4]); print parts[4] > (work "/" parts[1] ".key"); next }
  $1 in group { delete unbuilt[$1]; print hash[$2] > (work "/" group[$1] ".key") }
  END { for (object in unbuilt) print object, rand() > (work "/" group[object] ".key") }
' "$work/hashes" "$work/groups" "$work/deps"

read_together() {  # the name of its output, flags, files
  local fewer=()
  [[ $3 != *_test.cpp ]] || fewer=('--checks=-clang-analyzer-*')
  printf '#include "%s"  // NOLINT(bugprone-suspicious-include)\n' "${@:3}" >"$1.cpp"
  eval "local flags=($2)"
  "$tidy" --quiet "${fewer[@]}" "$1.cpp" -- "${flags[@]}" >"$1.out" 2>&1
}
read_group() {  # makes GROUP.clean where nothing was found
  local group=$1 flags files file
  flags=$(awk -F'\t' -v group="$group" '$1 == group { print $4; exit }' "$work/groups")
  mapfile -t files < <(awk -F'\t' -v group="$group" '$1 == group { print $2 }' "$work/groups")
  if ! read_together "$work/$group" "$flags" "${files[@]}"; then
    grep -q 'clang-diagnostic-error' "$work/$group.out" || return 0
    mv "$work/$group.out" "$work/$group.apart"
    for file in "${files[@]}"; do
      read_together "$work/$group-$(basename "$file")" "$flags" "$file" || touch "$work/$group.unclean"
    done
    [ ! -e "$work/$group.unclean" ] || return 0
  fi
  touch "$work/$group.clean"
}
export -f read_together read_group
version=$("$tidy" --version)
declare -A keys=()
for file in "$work"/*.key; do
  group=$(basename "$file" .key)
  key=$( (echo "$version" && cat "$root/.clang-tidy" "$root/cmake/tidy.sh" && sort -u "$file") | sha256sum | cut -d' ' -f1)
  [ -e "$memory/$key" ] || keys[$group]=$key
done
[ ${#keys[@]} -eq 0 ] || printf '%s\n' "${!keys[@]}" | xargs -n 1 -P "$(nproc)" bash -c 'read_group "$1"' -
unclean=0
for group in "${!keys[@]}"; do
  if [ -e "$work/$group.clean" ]; then touch "$memory/${keys[$group]}"; else unclean=$((unclean + 1)); fi
done
find "$work" -name '*.out' -exec grep -hE '(warning|error): ' {} + | sed "s#$build/include/[a-z]*/##; s#$root/##" | sort -u || true
echo "clang-tidy: $(wc -l <"$work/sources") sources in $(cut -f1 "$work/groups" | sort -u | wc -l) groups," \
  "${#keys[@]} read, $unclean with findings"
[ "$unclean" -eq 0 ]
