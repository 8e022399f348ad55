#!/usr/bin/env bash
# soft_apart.sh LIBRARY...: of what the memory lock leaves out of the program nothing is theirs, the layers' that the
# control thread may call, nor what that calls by a virtual function; and it is half of the program's code.
set -euo pipefail

symbols=$(nm --defined-only "$KADANS_BINARY_DIR/kadans" | sort)
address() { awk -v name="$1" '$3 == name {print $1}' <<<"$symbols"; }

for part in code constants; do
  begin=$(address "kadans_soft_${part}_begin") end=$(address "kadans_soft_${part}_end")
  echo "$part: $(((16#$end - 16#$begin) / 1024)) kB, from $begin"
  [ $((16#$begin % 4096)) = 0 ] && [ $((16#$end % 4096)) = 0 ] || { echo "not whole pages"; exit 1; }
  both=$(comm -12 <(awk -v begin="_$begin" -v end="_$end" '"_" $1 >= begin && "_" $1 < end {print $3}' <<<"$symbols" | sort -u) \
    <(nm -g --defined-only "$@" | awk 'NF == 3 && $2 ~ /[TWVRu]/ {print $3}' | sort -u))
  [ -z "$both" ] || { echo "left out, but not soft: $both"; exit 1; }
done

begin=$(address kadans_soft_code_begin) end=$(address kadans_soft_code_end)
functions=$(c++filt <<<"$symbols")
for called in ControlSide::record ControlSide::warm TruthTask::beside_tick TruthSignals::update UdpPlant::read \
  LinkedPlant::read LinkedPlant::write Recorder::record; do
  at=$(awk -v name="kadans::$called(" 'index($0, name) && !at {at = $1} END {print at}' <<<"$functions")
  [ -n "$at" ] || { echo "no $called"; exit 1; }
  [[ "$at" < "$begin" || ! "$at" < "$end" ]] || { echo "$called is left out"; exit 1; }
done

code=$((16#$(address kadans_soft_code_end) - 16#$(address kadans_soft_code_begin)))
all=$(size -A "$KADANS_BINARY_DIR/kadans" | awk '$1 == ".text" || $1 == "kadans_soft_code" {sum += $2} END {print sum}')
echo "$((100 * code / all)) % of the code"
[ $((2 * code)) -gt "$all" ] || { echo "less than half"; exit 1; }
