"""Defaults beside the papers' forms, as a table: python3 defaults.py BENCH.CSV

Of each technique and scene what `gnomon bench docs/accuracy/defaults.toml` measured of both:
RMSE and FLIP against the exact truth, megabytes moved, milliseconds to build a frame and to
draw it. The last rows are geometric means over scenes.
"""

import csv
import math
import sys

FIGURES = [
    ("rmse", "RMSE", "{:.4f}", 1),
    ("flip", "FLIP", "{:.4f}", 1),
    ("bytes", "MB", "{:.1f}", 1e-6),
    ("build_ms", "build ms", "{:.1f}", 1),
    ("frame_ms", "frame ms", "{:.1f}", 1),
]


def main(path):
    with open(path, newline="") as file:
        rows = [r for r in csv.DictReader(file) if r["status"] == "measured"]
    both = {}
    for row in rows:
        published = "horizon=off" in row["settings"]
        pair = both.setdefault(row["technique"], {}).setdefault(row["scene"], {})
        pair[published] = row
    heads = [head for _, head, _, _ in FIGURES]
    print("| technique | scene | " + " | ".join(heads) + " |")
    print("| --- | --- |" + " --- |" * len(heads))
    for technique, scenes in both.items():
        pairs = [p for p in scenes.values()]
        for scene, pair in scenes.items():
            print(line(technique, scene, [pair]))
        if len(pairs) > 1:
            print(line(technique, "**all**", pairs))


def line(technique, scene, pairs):
    cells = [cell(pairs, *figure) for figure in FIGURES]
    return f"| {technique} | {scene} | " + " | ".join(cells) + " |"


def cell(pairs, key, _, form, scale):
    def mean(published):
        values = [float(p[published][key]) * scale for p in pairs if published in p]
        if not values:
            return None
        if min(values) <= 0:
            return sum(values) / len(values)
        return math.exp(sum(map(math.log, values)) / len(values))

    found = [mean(published) for published in (True, False)]
    return " → ".join(form.format(v) for v in found if v is not None)


if __name__ == "__main__":
    main(sys.argv[1])
