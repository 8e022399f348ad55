# A robot's computer in QEMU, for the trials beside this file. A trial sources it and calls:
#   machine_new [MiB]        a card with the image on it, on which the trial works
#   machine_start [option..] the power comes; further options are QEMU's
#   machine_off              the power goes, at once
#   console_says PATTERN [S] waits until the console has said it since the power came
#   guest COMMAND...         as root in it, over ssh
#   fail WORDS               ends the trial, with the end of the console
# The machine is emulated, because a hypervisor may be one that runs no 32-bit kernel: one CPU like the VIA's (SSE3, no
# SSE4, no AVX), 256 MB. KADANS_IMAGE is the folder that scripts/image has made (default: build/image/i386).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

images=$(realpath "${KADANS_IMAGE:-build/image/i386}" 2>/dev/null || true)
arch=$(basename "$images")
kadans=$PWD/build/kadans
emulator=qemu-system-i386 cpu=coreduo uefi=/usr/share/ovmf/OVMF.fd
[ "$arch" != amd64 ] || emulator=qemu-system-x86_64 cpu=Penryn

skip() {
  echo "skipped: $*"
  exit 77
}
command -v $emulator >/dev/null || skip "no $emulator: scripts/setup image"
[ "$arch" != amd64 ] || [ -e $uefi ] || skip "no $uefi: scripts/setup image"
[ -e "$images/kadans.img" ] || skip "no image in ${images:-build/image/i386}: scripts/image $arch"

work=$(mktemp -d)
card=$work/card.img console=$work/console machine="" port=$((20000 + RANDOM % 20000)) live=$((40000 + RANDOM % 20000))

say() { echo "$(basename "$0" .sh): $*"; }
fail() {
  echo "failed: $*" >&2
  [ ! -e "$console" ] || tail -n 25 "$console" | tr -d '\r' | sed 's/^/  console: /' >&2
  exit 1
}
# edit FILE SUBSTITUTION...: each changes something in the file.
edit() {
  local file=$1 one
  shift
  for one in "$@"; do
    cp "$file" "$work/before"
    sed -i -E "$one" "$file"
    ! cmp -s "$work/before" "$file" || fail "$file has no '$one' any more: mend this trial"
  done
}
machine_off() {
  [ -z "$machine" ] || { kill -9 "$machine" && wait "$machine" || true; } 2>/dev/null
  machine=""
}
clean_up() {
  machine_off
  rm -rf "$work"
}
trap clean_up EXIT

machine_new() {
  cp --sparse=always "$images/kadans.img" "$card"
  truncate -s "${1:-400}M" "$card"
}

# disk: where the machine writes; a trial may put something in between.
disk=(-drive "if=ide,format=raw,cache=unsafe,file=$card")
machine_start() {
  : >"$console"
  began=$(date +%s%N)
  $emulator -accel tcg -cpu $cpu -m 256 -smp 1 -display none -serial "file:$console" -monitor "unix:$work/monitor,server,nowait" \
    "${disk[@]}" -nic "user,id=net,model=e1000,hostfwd=tcp:127.0.0.1:$port-:22,hostfwd=tcp:127.0.0.1:$live-:8765" \
    -device i6300esb "$@" 2>"$work/qemu" &
  machine=$!
}

since() { echo $((($(date +%s%N) - began) / 1000000000)); }
# within S COMMAND...: until it succeeds.
within() {
  local until=$((SECONDS + $1))
  shift
  until "$@"; do
    [ $SECONDS -lt $until ] || return 1
    [ -z "$machine" ] || kill -0 "$machine" 2>/dev/null || fail "the machine has ended: $(cat "$work/qemu")"
    sleep 0.5
  done
}
console_has() { grep -a -q -e "$1" "$console"; }
console_says() { within "${2:-400}" console_has "$1" || fail "the console does not say '$1'"; }

# How ssh reaches the machine.
cat >"$work/ssh_config" <<END
Host robot
  HostName 127.0.0.1
  Port $port
  User root
  IdentityFile $images/login
  StrictHostKeyChecking no
  UserKnownHostsFile /dev/null
  LogLevel ERROR
  ConnectTimeout 120
  ServerAliveInterval 20
END
mkdir "$work/bin"
printf '#!/bin/sh\nexec %s -F %s "$@"\n' "$(command -v ssh)" "$work/ssh_config" >"$work/bin/ssh"
chmod +x "$work/bin/ssh"
export PATH=$work/bin:$PATH  # so `kadans ctl --host robot` finds the machine, too
guest() { ssh robot "$@"; }
answers() { guest true 2>/dev/null; }
machine_answers() { within "${1:-300}" answers || fail "no answer over ssh"; }

# robot_is NAME OPTION...: names the robot and says how it is run; robot_environment has further variables of that run.
robot_environment=""
robot_is() {
  printf '%s\n' "KADANS_OPTIONS='${*:2}'" $robot_environment |
    guest "mkdir -p /data/etc/kadans/$1 && cat >/data/etc/kadans/$1/run.conf && sync && echo $1 >/data/robot.new &&
      sync /data/robot.new && mv /data/robot.new /data/robot && sync /data"
}
state_of() { guest "systemctl show -P ActiveState kadans@$1"; }
