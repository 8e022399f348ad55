#!/usr/bin/env bash
# TULip over a network that loses, delays and doubles datagrams: `kadans plant` and `kadans run` in two network
# namespaces with netem between them. It squats through that; when the cable is cut it goes down the ladder, and the
# plant's own watchdog damps it. Exit code 77, skipped, with the reason, where the machine does not allow it.
#   KADANS_SOURCE_DIR=. KADANS_BINARY_DIR=build tests/project/network.sh
set -euo pipefail
PATH=$PATH:/usr/sbin:/sbin
skip() { echo "skipped: $1"; exit 77; }
[ "$(id -u)" -eq 0 ] || skip "network namespaces need root"
for program in ip tc python3; do
  command -v "$program" >/dev/null || skip "$program is not installed (packages iproute2 and python3)"
done
kadans=$(realpath "$KADANS_BINARY_DIR")/kadans
source=$(realpath "$KADANS_SOURCE_DIR")
work=$(mktemp -d)
here=kadans-$$-control there=kadans-$$-plant
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
ip link add kadans0 netns "$here" type veth peer name kadans1 netns "$there" 2>"$work/why" ||
  skip "no pair of network interfaces: $(cat "$work/why")"
for side in "$here kadans0 10.77.0.1" "$there kadans1 10.77.0.2"; do
  read -r space device address <<<"$side"
  ip -n "$space" address add "$address/24" dev "$device"
  ip -n "$space" link set "$device" up
done
ip -n "$there" link set lo up
# In both directions; 0.5 ms of jitter lets datagrams overtake each other.
netem() { # LOSS%
  ip netns exec "$here" tc qdisc replace dev kadans0 root netem delay 1ms 0.5ms loss "$1%" duplicate 2% &&
    ip netns exec "$there" tc qdisc replace dev kadans1 root netem delay 1ms 0.5ms loss "$1%" duplicate 2%
}
if netem 5 2>"$work/why"; then
  port=7100
  echo 0 >"$work/stall"
else
  echo "no netem in this kernel, a relay in its place: $(grep -i error "$work/why")"
  port=7200
  ip netns exec "$there" python3 "$source/tests/project/lossy_relay.py" 10.77.0.2 7100 127.0.0.1 "$port" \
    0.05 0.02 0.001 0.0005 "$work/stall" &
fi

# Bounds for a machine with other work to do: late ticks and behaviors, and a stall of some milliseconds, are not what is
# tested here.
mkdir "$work/project"
cp -r "$source"/{config,models,behaviors} "$work/project"
cd "$work/project"
python3 - <<'END'
import json
robot = json.load(open("config/tulip/robot.json"))
robot["safety"].update(silent_ticks_max=30, overruns_in_a_row_max=10000, heartbeat_timeout_s=10)
robot["plant"]["udp"] = {"peer": "10.77.0.2:7100", "round_trip_max_s": 0.05, "watchdog_s": 0.1}
json.dump(robot, open("config/tulip/robot.json", "w"), indent=2)
END
field() { python3 -c 'import json, sys
value = json.loads(open(sys.argv[1]).read().splitlines()[-1])
for key in sys.argv[2].split("."): value = value[key]
print(value)' "$1" "$2"; }
expect() { # WHAT CONDITION
  python3 -c "import sys; sys.exit(not ($2))" || { echo "wrong: $1: $2"; cat "$work"/*.err; exit 1; }
}
plant() {
  ip netns exec "$there" "$kadans" plant config/tulip/robot.json --listen ":$port" --soft --once --json \
    >"$work/plant.json" 2>"$work/plant.err" &
}
drive() {
  ip netns exec "$here" "$kadans" run config/tulip/robot.json --plant udp --soft --json "$@" \
    >"$work/run.json" 2>"$work/run.err"
}

plant
plant=$!
drive --play squat --duration 8 || true
wait "$plant"
python3 -c 'import json, sys; print(json.loads(open(sys.argv[1]).read().splitlines()[-1])["link"])' "$work/run.json"
sent=$(field "$work/run.json" link.sent)
expect "the robot was driven" "$sent > 500"
expect "datagrams were lost" "$(field "$work/run.json" link.lost) > 0.02 * $sent"
expect "datagrams came twice" "$(field "$work/run.json" link.duplicates) > 0.005 * $sent"
expect "no datagram was garbage" "$(field "$work/run.json" link.refused) == 0"
expect "the plant was driven" "$(field "$work/plant.json" link.received) > 0.9 * $sent"
# Whoever keeps the control thread or the relay from its work for long is told, and is not what is tested here.
missed=$(field "$work/run.json" threads.control.missed)
if [ "$missed" -lt 20 ] && [ "$(cat "$work/stall")" -lt 20 ]; then
  expect "the robot squatted" "$(field "$work/run.json" passed)"
else
  echo "control missed $missed ticks, the relay stood for $(cat "$work/stall") ms: too busy a machine to squat on"
fi

plant
plant=$!
drive --play squat --duration 6 &
drive=$!
sleep 3
ip -n "$here" link set kadans0 down
wait "$drive" || true
wait "$plant"
expect "the ladder was gone down" "'$(field "$work/run.json" safety_level)' == 'off'"
expect "the run says that it failed" "not $(field "$work/run.json" passed)"
expect "the sensors were silent" "$(grep -c sensor_silent "$work/run.err") > 0"
expect "the plant's watchdog took the joints" "$(field "$work/plant.json" releases) >= 1"
expect "the plant ended the session by itself" "'fell silent' in '$(field "$work/plant.json" ended)'"

ip -n "$here" link set kadans0 up
drive --duration 1 && exit 1
grep -q "does not answer within 5 s" "$work/run.err"
echo "driven through 5 % loss, went down the ladder without a cable, said that nobody answers"
