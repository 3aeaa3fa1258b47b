# shellcheck shell=bash
# Shared by the scripts beside it; sourced, not run.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# As many compilers at once as there are processors and memory for: OpenVDB's headers take 1.5 GB each.
build_jobs() {
  local processors gigabytes
  processors=$(nproc)
  gigabytes=$(awk '/^MemAvailable/ {print int($2 / 1000000)}' /proc/meminfo 2>/dev/null || echo 4)
  local by_memory=$((gigabytes * 2 / 3))
  [ "$by_memory" -ge 1 ] || by_memory=1
  echo $((processors < by_memory ? processors : by_memory))
}

# build PRESET TESTS [TARGET...]: configures and builds quietly; shows everything when it fails.
build() {
  local preset=$1 tests=$2
  shift 2
  local log="$root/build/$preset.log"
  mkdir -p "$root/build"
  echo "Building ($preset)"
  if ! (cd "$root" && cmake --preset "$preset" -DEBRU_TESTS="$tests" &&
    cmake --build --preset "$preset" -j "$(build_jobs)" ${1:+--target "$@"}) >"$log" 2>&1; then
    cat "$log" >&2
    echo "The build failed; the lines above are also in $log" >&2
    return 1
  fi
}
