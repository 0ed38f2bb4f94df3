#!/bin/bash
# Gnomon beside Mesa's llvmpipe: runs both in turn on this machine and prints a
# Markdown table of ratios, how our own time scales, and what counting costs.
#
#   docs/performance/beside-peers.sh PEERS PYTHON [OUT]
#
# PEERS   folder of the peers' scripts (gl_fill_rate.py, gl_shadow_volumes.py, ...)
# PYTHON  the interpreter of their virtual environment
# OUT     where to write: OUT.md and OUT.json (default: beside-peers in the
#         target folder)
#
# Environment:
#   ROUNDS=3          turns of each program, at least 2
#   BUDGET=0.5        seconds for each fill-rate case and turn
#   FRAME_BUDGET=1    seconds for each scene, size and turn (twice: frame, pass)
#   PARTS="one all counting"  what to measure; leave some out to be quicker
#   BUILD=yes         "no" takes the benches that an earlier run has built
#   CARGO_TARGET_DIR  as for cargo
#
# Turns alternate (peer, ours, peer, ours, ...), first on one thread, then on
# all cores. llvmpipe's "one thread" rasterises in the calling thread
# (LP_NUM_THREADS=0). The peers raise their priority where they may, so ours is
# raised likewise. Takes about 2 + 2.5 * ROUNDS minutes after the builds.
set -euo pipefail
usage='usage: beside-peers.sh PEERS PYTHON [OUT]'
peers=${1:?$usage}
python=${2:?$usage}
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
target=${CARGO_TARGET_DIR:-target}
out=${3:-$target/beside-peers}
rounds=${ROUNDS:-3}
budget=${BUDGET:-0.5}
frame_budget=${FRAME_BUDGET:-1}
parts=${PARTS:-one all counting}
export PYTHONDONTWRITEBYTECODE=1
[ -f "$peers/gl_fill_rate.py" ] || { echo "$peers has no gl_fill_rate.py" >&2; exit 2; }

build() { # FOLDER [cargo options]: both benches into FOLDER
  local folder=$1
  shift
  [ "${BUILD:-yes}" != no ] || return 0
  CARGO_TARGET_DIR=$folder cargo build --release --quiet \
    -p gnomon-raster --example fill_rate -p gnomon-pipeline --example peer_bench "$@"
}
build "$target"
if [[ $parts == *counting* ]]; then build "$target/uncounted" --features gnomon-raster/uncounted; fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Copies, so that a build meanwhile changes nothing.
cp "$target/release/examples/"{fill_rate,peer_bench} "$work/"
if [[ $parts == *counting* ]]; then
  mkdir "$work/uncounted"
  cp "$target/uncounted/release/examples/"{fill_rate,peer_bench} "$work/uncounted/"
fi
first=()
if [ -z "$(nice -n -19 true 2>&1)" ]; then first=(nice -n -19); fi

note() { echo "$(date +%H:%M:%S) load $(cut -d' ' -f1-3 /proc/loadavg): $*" | tee -a "$work/notes.txt" >&2; }
peer() { # FILE WHAT BUDGET [--threads N]
  local file=$1 what=$2 seconds=$3
  shift 3
  "$python" "$here/peer_turn.py" "$peers" "$what" --json "$work/$file.json" --budget "$seconds" "$@" >"$work/turn.txt"
  grep OpenGL "$work/turn.txt" >"$work/peer.txt" || [ "$what" = scenes ]
}
ours() { # FILE PROGRAM BUDGET [options]
  local file=$1 program=$2 seconds=$3
  shift 3
  "${first[@]}" "$work/$program" --json "$work/$file.json" --budget "$seconds" "$@" >"$work/turn.txt"
  head -1 "$work/turn.txt" >"$work/ours.txt"
}

peer scenes scenes 0
for threads in one all; do
  [[ $parts == *$threads* ]] || continue
  theirs=() own=()
  if [ $threads = one ]; then theirs=(--threads 0) own=(--threads 1); fi
  for round in $(seq "$rounds"); do
    note "threads: $threads, round $round of $rounds"
    peer "peer-fill-$threads-$round" fill "$budget" "${theirs[@]}"
    ours "ours-fill-$threads-$round" fill_rate "$budget" "${own[@]}"
    peer "peer-blended-$threads-$round" blended "$budget" "${theirs[@]}"
    peer "peer-volumes-$threads-$round" volumes "$frame_budget" "${theirs[@]}"
    ours "ours-volumes-$threads-$round" peer_bench "$frame_budget" "${own[@]}"
  done
done
if [[ $parts == *counting* ]]; then
  for round in $(seq "$rounds"); do
    note "counting, round $round of $rounds"
    for how in counted uncounted; do
      program=. && [ $how = counted ] || program=uncounted
      ours "$how-fill-$round" "$program/fill_rate" "$budget" --threads 1
      ours "$how-volumes-$round" "$program/peer_bench" "$frame_budget" --threads 1
    done
  done
fi
note finished
{ # the source
  git rev-parse --short HEAD
  git diff --quiet HEAD -- raster pipeline shaders-rs || echo "with uncommitted changes"
  [ "${BUILD:-yes}" != no ] || echo "(built earlier)"
} | paste -sd' ' >"$work/commit.txt"
python3 "$here/ratios.py" "$work" --json "$out.json" | tee "$out.md"
echo "written: $out.md, $out.json" >&2
