#!/bin/sh
# run.sh FOLDER SAMPLE CUT: SAMPLE writes a record, CUT cuts it, readers from npm check both; they are installed into
# FOLDER, once.
set -eu
folder=$1
sample=$2
cut=$3
here=$(cd "$(dirname "$0")" && pwd)

if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
  echo "skipped: node and npm are not installed; records were not checked against the readers of @mcap/core"
  exit 77
fi

mkdir -p "$folder"
if ! cmp -s "$here/package-lock.json" "$folder/installed-lock.json"; then
  cp "$here/package.json" "$here/package-lock.json" "$folder/"
  (cd "$folder" && npm ci --no-audit --no-fund --loglevel=error)
  cp "$here/package-lock.json" "$folder/installed-lock.json"
fi
cp "$here/check.mjs" "$here/cut.mjs" "$folder/"
"$sample" "$folder/sample.mcap"
"$sample" "$folder/again.mcap"
cmp "$folder/sample.mcap" "$folder/again.mcap"
node "$folder/check.mjs" "$folder/sample.mcap"
"$cut" "$folder/sample.mcap" "$folder/cut.mcap"
node "$folder/cut.mjs" "$folder/sample.mcap" "$folder/cut.mcap"
