#!/usr/bin/env python3
"""Counts the instructions of kernels under valgrind, which no other load on the machine
changes, and compares them with docs/performance/instructions.csv: a regression gate
without noise.

    .ci/instructions.py BINARY            # compare; 1 where a kernel takes more
    .ci/instructions.py BINARY --renew    # write the file anew

BINARY is the release build of the example fill_rate. A kernel is one pass of it at 1024 x
1024, at AVX2 on one thread: the difference between runs of three passes and of one, so that
start-up does not count. ALLOWED is what compilers may add without being asked.
"""
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

ALLOWED = 0.05
KERNELS = [
    ("depth_pass", "small"),
    ("stencil_zfail", "small"),
    ("stencil_zfail", "large"),
    ("add_rgba8", "large"),
    ("shader60_add", "large"),
    ("shader60", "small"),
]
FILE = pathlib.Path(__file__).parent.parent / "docs/performance/instructions.csv"


def instructions(binary, case, mesh, passes):
    with tempfile.TemporaryDirectory() as folder:
        command = ["valgrind", "--tool=cachegrind", "--cache-sim=no",
                   f"--cachegrind-out-file={folder}/out", binary, "--threads", "1",
                   "--simd", "avx2", "--case", case, "--mesh", mesh, "--budget", "0",
                   "--passes", str(passes)]
        done = subprocess.run(command, capture_output=True, text=True)
    found = re.search(r"I +refs: +([0-9,]+)", done.stderr)
    if done.returncode or not found or case not in done.stdout:
        sys.exit(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    return int(found[1].replace(",", ""))


def measure(binary):
    for case, mesh in KERNELS:
        one, three = (instructions(binary, case, mesh, n) for n in (1, 3))
        yield case, mesh, (three - one) // 2


def main():
    binary, renew = sys.argv[1], "--renew" in sys.argv
    known = {}
    if FILE.exists():
        with FILE.open(newline="") as file:
            known = {(r["case"], r["mesh"]): int(r["instructions"]) for r in csv.DictReader(file)}
    rows, slower = [], []
    for case, mesh, count in measure(binary):
        rows.append((case, mesh, count))
        before = known.get((case, mesh))
        change = "" if before is None else f"{100 * (count / before - 1):+.2f} %"
        print(f"{case:16} {mesh:6} {count:12,} {change}", flush=True)
        if before is None or count > before * (1 + ALLOWED):
            slower.append(f"{case} {mesh}")
    if renew:
        with FILE.open("w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["case", "mesh", "instructions"])
            writer.writerows(rows)
    elif slower:
        sys.exit(f"more than {ALLOWED:.0%} more instructions than {FILE.name} says: {', '.join(slower)}; "
                 "mend it, or say why in docs/performance and renew the file")


if __name__ == "__main__":
    main()
