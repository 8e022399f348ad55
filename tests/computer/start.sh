#!/usr/bin/env bash
# The image starts, waits for a robot, and drives the one that it is told about, also after the next power-on. Memory and
# times are printed.
source "$(dirname "$0")/machine.sh"

used_MB() { guest free -m | awk '/^Mem:/ {print $3}'; }

machine_new 600
machine_start
console_says "waits for a robot"
say "it waits for a robot $(since) s after power-on"
machine_answers
console_has "has grown by" || fail "the data partition has not grown"
failed=$(guest systemctl --failed --no-legend --plain)
[ -z "$failed" ] || fail "units that failed: $failed"
idle=$(used_MB)
guest findmnt -n -o OPTIONS / | grep -q "upperdir" || fail "the root is not an overlay in memory"
[ "$(guest uname -v | grep -c PREEMPT_RT)" = 1 ] || fail "the kernel is not PREEMPT_RT"
guest "ssh -o BatchMode=yes -o StrictHostKeyChecking=no -o PreferredAuthentications=password root@localhost true" 2>/dev/null &&
  fail "a password lets in"

say "kadans doctor there:"
guest kadans doctor || true

# Lights and beeps: here they write down what they are told.
guest 'mkdir -p /data/hooks && cd /data/hooks && for name in ready stopped level; do
  printf "#!/bin/sh\necho %s \"\$@\" >>/data/told\n" $name >$name; chmod +x $name; done'
told() { guest "grep -q '$1' /data/told" 2>/dev/null; }

robot_is tulip --plant ideal --sleep-only --live --live-address 0.0.0.0
console_says "tulip is driven"
driven=$(used_MB)
say "$idle MB of memory are in use without a robot, $driven MB with the runtime idle"
# A PC-104 has 256 MB; programs of 64 bits take more, on computers that have more.
most=90
[ "$arch" != amd64 ] || most=100
[ "$driven" -lt $most ] || fail "the runtime takes more than $most MB"
within 60 told "ready tulip" || fail "the hook 'ready' is not run"
guest kadans ctl estop >/dev/null || fail "no emergency stop"
within 60 told "level off tulip" || fail "the hook 'level' is not told of an emergency stop: $(guest cat /data/told)"
guest systemctl restart kadans@tulip
within 60 told "stopped tulip" || fail "the hook 'stopped' is not run"
say "the hooks were told: $(guest cat /data/told | tr '\n' ',')"

guest sync
machine_off
# A mini PC may start by UEFI alone: so does the second power-on of amd64, with memory for such a firmware.
firmware=()
[ "$arch" != amd64 ] || firmware=(-bios "$uefi" -m 1024)
machine_start "${firmware[@]}"
console_says "tulip is driven"
all=$(since)
machine_answers
[ "$arch" != amd64 ] || guest test -d /sys/firmware/efi || fail "it was not started by UEFI"
within 60 eval '[ "$(state_of tulip)" = active ]' || fail "the robot is not driven"
ticked=$(guest systemctl show -P ActiveEnterTimestampMonotonic kadans@tulip)
say "the first tick comes $((ticked / 1000000)) s after the kernel's start, $all s after power-on"
"$kadans" ctl --host robot status || fail "ctl --host does not work"
[ "$(guest systemctl show -P NRestarts kadans@tulip)" = 0 ] || fail "the runtime was restarted"
say "ok"
