#!/usr/bin/env bash
# math_bindings.sh FUNCTION...: the program shows these functions, and whatever it loads takes them from it. From the C
# library's mathematics comes only what is exact by its definition: all else differs by the processor
# (src/signal/portable_math.cpp).
set -euo pipefail

# What rounds correctly, or has nothing to round.
exact='sqrt|fmod|remainder|fma|floor|ceil|trunc|rint|nearbyint|l?lrint|round|l?lround|roundeven|frexp|ldexp|scalbl?n|logb|ilogb'
exact="($exact|modf|fabs|fmin|fmax|fdim|copysign|nextafter)[fl]?|fe[a-z]+"

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# bindings PROGRAM ARGUMENT...: all that the loader binds while it runs into $folder/bindings, "WHO FUNCTION WHERE" a line.
bindings() {
  (cd "$folder" && LD_BIND_NOW=1 LD_DEBUG=bindings LD_DEBUG_OUTPUT="$folder/loader" "$@" >"$folder/said" 2>&1) ||
    { cat "$folder/said"; exit 1; }
  sed -n "s|.*binding file \([^ ]*\) \[[0-9]*\] to \([^ ]*\) \[[0-9]*\]: normal symbol \`\([^']*\)'.*|\1 \3 \2|p" \
    "$folder"/loader.* | sort -u >"$folder/bindings"
  rm "$folder"/loader.*
}

# looks PROGRAM LIBRARY...: nothing is bound to what is not exact, and these libraries take their sines from the program.
looks() {
  local program=$1 wrong
  shift
  for library in "$@"; do
    grep -q "/$library[^ ]* \(sin\|sincos\|pow\) $program\$" "$folder/bindings" ||
      { echo "$library takes neither sine nor power from $program"; exit 1; }
  done
  wrong=$(awk '$1 !~ /\/libm\.so/ && $3 ~ /\/libm\.so/ {print $1, $2}' "$folder/bindings" | grep -vE " ($exact)\$" || true)
  [ -z "$wrong" ] || { echo "$program: taken from the C library:"; echo "$wrong"; exit 1; }
  echo "$program: $(awk '{print $1}' "$folder/bindings" | sort -u | wc -l) files"
}

program=$KADANS_BINARY_DIR/kadans
shown=$(nm -D --defined-only "$program" | awk '{print $3}')
for function in "$@"; do
  for name in "$function" "${function}f"; do
    grep -qx "$name" <<<"$shown" || { echo "$program does not show $name"; exit 1; }
  done
done

bindings "$program" sim "$KADANS_SOURCE_DIR/config/scenarios/squat.json" --duration 0.5 --no-record
looks "$program" libBulletDynamics libBulletCollision libLinearMath libluajit liborocos-kdl
if [ -e "$program-tune" ]; then
  bindings "$program-tune" --help
  looks "$program-tune" libpagmo libBulletDynamics libluajit liborocos-kdl
fi
# A program that loads plug-ins with a copy of their own of what they use.
plugins=$KADANS_BINARY_DIR/tests/control_plugins_test
if [ -e "$plugins" ]; then
  bindings "$plugins"
  looks "$plugins"
  grep -q '/spring_plugin\.so ' "$folder/bindings" || { echo "no plug-in was loaded"; exit 1; }
fi
