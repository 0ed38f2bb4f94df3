#!/usr/bin/env python3
"""Switches faults on, one after the other, and says which tests see them.

    python3 .ci/faults.py [--list baselines|thesis] [--only N,N] [--folder DIR]

A copy of the tree gets all faults at once, each behind a number that the environment
variable GNOMON_FAULT chooses; so it is built once (ten minutes on two cores) and each fault
costs one run of the tests that could see it (a minute or so). Fault 0 is none: all
tests must pass. A fault that no test sees is an error (exit code 1).
The lists are in .ci/fault_lists/, results in docs/testing.md.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True  # beside the lists
from fault_lists import baselines, thesis  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent
SHADERS = "shaders-rs/src/"
LISTS = {"baselines": baselines.FAULTS, "thesis": thesis.FAULTS}
FAULTS = [fault for faults in LISTS.values() for fault in faults]

SWITCH = """
#[doc(hidden)]
pub fn fault(n: u32) -> bool {
    static ON: std::sync::OnceLock<u32> = std::sync::OnceLock::new();
    let read = || std::env::var("GNOMON_FAULT").ok()?.parse().ok();
    *ON.get_or_init(|| read().unwrap_or(0)) == n
}
"""


def put_in(folder):
    """Writes all faults into the copy."""
    library = folder / SHADERS / "lib.rs"
    library.write_text(library.read_text() + SWITCH)
    for number, (_, name, old, new, _) in enumerate(FAULTS, 1):
        path = folder / name
        text = path.read_text()
        if text.count(old) != 1:
            sys.exit(f"fault {number}: {name} has {text.count(old)} times: {old}")
        home = "crate" if name.startswith(SHADERS) else "gnomon_shaders"
        path.write_text(text.replace(old, new.replace("FAULT", f"{home}::fault({number})")))


def build(folder):
    """Builds the tests; gives the two binaries."""
    # The program too: with it dependencies have the features that whole builds give them.
    command = "cargo test -p gnomon-pipeline -p gnomon --lib --test suite --no-run".split()
    done = subprocess.run(command, cwd=folder, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    names = re.findall(r"\(([^()]*deps/(?:gnomon_pipeline|suite)-[0-9a-f]+)\)", done.stderr)
    assert len(names) == 2, done.stderr
    return sorted((folder / n for n in names), key=lambda p: "suite" in p.name)


def failures(folder, binaries, number, tests):
    """Names of the tests that fail."""
    units, suite = binaries
    of_suite, beside = tests
    failed = []
    for binary, wanted in [(suite, of_suite), (units, beside)]:
        environment = {**os.environ, "GNOMON_FAULT": str(number)}
        command = [binary, *wanted]
        try:
            done = subprocess.run(command, cwd=folder / "pipeline", env=environment, timeout=900,
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
            failed += re.findall(r"^test (\S+) \.\.\. FAILED", done.stdout, re.M)
            if done.returncode and not failed:
                failed.append(f"{binary.name}: exit {done.returncode}")
        except subprocess.TimeoutExpired:
            failed.append(f"{binary.name}: no end")
    return failed


def numbers_of(name):
    """Numbers of the faults of a list, or of all."""
    if not name:
        return list(range(1, len(FAULTS) + 1))
    before = list(LISTS)[: list(LISTS).index(name)]
    first = sum(len(LISTS[b]) for b in before)
    return list(range(first + 1, first + len(LISTS[name]) + 1))


def groups_of(numbers):
    """Fault 0 for each set of tests in use."""
    seen = []
    for number in numbers:
        tests = FAULTS[number - 1][4]
        if tests not in seen:
            seen.append(tests)
    return [(0, tests) for tests in seen]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--list", choices=LISTS, help="faults of one list")
    parser.add_argument("--only", help="numbers, separated by commas")
    parser.add_argument("--folder", help="where the copy goes; kept")
    given = parser.parse_args()
    numbers = [int(n) for n in given.only.split(",")] if given.only else numbers_of(given.list)
    folder = Path(given.folder or tempfile.mkdtemp(prefix="gnomon-faults-"))
    shutil.copytree(ROOT, folder, dirs_exist_ok=True,
                    ignore=shutil.ignore_patterns("target", ".git", "out", "__pycache__"))
    put_in(folder)
    binaries = build(folder)
    unseen = []
    runs = ([] if 0 in numbers else groups_of(numbers))
    runs += [(n, FAULTS[n - 1][4] if n else FAULTS[0][4]) for n in numbers]
    print("| fault | in | tests that fail |\n| ---: | --- | --- |")
    for number, tests in runs:
        failed = failures(folder, binaries, number, tests)
        what, name, *_ = FAULTS[number - 1] if number else ("", "none")
        where = f"{what}: `{name}`" if what else f"`{name}`"
        shown = ", ".join(f"`{f}`" for f in failed[:3]) + (f" and {len(failed) - 3} more" if failed[3:] else "")
        print(f"| {number} | {where} | {shown or '**none**' if number else shown or 'none, as it should'} |",
              flush=True)
        if bool(failed) != bool(number):
            unseen.append(number)
    if not given.folder:
        shutil.rmtree(folder)
    sys.exit(f"not as it should: {unseen}" if unseen else 0)


if __name__ == "__main__":
    main()
