#!/bin/bash
# Convolution soft shadows beside ray-traced visibility by Embree at equal error, with
# mip chains and with summed-area tables, and their scaling over threads: one run.
#
#   docs/performance/convolution.sh PEERS PYTHON [OUT]
#
# PEERS   folder of the peers' scripts (embree_area_light.py, scenes.py, peerlib.py)
# PYTHON  the interpreter of their virtual environment
# OUT     where to write: OUT.md (default: convolution in the target folder)
#
# Environment, as for beside-embree.sh: ROUNDS=3, BUDGET=1, SCENES=ABC, BUILD=yes,
# CARGO_TARGET_DIR, and
#   SETS="m=4 m=4,filter=sat m=4,filter=sat,edges=texel"   settings, one table each
#   THREADS="1 2 4"                             counts for the scaling
#
# One light, one light view of 512x512, pictures of 512x512. See beside-embree.sh for
# what is compared, and scaling.py for the second table.
set -euo pipefail
usage='usage: convolution.sh PEERS PYTHON [OUT]'
peers=${1:?$usage}
python=${2:?$usage}
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
target=${CARGO_TARGET_DIR:-target}
out=${3:-$target/convolution}
if [ "${BUILD:-yes}" != no ]; then
  cargo build --release --quiet -p gnomon-pipeline --example soft_bench
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sets=${SETS:-m=4 m=4,filter=sat m=4,filter=sat,edges=texel}
: >"$out.md"
for set in $sets; do
  {
    echo "## \`$set\`"
    echo
    BUILD=no TECHNIQUE=convolution-soft-shadows SET=$set \
      "$here/beside-embree.sh" "$peers" "$python" "$work/one"
    echo
  } >>"$out.md"
done
first=()
if [ -z "$(nice -n -19 true 2>&1)" ]; then first=(nice -n -19); fi
for round in $(seq "${ROUNDS:-3}"); do
  for set in $sets; do
    for threads in ${THREADS:-1 2 4}; do
      "${first[@]}" "$target/release/examples/soft_bench" --scenes "${SCENES:-ABC}" \
        --technique convolution-soft-shadows --set "$set" --errors off --threads "$threads" \
        --budget "${BUDGET:-1}" --json "$work/scaling-$set-$threads-$round.json" >/dev/null
    done
  done
done
{
  echo "## Scaling"
  echo
  python3 "$here/scaling.py" "$work"
  echo
  echo "Load average at the end: $(cut -d' ' -f1-3 /proc/loadavg)."
} >>"$out.md"
cat "$out.md"
echo "written: $out.md" >&2
