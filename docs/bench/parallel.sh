#!/usr/bin/env bash
# A suite of `gnomon bench` in parts by GNU parallel, joined at the end:
#
#   docs/bench/parallel.sh standard out/standard 4
#   docs/bench/parallel.sh standard out/standard 4 --sshloginfile hosts
#
# On one machine parts measure beside each other: errors, bytes and hashes are as they
# are alone, times are not, and `load` says so. Give `--jobs 1`, or other machines that
# share the folder, where times matter. What was measured is not measured again when the
# same line is run again. GNOMON names the program, GNOMON_FLAGS gives further flags.
set -euo pipefail

suite=${1:?a suite or a scene}
folder=${2:?the folder for results}
parts=${3:?the number of parts}
shift 3
gnomon=${GNOMON:-gnomon}

parallel "$@" "$gnomon" bench "$suite" "${GNOMON_FLAGS:-}" --shard "{}/$parts" \
  --out-dir "$folder/part-{}" --cache-dir "$folder/oracle-cache" ::: $(seq "$parts")
"$gnomon" bench merge "$folder"/part-* --out-dir "$folder/all"
