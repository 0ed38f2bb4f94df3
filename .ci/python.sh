#!/usr/bin/env bash
# The Python package: built, installed and tested in an environment of its own.
#
#   .ci/python.sh [PROGRAM]
#
# Results are held against those of PROGRAM, by default target/release/gnomon. Needs Python
# 3.10 with venv, and packages from PyPI; says so and is skipped where there are none. What is
# built is what users get, a release, in a target folder of its own: crates that a workspace
# built are none of another one's.
set -Eeuo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
target=${CARGO_TARGET_DIR:-$PWD/target}
program=$(realpath -m "${1:-$target/release/gnomon}")
export CARGO_TARGET_DIR=$target/python
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

skip() {
  echo "skipped: $1"
  exit 0
}

new_environment() {
  python3 -m venv "$work/venv" >"$work/venv.log" 2>&1
}

command -v python3 >/dev/null || skip "no python3"
python3 -c 'import sys; sys.exit(sys.version_info < (3, 10))' || skip "$(python3 --version) is older than 3.10"
if ! new_environment && [[ $(id -u) == 0 ]] && command -v apt-get >/dev/null; then
  { apt-get update && apt-get install -y --no-install-recommends python3-venv; } >"$work/apt.log" 2>&1 ||
    echo "python3-venv cannot be installed: $(tail -1 "$work/apt.log")"
  rm -rf "$work/venv"
  new_environment || true
fi
[[ -x $work/venv/bin/pip ]] || skip "no environment can be made: $(tail -1 "$work/venv.log")"
# shellcheck disable=SC1091
source "$work/venv/bin/activate"

if ! pip install --quiet --disable-pip-version-check 'maturin>=1.9.4,<2' 2>"$work/pip.log"; then
  skip "the package index cannot be reached: $(tail -1 "$work/pip.log")"
fi
python3 --version
[[ -x $program ]] || { echo "no program at $program to hold results against" >&2; exit 1; }

cargo fmt --manifest-path python/Cargo.toml --check
cargo clippy --locked --manifest-path python/Cargo.toml -- -D warnings

began=$SECONDS
pip install --quiet --disable-pip-version-check './python[test]'
printf 'installed in %d s\n' $((SECONDS - began))

# From elsewhere: what is installed is tested, not the sources.
cp -r python/tests "$work/tests"
GNOMON=$program GNOMON_ROOT=$PWD \
  python3 -m pytest -q -c python/pyproject.toml --rootdir "$work" -p no:cacheprovider "$work/tests"
# The notebook's cells, and the outputs that it shows.
python3 -m pytest -q -c python/pyproject.toml --rootdir "$PWD" -p no:cacheprovider --nbval docs/python.ipynb
printf 'Python package passed; %d s\n' "$SECONDS"
