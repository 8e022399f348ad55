#!/usr/bin/env bash
# contract_table.sh TEST_PROGRAM FILE: whether FILE is the table of the tests. They are not run: each is a test of its own.
# With --write as third argument they are run, and FILE is renewed when all pass.
set -euo pipefail
made=$(mktemp)
trap 'rm -f "$made"' EXIT
"$1" --test-suite=contract --list-test-cases --reporters=contract_table --no-version >"$made"
if [ "${3:-}" = --write ]; then
  "$1" --test-suite=contract --minimal
  cp "$made" "$2"
fi
if ! diff -u "$2" "$made"; then
  echo "docs/failures.md is not the table of the tests: run scripts/failures" >&2
  exit 1
fi
