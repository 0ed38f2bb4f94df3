"""A sweep over Dask has the results of one process."""

from __future__ import annotations

import csv
import subprocess
import sys

from conftest import ROOT

SCRIPT = ROOT / "docs/bench/dask_sweep.py"
CELLS = [
    "cylinder", "parallel-plates",
    "--techniques", "pcss:samples=4", "pcss:samples=16", "shadow-volumes",
    "--sizes", "32x24", "48x32",
]  # fmt: skip


def sweep(folder, name, *flags):
    out = folder / name
    words = [sys.executable, SCRIPT, *CELLS, *flags, "--out", out]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return out.read_bytes(), done.stderr


def test_two_workers_give_what_one_process_gives(tmp_path):
    alone, told = sweep(tmp_path, "alone.csv", "--serial")
    assert "12 cells by 1 process" in told
    both, told = sweep(tmp_path, "both.csv", "--workers", "2")
    assert "12 cells by 2 processes" in told
    assert both == alone
    rows = list(csv.DictReader(alone.decode().splitlines()))
    assert len(rows) == 2 * 3 * 2 and len({row["color"] for row in rows}) == 12
    assert all(float(row["rmse"]) >= 0.0 for row in rows)


def test_mistakes_end_before_the_work(tmp_path):
    words = [sys.executable, SCRIPT, "cylinder", "--techniques", "pcsss", "--serial"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 2 and "did you mean 'pcss'" in done.stderr
    assert list(tmp_path.iterdir()) == []
