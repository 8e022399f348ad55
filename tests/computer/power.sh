#!/usr/bin/env bash
# The power goes at random moments of a life: first start, a robot's first run, a record, a push, an update, the run after it.
# What was not flushed is lost. The card must be sound, its record must reach to the last second, and it must boot.
#   power.sh [CUTS] [SEED] [--no-boot] [--only-without]    (default: 50 1) --no-boot only looks at the cards
# Then the same life without fsync, which must fail: the power goes whenever the record had been seen to grow.
# --only-without does nothing else.
source "$(dirname "$0")/machine.sh"

cuts=50 seed=1 boots=yes with=yes
numbers=()
for word in "$@"; do
  case $word in
    --no-boot) boots=no ;;
    --only-without) with=no ;;
    *) numbers+=("$word") ;;
  esac
done
cuts=${numbers[0]:-$cuts} seed=${numbers[1]:-$seed}
slack_s=4  # a second between flushes, and how long one takes in an emulated machine
records=/var/lib/kadans/tulip/records
log=$work/log base=$work/base.img progress=$work/progress

# entries NAME: a line with what the machine had reached by then.
note() { echo "$(python3 tests/computer/power_log.py count "$log") $*" >>"$progress"; }
# The record that is written, which no dump of the flight recorder is, and the run's time, then the entries.
note_run() {
  local now
  now=$(guest "ls $records | grep -v _flight | tail -n 1; kadans ctl status" 2>/dev/null | awk 'NR == 1 {file = $1; next} /^tulip/ {sub(/,$/, "", $5); print file, $5}') || return 0
  [ -z "$now" ] || note record "$now"
}
run_for() {
  local until=$((SECONDS + $1))
  while [ $SECONDS -lt $until ]; do note_run; done
}

# live [LIBRARY]: from the first start to the run after an update, all writes in the log. With
# a library that is loaded into the runtime, the first run alone.
live() {
  local library=${1:-}
  machine_new 1000
  cp --sparse=always "$card" "$base"
  : >"$log"
  : >"$progress"
  disk=(-blockdev "driver=file,node-name=proto,filename=$card" -blockdev "driver=file,node-name=log,filename=$log"
        -blockdev "driver=blklogwrites,node-name=card,file=proto,log=log,log-sector-size=512" -device "ide-hd,drive=card")
  machine_start
  console_says "waits for a robot"
  note waits
  machine_answers
  guest "install -d -o kadans -g kadans $records"
  robot_environment=""
  if [ -n "$library" ]; then
    scp -q -F "$work/ssh_config" "$library" robot:/data/
    robot_environment=LD_PRELOAD=/data/$(basename "$library")
  fi
  robot_is tulip --plant ideal --play squat --sleep-only --record $records/ --records-max 20
  console_says "tulip is driven"
  note drives
  run_for 40
  if [ -z "$library" ]; then
    "$kadans" push robot config/tulip/robot.json >"$work/push" 2>&1 || { cat "$work/push"; fail "push does not work"; }
    run_for 10
    scp -q -F "$work/ssh_config" "$images/kadans.raucb" robot:/data/update.raucb
    guest "rauc install /data/update.raucb" >"$work/said" 2>&1 || fail "the update is refused: $(cat "$work/said")"
    note installed
    : >"$console"
    guest systemctl reboot 2>/dev/null || true
    console_says "tulip is driven"
    machine_answers
    run_for 30
    console_says "this system is kept" 300
    note kept
    run_for 20
  fi
  machine_off
  disk=(-drive "if=ide,format=raw,cache=unsafe,file=$card")
  say "a life of $(tail -n 1 "$progress" | cut -d' ' -f1) writes and flushes, looked at $(wc -l <"$progress") times"
}

# holds N: the card's data partition after N entries is sound, and its record reaches to what was seen before. Says what is wrong.
holds() {
  local data=$work/data.img start want file time status=0 reach
  start=$(sfdisk -J "$card" | python3 -c 'import json,sys; print(json.load(sys.stdin)["partitiontable"]["partitions"][3]["start"])') || {
    echo "the table of partitions is damaged"
    return 1
  }
  dd if="$card" of="$data" bs=512 skip="$start" conv=sparse status=none
  e2fsck -fp "$data" >"$work/fsck" 2>&1 || status=$?
  [ "$status" -le 1 ] || { echo "the data partition is damaged: $(tail -n 2 "$work/fsck")"; return 1; }
  want=$(awk -v n="$1" '$1 <= n && $2 == "record" {line = $3 " " $4} END {print line}' "$progress")
  [ -n "$want" ] || return 0
  read -r file time <<<"$want"
  debugfs -R "dump /lib/kadans/tulip/records/$file $work/record.mcap" "$data" >/dev/null 2>&1
  reach=$("$kadans" log info "$work/record.mcap" --json 2>"$work/said" |
    python3 -c 'import json,sys; print(json.load(sys.stdin)["to_s"])' 2>/dev/null) || { echo "$file cannot be read: $(cat "$work/said")"; return 1; }
  awk -v r="$reach" -v t="$time" -v s=$slack_s 'BEGIN {exit !(r >= t - s)}' || { echo "$file ends at $reach s, $time s had been run"; return 1; }
}

boots() {
  machine_start
  if awk -v n="$1" '$1 <= n && $2 == "drives" {found = 1} END {exit !found}' "$progress"; then
    console_says "tulip is driven" 600
  else
    console_says "waits for a robot\|tulip is driven" 600
  fi
  machine_off
}

# cut_after BOOTS ENTRY...: how many cards were not as they must be.
cut_after() {
  local boots=$1 n wrong=0 what
  shift
  for n in "$@"; do
    what=$(python3 tests/computer/power_log.py card "$log" "$base" "$card" "$n" "$seed.$n")
    if ! why=$(holds "$n"); then
      say "power gone after entry $n ($what): $why"
      wrong=$((wrong + 1))
    elif [ "$boots" = yes ]; then
      boots "$n"
      say "power gone after entry $n ($what): sound, and it boots in $(since) s"
    fi
  done
  echo "$wrong" >"$work/wrong"
}

if [ $with = yes ]; then
  live ""
  last=$(python3 tests/computer/power_log.py count "$log")
  cut_after "$boots" $(python3 -c "
import random
print(*sorted(random.Random($seed).sample(range(1, $last + 1), $cuts)))")
  [ "$(cat "$work/wrong")" = 0 ] || fail "$(cat "$work/wrong") of $cuts cards were not sound"
  say "the power went $cuts times, every card was sound$([ "$boots" = no ] || echo " and booted")"
fi

echo 'int fsync(int f) { (void)f; return 0; } int fdatasync(int f) { (void)f; return 0; }' >"$work/no_sync.c"
bits=-m64
[ "$arch" = amd64 ] || bits=-m32
gcc $bits -O1 -shared -fPIC -nostdlib -o "$work/no_sync.so" "$work/no_sync.c"
live "$work/no_sync.so"
moments=$(awk '$2 == "record" {print $1}' "$progress" | sort -nu)
cut_after no $moments >"$work/without"
[ "$(cat "$work/wrong")" != 0 ] || fail "without fsync nothing was lost: this trial tries nothing"
say "without fsync $(cat "$work/wrong") of $(wc -w <<<"$moments") cards were wrong, as it must be; the first: $(head -n 1 "$work/without" | cut -c1-200)"
say "ok"
