//! The parts of a draw that can differ by themselves: each can be shown, and be put from
//! one draw into another.

use std::collections::BTreeMap;
use std::sync::Arc;

use gnomon_raster::shader::ShaderIdentity;
use gnomon_raster::{Draw, RenderPass, RenderPipeline};

/// A part of a draw.
pub(super) struct Facet {
    pub(super) name: &'static str,
    /// It is code, or what code is given.
    pub(super) shader: bool,
    show: fn(&Draw) -> String,
    put: fn(&mut Draw, &Draw),
    /// Where data differ first.
    locate: fn(&Draw, &Draw) -> Option<String>,
}

fn nowhere(_: &Draw, _: &Draw) -> Option<String> {
    None
}

impl Facet {
    /// What it is in both, where it differs.
    pub(super) fn compare(&self, a: &Draw, b: &Draw) -> Option<[String; 2]> {
        let shown = [(self.show)(a), (self.show)(b)];
        (shown[0] != shown[1]).then_some(shown)
    }

    /// Where it differs first, of what is data.
    pub(super) fn locate(&self, a: &Draw, b: &Draw) -> Option<String> {
        (self.locate)(a, b)
    }

    /// Makes it in `to` what it is in `from`.
    pub(super) fn put(&self, to: &mut Draw, from: &Draw) {
        (self.put)(to, from);
    }
}

/// Parts of the pipeline, which draws share.
fn pipeline(draw: &mut Draw) -> &mut RenderPipeline {
    Arc::make_mut(&mut draw.pipeline)
}

macro_rules! of_pipeline {
    ($($field:ident).+) => {
        Facet {
            name: stringify!($($field).+),
            shader: false,
            show: |d| format!("{:?}", d.pipeline.$($field).+),
            put: |to, from| pipeline(to).$($field).+ = from.pipeline.$($field).+.clone(),
            locate: nowhere,
        }
    };
}

macro_rules! of_draw {
    ($field:ident) => {
        Facet {
            name: stringify!($field),
            shader: false,
            show: |d| format!("{:?}", d.$field),
            put: |to, from| to.$field = from.$field.clone(),
            locate: nowhere,
        }
    };
}

/// All parts. A draw in which each is as in another is that other draw, labels apart.
pub(super) const FACETS: &[Facet] = &[
    of_pipeline!(primitive.topology),
    of_pipeline!(primitive.front_face),
    of_pipeline!(primitive.cull_mode),
    of_pipeline!(primitive.depth_clamp),
    of_pipeline!(primitive.clip_planes),
    of_pipeline!(primitive.line_width),
    of_pipeline!(primitive.point_size),
    of_pipeline!(depth_stencil.depth.compare),
    of_pipeline!(depth_stencil.depth.write),
    of_pipeline!(depth_stencil.depth.bounds),
    of_pipeline!(depth_stencil.stencil.front.compare),
    of_pipeline!(depth_stencil.stencil.front.fail_op),
    of_pipeline!(depth_stencil.stencil.front.depth_fail_op),
    of_pipeline!(depth_stencil.stencil.front.pass_op),
    of_pipeline!(depth_stencil.stencil.front.read_mask),
    of_pipeline!(depth_stencil.stencil.front.write_mask),
    of_pipeline!(depth_stencil.stencil.back.compare),
    of_pipeline!(depth_stencil.stencil.back.fail_op),
    of_pipeline!(depth_stencil.stencil.back.depth_fail_op),
    of_pipeline!(depth_stencil.stencil.back.pass_op),
    of_pipeline!(depth_stencil.stencil.back.read_mask),
    of_pipeline!(depth_stencil.stencil.back.write_mask),
    of_pipeline!(depth_stencil.bias.constant),
    of_pipeline!(depth_stencil.bias.slope),
    of_pipeline!(depth_stencil.bias.clamp),
    of_pipeline!(color_targets),
    Facet {
        name: "vertex shader",
        shader: true,
        show: |d| shader(d.pipeline.vertex.identity()),
        put: |to, from| pipeline(to).vertex = from.pipeline.vertex.clone(),
        locate: |a, b| {
            differing_uniform(a.pipeline.vertex.identity(), b.pipeline.vertex.identity())
        },
    },
    Facet {
        name: "fragment shader",
        shader: true,
        show: |d| match &d.pipeline.fragment {
            Some(stage) => shader(stage.identity()),
            None => "none".to_owned(),
        },
        put: |to, from| pipeline(to).fragment = from.pipeline.fragment.clone(),
        locate: |a, b| {
            let identity = |d: &Draw| d.pipeline.fragment.as_ref()?.identity();
            differing_uniform(identity(a), identity(b))
        },
    },
    Facet {
        name: "vertices",
        shader: false,
        show: |d| {
            d.vertices
                .as_ref()
                .map_or_else(none, |v| floats(&v.data, v.stride))
        },
        put: |to, from| to.vertices = from.vertices.clone(),
        locate: differing_vertex,
    },
    Facet {
        name: "indices",
        shader: false,
        show: |d| {
            let words = d.indices.as_ref().map(|i| i.indices());
            words.map_or_else(none, |w| {
                format!("{} indices, {}", w.len(), digest(w.iter().copied()))
            })
        },
        put: |to, from| to.indices = from.indices.clone(),
        locate: differing_index,
    },
    of_draw!(first),
    of_draw!(count),
    of_draw!(instances),
    of_draw!(stencil_reference),
    of_draw!(blend_constant),
    of_draw!(viewport),
    of_draw!(scissor),
    of_draw!(textures),
];

