//! What there is to know about a fragment, and a line for the debugger.

use gnomon_raster::shader::ShaderIdentity;
use gnomon_traces::history::{Debug, DebugStage, FragmentEvent};

use super::args::DebugArgs;
use crate::error::CliError;
use crate::output;
use crate::verbs::pixel::{PlaceArgs, Shown, float};

/// Prints it.
pub(crate) fn run(args: &DebugArgs) -> Result<(), CliError> {
    let shown = Shown::new(&args.place)?;
    let debug = shown
        .history
        .debug(&shown.recording, &shown.options, args.event)?;
    let (event, fragment) = shown.history.fragment(args.event)?;
    let mut text = format!(
        "event {}: pass {} `{}`, draw {} `{}`, primitive {}, {}\n",
        args.event,
        event.pass,
        event.pass_label,
        fragment.draw,
        fragment.label,
        fragment.primitive,
        if fragment.front { "front" } else { "back" },
    );
    text += &vertices(&debug);
    text += &stage("vertex shader", &debug.vertex);
    match &debug.fragment {
        Some(s) => text += &stage("fragment shader", s),
        None => text += "\nno fragment shader\n",
    }
    text += &values(fragment);
    text += &line(&args.place, &debug);
    output::print(&text)
}

fn vertices(debug: &Debug) -> String {
    let mut text = format!("\ninstance {}, vertices in clip space\n", debug.instance);
    for v in &debug.vertices {
        let [x, y, z, w] = v.position;
        text += &format!("  {}: {x} {y} {z} {w}\n", v.number);
    }
    text
}

/// Floats of uniforms in a line.
const FLOATS: usize = 4;
/// Lines of uniforms that are shown: tables may have thousands.
const LINES: usize = 64;

fn stage(what: &str, s: &DebugStage) -> String {
    let mut text = format!("\n{what} {}\n", s.type_name);
    match &s.identity {
        Some(identity) => text += &uniforms(identity),
        None => text += "  a closure: it has no name, and what it holds cannot be told\n",
    }
    text
}

/// The uniforms' bytes, four at a time as floats.
fn uniforms(identity: &ShaderIdentity) -> String {
    let bytes = &identity.uniforms;
    let mut text = format!(
        "  {} version {}, {} bytes of uniforms, as floats:\n",
        identity.name,
        identity.version,
        bytes.len()
    );
    let (words, rest) = bytes.as_chunks::<4>();
    let lines = words.chunks(FLOATS);
    let hidden = lines.len().saturating_sub(LINES);
    for line in lines.take(LINES) {
        let floats = line.iter().map(|w| float(u32::from_le_bytes(*w)));
        text += &format!("    {}\n", floats.collect::<Vec<_>>().join(" "));
    }
    if hidden > 0 {
        text += &format!("    and {hidden} more lines\n");
    }
    if !rest.is_empty() {
        text += &format!("    and the bytes {rest:?}\n");
    }
    text
}

fn values(f: &FragmentEvent) -> String {
    let mut text = String::new();
    if let Some(v) = &f.varyings {
        let floats: Vec<_> = v.iter().map(|v| float(*v)).collect();
        text += &format!("\nvaryings {}\n", floats.join(" "));
    }
    for (i, c) in f.outputs.iter().flatten().enumerate() {
        text += &format!("output {i} {}\n", c.map(float).join(" "));
    }
    text
}

/// The command line of a debugger that stops at the fragment. One thread, so that it
/// stops there first.
fn line(place: &PlaceArgs, debug: &Debug) -> String {
    let mut text = String::from(match debug.is_run {
        true => "\nto stop in the shader, at the packet of 8x2 fragments:\n",
        false => "\nthe shader is not run for this fragment; to stop where the fragment comes:\n",
    });
    text += "  rust-gdb";
    for command in &debug.commands {
        text += &format!(" -ex '{command}'");
    }
    text += &format!(
        " --args gnomon pixel {} {} {} --frame {} --threads 1 --tile {} --simd {}",
        quoted(&place.trace.display().to_string()),
        place.x,
        place.y,
        place.frame,
        place.gpu.tile,
        place.gpu.simd.name(),
    );
    if place.gpu.no_skip {
        text += " --no-skip";
    }
    if let Some(image) = &place.image {
        text += &format!(" --image {}", quoted(image));
    }
    text.push('\n');
    text
}

/// For a shell, where it needs to be.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_./:".contains(c);
    match !word.is_empty() && word.chars().all(is_plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
}
