#!/usr/bin/env bash
# Updates of the system, with a clock that is ten years late: damaged and foreign ones change nothing that counts, a good one
# is kept after its trial, one that cannot start falls back by itself, and so does one that hangs.
source "$(dirname "$0")/machine.sh"

bundle=$images/kadans.raucb
running() { guest "sed -n 's/.*rauc.slot=\([AB]\).*/\1/p' /proc/cmdline"; }
slot_sum() { guest "sha256sum /dev/disk/by-partuuid/*-0$1" | cut -d' ' -f1; }
send() { scp -q -F "$work/ssh_config" "$1" robot:/data/update.raucb; }
reboot() {
  : >"$console"
  guest systemctl reboot 2>/dev/null || true
  console_says "$1"
  machine_answers
}

machine_new 1000
machine_start -rtc base=2016-01-01,clock=vm
machine_answers
[ "$(running)" = A ] || fail "it does not run A"
before=$(slot_sum 3)

# Signed by somebody else.
openssl req -x509 -newkey rsa:3072 -nodes -sha256 -days 36500 -subj "/CN=Somebody" -keyout "$work/key" -out "$work/pem" 2>/dev/null
mkdir "$work/content"
rauc --keyring="$images/update.pem" extract "$bundle" "$work/content/of" >/dev/null 2>&1 || fail "the bundle cannot be read"
rauc --cert="$work/pem" --key="$work/key" bundle "$work/content/of" "$work/foreign.raucb" >/dev/null 2>&1 || fail "no foreign bundle"
send "$work/foreign.raucb"
guest rauc install /data/update.raucb >"$work/said" 2>&1 && fail "a foreign update is taken"
grep -q "signature" "$work/said" || fail "a foreign update is refused with: $(cat "$work/said")"
[ "$(slot_sum 3)" = "$before" ] || fail "a foreign update has changed the other system"
say "a foreign update is refused, nothing is written"

# Damaged in its middle.
cp "$bundle" "$work/damaged.raucb"
printf 'damage' | dd of="$work/damaged.raucb" bs=1 seek=$(($(stat -c %s "$bundle") / 2)) conv=notrunc status=none
send "$work/damaged.raucb"
guest rauc install /data/update.raucb >"$work/said" 2>&1 && fail "a damaged update is taken"
[ "$(guest /usr/lib/kadans-computer/slots get-primary)" = A ] || fail "a damaged update is started next"
say "a damaged update is refused, the running system stays the one that is started"

# A good one.
send "$bundle"
guest rauc install /data/update.raucb >"$work/said" 2>&1 || fail "a good update is refused: $(cat "$work/said")"
reboot "on trial"
[ "$(running)" = B ] || fail "the update is not started"
console_says "this system is kept" 300
[ "$(guest /usr/lib/kadans-computer/slots get-primary)" = B ] || fail "the update is not kept"
say "a good update is kept after its trial"

# One whose kernel is none, and one that hangs before it is well. Either is the other slot, A, changed by hand.
unsquashfs -q -n -d "$work/root" "$images/root.squashfs" >/dev/null
pack() {
  mkdir -p "$work/bad"
  cp "$work/content/of/manifest.raucm" "$work/bad/"
  sed -i '/^sha256\|^size\|verity-\(hash\|salt\|size\)/d' "$work/bad/manifest.raucm"
  rm -f "$work/bad/root.img" "$work/bad.raucb"
  mksquashfs "$work/root" "$work/bad/root.img" -quiet -no-progress -comp gzip -noappend >/dev/null
  rauc --cert="$images/update.pem" --key="$images/update.key" bundle "$work/bad" "$work/bad.raucb" >/dev/null 2>&1 || fail "no bundle"
  send "$work/bad.raucb"
  guest rauc install /data/update.raucb >"$work/said" 2>&1 || fail "the update is refused: $(cat "$work/said")"
}
mv "$work/root/vmlinuz" "$work/vmlinuz"
pack
reboot "waits for a robot"
[ "$(running)" = B ] || fail "a system without a kernel does not fall back"
say "an update without a kernel falls back"

mv "$work/vmlinuz" "$work/root/vmlinuz"
cat >"$work/root/usr/lib/systemd/system/hang.service" <<'END'
[Service]
ExecStart=/bin/sh -c 'echo 1 >/proc/sys/kernel/sysrq; echo 0 >/proc/sys/kernel/panic; echo c >/proc/sysrq-trigger'
END
ln -sf ../hang.service "$work/root/usr/lib/systemd/system/multi-user.target.wants/hang.service"
pack
reboot "waits for a robot"
[ "$(running)" = B ] || fail "a system whose kernel hangs does not fall back"
say "an update whose kernel hangs falls back by the watchdog"
say "ok"
