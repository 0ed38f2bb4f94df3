//! Every error of the raster API: reached through the public API, named, and
//! with the actual value and the limit in its message.

use std::sync::Arc;

use gnomon_raster::state::{
    BlendFactor, BlendState, ColorTargetState, DepthStencilState, ScissorRect, Viewport,
};
use gnomon_raster::{
    Drawn, Error, Format, FrameBuilder, Gpu, GpuConfig, IndexBuffer, Sampler, Subresource,
    TextureBinding, TextureDescriptor, TextureDimension, VertexBuffer,
};
use gnomon_tests::api::{Use, color_attachment, depth_attachment, shaders};

/// What is done, the error's name, and what its message has to contain.
type Row = (
    &'static str,
    fn(&mut Use) -> Result<(), Error>,
    &'static str,
    &'static [&'static str],
);

/// Submits after a change of the use.
macro_rules! submit {
    ($use:ident => $($change:tt)*) => {
        |$use: &mut Use| {
            { $($change)* };
            $use.submit().map(|_| ())
        }
    };
}

/// Submits after a change of the draw's pipeline.
macro_rules! pipeline {
    ($p:ident => $($change:tt)*) => { submit!(u => u.pipeline(|$p| { $($change)*; })) };
}

/// Submits after a change of the draw.
macro_rules! draw {
    ($d:ident => $($change:tt)*) => { submit!(u => u.draw(|$d| { $($change)*; })) };
}

fn descriptor(dimension: TextureDimension, size: [u32; 3], mip_levels: u32) -> TextureDescriptor {
    TextureDescriptor {
        label: "t".to_owned(),
        dimension,
        format: Format::Rgba32Float,
        size,
        mip_levels,
    }
}

fn create(
    u: &mut Use,
    dimension: TextureDimension,
    size: [u32; 3],
    mips: u32,
) -> Result<(), Error> {
    u.gpu
        .create_texture(&descriptor(dimension, size, mips))
        .map(|_| ())
}

fn add(u: &mut Use, format: Format, side: u32) -> gnomon_raster::TextureId {
    u.gpu
        .create_texture(&TextureDescriptor::d2("other", format, side, side))
        .expect("valid")
}

fn configured(change: impl FnOnce(&mut GpuConfig)) -> Result<(), Error> {
    let mut config = GpuConfig::default();
    change(&mut config);
    Gpu::new(config).map(|_| ())
}

fn bind(u: &mut Use, texture: gnomon_raster::TextureId, sampler: Sampler) {
    u.draw(|d| d.textures = vec![TextureBinding { texture, sampler }]);
}

/// A texture id beyond those of the use's GPU.
fn foreign() -> gnomon_raster::TextureId {
    let mut other = Use::new();
    (0..5)
        .map(|_| add(&mut other, Format::R8Unorm, 1))
        .last()
        .expect("five")
}

fn drawn() -> Result<Drawn, Error> {
    let config = GpuConfig {
        threads: 1,
        ..GpuConfig::default()
    };
    FrameBuilder::new(4, 4)?.build().draw(config)
}

const MIP2: Subresource = Subresource { mip: 2, layer: 0 };

