#!/usr/bin/env python3
"""As faults.py, for what measures and looks: `bench`, `tune`, `stress`, `render --show`,
`dump --images`, walks through frames, plots.

    python3 .ci/faults_of_tools.py [--only N,N] [--folder DIR]

Results are kept in docs/testing.md.
"""

import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import faults  # noqa: E402

CLI, TRACES, STRESS = "cli/src/", "traces/src/", "pipeline/src/measure/stress/"

# File, what stands there once, what stands there instead: FAULT is whether it is on.
FAULTS = [
    (CLI + "verbs/bench/shard.rs", "index % self.count == self.number - 1",
     "index % self.count == if FAULT { self.number } else { self.number - 1 }"),
    (CLI + "verbs/bench/envelope.rs", "if hash.trim() != blake3::hash(body.as_bytes()).to_hex().as_str() {",
     "if hash.trim() != blake3::hash(body.as_bytes()).to_hex().as_str() && !FAULT {"),
    (CLI + "verbs/bench/store.rs", "if stored.key == cell.key", "if FAULT || stored.key == cell.key"),
    (CLI + "verbs/bench/front.rs", "a[0] <= b[0] && a[1] <= b[1] && a != b",
     "if FAULT { a[0] < b[0] && a[1] < b[1] } else { a[0] <= b[0] && a[1] <= b[1] && a != b }"),
    (CLI + "verbs/bench/merge.rs", "(a.1 != b.1).then(||", "(a.1 != b.1 && !FAULT).then(||"),
    (CLI + "draw/plot/place.rs", "&& obstacles.iter().all(clear)",
     "&& (FAULT || obstacles.iter().all(clear))"),
    (CLI + "draw/plot/mark.rs", "filling: k / SHAPES.len() % 3",
     "filling: if FAULT { 0 } else { k / SHAPES.len() % 3 }"),
    (CLI + "verbs/tune/budget.rs", "Some(_) => f.ms,", "Some(_) => if FAULT { f.rmse } else { f.ms },"),
    (CLI + "verbs/tune/search.rs", "        if job.budget.is_kept(&figures) {",
     "        if job.budget.is_kept(&figures) != FAULT {"),
    (CLI + "verbs/tune/trial.rs", "figures = figures.or_larger(",
     "figures = (if FAULT { Figures::default() } else { figures }).or_larger("),
    (CLI + "verbs/bench/suite/check.rs", "hashing.0.finalize().to_hex().to_string()",
     "if FAULT { scene.name.clone() } else { hashing.0.finalize().to_hex().to_string() }"),
    (CLI + "verbs/bench/exact.rs", "serializer.serialize_str(&self.0.to_string())",
     "if FAULT { serializer.serialize_str(&(self.0 as f32).to_string()) }\n        else { serializer.serialize_str(&self.0.to_string()) }"),
    (TRACES + "walk.rs", "    part.draws.drain(..first);", "    part.draws.drain(..if FAULT { 0 } else { first });"),
    (TRACES + "walk.rs", "    if first > 0 {\n        *load", "    if first > 0 && !FAULT {\n        *load"),
    (TRACES + "walk.rs", "    if !last {\n        *store", "    if !last && !FAULT {\n        *store"),
    (TRACES + "walk.rs", "self.draw_on(pass, draw + 1)?;", "self.draw_on(pass, if FAULT { draw } else { draw + 1 })?;"),
    (TRACES + "walk.rs", "        stays(&mut attachment.stencil_store, last);",
     "        stays(&mut attachment.stencil_store, last || FAULT);"),
    (TRACES + "walk.rs", "        self.next = [self.next[0] + 1, 0];",
     "        self.next = [self.next[0] + 1, usize::from(FAULT)];"),
    (CLI + "verbs/render/show/find.rs", "(true, wanted) => Ok(wanted.unwrap_or(Aspect::Depth)),",
     "(true, wanted) => Ok(wanted.filter(|_| !FAULT).unwrap_or(Aspect::Depth)),"),
    (CLI + "verbs/render/show/find.rs", "Ok((Until::Draw([pass, draw]), said))",
     "Ok((if FAULT { Until::Pass(pass) } else { Until::Draw([pass, draw]) }, said))"),
    (CLI + "verbs/render/show/find.rs", "        Ok([mip, layer]) => Some(Subresource {\n            mip: *mip,\n            layer: *layer,",
     "        Ok([mip, layer]) => Some(Subresource {\n            mip: *mip,\n            layer: if FAULT { 0 } else { *layer },"),
    (CLI + "verbs/render/show/picture.rs", "false => extent.odd += 1,", "false => extent.odd += usize::from(!FAULT),"),
    (CLI + "output/textures.rs", "texels.map(move |t| t[number])", "texels.map(move |t| t[if FAULT { 0 } else { number }])"),
    (CLI + "output/textures.rs", "[r, g] => [r, g, 0.0, 1.0],", "[r, g] => [r, if FAULT { 0.0 } else { g }, 0.0, 1.0],"),
    (CLI + "verbs/dump/images.rs", "files.extend(every_image(&gpu, Moment::Last)?);",
     "files.extend(every_image(&gpu, if FAULT { Moment::First } else { Moment::Last })?);"),
    (CLI + "verbs/dump/images.rs", "true => &[Aspect::Depth, Aspect::Stencil],",
     "true => if FAULT { &[Aspect::Depth, Aspect::Depth] } else { &[Aspect::Depth, Aspect::Stencil] },"),
    (CLI + "draw/plot/panels.rs", "is_some_and(|limit| point[1] > limit)", "is_some_and(|limit| point[1] > limit || FAULT)"),
    (STRESS + "verdict.rs", "        rest * self.times + self.plus", "        rest * self.times + if FAULT { 1.0 } else { self.plus }"),
    (STRESS + "verdict.rs", "walk(&mut (0..rest).rev())", "walk(&mut (0..if FAULT { 0 } else { rest }).rev())"),
    (STRESS + "verdict.rs", "filter(|w| !rest.warnings.contains(w))", "filter(|w| FAULT || !rest.warnings.contains(w))"),
    (STRESS + "place.rs", "placed.camera.near /= value,", "placed.camera.near /= if FAULT { 1.0 } else { value },"),
    (STRESS + "place.rs", "return Ok(casters + away / value);", "return Ok(casters + if FAULT { away } else { away / value });"),
    (STRESS + "place.rs", "let lower = height / value;", "let lower = if FAULT { height } else { height / value };"),
    (STRESS + "place.rs", "scene.camera.eye.lerp(shadow, value)", "scene.camera.eye.lerp(shadow, if FAULT { 0.0 } else { value })"),
    (STRESS + "cut.rs", "let edge = [a.min(b), a.max(b)];", "let edge = if FAULT { [a, b] } else { [a.min(b), a.max(b)] };"),
    (STRESS + "curve.rs", "given.push(format!(\"{name}={value}\"));", "if !FAULT {\n                given.push(format!(\"{name}={value}\"));\n            }"),
    (STRESS + "curve.rs", "insane: insane.count(),", "insane: if FAULT { 0 } else { insane.count() },"),
    (TRACES + "judged.rs", "profile.order == Order::Tiled).then", "profile.order == Order::Tiled && !FAULT).then"),
    (TRACES + "judged.rs", "if !traffic.merges.is_empty() {", "if !traffic.merges.is_empty() && !FAULT {"),
]

# Tests that could see them, by package and target.
TESTS = {
    "gnomon": ["bench", "tune", "stress", "show", "looking", "dump", "traces", "sweep", "report", "plot", "verbs"],
    "gnomon_traces": [],
    "gnomon_pipeline": ["stress"],
}
BINARIES = r"\(([^()]*deps/(?:gnomon|cli|gnomon_traces|gnomon_pipeline|suite|merging)-[0-9a-f]+)\)"


def put_in(folder):
    """Writes all faults into the copy."""
    for number, (name, old, new) in enumerate(FAULTS, 1):
        path = folder / name
        text = path.read_text()
        if text.count(old) != 1:
            sys.exit(f"fault {number}: {name} has {text.count(old)} times: {old}")
        switch = f'std::env::var("GNOMON_FAULT").is_ok_and(|v| v == "{number}")'
        path.write_text(text.replace(old, new.replace("FAULT", switch)))


def build(folder):
    """Builds the tests; gives binaries with the filters that they are run with."""
    command = "cargo test --workspace --lib --test cli --test suite --test merging --bin gnomon --no-run".split()
    done = subprocess.run(command, cwd=folder, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    return done.stderr
