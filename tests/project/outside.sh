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
  test -f second_try/build/second_try.so
fi

share="$work/moved/share/kadans"
if [ -x "$work/moved/bin/kadans" ]; then
  "$work/moved/bin/kadans" --version
  "$work/moved/bin/kadans" check "$share/config/scenarios/squat.json"
  # Too short to squat: 1 says that not all checks passed, which is right.
  "$work/moved/bin/kadans" sim "$share/config/scenarios/squat.json" --duration 0.1 --json || [ $? -eq 1 ]
fi
if grep -rlI -e "$KADANS_SOURCE_DIR" -e "$work/made" "$work/moved"; then
  echo "the files above name a path of the machine that built them"
  exit 1
fi