#[rustfmt::skip]
fn rows() -> Vec<Row> {
    use TextureDimension::{Cube, D1, D2, D3};
    vec![
        ("no size", |u| create(u, D2, [0, 4, 1], 1), "InvalidTexture", &["`t`", "0×4×1", "at least 1"]),
        ("too large", |u| create(u, D2, [8193, 4, 1], 1), "InvalidTexture", &["8193×4×1", "8192"]),
        ("too many bytes", |u| create(u, D3, [8192, 8192, 8192], 1), "InvalidTexture", &["8192×8192×8192", "8796093022208 bytes", "4294967296"]),
        ("no level", |u| create(u, D2, [4, 4, 1], 0), "InvalidTexture", &["0 mip levels", "1..=3"]),
        ("too many levels", |u| create(u, Cube, [4, 4, 1], 4), "InvalidTexture", &["4 mip levels", "1..=3"]),
        ("high 1D", |u| create(u, D1, [4, 2, 1], 1), "InvalidTexture", &["4×2×1", "height and depth 1"]),
        ("deep 2D", |u| create(u, D2, [4, 4, 2], 1), "InvalidTexture", &["4×4×2", "depth 1"]),
        ("oblong cube", |u| create(u, Cube, [4, 2, 1], 1), "InvalidTexture", &["4×2×1", "square"]),
        ("3D depth", |u| {
            let d = TextureDescriptor { format: Format::Depth24Stencil8, ..descriptor(D3, [4; 3], 1) };
            u.gpu.create_texture(&d).map(|_| ())
        }, "InvalidTexture", &["4×4×4", "depth-stencil"]),

        ("shade a vertex beyond the buffer", |u| {
            let buffer = VertexBuffer { data: vec![0.0; 12], stride: 4 };
            let vertex = &u.pass.draws[0].pipeline.vertex;
            vertex.positions(Some(&buffer), &[2, 3], 0).map(|_| ())
        }, "VertexOutOfRange", &["vertex 3", "3 vertices"]),
        ("read an unknown texture", |u| u.gpu.texture(foreign()).map(|_| ()), "NoSuchTexture", &["id 6", "2 textures"]),
        ("fill an unknown texture", |u| u.gpu.texture_mut(foreign()).map(|_| ()), "NoSuchTexture", &["id 6", "2 textures"]),
        ("read an unknown result", |_| drawn()?.output("colour").map(|_| ()), "NoSuchOutput", &["`colour`", "color, depth"]),
        ("attach an unknown texture", submit!(u => u.pass.color[0].texture = foreign()), "NoSuchTexture", &["id 6", "2 textures"]),
        ("bind an unknown texture", submit!(u => bind(u, foreign(), Sampler::default())), "NoSuchTexture", &["id 6", "2 textures"]),
        ("read an unknown level", |u| u.gpu.texture(u.color)?.read_raw(MIP2).map(|_| ()), "NoSuchSubresource", &["`image`", "mip 2", "2 mip levels"]),
        ("attach an unknown level", submit!(u => u.pass.color[0].subresource = MIP2), "NoSuchSubresource", &["mip 2", "2 mip levels"]),
        ("attach an unknown layer", submit!(u => u.pass.color[0].subresource = Subresource { mip: 1, layer: 9 }), "NoSuchSubresource", &["mip 1, layer 9", "1 layers"]),

        ("depth of colour", |u| u.gpu.texture(u.color)?.read_depth(Subresource::default()).map(|_| ()), "WrongAspect", &["`image`", "Rgba8Unorm", "depth"]),
        ("stencil of colour", |u| u.gpu.texture(u.color)?.read_stencil(Subresource::default()).map(|_| ()), "WrongAspect", &["Rgba8Unorm"]),
        ("colour of depth", |u| u.gpu.texture(u.depth)?.read_color(Subresource::default()).map(|_| ()), "WrongAspect", &["`depths`", "Depth24Stencil8", "color"]),
        ("fill colour of depth", |u| u.gpu.texture_mut(u.depth)?.write_raw(Subresource::default(), &[]), "WrongAspect", &["Depth24Stencil8"]),
        ("mipmaps of depth", |u| {
            let d = TextureDescriptor { mip_levels: 2, ..TextureDescriptor::d2("m", Format::Depth24Stencil8, 2, 2) };
            let id = u.gpu.create_texture(&d)?;
            u.gpu.texture_mut(id)?.generate_mipmaps()
        }, "WrongAspect", &["`m`"]),
        ("too few texels", |u| u.gpu.texture_mut(u.color)?.write_color(Subresource::default(), &[[0.0; 4]; 63]), "TexelCount", &["`image`", "64 texels", "63 were"]),
        ("too many raw texels", |u| u.gpu.texture_mut(u.color)?.write_raw(Subresource { mip: 1, layer: 0 }, &[[0; 4]; 17]), "TexelCount", &["16 texels", "17 were"]),
        ("too few bytes", |u| u.gpu.texture_mut(u.color)?.write_packed(Subresource::default(), &[0; 7]), "ByteCount", &["`image`", "7"]),
        ("stored depth", |u| {
            let id = u.gpu.create_texture(&TextureDescriptor::d2("d", Format::Depth32FloatStencil8, 1, 1))?;
            u.gpu.texture_mut(id)?.write_packed(Subresource::default(), &[0, 0, 0x80, 0x40, 0])
        }, "StoredDepth", &["`d`", "0x40800000", "0x3f800000"]),
        ("too few depths", |u| u.gpu.texture_mut(u.depth)?.write_depth_stencil(Subresource::default(), &[0.0; 1], &[0; 64]), "TexelCount", &["64 texels", "1 were"]),
        ("too few stencils", |u| u.gpu.texture_mut(u.depth)?.write_depth_stencil(Subresource::default(), &[0.0; 64], &[0; 2]), "TexelCount", &["64 texels", "2 were"]),

        ("no attachment", submit!(u => { u.pass.color.clear(); u.pass.depth_stencil = None; u.pass.draws.clear() }), "NoAttachment", &["`main`", "give it"]),
        ("five colours", submit!(u => u.pass.color = vec![color_attachment(u.color); 5]), "TooManyAttachments", &["`main`", "5 colour", "limit is 4"]),
        ("two sizes", submit!(u => { let t = add(u, Format::Depth24Stencil8, 4); u.pass.depth_stencil = Some(depth_attachment(t)) }), "AttachmentSize", &["`other`", "4×4", "8×8"]),
        ("attached twice", submit!(u => u.pass.color = vec![color_attachment(u.color); 2]), "AttachedTwice", &["`main`", "`image`"]),
        ("depth as colour", submit!(u => u.pass.color[0].texture = u.depth), "AttachmentFormat", &["`depths`", "Depth24Stencil8", "colour attachment"]),
        ("colour as depth", submit!(u => u.pass.depth_stencil = Some(depth_attachment(u.color))), "AttachmentFormat", &["`image`", "Rgba8Unorm", "depth-stencil attachment"]),

        ("two targets", pipeline!(p => p.color_targets.push(ColorTargetState::OPAQUE)), "ColorTargetCount", &["`triangle`", "2 colour targets", "render pass 1"]),
        ("blended integers", submit!(u => {
            let t = add(u, Format::R32Uint, 8);
            u.pass.color[0].texture = t;
            u.pipeline(|p| p.color_targets[0].blend = Some(BlendState::ADDITIVE));
        }), "Unblendable", &["`triangle`", "target 0", "R32Uint", "None"]),
        ("scaled integers", submit!(u => {
            let t = add(u, Format::R16Sint, 8);
            u.pass.color[0].texture = t;
            let mut blend = BlendState::ADDITIVE;
            blend.color.src_factor = BlendFactor::SrcAlpha;
            u.pipeline(|p| p.color_targets[0].blend = Some(blend));
        }), "Unblendable", &["R16Sint", "One and Zero"]),
        ("no depth buffer", submit!(u => u.pass.depth_stencil = None), "NoDepthStencil", &["`triangle`", "`main`"]),
        ("unbound slot", submit!(u => {
            u.draw(|d| d.pipeline = Arc::new(shaders(0, 3)));
            let t = add(u, Format::R8Unorm, 4);
            bind(u, t, Sampler::default());
        }), "MissingTexture", &["`triangle`", "slot 2", "1 are bound"]),
        ("bound and attached", submit!(u => bind(u, u.color, Sampler::default())), "FeedbackLoop", &["`triangle`", "`image`"]),

        ("seven clip planes", pipeline!(p => p.primitive.clip_planes = vec![[1.0; 4]; 7]), "Limit", &["clip planes is 7", "limit is 6"]),
        ("seventeen varyings", pipeline!(p => *p = shaders(17, 0)), "Limit", &["varyings is 17", "limit is 16"]),
        ("nine textures", submit!(u => {
            let texture = add(u, Format::R8Unorm, 4);
            u.draw(|d| d.textures = vec![TextureBinding { texture, sampler: Sampler::default() }; 9]);
        }), "Limit", &["textures is 9", "limit is 8"]),
        ("nine slots", pipeline!(p => *p = shaders(0, 9)), "Limit", &["slots the shader reads is 9", "limit is 8"]),
        ("many vertices", draw!(d => d.count = u32::MAX), "Limit", &["4294967295", "134217728"]),
        ("many instances", draw!(d => d.instances = u32::MAX), "Limit", &["instances is 4294967295", "1048576"]),

        ("NaN clip plane", pipeline!(p => p.primitive.clip_planes = vec![[f32::NAN; 4]]), "OutOfRange", &["clip plane", "NaN", "finite"]),
        ("wide line", pipeline!(p => p.primitive.line_width = 257.0), "OutOfRange", &["line width 257", "256"]),
        ("point of no size", pipeline!(p => p.primitive.point_size = 0.0), "OutOfRange", &["point size 0", "above 0"]),
        ("NaN bias", pipeline!(p => p.depth_stencil.bias.slope = f32::NAN), "OutOfRange", &["depth bias", "NaN", "finite"]),
        ("reversed bounds", pipeline!(p => p.depth_stencil.depth.bounds = Some([0.75, 0.25])), "OutOfRange", &["depth bounds 0.75..0.25", "min ≤ max"]),
        ("viewport of no size", draw!(d => d.viewport = Some(Viewport::full(0, 8))), "OutOfRange", &["viewport", "width: 0.0", "12288"]),
        ("narrow viewport", draw!(d => d.viewport = Some(Viewport { width: 1.9e-34, ..Viewport::full(8, 8) })), "OutOfRange", &["width: 1.9e-34", "1.93e-34"]),
        ("low viewport", draw!(d => d.viewport = Some(Viewport { height: f32::from_bits(1), ..Viewport::full(8, 8) })), "OutOfRange", &["height: 1e-45", "2⁻¹¹²"]),
        ("viewport depth", draw!(d => d.viewport = Some(Viewport { max_depth: 1.5, ..Viewport::full(8, 8) })), "OutOfRange", &["viewport depth 0..1.5", "0..=1"]),
        ("endless scissor", draw!(d => d.scissor = Some(ScissorRect { x: 9, y: 0, width: u32::MAX, height: 1 })), "OutOfRange", &["scissor", "4294967295", "32 bits"]),
        ("reversed levels", submit!(u => {
            let t = add(u, Format::R8Unorm, 4);
            bind(u, t, Sampler { lod: [2.0, 1.0], ..Sampler::default() });
        }), "OutOfRange", &["[2.0, 1.0]", "min ≤ max"]),
        ("primitives", draw!(d => { d.vertices = None; d.pipeline = points(); d.count = 1 << 27; d.instances = 16 }), "OutOfRange", &["primitive count 2147483648", "2³¹"]),
        ("beyond the vertices", draw!(d => d.first = 1), "OutOfRange", &["vertex range 1..4", "end at 3"]),
        ("no whole vertex", draw!(d => d.vertices = Some(Arc::new(VertexBuffer { data: vec![0.0; 9], stride: 0 }))), "OutOfRange", &["vertex range 0..3", "end at 0"]),
        ("beyond the indices", draw!(d => { d.indices = Some(Arc::new(IndexBuffer::new(vec![0, 1]))) }), "OutOfRange", &["index range 0..3", "end at 2"]),
        ("index beyond the vertices", draw!(d => { d.indices = Some(Arc::new(IndexBuffer::new(vec![0, 1, 3]))) }), "IndexOutOfRange", &["index 3", "position 2", "3 vertices"]),

        ("tile of 48", |_| configured(|c| c.tile = 48), "TileSize", &["48", "16, 32, 64, 128"]),
        ("threads", |_| configured(|c| c.threads = 1025), "Threads", &["1025", "limit is 1024"]),
        ("memory", |_| {
            let what = || "half of all addresses".to_owned();
            gnomon_raster::memory::filled(0u8, isize::MAX as usize, what).map(drop)
        }, "OutOfMemory", &["half of all addresses takes 9223372036854775807 bytes"]),
    ]
}

