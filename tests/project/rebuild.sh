#!/usr/bin/env bash
# rebuild.sh PRESET TARGET...: builds targets in the preset's way below the build folder, then runs those that are test
# programs. With KADANS_SOAK set it builds and runs all there are, with the tests' usual counts. Address randomisation is
# off throughout: ThreadSanitizer of gcc 12 does not start on kernels with more of it.
# In the way "clang", without KADANS_SOAK, the compiler parses what else KADANS_PARSED names (parse.py).
set -euo pipefail
preset=$1
shift
build="$KADANS_BINARY_DIR/$preset"

[ $# -gt 0 ] || { echo "nothing to build yet"; exit 0; }
cd "$KADANS_SOURCE_DIR"
unity=${KADANS_SOAK:+-DCMAKE_UNITY_BUILD=OFF}  # clang-tidy looks at one file at a time
quick=()  # compiling takes nearly all of the time here; scripts/soak has the presets' own optimisation
if [ -z "${KADANS_SOAK:-}" ]; then
  case $preset in
    clang) quick=(-DKADANS_OPTIMISATION=-O0 -DKADANS_SANITIZE=address,undefined) ;;  # one build for two purposes
    asan) echo "scripts/soak builds it"; exit 77 ;;
  esac
fi
cmake --preset "$preset" -B "$build" -DKADANS_REBUILD_TESTS=OFF $unity "${quick[@]}" >"$KADANS_BINARY_DIR/$preset.configure.log" 2>&1 ||
  { cat "$KADANS_BINARY_DIR/$preset.configure.log"; exit 1; }
[ -z "${KADANS_SOAK:-}" ] || set -- all
setarch -R cmake --build "$build" --target "$@"

jobs=${KADANS_SOAK:+1}  # there each takes as long as it wants, alone
unset KADANS_SOAK
programs=()
for program in "$build"/tests/*_test; do
  target=$(basename "$program")
  [[ " $* " == *" $target "* || ($* == all && $preset != clang) ]] && programs+=("$target")
done
passes() {
  setarch -R "$1/$2" --minimal >"$1/$2.said" 2>&1 && echo "$2" || { cat "$1/$2.said"; exit 1; }
}
export -f passes
printf '%s\n' "${programs[@]}" | xargs -P "${jobs:-$(nproc)}" -I{} bash -c 'passes "$0" "$1"' "$build/tests" {}
[ "$preset" != clang ] || [ ${#quick[@]} -eq 0 ] || "$KADANS_SOURCE_DIR/tests/project/parse.py" "$build" $KADANS_PARSED -- "$@"
