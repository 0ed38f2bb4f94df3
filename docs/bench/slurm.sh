#!/usr/bin/env bash
#SBATCH --job-name=gnomon-bench
#SBATCH --array=1-8
#SBATCH --exclusive
#
# A suite of `gnomon bench` as a Slurm array, a part for each task:
#
#   sbatch docs/bench/slurm.sh standard /shared/bench
#   sbatch --dependency=afterok:JOBID --array=1-1 docs/bench/slurm.sh --merge /shared/bench
#
# --exclusive, since times measured beside other work tell little. All nodes run one
# program; the suite should say how many threads, so that all plan the same cells.
# A task that was killed is started again with the same line and goes on where it was.
# GNOMON names the program, GNOMON_FLAGS gives further flags of `bench`.
set -euo pipefail

what=${1:?a suite, a scene, or --merge}
folder=${2:?the folder for results}
gnomon=${GNOMON:-gnomon}
read -ra flags <<<"${GNOMON_FLAGS:-}"

if [[ $what == --merge ]]; then
  exec "$gnomon" bench merge "$folder"/part-* --out-dir "$folder/all"
fi

part=${SLURM_ARRAY_TASK_ID:?run by sbatch, or set by hand}
parts=${SLURM_ARRAY_TASK_COUNT:-${SLURM_ARRAY_TASK_MAX:-8}}
# The truth is the same for all parts, and found by its content: whoever comes first
# computes it.
exec "$gnomon" bench "$what" "${flags[@]}" --shard "$part/$parts" \
  --out-dir "$folder/part-$part" --cache-dir "$folder/oracle-cache"
