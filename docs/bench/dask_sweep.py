#!/usr/bin/env python3
"""A sweep of scenes, techniques and sizes over a Dask cluster, through the Python package:

    docs/bench/dask_sweep.py cylinder peer-a --techniques pcss:samples=16 soft-shadow-volumes \
        --sizes 320x240 640x480 --workers 4 --out sweep.csv
    docs/bench/dask_sweep.py ... --scheduler tcp://head:8786

Each cell is a comparison with the exact truth. The table is the same whoever measures what,
to the byte: errors, bytes moved and hashes depend on nothing but the cell. Times do, and are
written with --times alone; give workers a machine each where they matter. All workers need
the same version of the package, and the same scene files in the same places.
"""

from __future__ import annotations

import argparse
import csv
import os
import sys
from itertools import product
from pathlib import Path

import gnomon

FIGURES = ["rmse", "max", "p99", "rmse_umbra", "rmse_penumbra", "rmse_lit", "psnr", "ssim", "flip"]
Cell = tuple[str, str, tuple[int, int]]


def measure(cell: Cell, threads: int) -> dict[str, object]:
    """One cell: where it was measured, and what was found."""
    scene, technique, size = cell
    found = gnomon.compare(scene, [technique], size=size, threads=threads)
    result = found.results[0]
    row: dict[str, object] = {"scene": scene, "technique": technique, "size": "%dx%d" % size}
    row |= {name: getattr(result, name) for name in FIGURES}
    row |= {"bytes": result.bytes, **result.frame.hash, "time_ms": result.time_ms}
    row |= {"process": f"{os.uname().nodename}:{os.getpid()}"}
    return row


def over_dask(cells: list[Cell], arguments: argparse.Namespace) -> list[dict[str, object]]:
    """All cells, in their order, by the workers of a cluster."""
    from dask.distributed import Client, LocalCluster

    if arguments.scheduler:
        with Client(arguments.scheduler) as client:
            return client.gather(client.map(measure, cells, threads=arguments.threads))
    local = LocalCluster(
        n_workers=arguments.workers, threads_per_worker=1, dashboard_address=None
    )
    with local, Client(local) as client:
        # Dealt out in turn: a quick cell would otherwise let one worker do it all.
        workers = sorted(client.scheduler_info()["workers"])
        turns = [workers[i % len(workers)] for i in range(len(cells))]
        futures = [
            client.submit(measure, cell, threads=arguments.threads, workers=[worker])
            for cell, worker in zip(cells, turns)
        ]
        return client.gather(futures)


def write(rows: list[dict[str, object]], arguments: argparse.Namespace) -> None:
    """The table; it appears whole or not at all."""
    left_out = {"process"} | (set() if arguments.times else {"time_ms"})
    names = [name for name in rows[0] if name not in left_out]
    part = arguments.out.with_name(f"{arguments.out.name}.{os.getpid()}.part")
    with part.open("w", newline="") as file:
        table = csv.DictWriter(file, names, extrasaction="ignore", lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
    part.replace(arguments.out)


def size(text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    return int(width), int(height)


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("scenes", nargs="+", metavar="SCENE")
    parser.add_argument("--techniques", nargs="+", required=True, metavar="NAME[:KEY=VALUE...]")
    parser.add_argument("--sizes", nargs="+", type=size, default=[(320, 240)], metavar="WxH")
    parser.add_argument("--out", type=Path, default=Path("sweep.csv"), metavar="FILE.csv")
    parser.add_argument("--workers", type=int, default=2, help="processes on this machine")
    parser.add_argument("--threads", type=int, default=1, help="threads of each")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="a cluster that runs already")
    parser.add_argument("--serial", action="store_true", help="without Dask, in this process")
    parser.add_argument("--times", action="store_true", help="write times too")
    return parser.parse_args()


def check(arguments: argparse.Namespace) -> None:
    """A mistake should be found before the hours of work."""
    for scene in arguments.scenes:
        gnomon.Scene(scene)
    for technique in arguments.techniques:
        gnomon.render("cylinder", technique, size=(8, 8))


def main() -> int:
    arguments = parse()
    try:
        check(arguments)
    except (ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    cells = list(product(arguments.scenes, arguments.techniques, arguments.sizes))
    if arguments.serial:
        rows = [measure(cell, arguments.threads) for cell in cells]
    else:
        rows = over_dask(cells, arguments)
    write(rows, arguments)
    processes = len({row["process"] for row in rows})
    by = f"{processes} process{'' if processes == 1 else 'es'}"
    print(f"{len(cells)} cells by {by}: {arguments.out}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
