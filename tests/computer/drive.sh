#!/usr/bin/env bash
# The runtime in the machine drives TULip, which `kadans plant` serves on this one, with the machine's time: TULip squats, is
# watched from here by ctl and the page's server, gets a behavior that was changed, and leaves a record that is read here.
source "$(dirname "$0")/machine.sh"

served=$((30000 + RANDOM % 10000))
"$kadans" plant config/tulip/robot.json --listen "127.0.0.1:$served" --in-step --soft >"$work/plant" 2>&1 &
plant=$!
trap 'kill $plant 2>/dev/null; clean_up' EXIT

machine_new 600
machine_start -icount shift=1
machine_answers
robot_is tulip --plant udp --peer "10.0.2.2:$served" --play squat --sleep-only --live --live-address 0.0.0.0 \
  --record /var/lib/kadans/tulip/records/ --records-max 40
guest "install -d -o kadans -g kadans /var/lib/kadans/tulip/records"
console_says "tulip is driven"

value() { "$kadans" ctl --host robot get "$1" | awk '{print $2}'; }
of() { "$kadans" ctl --host robot "$@" 2>&1; }
of status || fail "ctl does not answer"
squats() { of status | grep -q 'squat/down\|squat.*down'; }
within 120 squats || { of status; fail "TULip does not squat"; }
say "TULip squats"
page=$(curl -s -m 30 -o /dev/null -w '%{http_code}' "http://127.0.0.1:$live/") || true
[ "$page" = 200 ] || fail "the page does not come: $page"

# Another depth, pushed: what plays counts from then on.
project=$work/project
mkdir -p "$project"
cp -r config behaviors models "$project/"
sed -i 's/depth_m = [0-9.]*/depth_m = 0.05/' "$project"/behaviors/tulip/squat.lua
(cd "$project" && "$kadans" push robot config/tulip/robot.json) || fail "push does not work"
of status
guest systemctl show -P NRestarts kadans@tulip | grep -qx 0 || fail "the runtime was restarted"
guest systemctl stop kadans@tulip
scp -q -F "$work/ssh_config" 'robot:/var/lib/kadans/tulip/records/*.mcap' "$work/" || fail "no record"
for record in "$work"/*.mcap; do "$kadans" log info "$record" | head -n 20; done
cat "$work/plant"
say "ok"
