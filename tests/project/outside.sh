#!/usr/bin/env bash
# outside.sh COMPILER: installs, moves the installed tree, builds the project in outside/ against it, and runs what was
# built and installed from a folder that is not ours.
set -Eeuo pipefail
trap 'echo "outside.sh:$LINENO: this failed: $BASH_COMMAND"' ERR
here=$(dirname "$(realpath "$0")")
work="$KADANS_BINARY_DIR/outside"
rm -rf "$work"
mkdir -p "$work/elsewhere"

cmake --install "$KADANS_BINARY_DIR" --prefix "$work/made" >"$work/install.log"
mv "$work/made" "$work/moved"

# built SOURCE BUILD COMPILER: a project against the installed package. Its compilers are heard when they fail.
built() {
  cmake -S "$1" -B "$2" -G Ninja -DCMAKE_PREFIX_PATH="$work/moved" -DCMAKE_CXX_COMPILER="$3" >"$work/configure.log"
  cmake --build "$2" --parallel "$(nproc)" >"$work/build.log" 2>&1 || { tail -n 100 "$work/build.log"; return 1; }
}
built "$here/outside" "$work/build" "$1"

cd "$work/elsewhere"
for program in "$work"/build/run_*; do
  echo "$(basename "$program")"
  "$program"
done

# Nothing here is a test of the machine, which other programs keep busy: late ticks, behaviors and datagrams are no faults.
patient='"safety": { "overruns_in_a_row_max": 10000, "heartbeat_timeout_s": 10, "silent_ticks_max": 10000 }'

# driven COMMAND...: a run on the bench that says at its end in JSON how often it wrote, and that it closed the bus.
driven() {
  local said
  said=$("$@") || { echo "failed: $*"; exit 1; }
  echo "$said"
  grep -Eq '"written": ?[0-9]{3,}' <<<"$said" && grep -Eq '"closed": ?[1-9]' <<<"$said" || { echo "not driven: $*"; exit 1; }
}
share="$work/moved/share/kadans"
if [ -x "$work/build/bench_program" ]; then
  echo "{ \"based_on\": \"config/tulip/robot.json\", $patient }" >"$share/config/tulip/patient.json"
  driven "$work/build/bench_program" "$share/config/tulip/patient.json"
fi

# What `kadans new` writes builds and passes as it stands: control objects as a program, as a plug-in and around C code in
# the shapes of three tools, and a plant. One build for all of them.
if [ -x "$work/moved/bin/kadans" ]; then
  kadans="$work/moved/bin/kadans"
  mkdir written
  "$kadans" new control-object first_try --in written
  "$kadans" new control-object second_try --in written --plugin
  if "$kadans" new control-object first_try --in written; then
    echo "a control object was overwritten"
    exit 1
  fi
  for shape in twenty_sim simulink openmodelica; do
    "$kadans" new control-object "$shape" --in written --plugin --from-c "$here/../app/generated_code/$shape"
  done
  "$kadans" new plant can_drives --in written --robot "$share/config/jiwiy/robot.json"
  cat >written/CMakeLists.txt <<'EOF'
cmake_minimum_required(VERSION 3.25)
project(written LANGUAGES C CXX)
find_package(kadans 0.2 REQUIRED)
enable_testing()
foreach(part IN ITEMS first_try second_try twenty_sim simulink openmodelica can_drives)
  add_subdirectory(${part})
endforeach()
EOF
  built written written/build "$1"
  ctest --test-dir written/build --output-on-failure
  written/build/first_try/kadans_first_try check "$share/config/tulip/robot.json"
  # What two instances would share was found in the compiled code.
  grep -q 'xx_P' written/build/twenty_sim/twenty_sim_state.h
  grep -q 'jiwiy_pid_DW' written/build/simulink/simulink_state.h
  grep -q '""' written/build/openmodelica/openmodelica_state.h
fi

# The plug-in of plugins/unitree, built by itself: it needs nothing of the tree.
if [ -x "$work/moved/bin/kadans" ] && command -v idlc >/dev/null; then
  cp -r "$here/../../plugins/unitree" unitree
  built unitree unitree/build "$1"
  [ -s "$work/moved/lib/kadans/unitree.so" ] || { echo "the plug-in unitree is not installed"; exit 1; }
  cat >"$share/config/jiwiy/unitree.json" <<EOF
{ "based_on": "config/jiwiy/robot.json", "plugins": ["$PWD/unitree/build/unitree.so"],
  "plant": { "unitree": { "robot": "go2", "motors": { "pan": { "number": 0 }, "tilt": { "number": 1 } } } } }
