#!/usr/bin/env python3
"""Switches faults on, one after the other, and says which tests see them.

    python3 .ci/faults.py [--only N,N] [--folder DIR]

A copy of the tree gets all faults at once, each behind a number that the environment
variable GNOMON_FAULT chooses; so it is built once (ten minutes on two cores) and each fault
costs one run of the tests that could see it (a minute and a half). Fault 0 is none: all
tests must pass. A fault that no test sees is an error (exit code 1).
Results are kept in docs/testing.md.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SHADERS, PIPELINE = "shaders-rs/src/", "pipeline/src/"
TECHNIQUES = PIPELINE + "techniques/"

# File, what stands there once, what stands there instead: FAULT is whether it is on.
FAULTS = [
    (SHADERS + "deferred/obscured.rs", "Combine::Product => one - visible,",
     "Combine::Product => if FAULT { most } else { one - visible },"),
    (SHADERS + "deferred/obscured.rs", "let lost = f.varying(6) * hidden;",
     "let lost = if FAULT { hidden } else { f.varying(6) * hidden };"),
    (SHADERS + "deferred/obscured.rs", "self.shininess) * std::f32::consts::FRAC_1_PI;",
     "self.shininess) * if FAULT { 1.0 } else { std::f32::consts::FRAC_1_PI };"),
    (SHADERS + "deferred/obscured.rs", "let lost = highlight.reflected(l, f) * f.varying(7) * hidden;",
     "let lost = highlight.reflected(l, f) * hidden;\n            let lost = if FAULT { lost } else { lost * f.varying(7) };"),
    (SHADERS + "deferred/obscured.rs", "let before = w.gt(zero) & affine(position, self.below).gt(zero);",
     "let before = if FAULT { w.gt(zero) } else { w.gt(zero) & affine(position, self.below).gt(zero) };"),
    (SHADERS + "deferred/obscured.rs", "let sum = sum.min(one);",
     "let sum = if FAULT { sum } else { sum.min(one) };"),
    (SHADERS + "cones/mod.rs", "/ self.light * weight, zero)",
     "/ self.light * if FAULT { 1.0 } else { weight }, zero)"),
    (SHADERS + "cones/mod.rs", "[one - hidden.min(one), zero, zero, zero]",
     "[one - if FAULT { hidden } else { hidden.min(one) }, zero, zero, zero]"),
    (SHADERS + "cones/disc.rs", ".min(all) + HALF_DIAGONAL",
     ".min(all) + if FAULT { 0.0 } else { HALF_DIAGONAL }"),
    (SHADERS + "cones/bounds.rs", "there.select_f32(high[i].max(top[i]), high[i])",
     "there.select_f32(if FAULT { top[i] } else { high[i].max(top[i]) }, high[i])"),
    (SHADERS + "smoothies.rs", "background.select_f32(one, ratio)",
     "if FAULT { one } else { background.select_f32(one, ratio) }"),
    (SHADERS + "smoothies.rs", "smoothie.lt(reference).select_f32(alpha, one)",
     "(if FAULT { smoothie.gt(reference) } else { smoothie.lt(reference) }).select_f32(alpha, one)"),
    (SHADERS + "smoothies.rs", "reference)) * (x * y);",
     "reference)) * if FAULT { x * x } else { x * y };"),
    (SHADERS + "shadow_rays.rs", "let before = along.gt(zero) & along.lt(self.end);",
     "let before = if FAULT { along.gt(zero) } else { along.gt(zero) & along.lt(self.end) };"),
    (SHADERS + "shadow_rays.rs", "let step = behind.select_f32(step, -step);",
     "let step = if FAULT { step } else { behind.select_f32(step, -step) };"),
    (SHADERS + "moments/bound.rs", "let second = second - factor * third;",
     "let second = if FAULT { second + factor * third } else { second - factor * third };"),
    (SHADERS + "backprojection/cover.rs", "(high.clamp(-1.0, 1.0) - low.clamp(-1.0, 1.0)).max(zero)",
     "if FAULT { (high - low).max(zero) } else { (high.clamp(-1.0, 1.0) - low.clamp(-1.0, 1.0)).max(zero) }"),
    (SHADERS + "backprojection/cover.rs", "row.lt(rows[1])",
     "if FAULT { row.le(rows[1]) } else { row.lt(rows[1]) }"),
    (SHADERS + "backprojection/cover.rs", "(halves + (halves >> 16)) & splat(0x3f)",
     "(if FAULT { halves } else { halves + (halves >> 16) }) & splat(0x3f)"),
    (TECHNIQUES + "moment_maps/tables.rs", "FixedPoint::of_box(most_texels(reads.as_ref(), side))",
     "FixedPoint::of_box(if FAULT { 1 } else { most_texels(reads.as_ref(), side) })"),
    (TECHNIQUES + "ray_traced/hierarchy.rs", "self.nodes[number].next = self.nodes.len() as u32;",
     "self.nodes[number].next = self.nodes.len() as u32 + u32::from(part.len() == 1 && FAULT);"),
    (TECHNIQUES + "backprojection/pyramid.rs", "|mip| LeastOfFour { mip }.stage(),",
     "|mip| if FAULT { CopyLevel { textures: 1, mip }.stage() } else { LeastOfFour { mip }.stage() },"),
    (TECHNIQUES + "heckbert_herf/counting.rs", "stencil_reference: [reference; 2],",
     "stencil_reference: [if FAULT { reference.min(9) } else { reference }; 2],"),
    (TECHNIQUES + "backprojection/mod.rs", "GapFilling::Fill => Gaps::Filled,",
     "GapFilling::Fill => if FAULT { Gaps::Left } else { Gaps::Filled },"),
    (TECHNIQUES + "deferred_shadowing/placing.rs", "let square = distance * source.solid_angle(centre).sqrt();",
     "let square = distance * if FAULT { source.solid_angle(centre) } else { source.solid_angle(centre).sqrt() };"),
    (TECHNIQUES + "deferred_shadowing/bodies.rs", "self.turn.transpose() * direction",
     "(if FAULT { self.turn } else { self.turn.transpose() }) * direction"),
    (TECHNIQUES + "deferred_shadowing/bodies.rs", "Rotation::new(&self.turn.transpose(), bands)",
     "Rotation::new(&if FAULT { self.turn } else { self.turn.transpose() }, bands)"),
    (PIPELINE + "truth/oracle/transport/mod.rs", "diffuse.iter_mut().for_each(|c| *c /= std::f64::consts::PI);",
     "if !FAULT { diffuse.iter_mut().for_each(|c| *c /= std::f64::consts::PI); }"),
    (PIPELINE + "truth/oracle/transport/mod.rs", "let buried = buried::replace(&mut all, object.triangles);",
     "let buried = if FAULT { 0 } else { buried::replace(&mut all, object.triangles) };"),
    (TECHNIQUES + "deferred_shadowing/radiance.rs", "let of = |c: usize| LUMINANCE[c]",
     "let of = |c: usize| LUMINANCE[if FAULT { 2 - c } else { c }]"),
    (TECHNIQUES + "deferred_shadowing/placing.rs", "below: (-towards).extend(top),",
     "below: (-towards).extend(if FAULT { low } else { top }),"),
    (TECHNIQUES + "cone_culling/samples.rs", "let weight = 1.0 / (f64::from(count) * density.at(radius));",
     "let weight = if FAULT { PI / f64::from(count) } else { 1.0 / (f64::from(count) * density.at(radius)) };"),
    (TECHNIQUES + "smoothies/attached.rs", "LightShape::Disc { radius, .. } => radius,",
     "LightShape::Disc { radius, .. } => if FAULT { 2.0 * radius } else { radius },"),
]

SWITCH = """
#[doc(hidden)]
pub fn fault(n: u32) -> bool {
    static ON: std::sync::OnceLock<u32> = std::sync::OnceLock::new();
    let read = || std::env::var("GNOMON_FAULT").ok()?.parse().ok();
    *ON.get_or_init(|| read().unwrap_or(0)) == n
}
"""
SUITE = ("backprojection cone_culling deferred moment map_support ray_traced planar smoothies "
         "settings_effect").split()
UNITS = "cone smoothie moment deferred transport harmonic ray_traced backproj planar heckbert samples".split()


def put_in(folder):
    """Writes all faults into the copy."""
    library = folder / SHADERS / "lib.rs"
    library.write_text(library.read_text() + SWITCH)
    for number, (name, old, new) in enumerate(FAULTS, 1):
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


def failures(folder, binaries, number):
    """Names of the tests that fail."""
    units, suite = binaries
    failed = []
    for binary, wanted in [(suite, SUITE), (units, UNITS)]:
        environment = {**os.environ, "GNOMON_FAULT": str(number)}
        command = [binary, *wanted]
        try:
            done = subprocess.run(command, cwd=folder / "pipeline", env=environment, timeout=600,
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
            failed += re.findall(r"^test (\S+) \.\.\. FAILED", done.stdout, re.M)
        except subprocess.TimeoutExpired:
            failed.append(f"{binary.name}: no end")
    return failed


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", help="numbers, separated by commas")
    parser.add_argument("--folder", help="where the copy goes; kept")
    given = parser.parse_args()
    numbers = [int(n) for n in given.only.split(",")] if given.only else range(len(FAULTS) + 1)
    folder = Path(given.folder or tempfile.mkdtemp(prefix="gnomon-faults-"))
    shutil.copytree(ROOT, folder, dirs_exist_ok=True,
                    ignore=shutil.ignore_patterns("target", ".git", "out"))
    put_in(folder)
    binaries = build(folder)
    unseen = []
    print("| fault | in | tests that fail |\n| ---: | --- | --- |")
    for number in numbers:
        failed = failures(folder, binaries, number)
        name = FAULTS[number - 1][0] if number else "none"
        shown = ", ".join(f"`{f}`" for f in failed[:3]) + (f" and {len(failed) - 3} more" if failed[3:] else "")
        print(f"| {number} | {name} | {shown or '**none**' if number else shown or 'none, as it should'} |",
              flush=True)
        if bool(failed) != bool(number):
            unseen.append(number)
    if not given.folder:
        shutil.rmtree(folder)
    sys.exit(f"not as it should: {unseen}" if unseen else 0)


if __name__ == "__main__":
    main()
