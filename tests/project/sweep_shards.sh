#!/usr/bin/env bash
# A randomised push in four parts, in an order of chance, merges to the same tables, byte for byte, as one process makes.
# 24 runs, 1,000 when KADANS_SOAK is set. Prints the runs a second with one job and with two.
#   KADANS_SOURCE_DIR=. KADANS_BINARY_DIR=build tests/project/sweep_shards.sh
set -euo pipefail
cases=24
[ -z "${KADANS_SOAK:-}" ] || cases=1000
kadans=$(realpath "$KADANS_BINARY_DIR")/kadans
work=$(mktemp -d "$(realpath "$KADANS_BINARY_DIR")/sweep.XXXXXX")
trap 'rm -rf "$work"' EXIT
cd "$KADANS_SOURCE_DIR"
sweep() { { "$kadans" sweep config/sweeps/push_varied.json --cases "$cases" --json "$@" || [ $? -eq 1 ]; } | tail -1; }

began=$(date +%s%N)
sweep --jobs 1 --out "$work/whole"
ended=$(date +%s%N)
for part in $(shuf -i 0-3); do sweep --jobs 2 --shard "$part/4" --out "$work/part$part"; done
echo "$cases runs with one job and with two:" "$(awk "BEGIN { t = $ended - $began; u = $(date +%s%N) - $ended
  printf \"%.2f and %.2f a second, ratio %.2f\", $cases * 1e9 / t, $cases * 1e9 / u, t / u }")"

tables() { "$kadans" merge "${@:2}" --csv "$work/$1.csv" --sqlite "$work/$1.db" --heat-map "$work/$1.svg" >"$work/$1.txt" || [ $? -eq 1 ]; }
tables one "$work/whole"
tables four $(shuf -e "$work"/part?)
for kind in csv db svg txt; do
  cmp "$work/one.$kind" "$work/four.$kind"
  sha256sum <"$work/one.$kind" | sed "s/-/$kind/"
done
sed -n 2,6p "$work/one.txt"
