#!/usr/bin/env bash
# same_state.sh SCENARIO: three seconds of it end with the same state_hash in the release and the clang build, and two
# scenarios of the suite end with their golden hashes there; in the sanitizer build too where its program was built. Only
# scripts/soak builds these programs.
set -euo pipefail
scenario="$KADANS_SOURCE_DIR/$1"
[ -n "${KADANS_SOAK:-}" ] || { echo "scripts/soak builds the programs"; exit 77; }

hash_of() {
  { "$1" sim "$scenario" --duration 3 --json --no-record || true; } | sed -n 's/.*"state_hash": *"\([0-9a-fx]*\)".*/\1/p'
}

expected=$(hash_of "$KADANS_BINARY_DIR/kadans")
echo "gcc: $expected"
[ -n "$expected" ]
variants=(clang)
[ ! -e "$KADANS_BINARY_DIR/asan/kadans" ] || variants+=(asan)
for variant in "${variants[@]}"; do
  found=$(hash_of "$KADANS_BINARY_DIR/$variant/kadans")
  echo "$variant: $found"
  [ "$found" = "$expected" ]
done
cd "$KADANS_SOURCE_DIR"
for variant in "${variants[@]}"; do
  "$KADANS_BINARY_DIR/$variant/kadans" test --golden push_left ticks_missed
done
