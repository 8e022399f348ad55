#!/usr/bin/env bash
# contract_table.sh TEST_PROGRAM FILE: whether FILE is the table that the tests make, and all of them passed.
# With --write as third argument FILE is renewed first.
set -euo pipefail
made=$(mktemp)
trap 'rm -f "$made"' EXIT
"$1" --test-suite=contract --reporters=contract_table --no-version >"$made" || true
[ "${3:-}" = --write ] && cp "$made" "$2"
if ! diff -u "$2" "$made"; then
  echo "docs/failures.md is not what the tests say: run scripts/failures" >&2
  exit 1
fi
! grep -q '| FAILED |$' "$made"
