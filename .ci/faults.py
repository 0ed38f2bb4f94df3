#!/usr/bin/env python3
"""Switches faults on, one after the other, and says which tests see them.

    python3 .ci/faults.py [--list baselines|thesis|maps|tools|lines|scenes] [--only N,N] [--folder DIR]

A copy of the tree gets all faults at once, each behind a number that the environment
variable GNOMON_FAULT chooses; so it is built once (ten minutes on two cores) and each fault
costs the tests that could see it until one does (seconds, or a few minutes). Fault 0 is none: all
tests must pass. A fault that no test sees is an error (exit code 1).
The lists are in .ci/fault_lists/, results in docs/testing.md.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

sys.dont_write_bytecode = True  # beside the lists
from fault_lists import baselines, lines, maps, scenes, thesis, tools  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent
SHADERS = "shaders-rs/src/"
LISTS = {"baselines": baselines.FAULTS, "thesis": thesis.FAULTS, "maps": maps.FAULTS,
         "tools": tools.FAULTS, "lines": lines.FAULTS, "scenes": scenes.FAULTS}
FAULTS = [fault for faults in LISTS.values() for fault in faults]

SWITCH = """
#[doc(hidden)]
pub fn fault(n: u32) -> bool {
    static ON: std::sync::OnceLock<u32> = std::sync::OnceLock::new();
    let read = || std::env::var("GNOMON_FAULT").ok()?.parse().ok();
    *ON.get_or_init(|| read().unwrap_or(0)) == n
}
"""


def faulty():
    """Text of each file with all its faults, by name."""
    library = SHADERS + "lib.rs"
    texts = {library: (ROOT / library).read_text() + SWITCH}
    for number, (_, name, old, new, _) in enumerate(FAULTS, 1):
        text = texts.get(name) or (ROOT / name).read_text()
        if text.count(old) != 1:
            sys.exit(f"fault {number}: {name} has {text.count(old)} times: {old}")
        texts[name] = text.replace(old, new.replace("FAULT", switch(name, number)))
    return texts


def copy(folder):
    """Copies the tree with all faults; what is there already stays, so that a folder that is
    kept is built again in parts only."""
    texts = faulty()
    own = {str(ROOT / name) for name in texts}
    shutil.copytree(ROOT, folder, dirs_exist_ok=True,
                    copy_function=lambda a, b: a in own or shutil.copy2(a, b),
                    ignore=shutil.ignore_patterns("target", ".git", "out", "__pycache__"))
    for name, text in texts.items():
        path = folder / name
        if not path.exists() or path.read_text() != text:
            path.write_text(text)


def switch(name, number):
    """Whether the fault is on, as code in that file."""
    if name.startswith(SHADERS):
        return f"crate::fault({number})"
    if name.startswith("traces/"):  # It knows no shaders; nothing of it is asked often.
        return f'std::env::var("GNOMON_FAULT").is_ok_and(|n| n == "{number}")'
    return f"gnomon_shaders::fault({number})"


def build(folder):
    """Builds the tests; gives the binaries by package and target."""
    # The program too: with it dependencies have the features that whole builds give them.
    packages = [f"-pgnomon{end}" for end in ("", "-pipeline", "-traces")]
    targets = "--lib --test suite --test cli --test merging --test difference --bin gnomon".split()
    command = ["cargo", "test", *packages, *targets, "--no-run", "--message-format=json"]
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    messages = [json.loads(line) for line in done.stdout.splitlines()]
    made = [m for m in messages if m.get("executable") and m["profile"]["test"]]
    package = {str(folder / "cli"): "gnomon", str(folder / "pipeline"): "gnomon-pipeline",
               str(folder / "traces"): "gnomon-traces"}
    def key(m):
        target = m["target"]
        home = str(Path(m["manifest_path"]).parent)
        return package[home], "lib" if "lib" in target["kind"] else target["name"]
    return {key(m): m["executable"] for m in made if "bin" not in m["target"]["kind"]}


def first_failure(folder, binaries, test, number):
    """The first of the tests that fails, if one does; the rest is not waited for."""
    package, target, wanted = test
    environment = {**os.environ, "GNOMON_FAULT": str(number)}
    home = folder / {"gnomon": "cli"}.get(package, package.removeprefix("gnomon-"))
    running = subprocess.Popen([binaries[package, target], wanted], cwd=home, env=environment,
                               stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    stop = threading.Timer(900, running.kill)
    stop.start()
    try:
        for line in running.stdout:
            failed = re.match(r"test (\S+).* \.\.\. FAILED", line)
            if failed:
                return failed[1]
        running.wait()
        return f"{wanted}: ends with {running.returncode}" if running.returncode else None
    finally:
        stop.cancel()
        running.kill()
        running.wait()


def tests_of(fault):
    """Package, target and words of all tests that could see a fault, group by group."""
    tests = fault[4]
    if isinstance(tests, list):
        return tests
    of_suite, beside = tests
    return [("gnomon-pipeline", "lib", w) for w in beside] + [("gnomon-pipeline", "suite", w) for w in of_suite]


def failure(folder, binaries, number, tests):
    """The first that fails of them."""
    found = (first_failure(folder, binaries, test, number) for test in tests)
    return next((f for f in found if f), None)


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
        tests = tests_of(FAULTS[number - 1])
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
    copy(folder)
    binaries = build(folder)
    unseen = []
    runs = ([] if 0 in numbers else groups_of(numbers))
    runs += [(n, tests_of(FAULTS[max(n, 1) - 1])) for n in numbers]
    print("| fault | in | a test that fails |\n| ---: | --- | --- |")
    for number, tests in runs:
        failed = failure(folder, binaries, number, tests)
        what, name, *_ = FAULTS[number - 1] if number else ("", "none")
        where = f"{what}: `{name}`" if what else f"`{name}`"
        shown = f"`{failed}`" if failed else "**none**" if number else "none, as it should"
        print(f"| {number} | {where} | {shown} |", flush=True)
        if bool(failed) != bool(number):
            unseen.append(number)
    if not given.folder:
        shutil.rmtree(folder)
    sys.exit(f"not as it should: {unseen}" if unseen else 0)


if __name__ == "__main__":
    main()