fn points() -> Arc<gnomon_raster::RenderPipeline> {
    let mut p = shaders(0, 0);
    p.primitive.topology = gnomon_raster::state::PrimitiveTopology::PointList;
    Arc::new(p)
}

/// The name of an error's variant.
fn name(e: &Error) -> String {
    let text = format!("{e:?}");
    text.split([' ', '{']).next().unwrap_or_default().to_owned()
}

/// Variants of the error type, from its source.
fn variants() -> Vec<String> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../raster/src/error.rs");
    let source = std::fs::read_to_string(path).expect("the workspace has the source");
    let is_variant = |l: &&str| l.starts_with("    ") && l[4..].starts_with(char::is_uppercase);
    let names = source.lines().filter(is_variant).map(|l| {
        let end = l[4..].find(|c: char| !c.is_alphanumeric());
        l[4..][..end.unwrap_or(l.len() - 4)].to_owned()
    });
    names.collect()
}

#[test]
fn the_valid_use_is_valid() {
    let report = Use::new().submit().expect("valid");
    assert_eq!(report.passes[0].draws[0].counters.fragments.written, 64);
}

#[test]
fn every_error_is_reached_and_names_value_and_limit() {
    for (what, act, expected, parts) in rows() {
        let mut u = Use::new();
        let error = match act(&mut u) {
            Ok(()) => panic!("{what}: accepted"),
            Err(e) => e,
        };
        assert_eq!(name(&error), expected, "{what}: {error}");
        let message = error.to_string();
        for part in parts {
            assert!(message.contains(part), "{what}: `{message}` lacks `{part}`");
        }
    }
}

