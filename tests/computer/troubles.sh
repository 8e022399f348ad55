#!/usr/bin/env bash
# A disk that is full, a network that goes and comes back, a kernel that hangs: the robot is driven on, or again.
source "$(dirname "$0")/machine.sh"

machine_new 450
machine_start
machine_answers
guest "install -d -o kadans -g kadans /var/lib/kadans/tulip/records && chown kadans:kadans /var/lib/kadans/tulip"
robot_is tulip --plant ideal --sleep-only --record /var/lib/kadans/tulip/records/
console_says "tulip is driven"
started() { guest systemctl show -P NRestarts kadans@tulip; }
ticks() { guest kadans ctl status | sed -n 's/.*tick \([0-9]*\).*/\1/p' | head -n 1; }

guest "dd if=/dev/zero of=/data/fill bs=1M status=none" 2>/dev/null && fail "the disk did not fill"
before=$(ticks)
sleep 10
[ "$(ticks)" -gt "$before" ] || fail "a full disk stops the robot"
guest kadans ctl status
[ "$(started)" = 0 ] || fail "a full disk ends the run"
guest "rm /data/fill && sync"
say "a full disk costs the record, and the robot is driven on"

monitor() {  # a command of QEMU's
  python3 -c '
import socket, sys
s = socket.socket(socket.AF_UNIX)
s.connect(sys.argv[1])
s.settimeout(5)
s.recv(4096)
s.sendall(sys.argv[2].encode() + b"\n")
s.recv(4096)' "$work/monitor" "$1"
}
before=$(ticks)
monitor "set_link net off"
sleep 15
monitor "set_link net on"
machine_answers
[ "$(ticks)" -gt "$before" ] || fail "a network that goes stops the robot"
[ "$(started)" = 0 ] || fail "a network that goes ends the run"
say "the network goes and comes back, and the robot is driven on"

: >"$console"
guest "echo 0 >/proc/sys/kernel/panic; echo 1 >/proc/sys/kernel/sysrq; (sleep 1; echo c >/proc/sysrq-trigger) >/dev/null 2>&1 &" || true
console_says "starting system"
console_says "tulip is driven"
machine_answers
guest "ls -la /var/lib/kadans/tulip/records; dmesg | grep -c -i recover" || true
say "a kernel that hangs is started again by the watchdog, and the robot is driven"
say "ok"
