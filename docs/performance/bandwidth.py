#!/usr/bin/env python3
"""What shadow techniques move under every profile of hardware, as Markdown.

    cargo build --release && python3 docs/performance/bandwidth.py > docs/bandwidth-tables.md

The environment variable GNOMON names another program than target/release/gnomon: its bytes
are the same, whatever it was built with.

Each frame is recorded once (640x400, colours in rgba8, which every profile can blend) and
judged without being drawn again. Same program, same figures: nothing here is timed.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
GNOMON = os.environ.get("GNOMON", ROOT / "target/release/gnomon")
SCENES = ["demo", "spheres", "columns"]
TECHNIQUES = [
    ("unshadowed", []),
    ("shadow-volumes", ["method=zpass"]),
    ("shadow-volumes", ["method=zfail"]),
    ("shadow-map", []),
    ("pcf", []),
    ("pcss", []),
    ("convolution-soft-shadows", []),
    ("penumbra-wedges", []),
    ("soft-shadow-volumes", []),
]
PROFILES = ["naive", "compulsory", "gnomon", "imr-2003", "imr-2008", "tbr-mali", "tbr-adreno"]
TILERS = {"tbr-mali", "tbr-adreno"}


def run(arguments):
    done = subprocess.run([GNOMON, *arguments], capture_output=True, text=True, check=False)
    if done.returncode:
        return None, done.stderr.strip()
    return done.stdout, None


def total(trace, profile, merged=False):
    flags = ["--per-pass-merged"] if merged else []
    text, error = run(["traffic", trace, "--profile", profile, "--by", "client", "--json", *flags])
    if error:
        return None
    document = json.loads(text)
    document = document[-1] if isinstance(document, list) else document
    bytes_of = lambda level: sum(document["totals"][level].values())
    return bytes_of("dram"), bytes_of("logical")


def mb(value):
    return "—" if value is None else f"{value / 1e6:.2f}"


def row(name, trace):
    cells = []
    logical = None
    for profile in PROFILES:
        found = total(trace, profile)
        cells.append(mb(found and found[0]))
        if profile == "gnomon":
            logical = found and found[1]
        if profile in TILERS:
            merged = total(trace, profile, merged=True)
            cells.append(mb(merged and merged[0]))
    print(f"| {name} | {mb(logical)} | " + " | ".join(cells) + " |")


def main():
    heads = ["technique", "logical"]
    for profile in PROFILES:
        heads.append(profile)
        if profile in TILERS:
            heads.append("merged")
    for scene in SCENES:
        print(f"\n### `{scene}`, MB a frame\n")
        print("| " + " | ".join(heads) + " |")
        print("| --- |" + " ---: |" * (len(heads) - 1))
        for technique, settings in TECHNIQUES:
            with tempfile.TemporaryDirectory() as folder:
                trace = str(pathlib.Path(folder) / "f.gnt")
                flags = [f for s in settings for f in ("--set", s)]
                command = ["record", scene, "--technique", technique, "--size", "640x400"]
                command += ["--set", "color-format=rgba8", *flags, "--out", trace]
                _, error = run(command)
                name = technique + "".join(f" {s.split('=')[1]}" for s in settings)
                if error:
                    print(f"{name} on {scene}: {error}", file=sys.stderr)
                    continue
                row(name, trace)


main()
