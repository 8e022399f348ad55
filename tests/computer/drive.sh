#!/usr/bin/env bash
# The runtime in the machine drives TULip, which `kadans plant` serves on this one, with the machine's time: TULip squats, is
# watched from here by ctl and the page's server, gets a behavior that was changed, and leaves a record that is read here.
source "$(dirname "$0")/machine.sh"

served=$((30000 + RANDOM % 10000))
"$kadans" plant config/tulip/robot.json --listen "127.0.0.1:$served" --in-step --soft >"$work/plant" 2>&1 &
plant=$!
trap 'kill $plant 2>/dev/null; clean_up' EXIT

# Late ticks and late answers are the emulation's: here they are counted, but nothing is made of them.
project=$work/project
mkdir "$project"
cp -r config behaviors models "$project/"
robot_json=$project/config/tulip/robot.json
edit "$robot_json" 's/("overruns_in_a_row_max": )[0-9]+/\110000/' 's/("heartbeat_timeout_s": )[0-9.]+/\15/' \
  's/("silent_ticks_max": )[0-9]+/\11000/' 's/^( *)"plant": \{/&\n\1  "udp": { "round_trip_max_s": 1, "connect_timeout_s": 60 },/'

machine_new 600
machine_start -icount shift=1  # its time is that of its instructions, 500 million a second
machine_answers
guest "mkdir -p /run/systemd/system/kadans@.service.d && cat >/run/systemd/system/kadans@.service.d/slow.conf && systemctl daemon-reload" <<END
[Service]
WatchdogSec=60
END
guest "install -d -o kadans -g kadans /var/lib/kadans/tulip/records && chown -R kadans:kadans /var/lib/kadans/tulip"
(cd "$project" && "$kadans" push robot config/tulip/robot.json >/dev/null) || fail "push does not work"
robot_is tulip --plant udp --peer "10.0.2.2:$served" --play squat --sleep-only --live --live-address 0.0.0.0 \
  --record /var/lib/kadans/tulip/records/ --records-max 40
console_says "tulip is driven"

of() { "$kadans" ctl --host robot "$@" 2>&1; }
of status || fail "ctl does not answer"
plays() { of status | grep -q "plays .*$1"; }
within 300 plays "squat in squat" || { of status; fail "TULip does not squat"; }
within 900 plays "squat: done" || { of status; fail "the squat does not end well"; }
of status
say "TULip has squatted three times"
page=$(curl -s -m 30 -o /dev/null -w '%{http_code}' "http://127.0.0.1:$live/") || true
[ "$page" = 200 ] || fail "the page does not come: $page"

# Another depth, pushed while it squats again: it counts from then on.
of play squat || fail "nothing is played"
edit "$project/behaviors/tulip/squat.lua" 's/(depth_m +=.*)0\.10/\10.05/'
(cd "$project" && "$kadans" push robot config/tulip/robot.json) >"$work/said" || fail "push does not work: $(cat "$work/said")"
cat "$work/said"
grep -q "reload" "$work/said" || fail "what plays is not reloaded"
guest systemctl show -P NRestarts kadans@tulip | grep -qx 0 || fail "the runtime was restarted"
guest systemctl stop kadans@tulip
scp -q -F "$work/ssh_config" 'robot:/var/lib/kadans/tulip/records/*.mcap' "$work/" || fail "no record"
"$kadans" log info "$(ls "$work"/*.mcap | head -n 1)" | head -n 12
cat "$work/plant"
say "ok"
