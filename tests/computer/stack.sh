#!/usr/bin/env bash
# The model on the robot's own computer, as in 2008, as far as another machine can show it: the system of the image on one
# CPU of this one and in 256 MB, on the wall clock. TULip squats in Bullet, with a record, `kadans ctl` and a client of the
# page, and in turns without the three. The ticks that it misses with them are no more than without.
#   stack.sh [MINUTES]    with and without, each (default: 10). Needs root, and the rights of real time
source "$(dirname "$0")/machine.sh"

minutes=${1:-10} turns=5 cpu=$(($(nproc) - 1)) memory_MB=256
[ "$(id -u)" = 0 ] || skip "chroot needs root"
command -v unsquashfs >/dev/null || skip "no unsquashfs: scripts/setup image"
[ "$arch" = i386 ] || [ "$arch" = "$(dpkg --print-architecture)" ] || skip "this machine does not run programs of $arch"
turn_s=$(awk -v m="$minutes" -v t=$turns 'BEGIN {printf "%d", m * 60 / t}')

root=$work/root
unsquashfs -q -n -d "$root" "$images/root.squashfs" >/dev/null
# This machine's own stalls (20 ms were seen where it is a guest) are counted as missed ticks, in both kinds of turn, but do
# not take the torque from the robot.
robot_json=$root/usr/share/kadans/config/tulip/robot.json
cp "$robot_json" "$work/robot.json"
sed -i -E 's/("overruns_in_a_row_max": )[0-9]+/\110000/; s/("heartbeat_timeout_s": )[0-9.]+/\15/' "$robot_json"
[ "$(diff "$work/robot.json" "$robot_json" | grep -c '^>')" = 2 ] || fail "$robot_json has changed: mend this trial"
# A group of processes with a bound of memory, of whichever version of cgroups is here.
group=/sys/fs/cgroup/memory/kadans_stack bound=memory.limit_in_bytes peak=memory.max_usage_in_bytes
[ -d /sys/fs/cgroup/memory ] || group=/sys/fs/cgroup/kadans_stack bound=memory.max peak=memory.peak
mkdir -p "$group"
echo $((memory_MB << 20)) >"$group/$bound"
trap 'rmdir "$group" 2>/dev/null || true; clean_up' EXIT

# small COMMAND...: on the one CPU, in the bound of memory, in the image's system.
small() {
  (
    echo $BASHPID >"$group/cgroup.procs"
    exec taskset -c "$cpu" unshare --mount --propagation private bash -c '
      mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && mount -t tmpfs tmpfs "$0/run" && mkdir -p "$0/tmp/ctl"
      exec setarch linux32 chroot "$0" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 "$@"' "$root" "$@"
  )
}
run() {
  small kadans run /usr/share/kadans/config/tulip/robot.json --play "squat { repeats = 100 }" --sleep-only --cpu "$cpu" \
    --duration "$turn_s" --json "$@" 2>"$work/said"
}
served() { (exec 3<>"/dev/tcp/127.0.0.1/$live") 2>/dev/null; }
# watched N: as operators do, with `kadans ctl` once a second; the page's client is elsewhere.
watched() {
  local runner clients
  run --ctl /tmp/ctl --live="$live" --record "/tmp/$1.mcap" >"$work/watched.$1" &
  runner=$!
  within 30 served || fail "the page is not served: $(cat "$work/said")"
  python3 tests/computer/page_client.py "$live" >"$work/page.$1" 2>&1 &
  clients=$!
  while kill -0 $runner 2>/dev/null; do
    small kadans ctl --socket /tmp/ctl status >"$work/status" 2>&1 || true
    sleep 1
  done
  wait $runner || fail "the run does not end well: $(tail -n 3 "$work/said")"
  wait $clients || fail "the page's client ends badly: $(cat "$work/page.$1")"
  "$kadans" log info "$root/tmp/$1.mcap" >"$work/record" || fail "the record cannot be read"
  rm "$root/tmp/$1.mcap"
}
alone() { run --no-ctl >"$work/alone.$1" || fail "the run does not end well: $(tail -n 3 "$work/said")"; }

for ((turn = 1; turn <= turns; ++turn)); do
  alone $turn
  watched $turn
done
python3 - "$work" $turns <<'END'
import json, sys
work, turns = sys.argv[1], int(sys.argv[2])
missed = {}
for kind in ("alone", "watched"):
    runs = [json.load(open(f"{work}/{kind}.{turn}")) for turn in range(1, turns + 1)]
    control, behaviors = [run["threads"]["control"] for run in runs], [run["threads"]["behaviors"] for run in runs]
    add = lambda threads, name: sum(thread[name] for thread in threads)
    missed[kind] = add(control, "missed")
    print(f"stack: {kind}: {add(control, 'beats')} ticks, missed {missed[kind]}, over their time {add(control, 'overruns')}; "
          f"behaviors missed {add(behaviors, 'missed')} of {add(behaviors, 'beats')}; at most {max(run['resident_MB'] for run in runs):.1f} MB; "
          f"control thread {100e3 * add(control, 'cpu_s') / add(control, 'beats'):.1f} % of the CPU; "
          f"passed {sum(run['passed'] for run in runs)} of {turns}")
sys.exit(missed["watched"] > missed["alone"] and "failed: more ticks are missed with record, ctl and page than without")
END
say "the page's client read, each time: $(head -n 1 "$work/page.1")"
say "at most $(($(cat "$group/$peak") >> 20)) MB of $memory_MB MB in all, with what the kernel keeps of files"
say "ok"