/// A new variant needs a row. A flushing floating-point unit cannot be had
/// without `unsafe`.
#[test]
fn no_error_is_left_out() {
    let reached: Vec<_> = rows().into_iter().map(|r| r.2).collect();
    let all = variants();
    assert!(all.len() >= 20, "only {all:?} understood");
    for variant in all {
        let known = reached.contains(&variant.as_str()) || variant == "DenormalsFlushed";
        assert!(known, "{variant} has no row");
    }
}

/// An error found late leaves everything as it was.
#[test]
fn nothing_runs_when_something_is_refused() {
    let mut u = Use::new();
    u.submit().expect("valid");
    let before = u
        .gpu
        .texture(u.color)
        .and_then(|t| t.read_raw(Subresource::default()));
    let mut bad = u.pass.clone();
    bad.draws[0].first = 7;
    let mut other = u.pass.clone();
    other.draws[0].pipeline = Arc::new(gnomon_raster::RenderPipeline {
        depth_stencil: DepthStencilState::default(),
        fragment: None,
        ..shaders(0, 0)
    });
    let passes = vec![other, bad];
    let refused = u.gpu.submit(&gnomon_raster::CommandList { passes });
    assert_eq!(name(&refused.unwrap_err()), "OutOfRange");
    let after = u
        .gpu
        .texture(u.color)
        .and_then(|t| t.read_raw(Subresource::default()));
    assert_eq!(before, after);
}