fn none() -> String {
    "none".to_owned()
}

fn floats(data: &[f32], stride: usize) -> String {
    let vertices = data.len().checked_div(stride).unwrap_or(0);
    format!(
        "{vertices} vertices of {stride} floats, {}",
        digest(data.iter().map(|v| v.to_bits()))
    )
}

/// The first half of blake3 over little-endian words.
fn digest(words: impl Iterator<Item = u32>) -> String {
    let mut hasher = blake3::Hasher::new();
    words.for_each(|w| {
        hasher.update(&w.to_le_bytes());
    });
    hasher.finalize().to_hex()[..16].to_owned()
}

/// Name, version and uniforms: floats as far as the bytes are some.
fn shader(identity: Option<ShaderIdentity>) -> String {
    let Some(ShaderIdentity {
        name,
        version,
        uniforms,
    }) = identity
    else {
        return "without identity".to_owned();
    };
    format!("{name} {version} ({})", uniform_text(&uniforms))
}

/// Uniforms beyond this many bytes are told by their digest alone.
const SHOWN: usize = 256;

fn uniform_text(bytes: &[u8]) -> String {
    let (words, rest) = bytes.as_chunks::<4>();
    if bytes.len() > SHOWN {
        let hash = blake3::hash(bytes).to_hex();
        return format!("{} bytes, {}", bytes.len(), &hash[..16]);
    }
    let words = words.iter().map(|w| word_text(*w));
    let rest = rest.iter().map(|b| format!("{b:#04x}"));
    words.chain(rest).collect::<Vec<_>>().join(" ")
}

/// A float, unless it would be none that anybody writes.
fn word_text(word: [u8; 4]) -> String {
    let float = f32::from_le_bytes(word);
    if float == 0.0 && float.is_sign_positive() || (1e-12..1e12).contains(&float.abs()) {
        return format!("{float:?}");
    }
    format!("{:#010x}", u32::from_le_bytes(word))
}

/// What a pass does to its attachments at both ends, by name.
pub(super) fn pass_parts(pass: &RenderPass) -> BTreeMap<String, String> {
    let color = pass.color.iter().enumerate();
    let mut parts: BTreeMap<_, _> = color
        .map(|(i, a)| (format!("color[{i}]"), format!("{a:?}")))
        .collect();
    if let Some(depth) = &pass.depth_stencil {
        parts.insert("depth_stencil".to_owned(), format!("{depth:?}"));
    }
    parts
}

/// The first word that differs, of shaders that are otherwise the same.
fn differing_uniform(a: Option<ShaderIdentity>, b: Option<ShaderIdentity>) -> Option<String> {
    let (a, b) = (a?, b?);
    if (&a.name, a.version) != (&b.name, b.version) {
        return None;
    }
    let (a, b) = (a.uniforms, b.uniforms);
    let at = a.iter().zip(&b).position(|(x, y)| x != y)? & !3;
    let word = |bytes: &[u8]| bytes.get(at..at + 4)?.try_into().ok().map(word_text);
    Some(format!(
        "uniforms, byte {at}: {} and {}",
        word(&a)?,
        word(&b)?
    ))
}

fn differing_vertex(a: &Draw, b: &Draw) -> Option<String> {
    let (a, b) = (a.vertices.as_ref()?, b.vertices.as_ref()?);
    let mut floats = a.data.iter().zip(&b.data);
    let at = floats.position(|(x, y)| x.to_bits() != y.to_bits())?;
    let (vertex, float) = (at.checked_div(a.stride)?, at.checked_rem(a.stride)?);
    Some(format!(
        "vertex {vertex}, float {float}: {:?} and {:?}",
        a.data[at], b.data[at]
    ))
}

fn differing_index(a: &Draw, b: &Draw) -> Option<String> {
    let (a, b) = (a.indices.as_ref()?.indices(), b.indices.as_ref()?.indices());
    let at = a.iter().zip(b).position(|(x, y)| x != y)?;
    Some(format!("index {at}: {} and {}", a[at], b[at]))
}
