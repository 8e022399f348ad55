#!/usr/bin/env bash
# A sweep as a Slurm array on a cluster of this one machine: a real slurmctld, slurmd and munged, in folders of their own.
# Exit code 77, skipped, without root or where scripts/setup did not run.
#   KADANS_SOURCE_DIR=. KADANS_BINARY_DIR=build tests/project/slurm.sh
set -euo pipefail
skip() { echo "skipped: $1"; exit 77; }
[ "$(id -u)" -eq 0 ] || skip "starting Slurm needs root"
for program in slurmctld slurmd munged mungekey sbatch squeue scontrol; do
  command -v "$program" >/dev/null || [ -x "/usr/sbin/$program" ] || skip "$program is not installed"
done
PATH=$PATH:/usr/sbin
kadans=$(realpath "$KADANS_BINARY_DIR")/kadans
football=$kadans-football
source=$(realpath "$KADANS_SOURCE_DIR")
work=$(mktemp -d /tmp/kadans-slurm.XXXXXX)  # short: sockets have short names
chmod 755 "$work"
pids=()
finish() {
  for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
  for pid in "${pids[@]}"; do wait "$pid" 2>/dev/null || true; done
  rm -rf "$work"
}
trap finish EXIT

mkdir "$work"/{munge,state,spool}
mungekey --create --keyfile "$work/munge/key"
chown -R munge "$work/munge"
chmod 700 "$work/munge/key"
socket=$work/munge/socket
setpriv --reuid munge --clear-groups munged --foreground --force --key-file "$work/munge/key" --socket "$socket" \
  --pid-file "$work/munge/pid" --log-file "$work/munge/log" --seed-file "$work/munge/seed" &
pids+=($!)

node=$(hostname -s)
cat >"$work/slurm.conf" <<END
ClusterName=kadans
SlurmctldHost=$node(127.0.0.1)
SlurmctldPort=17817
SlurmdPort=17818
AuthType=auth/munge
AuthInfo=socket=$socket
CredType=cred/munge
SlurmUser=root
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
ReturnToService=2
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
NodeName=$node NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$node Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF=$work/slurm.conf
wait_for() {  # what, condition
  for _ in $(seq 300); do
    if eval "$2" >/dev/null 2>&1; then return; fi
    sleep 0.2
  done
  echo "there is no $1"
  tail -n 20 "$work"/*.log || true
  exit 1
}
wait_for "munge" "[ -S '$socket' ]"
slurmctld -D -c -f "$SLURM_CONF" >"$work/slurmctld.log" 2>&1 &
pids+=($!)
slurmd -D -f "$SLURM_CONF" -N "$node" >"$work/slurmd.log" 2>&1 &
pids+=($!)
wait_for "idle node" "sinfo -h -o %T | grep -q idle"

cd "$source"
plan=config/sweeps/push_varied.json
KADANS=$kadans sbatch --array=0-3 --output="$work/task-%a.log" config/sweeps/slurm.sbatch "$plan" --cases 12 --out "$work/array"
wait_for "end of the jobs" "[ -z \"\$(squeue -h)\" ] && [ \$(ls '$work/array/cases' | wc -l) -eq 12 ]"
grep -h "this is part" "$work"/task-?.log | sort
[ "$(cat "$work"/task-?.log | grep -c "this is part ./4")" -eq 4 ]
"$kadans" sweep "$plan" --cases 12 --out "$work/alone" >/dev/null || [ $? -eq 1 ]
for part in array alone; do "$kadans" merge "$work/$part" --csv "$work/$part.csv" --sqlite "$work/$part.db" >"$work/$part.txt" || [ $? -eq 1 ]; done
for kind in csv db txt; do cmp "$work/array.$kind" "$work/alone.$kind"; done
echo "12 cases in four tasks of a Slurm array: the same tables as without Slurm"

matches=(config/matches/striker_drill.json --cases 4 --seed 3 --set ends.playing_s=1 --set rules.ready_s=5)
KADANS_FOOTBALL=$football sbatch --array=0-1 --output="$work/match-%a.log" config/matches/slurm.sbatch "${matches[@]}" --out "$work/matches"
wait_for "end of the matches" "[ -z \"\$(squeue -h)\" ] && [ \$(ls '$work'/matches/0-*.json | wc -l) -eq 4 ]"
grep -h "matches$" "$work"/match-?.log
[ "$(cat "$work"/match-?.log | grep -c ": 2 matches")" -eq 2 ]
"$football" merge "$work/matches" --json >"$work/matches.json"
"$football" matches "${matches[@]}" --json >"$work/matches_alone.json"
cmp "$work/matches.json" "$work/matches_alone.json"
echo "4 matches in two tasks of a Slurm array: the same summary as without Slurm"
