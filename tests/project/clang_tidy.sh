#!/usr/bin/env bash
# Every source file, and the headers it includes, under .clang-tidy: in scripts/soak, which sets KADANS_SOAK. Without it
# the test is skipped. A file that passed is looked at again only when it, one of our headers that it includes, or the
# settings changed: the key of each pass is a file in the build folder.
set -euo pipefail
build="$KADANS_BINARY_DIR/clang"
passed="$KADANS_BINARY_DIR/clang-tidy"
[ -n "${KADANS_SOAK:-}" ] || exit 77
mkdir -p "$passed"

# "object source-or-header" of every object, as ninja found them when it built.
dependencies() {
  ninja -C "$build" -t deps | awk -v root="$KADANS_SOURCE_DIR/" '
    /^[^ ]/ { object = $1; sub(/:$/, "", object) }
    /^ / && index($1, root) == 1 && index($1, root "build") != 1 { print object, $1 }'
}

# "source key" of every source file.
keys() {
  dependencies >"$passed/.dependencies"
  awk '{ print $2 }' "$passed/.dependencies" | sort -u | xargs sha256sum >"$passed/.sums"
  local settings
  settings=$(cat "$KADANS_SOURCE_DIR"/.clang-tidy "$KADANS_SOURCE_DIR"/*/.clang-tidy <(clang-tidy --version) | sha256sum)
  awk -v settings="${settings%% *}" '
    FNR == NR { sum[$2] = $1; next }
    { digest[$1] = digest[$1] " " sum[$2] }
    $2 ~ /\.cpp$/ { source[$1] = $2 }
    END { for (object in source) print source[object], settings digest[object] }
  ' "$passed/.sums" "$passed/.dependencies"
}

check() {
  local key
  key=$(printf '%s' "$2" | sha256sum)
  [ -e "$passed/${key%% *}" ] && return 0
  if output=$(clang-tidy -p "$build" --quiet "$1" 2>/dev/null); then
    : >"$passed/${key%% *}"
    echo "checked ${1#"$KADANS_SOURCE_DIR"/}"
  else
    printf '%s\n' "$output"
    return 1
  fi
}
export -f check
export build passed

keys | sort >"$passed/.keys"
[ -s "$passed/.keys" ] || { echo "no file found; was $build built?"; exit 1; }
xargs -P "$(nproc)" -d '\n' -n 1 bash -c 'check "${1%% *}" "${1#* }"' check <"$passed/.keys"
echo "$(wc -l <"$passed/.keys") files pass"
