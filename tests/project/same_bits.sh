#!/usr/bin/env bash
# same_bits.sh: all scenarios end with their golden hashes when the C library, which chooses its code by the processor, is
# told that there is neither fused multiply-add nor AVX2. That they do on this processor as it is, app_test shows.
set -euo pipefail
cd "$KADANS_SOURCE_DIR"
[ "$(uname -m)" = x86_64 ] || { echo "the golden hashes are those of x86_64"; exit 77; }

older_processor=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4
features() { GLIBC_TUNABLES=$1 /lib64/ld-linux-x86-64.so.2 --list-diagnostics | grep '^x86.cpu_features.features.*active'; }
if grep -qw fma /proc/cpuinfo && [ "$(features "")" = "$(features $older_processor)" ]; then
  echo "this C library does not know $older_processor"
  exit 1
fi

GLIBC_TUNABLES=$older_processor "$KADANS_BINARY_DIR/kadans" test --golden
