#!/usr/bin/env bash
# manual.sh: the manual can be built as a site, and every link in it leads somewhere. Skipped where mkdocs-material or Doxygen
# is not installed (scripts/setup package).
set -euo pipefail
cd "$KADANS_SOURCE_DIR"
for tool in mkdocs doxygen python3; do
  command -v "$tool" >/dev/null || { echo "no $tool"; exit 77; }
done
mkdocs build --help | grep -q material || { echo "no mkdocs-material"; exit 77; }
scripts/manual --program "$KADANS_BINARY_DIR/kadans" --reference "$KADANS_BINARY_DIR/reference" "$KADANS_BINARY_DIR/manual" 2>&1 | tail -n 20
