#!/bin/bash
# Gnomon's soft shadow volumes beside ray-traced area-light visibility by Embree at
# equal error: both in turn on this machine, all cores, peer scenes A, B and C.
#
#   docs/performance/beside-embree.sh PEERS PYTHON [OUT]
#
# PEERS   folder of the peers' scripts (embree_area_light.py, scenes.py, peerlib.py)
# PYTHON  the interpreter of their virtual environment
# OUT     where to write: OUT.md and OUT.json (default: beside-embree in the target
#         folder)
#
# Environment:
#   ROUNDS=3          turns of each program
#   BUDGET=1          seconds for each scene, ray count and turn
#   SCENES=ABC        which scenes
#   SIZE=512          pixels along a side
#   TECHNIQUE=soft-shadow-volumes  SET=horizon=on   ours
#   BUILD=yes         "no" takes the bench that an earlier run has built
#   CARGO_TARGET_DIR  as for cargo
#
# Our error is against the exact oracle, Embree's is its noise alone, against 4096
# rays of its own. Its ray count is the one whose error equals ours, between the two
# counts measured on either side of it. See embree_turn.py and equal_error.py.
set -euo pipefail
usage='usage: beside-embree.sh PEERS PYTHON [OUT]'
peers=${1:?$usage}
python=${2:?$usage}
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
target=${CARGO_TARGET_DIR:-target}
out=${3:-$target/beside-embree}
export PYTHONDONTWRITEBYTECODE=1
[ -f "$peers/embree_area_light.py" ] || { echo "$peers has no embree_area_light.py" >&2; exit 2; }
if [ "${BUILD:-yes}" != no ]; then
  cargo build --release --quiet -p gnomon-pipeline --example soft_bench
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$target/release/examples/soft_bench" "$work/"
first=()
if [ -z "$(nice -n -19 true 2>&1)" ]; then first=(nice -n -19); fi
for round in $(seq "${ROUNDS:-3}"); do
  for scene in $(echo "${SCENES:-ABC}" | fold -w1); do
    echo "$(date +%H:%M:%S) load $(cut -d' ' -f1-3 /proc/loadavg): scene $scene, round $round" >&2
    "${first[@]}" "$work/soft_bench" --scenes "$scene" --size "${SIZE:-512}" --budget "${BUDGET:-1}" --npy "$work" \
      --technique "${TECHNIQUE:-soft-shadow-volumes}" --set "${SET:-horizon=on}" \
      --json "$work/ours-$scene-$round.json" >"$work/turn.txt"
    "$python" "$here/embree_turn.py" "$peers" "$scene" "$work" "${BUDGET:-1}" "$round"
  done
done
python3 "$here/equal_error.py" "$work" --json "$out.json" | tee "$out.md"
echo "written: $out.md, $out.json" >&2