EOF
  "$work/moved/bin/kadans" check --plugins "$share/config/jiwiy/unitree.json"
  rm "$share/config/jiwiy/unitree.json"  # it names this machine
fi

if [ -x "$work/moved/bin/kadans" ]; then
  mkdir "$share/plugins"
  cp "$work/build/bench_plugin.so" written/build/second_try/second_try.so written/build/twenty_sim/twenty_sim.so "$share/plugins"
  cat >"$share/config/tulip/benched.json" <<'EOF'
{ "based_on": "config/tulip/patient.json", "plugins": ["plugins/bench_plugin.so", "plugins/second_try.so"],
  "plant": { "bench": { "period_s": 0.001 } } }
EOF
  "$work/moved/bin/kadans" check --plugins "$share/config/tulip/benched.json"
  driven "$work/moved/bin/kadans" run "$share/config/tulip/benched.json" --plant bench --soft --json --no-ctl --duration 1
  # JIWIY under C code in the shape of 20-sim's. Without its stiffness it does not follow, and there is one object of it.
  cp "$here/outside/generated/generated.json" "$share/config/jiwiy"
  cp "$here/outside/generated/jiwiy_generated.json" "$share/config/scenarios"
  cp "$here/outside/generated/around.lua" "$share/behaviors/jiwiy"
  "$kadans" check --plugins "$share/config/jiwiy/generated.json"
  "$kadans" sim "$share/config/scenarios/jiwiy_generated.json" --no-record
  if "$kadans" sim "$share/config/scenarios/jiwiy_generated.json" --no-record --set control.generated.pan.kp=0.05; then
    echo "JIWIY follows without stiffness"
    exit 1
  fi
  cat >"$share/config/jiwiy/twice.json" <<'EOF'
{ "based_on": "config/jiwiy/generated.json",
  "control": { "objects": [{ "name": "again", "type": "twenty_sim", "joints": ["*"], "options": {
    "pan.wanted": "pan.reference_rad", "pan.measured": "pan.position_rad", "tilt.wanted": "tilt.reference_rad",
    "tilt.measured": "tilt.position_rad", "pan.torque": "pan.effort_Nm", "tilt.torque": "tilt.effort_Nm" } }] } }
EOF
  twice=$("$kadans" check --plugins "$share/config/jiwiy/twice.json" 2>&1) && { echo "two objects share the state of one code"; exit 1; }
  grep -q 'two objects of the type would disturb each other' <<<"$twice" || { echo "$twice"; exit 1; }
  # The written plant, against its own emulator.
  place=127.0.7.63:27200
  trap 'kill $(jobs -p) 2>/dev/null || true' EXIT
  sed -i 's|"[^"]*can_drives.so"|"plugins/can_drives.so"|' "$share/config/jiwiy/can_drives.json"
  cp written/build/can_drives/can_drives.so "$share/plugins"
  echo "{ \"based_on\": \"config/jiwiy/can_drives.json\", $patient }" >"$share/config/jiwiy/patient.json"
  "$kadans" plant "$share/config/jiwiy/patient.json" --as can_drives --listen $place --soft --once &
  "$kadans" run "$share/config/jiwiy/patient.json" --plant can_drives --peer $place --soft --no-ctl --json --duration 1 | tee run.json
  wait $!
  grep -Eq '"received": ?[0-9]{2,}' run.json || { echo "the written plant was not driven"; exit 1; }
  "$work/moved/bin/kadans" --version
  # A robot's file outside of any project belongs to the installed one. Man pages and completion are installed, too.
  echo '{ "based_on": "config/tulip/robot.json" }' >robot.json
  "$work/moved/bin/kadans" check robot.json
  for file in man/man1/kadans.1 man/man1/kadans-sim.1 bash-completion/completions/kadans kadans/stubs/kadans.lua; do
    [ -s "$work/moved/share/$file" ] || { echo "not installed: $file"; exit 1; }
  done
  "$work/moved/bin/kadans" check "$share/config/scenarios/squat.json"
  # Too short to squat: 1 says that not all checks passed, which is right.
  "$work/moved/bin/kadans" sim "$share/config/scenarios/squat.json" --duration 0.1 --json || [ $? -eq 1 ]
fi
if grep -rlI -e "$KADANS_SOURCE_DIR" -e "$work/made" "$work/moved"; then
  echo "the files above name a path of the machine that built them"
  exit 1
fi
