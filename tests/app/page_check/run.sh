#!/bin/sh
# run.sh FOLDER KADANS PROJECT CHECK...: runs checks of the live server and the page against the program; what they need
# of npm is installed into FOLDER, once.
set -eu
folder=$1
kadans=$2
project=$3
shift 3
here=$(cd "$(dirname "$0")" && pwd)

skip() {
  echo "skipped: $1"
  exit 77
}
command -v node >/dev/null && command -v npm >/dev/null || skip "node and npm are not installed"
case "$*" in
  *page* | *pictures* | *first_view* | *world* | *match*)
    command -v chromium >/dev/null || skip "chromium is not installed; the page was not tested"
    KADANS_CHROMIUM=${KADANS_CHROMIUM:-$(command -v chromium)}
    export KADANS_CHROMIUM
    [ -e "$project/web/dist/index.html.gz" ] || skip "the page is not built: scripts/page"
    ;;
esac

mkdir -p "$folder"
if ! cmp -s "$here/package-lock.json" "$folder/installed-lock.json"; then
  cp "$here/package.json" "$here/package-lock.json" "$folder/"
  (cd "$folder" && npm ci --no-audit --no-fund --loglevel=error)
  cp "$here/package-lock.json" "$folder/installed-lock.json"
fi
cp "$here"/*.mjs "$folder/"
for check in "$@"; do
  node "$folder/$check.mjs" "$kadans" "$project" "$folder"
done
