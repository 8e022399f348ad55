#!/usr/bin/env bash
# The emulated boards in a network namespace of their own, at the other end of a veth pair: mesaflash reads them there as
# it reads a real board, and kadans drives them. With --bench, a tick's CPU time against a bare sendto and recvfrom of the
# same bytes over the same pair (a program of tests/bench). Exit code 77, skipped, with the reason, where the machine does
# not allow it.
#   KADANS_SOURCE_DIR=. KADANS_BINARY_DIR=build tests/project/board_network.sh [--bench PROGRAM]
set -euo pipefail
PATH=$PATH:/usr/sbin:/sbin
skip() { echo "skipped: $1"; exit 77; }
[ "$(id -u)" -eq 0 ] || skip "network namespaces need root"
command -v ip >/dev/null || skip "ip is not installed (package iproute2)"
kadans=$(realpath "$KADANS_BINARY_DIR")/kadans
cd "$KADANS_SOURCE_DIR"
work=$(mktemp -d)
here=kadans-$$-host there=kadans-$$-board
finish() {
  for pid in $(jobs -p); do kill "$pid" 2>/dev/null || true; done
  wait || true
  ip netns del "$here" 2>/dev/null || true
  ip netns del "$there" 2>/dev/null || true
  rm -rf "$work"
}
trap finish EXIT
ip netns add "$here" 2>"$work/why" || skip "no network namespaces: $(cat "$work/why")"
ip netns add "$there" 2>"$work/why" || skip "no network namespaces: $(cat "$work/why")"
ip link add board0 netns "$here" type veth peer name board1 netns "$there" 2>"$work/why" ||
  skip "no pair of network interfaces: $(cat "$work/why")"
for side in "$here board0 192.168.1.1" "$there board1 192.168.1.121"; do
  read -r space device address <<<"$side"
  ip -n "$space" address add "$address/24" dev "$device"
  ip -n "$space" link set "$device" up
  ip -n "$space" link set lo up
done

if [ "${1:-}" = --bench ]; then
  KADANS_BENCH_NETNS=$there KADANS_BENCH_BOARD=192.168.1.121 ip netns exec "$here" "$2" --only bus
  exit
fi

# What is tried here is the wire, not how busy this machine is: board and master run before anything else where that is
# allowed, and the robot waits as long as a machine may stand still.
first=; chrt -f 20 true 2>/dev/null && first="chrt -f 20"
mkdir "$work/jiwiy"
robot=$work/jiwiy/patient.json
cat >"$robot" <<ROBOT
{ "based_on": "$PWD/config/jiwiy/anything_io.json", "name": "jiwiy",
  "plant": { "hm2-eth": { "watchdog_s": 1 } },
  "safety": { "silent_ticks_max": 10000, "drives": { "sample_age_max_s": 10 } } }
ROBOT
ip netns exec "$there" $first "$kadans" plant "$robot" --as hm2-eth --listen 192.168.1.121 --soft \
  >"$work/plant" 2>&1 &
for _ in $(seq 100); do
  grep -q serves "$work/plant" && break
  sleep 0.1
done
grep -q serves "$work/plant" || { cat "$work/plant"; exit 1; }
if command -v mesaflash >/dev/null; then
  ip netns exec "$here" timeout 60 $first mesaflash --device 7I96 --addr 192.168.1.121 --readhmid >"$work/read" 2>&1 ||
    { echo "mesaflash ends with $?"; cat "$work/read"; exit 1; }
  for part in "BoardName : MESA7I96" "There are 1 of WatchDog" "There are 2 of QCount" "There are 2 of PWM"; do
    grep -q "$part" "$work/read" || { echo "mesaflash does not say '$part'"; cat "$work/read"; exit 1; }
  done
  echo "mesaflash reads the boards over veth"
else
  echo "mesaflash is not installed"
fi
ip netns exec "$here" $first "$kadans" run "$robot" --plant hm2-eth --soft --no-ctl --play sine --duration 3 \
  --json >"$work/run" 2>"$work/why" || true
received=$(grep -o '"received": *[0-9]*' "$work/run" | grep -o '[0-9]*$' || echo 0)
[ "$received" -gt 1000 ] || { echo "the boards answered $received times in 3 s"; cat "$work/run" "$work/why"; exit 1; }
echo "kadans had $received answers of the boards over veth in 3 s"

# With the interface down, or without its cable, nothing begins, and the card is named at the board's line.
refused() {  # WORDS
  ! ip netns exec "$here" "$kadans" run config/jiwiy/anything_io.json --plant hm2-eth --soft --no-ctl >"$work/run" 2>"$work/why" ||
    { echo "it drives boards that it cannot reach"; exit 1; }
  grep -q "anything_io.json:[0-9]*:[0-9]*: board 'io'.*$1" "$work/why" || { echo "it does not say '$1'"; cat "$work/why"; exit 1; }
}
ip -n "$there" link set board1 down
refused "board0 (192.168.1.1) has no cable in, or nothing is powered at its other end: plug the cable in"
ip -n "$here" link set board0 down
refused "board0 (192.168.1.1) is down: sudo ip link set board0 up"
echo "an interface that is down is named"
