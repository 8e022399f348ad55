#!/usr/bin/env bash
# math_bindings.sh FUNCTION...: the program shows these functions, and whatever it loads takes them from it. From the C
# library's mathematics comes only what is exact by its definition: all else differs by the processor
# (src/signal/portable_math.cpp). So do all other programs of the build, tests and benchmarks, that load Bullet, KDL or
# LuaJIT; the process of the behaviors is forked from the program.
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

# shows PROGRAM FUNCTION...: the functions and those of single precision stand in its table of dynamic symbols.
shows() {
  local program=$1 function name shown
  shift
  shown=$(nm -D --defined-only "$program" | awk '{print $3}')
  for function in "$@"; do
    for name in "$function" "${function}f"; do
      grep -qx "$name" <<<"$shown" || { echo "$program does not show $name"; exit 1; }
    done
  done
}

program=$KADANS_BINARY_DIR/kadans
c_library=$(ldd "$program" | awk '$1 ~ /^libm\.so/ {print $3}')
nm -D --defined-only "$c_library" | awk '{sub("@.*", "", $3); print $3}' | sort -u >"$folder/c_functions"
looked_at=0
for file in "$KADANS_BINARY_DIR"/kadans* "$KADANS_BINARY_DIR"/tests/* "$KADANS_BINARY_DIR"/tests/bench/*; do
  readelf -d "$file" 2>/dev/null | grep -q 'NEEDED.*\[lib\(Bullet\|LinearMath\|luajit\|orocos-kdl\)' || continue
  [[ $file == *.so ]] && continue
  [[ $file == */kadans-hull ]] && continue  # it reads files, and computes nothing of a run
  shows "$file" "$@"
  # Two tests compare with formulas of complex numbers, within wide bounds.
  wrong=$(nm -D --undefined-only "$file" | awk '{sub("@.*", "", $2); print $2}' | sort | comm -12 - "$folder/c_functions" |
    grep -vxE "$exact" | { [ "$file" = "$program" ] && cat || grep -vx 'cabs\|cexp'; } || true)
  [ -z "$wrong" ] || { echo "$file takes from the C library:" $wrong; exit 1; }
  looked_at=$((looked_at + 1))
done
echo "$looked_at programs bring their own mathematics"

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
