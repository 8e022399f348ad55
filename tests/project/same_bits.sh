#!/usr/bin/env bash
# same_bits.sh: all scenarios end with their golden hashes on this processor, and when the C library, which chooses its code
# by the processor, is told that there is neither fused multiply-add nor AVX2.
set -euo pipefail
cd "$KADANS_SOURCE_DIR"
[ "$(uname -m)" = x86_64 ] || { echo "the golden hashes are those of x86_64"; exit 77; }

older_processor=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4
features() { GLIBC_TUNABLES=$1 /lib64/ld-linux-x86-64.so.2 --list-diagnostics | grep '^x86.cpu_features.features.*active'; }
if grep -qw fma /proc/cpuinfo && [ "$(features "")" = "$(features $older_processor)" ]; then
  echo "this C library does not know $older_processor"
  exit 1
fi

for tunables in "" "$older_processor"; do
  echo "GLIBC_TUNABLES=$tunables"
  GLIBC_TUNABLES=$tunables "$KADANS_BINARY_DIR/kadans" test --golden
done
