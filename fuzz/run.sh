#!/usr/bin/env bash
# Runs fuzz targets for a number of seconds each: fuzz/run.sh SECONDS [TARGET...].
# Needs cargo-fuzz; no nightly compiler. Exits with 1 where a target crashed.
set -euo pipefail
cd "$(dirname "$0")"
seconds=${1:?usage: fuzz/run.sh SECONDS [TARGET...]}
shift
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
    mapfile -t targets < <(cd fuzz_targets && basename -s .rs -- *.rs)
fi
# One level of instructions is enough, and a third of the build.
export RUSTFLAGS="--cfg gnomon_widest ${RUSTFLAGS:-}"
crashed=()
for target in "${targets[@]}"; do
    # What is found goes to corpus/, which git ignores; seeds/ is only read.
    mkdir -p "corpus/$target" "seeds/$target"
    seeds=("seeds/$target")
    if [ "$target" = trace ]; then seeds+=(../traces/tests/golden/v1); fi
    if ! cargo fuzz run --sanitizer none "$target" "corpus/$target" "${seeds[@]}" -- \
        -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -malloc_limit_mb=1024 \
        -max_len=65536 -print_final_stats=1 >"$target.log" 2>&1; then
        crashed+=("$target")
    fi
    printf '%-9s ' "$target"
    awk '/stat::number_of_executed_units/ { n = $2 } /stat::average_exec_per_sec/ { r = $2 }
         /stat::peak_rss_mb/ { m = $2 } / cov: / { for (i = 1; i < NF; i++) if ($i == "cov:") c = $(i + 1) }
         END { printf "%d runs, %d/s, %d edges, %d MB\n", n, r, c, m }' "$target.log"
done
if [ ${#crashed[@]} -gt 0 ]; then
    echo "crashed: ${crashed[*]} (see fuzz/TARGET.log and fuzz/artifacts)"
    exit 1
fi
