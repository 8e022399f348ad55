#!/usr/bin/env bash
# outside.sh COMPILER: installs, moves the installed tree, builds the project in outside/ against it, and runs what was
# built and installed from a folder that is not ours.
set -euo pipefail
here=$(dirname "$(realpath "$0")")
work="$KADANS_BINARY_DIR/outside"
rm -rf "$work"
mkdir -p "$work/elsewhere"

cmake --install "$KADANS_BINARY_DIR" --prefix "$work/made" >"$work/install.log"
mv "$work/made" "$work/moved"
cmake -S "$here/outside" -B "$work/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/moved" -DCMAKE_CXX_COMPILER="$1" >"$work/configure.log"
cmake --build "$work/build" --parallel "$(nproc)"

cd "$work/elsewhere"
for program in "$work"/build/run_*; do
  echo "$(basename "$program")"
  "$program"
done

# driven COMMAND...: a run on the bench that says at its end in JSON how often it wrote, and that it closed the bus.
driven() {
  local said
  said=$("$@") || { echo "failed: $*"; exit 1; }
  echo "$said"
  grep -Eq '"written": ?[0-9]{3,}' <<<"$said" && grep -Eq '"closed": ?[1-9]' <<<"$said" || { echo "not driven: $*"; exit 1; }
}
if [ -x "$work/build/bench_program" ]; then
  driven "$work/build/bench_program"
fi

# What `kadans new control-object` writes builds and passes as it stands, as a program and as a plug-in.
if [ -x "$work/moved/bin/kadans" ]; then
  "$work/moved/bin/kadans" new control-object first_try
  "$work/moved/bin/kadans" new control-object second_try --plugin
  if "$work/moved/bin/kadans" new control-object first_try; then
    echo "a control object was overwritten"
    exit 1
  fi
  for name in first_try second_try; do
    cmake -S "$name" -B "$name/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/moved" -DCMAKE_CXX_COMPILER="$1" >>"$work/configure.log"
    cmake --build "$name/build" --parallel "$(nproc)"
    "$name/build/${name}_test"
  done
  first_try/build/kadans_first_try check "$work/moved/share/kadans/config/tulip/robot.json"
fi

share="$work/moved/share/kadans"
if [ -x "$work/moved/bin/kadans" ]; then
  mkdir "$share/plugins"
  cp "$work/build/bench_plugin.so" second_try/build/second_try.so "$share/plugins"
  cat >"$share/config/tulip/benched.json" <<'EOF'
{ "based_on": "config/tulip/robot.json", "plugins": ["plugins/bench_plugin.so", "plugins/second_try.so"],
  "plant": { "bench": { "period_s": 0.001 } } }
EOF
  "$work/moved/bin/kadans" check --plugins "$share/config/tulip/benched.json"
  driven "$work/moved/bin/kadans" run "$share/config/tulip/benched.json" --plant bench --soft --json --no-ctl --duration 1
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
