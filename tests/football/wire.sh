#!/usr/bin/env bash
# A short match over the wire, all processes apart: the world is served, each robot is a `kadans run` with a supervisor of
# its own, the referee's packets and what is perceived come as datagrams, and what the robots say to their mates is counted.
# The same rules are kept, whatever the machine's load does to the robots. Exit code 77, skipped, without real time.
#   KADANS_SOURCE_DIR=. KADANS_BINARY_DIR=build tests/football/wire.sh [MATCH [SETTING...]]
# With --referee game_controller.py, a program that knows Kadans' code not at all, is the referee of a striker alone.
set -euo pipefail
build=$(realpath "$KADANS_BINARY_DIR")
cd "$KADANS_SOURCE_DIR"
elsewhere=()
if [ "${1:-}" = --referee ]; then
  elsewhere=(--referee 127.0.0.1)
  set -- config/matches/striker_drill.json
fi
match=${1:-config/matches/two_against_two.json}
settings=("${@:2}")
[ $# -gt 0 ] || settings=(rules.half_s=6 rules.break_s=1 rules.initial_s=2 rules.ready_s=8 rules.set_s=1 home.keeper=0 away.keeper=0)
if ! chrt --fifo 40 true 2>/dev/null; then echo "skipped: no right to real time"; exit 77; fi
work=$(mktemp -d "$build/wire.XXXXXX")
pids=()
finish() {
  for pid in "${pids[@]}"; do kill -INT "$pid" 2>/dev/null || true; done
  for pid in "${pids[@]}"; do wait "$pid" 2>/dev/null || true; done
  rm -rf "$work"
}
trap finish EXIT

: >"$work/serve.txt"
arguments=()
for setting in "${settings[@]}"; do arguments+=(--set "$setting"); done
"$build/kadans-football" serve "$match" --listen 127.0.7.64:27100 --robots "$work" --json "${arguments[@]}" "${elsewhere[@]}" >"$work/result.json" 2>"$work/serve.txt" &
serve=$!
pids+=("$serve")
until grep -q "^serves" "$work/serve.txt"; do
  kill -0 "$serve" 2>/dev/null || { cat "$work/serve.txt"; exit 1; }
  sleep 0.1
done
recorded=""
while read -r _ _ file rest; do
  if [ -z "$recorded" ]; then recorded=$(basename "$file" .json); rest="$rest --record $work/$recorded.mcap"; fi
  "$build/kadans" run "$file" $rest --no-ctl --flight 0 --verbose >"$work/$(basename "$file" .json).txt" 2>&1 &
  pids+=($!)
done < <(grep "^kadans run" "$work/serve.txt")
if [ ${#elsewhere[@]} -gt 0 ]; then
  until grep -q "driven" "$work/serve.txt"; do sleep 0.1; done
  python3 tests/football/game_controller.py
fi
code=0
wait "$serve" || code=$?
for pid in "${pids[@]:1}"; do kill -INT "$pid" 2>/dev/null || true; done
for pid in "${pids[@]:1}"; do wait "$pid" || true; done
cat "$work/serve.txt"
# Its decisions, too, from the packets, messages and observations that came over the wire.
"$build/kadans" replay "$work/$recorded.mcap" | tee "$work/replay.txt"
grep -q "ticks of the decisions" "$work/replay.txt"
python3 - "$work" "$code" "${elsewhere[@]}" <<'END'
import json, pathlib, sys

work, code = pathlib.Path(sys.argv[1]), int(sys.argv[2])
result = json.loads((work / "result.json").read_text())
print(f"{result['home']['goals']} : {result['away']['goals']}, ended {result['ended']}, {result['simulated_s']} s")
for decision in result["decisions"]:
    print(f"  {decision['time_s']:8.3f} s  {decision['text']} [{decision['rule']}]")
wrong = [] if code == 0 and result["ended"] == "by the rules" else [f"exit code {code}, ended {result['ended']}"]
told = [decision["text"] for decision in result["decisions"]]
if len(sys.argv) > 3 and told:
    wrong.append("the program judged, though another game controller did")
for wanted in () if len(sys.argv) > 3 else ("ready: kick-off", "set: kick-off", "playing", "the first half is over", "the match is over"):
    if not any(text.startswith(wanted) for text in told):
        wrong.append(f"the referee did not say '{wanted}'")
for robot in result["robots"]:
    print("  " + ", ".join(f"{key} {value}" for key, value in robot.items()))
    log = (work / (robot["name"] + ".txt")).read_text()
    if robot["errors"] or "team: wait -> ready" not in log:
        wrong.append(f"{robot['name']} did not hear of ready: " + "; ".join(log.splitlines()[:5]))
    if robot["played_s"] > 0 and "team: wait -> play" not in log:  # who is penalised in both halves plays in none
        wrong.append(f"{robot['name']} did not hear of playing")
if not any(robot["played_s"] > 0 for robot in result["robots"]):
    wrong.append("nobody played")
mates = {}
for robot in result["robots"]:
    mates.setdefault(robot["name"].split("_")[0], []).append(robot["messages"])
wrong += [f"nobody counted a message of {side}" for side, sent in mates.items() if len(sent) > 1 and not any(sent)]
sys.exit("\n".join(wrong) if wrong else 0)
END
echo "the match was played over the wire, and kept to the rules"
