#!/usr/bin/env bash
# Every C++ file is as .clang-format wants it; `clang-format -i FILE` makes it so.
set -euo pipefail
cd "$KADANS_SOURCE_DIR"

mapfile -d '' files < <(find src include plugins tests -name node_modules -prune -o -type f \( -name '*.h' -o -name '*.cpp' \) -print0)
[ ${#files[@]} -gt 0 ]
clang-format --dry-run -Werror "${files[@]}"
echo "${#files[@]} files"
