//! Random uses of the raster API, valid and not.

use std::sync::Arc;

use gnomon_raster::state::{ColorWrites, ScissorRect, Viewport};
use gnomon_raster::{
    ColorAttachment, CommandList, DepthStencilAttachment, Draw, Error, Format, Gpu, GpuConfig,
    IndexBuffer, LoadOp, RenderPass, RenderPipeline, SimdLevel, StoreOp, SubmitReport, Subresource,
    TextureBinding, TextureDescriptor, TextureDimension, TextureId, VertexBuffer,
};

use super::{Random, look_up, state, texture};
use crate::api::{Use, shaders};
use crate::twin::{ColorSource, DepthSource, Discard, Program, TwinDraw};

/// What became of everything that random numbers try, in order: fragments written, or
/// why not.
#[must_use]
pub fn misuse(mut r: Random) -> Vec<Result<u64, Error>> {
    let mut results = Vec::new();
    let mut gpu = match gpu(&mut r) {
        Ok(gpu) => gpu,
        Err(e) => return vec![Err(e)],
    };
    let mut textures = Vec::new();
    if r.one_in(8) {
        textures.push(Use::new().depth); // of another GPU
    }
    for format in [Format::Rgba8Unorm, Format::Depth24Stencil8] {
        let valid = TextureDescriptor::d2("valid", format, 24, 24);
        textures.extend(gpu.create_texture(&valid));
    }
    for _ in 0..r.between(2, 6) {
        match gpu.create_texture(&descriptor(&mut r)) {
            Ok(id) => textures.push(id),
            Err(e) => results.push(Err(e)),
        }
    }
    for _ in 0..3 {
        results.push(transfer(&mut r, &mut gpu, &textures).map(|()| 0));
    }
    for _ in 0..3 {
        let passes = (0..r.pick(&[0, 1, 1, 1, 1, 2])).map(|_| pass(&mut r, &gpu, &textures));
        let list = CommandList {
            passes: passes.collect(),
        };
        let written = |report: SubmitReport| {
            let passes = report.passes.iter();
            passes.map(|p| p.totals().fragments.written).sum()
        };
        results.push(gpu.submit(&list).map(written));
    }
    results
}

fn gpu(r: &mut Random) -> Result<Gpu, Error> {
    Gpu::new(GpuConfig {
        threads: if r.one_in(100) {
            r.pick(&[1025, usize::MAX])
        } else {
            r.pick(&[1, 1, 2])
        },
        tile: if r.one_in(50) {
            r.pick(&[0, 8, 48, u32::MAX])
        } else {
            r.pick(&[16, 32, 64, 128])
        },
        simd: r.pick(&SimdLevel::available()),
        skip: r.one_in(2),
    })
}

/// A side: mostly small, sometimes none, large or absurd.
fn side(r: &mut Random) -> u32 {
    match r.below(24) {
        0 => r.pick(&[0, 8193, u32::MAX, 1 << 31]),
        1 => r.pick(&[129, 300]),
        2..8 => r.pick(&[1, 7, 8, 9, 16]),
        _ => 24,
    }
}

fn descriptor(r: &mut Random) -> TextureDescriptor {
    use TextureDimension::{Cube, D1, D2, D3};
    let dimension = r.pick(&[D1, D2, D2, D2, D2, D3, Cube]);
    let wild = r.one_in(4);
    let mut size = [side(r), side(r), 1];
    match dimension {
        D1 if !wild => size[1] = 1,
        Cube if !wild => size[1] = size[0],
        D3 => size[2] = r.pick(&[1, 2, 5, 0, 8192]),
        _ if wild => size[2] = r.pick(&[1, 1, 2, 0]),
        _ => {}
    }
    if r.one_in(60) {
        size = [8192; 3];
    }
    TextureDescriptor {
        label: "random".to_owned(),
        dimension,
        format: r.pick(&Format::ALL),
        size,
        mip_levels: r.pick(&[1, 1, 1, 1, 2, 3, 5, 0, 14, u32::MAX]),
    }
}

fn subresource(r: &mut Random) -> Subresource {
    if r.one_in(5) {
        Subresource {
            mip: r.pick(&[0, 1, 2, 31, 32, u32::MAX]),
            layer: r.pick(&[0, 1, 5, 6, u32::MAX]),
        }
    } else {
        Subresource::default()
    }
}

/// Its value once in eight times.
fn rarely<T: Default>(r: &mut Random, f: impl Fn(&mut Random) -> T) -> T {
    if r.one_in(8) { f(r) } else { T::default() }
}

/// Reads or fills some image, with the right number of texels or not.
fn transfer(r: &mut Random, gpu: &mut Gpu, textures: &[TextureId]) -> Result<(), Error> {
    let (id, s) = (r.pick(textures), subresource(r));
    let [w, h, _] = gpu.texture(id)?.mip_size(s.mip);
    let n = if r.one_in(4) {
        r.below(40) as usize
    } else {
        w as usize * h as usize
    };
    let texture = gpu.texture_mut(id)?;
    match r.below(7) {
        0 => texture.write_raw(s, &vec![r.array(Random::next); n]),
        1 => texture.write_color(s, &vec![r.array(wild); n]),
        2 => {
            let m = if r.one_in(6) { n / 2 } else { n };
            texture.write_depth_stencil(s, &vec![wild(r); n], &vec![7; m])
        }
        3 => texture.generate_mipmaps(),
        4 => texture.read_color(s).map(|_| ()),
        5 => texture.read_depth(s).map(|_| ()),
        _ => texture.read_stencil(s).map(|_| ()),
    }
}

/// Any float, and those that hurt.
fn wild(r: &mut Random) -> f32 {
    match r.below(6) {
        0 => f32::from_bits(r.next()),
        1 => r.pick(&[
            f32::NAN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::MAX,
            f32::MIN,
            f32::MIN_POSITIVE,
            1e-45,
            -0.0,
        ]),
        2 => r.pick(&[0.0, 1.0, -1.0, 0.5]),
        _ => r.float(-2.0, 2.0),
    }
}

/// Mostly 24×24 images, so that passes are often valid.
fn attached(r: &mut Random, gpu: &Gpu, textures: &[TextureId], depth: bool) -> TextureId {
    let fits = |id: &&TextureId| {
        gpu.texture(**id).is_ok_and(|t| {
            let d = t.descriptor();
            d.size[..2] == [24, 24] && d.format.is_depth_stencil() == depth
        })
    };
    let fitting: Vec<TextureId> = textures.iter().filter(fits).copied().collect();
    if fitting.is_empty() || r.one_in(12) {
        r.pick(textures)
    } else {
        r.pick(&fitting)
    }
}

fn pass(r: &mut Random, gpu: &Gpu, textures: &[TextureId]) -> RenderPass {
    let colors = r.pick(&[0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 5]);
    let load = |r: &mut Random| match r.below(3) {
        0 => LoadOp::Load,
        1 => LoadOp::Clear(r.array(wild)),
        _ => LoadOp::DontCare,
    };
    let color: Vec<_> = (0..colors)
        .map(|_| ColorAttachment {
            texture: attached(r, gpu, textures, false),
            subresource: rarely(r, subresource),
            load: load(r),
            store: StoreOp::Store,
        })
        .collect();
    let depth_stencil = r.one_in(2).then(|| DepthStencilAttachment {
        texture: attached(r, gpu, textures, true),
        subresource: rarely(r, subresource),
        depth_load: LoadOp::Clear(wild(r)),
        depth_store: StoreOp::Store,
        stencil_load: LoadOp::Clear(r.next() as u8),
        stencil_store: StoreOp::Discard,
    });
    let formats: Vec<Format> = color
        .iter()
        .filter_map(|c| gpu.texture(c.texture).ok())
        .map(|t| t.descriptor().format)
        .collect();
    let depth = depth_stencil.as_ref();
    let is_attached = |id: &TextureId| {
        color.iter().any(|c| c.texture == *id) || depth.is_some_and(|d| d.texture == *id)
    };
    let free: Vec<_> = textures
        .iter()
        .filter(|t| !is_attached(t))
        .copied()
        .collect();
    let readable = if free.is_empty() || r.one_in(12) {
        textures
    } else {
        &free
    };
    let draws =
        (0..r.pick(&[0, 1, 1, 1, 1, 3])).map(|_| draw(r, &formats, depth.is_some(), readable));
    let draws = draws.collect();
    RenderPass {
        label: "pass".to_owned(),
        draws,
        color,
        depth_stencil,
    }
}

fn draw(r: &mut Random, formats: &[Format], depth: bool, textures: &[TextureId]) -> Draw {
    let stride = if r.one_in(12) {
        r.pick(&[3, 1, 0, 100])
    } else {
        r.pick(&[4, 7, 8])
    };
    let vertices = r.pick(&[0, 1, 3, 12, 12, 30, 30]);
    let tame = r.one_in(2);
    let float = |k: usize, r: &mut Random| match k % stride {
        _ if !tame => wild(r),
        3 => r.pick(&[1.0, 1.0, 2.0]),
        _ => r.float(-1.0, 1.2),
    };
    let length = vertices * stride + r.below(3) as usize * usize::from(stride > 0);
    let data: Vec<f32> = (0..length).map(|k| float(k, r)).collect();
    let buffer = (!r.one_in(6)).then(|| Arc::new(VertexBuffer { data, stride }));
    let mut d = Draw::vertices_only("draw", &Arc::new(pipeline(r, formats, depth)), 0);
    d.count = match r.below(32) {
        0 => r.pick(&[u32::MAX, 1 << 27, (1 << 27) + 1]),
        1..8 => r.below(vertices as u32 + 1),
        _ => vertices as u32,
    };
    if d.count >= 1 << 27 && buffer.is_none() {
        d.count = u32::MAX; // what is valid takes gigabytes
    }
    d.first = match r.below(40) {
        0 => r.pick(&[1, u32::MAX, 1 << 31, (1 << 31) - 3]),
        1 => 1,
        _ => 0,
    };
    if r.one_in(3) {
        d.indices = Some(Arc::new(indices(r, d.count.min(64), vertices as u32)));
    }
    d.vertices = buffer;
    d.instances = if r.one_in(20) {
        r.pick(&[0, 2, 3, u32::MAX])
    } else {
        1
    };
    d.stencil_reference = r.array(|r| r.next() as u8);
    d.blend_constant = r.array(wild);
    d.viewport = r.one_in(10).then(|| viewport(r));
    d.scissor = r.one_in(4).then(|| ScissorRect {
        x: r.pick(&[0, 3, 24, 25, u32::MAX]),
        y: r.below(30),
        width: r.pick(&[0, 1, 24, u32::MAX]),
        height: r.below(30),
    });
    let slots = match r.below(40) {
        0 => 9,
        1..4 => 1,
        _ => 2,
    };
    d.textures = (0..slots)
        .map(|_| TextureBinding {
            texture: r.pick(textures),
            sampler: sampler(r),
        })
        .collect();
    d
}

fn indices(r: &mut Random, count: u32, vertices: u32) -> IndexBuffer {
    let beyond = r.one_in(8);
    let index = |r: &mut Random| match r.below(8) {
        0 if beyond => r.pick(&[vertices, u32::MAX, 1 << 31, (1 << 31) - 1, 2_000_000_000]),
        _ => r.below(vertices.max(1)),
    };
    let more = r.pick(&[0, 0, 0, 5]);
    IndexBuffer::new((0..count + more).map(|_| index(r)).collect())
}

fn viewport(r: &mut Random) -> Viewport {
    let wide = |r: &mut Random| match r.below(6) {
        0 => wild(r),
        1 => r.pick(&[-4096.0, 12288.0, 16384.0, -4096.5, 1e-30]),
        _ => r.float(-10.0, 40.0),
    };
    Viewport {
        x: wide(r),
        y: wide(r),
        width: wide(r),
        height: wide(r),
        min_depth: r.pick(&[0.0, 0.0, 0.25, 1.0, f32::NAN, -1.0]),
        max_depth: r.pick(&[1.0, 1.0, 0.25, 0.0, f32::INFINITY]),
    }
}

fn sampler(r: &mut Random) -> gnomon_raster::Sampler {
    let mut s = texture::sampler(r);
    if r.one_in(40) {
        s.lod = r.array(wild);
    }
    if r.one_in(40) {
        s.lod_bias = wild(r);
    }
    s.border = r.array(wild);
    s
}

fn pipeline(r: &mut Random, formats: &[Format], depth: bool) -> RenderPipeline {
    let mut p = if r.one_in(3) {
        let [varyings, slots] = match r.below(20) {
            0 => [17, 0],
            1 => [4, 9],
            2 => [16, 8],
            _ => [r.pick(&[0, 1, 4]), r.pick(&[0, 0, 1])],
        };
        shaders(varyings, slots)
    } else {
        lanes(r, formats)
    };
    p.primitive = state::primitive(r);
    if r.one_in(30) {
        p.primitive.line_width = wild(r);
        p.primitive.point_size = wild(r) * 200.0;
    }
    if r.one_in(30) {
        p.primitive.clip_planes = (0..r.between(1, 7)).map(|_| r.array(wild)).collect();
    }
    p.depth_stencil = if depth || r.one_in(30) {
        state::depth_stencil(r)
    } else {
        Default::default()
    };
    if r.one_in(30) && depth {
        let bias = &mut p.depth_stencil.bias;
        [bias.constant, bias.slope, bias.clamp] = r.array(wild);
        p.depth_stencil.depth.bounds = Some(r.array(wild));
    }
    p.color_targets = formats.iter().map(|f| state::target(r, *f)).collect();
    for t in &mut p.color_targets {
        if r.one_in(8) {
            t.write_mask = ColorWrites(r.next() as u8);
        }
        if r.one_in(40) {
            t.blend = state::target(r, Format::Rgba8Unorm).blend;
        }
    }
    if r.one_in(20) {
        p.color_targets.pop();
    }
    p
}

/// The twin's programs over lanes, with look-ups in slots bound or not.
fn lanes(r: &mut Random, formats: &[Format]) -> RenderPipeline {
    let mut d = TwinDraw::triangles(Vec::new());
    let mut program = Program::plain(r.pick_ref(&[
        ColorSource::Varyings,
        ColorSource::Wild,
        ColorSource::Geometry,
    ]));
    program.outputs = formats.len().min(4);
    program.discard = r.one_in(4).then_some(Discard::Below(0, 0.5));
    program.depth = r.one_in(4).then_some(DepthSource::Wild(1));
    if r.one_in(2) {
        look_up::add(r, &mut program, 2);
    }
    d.interpolation = vec![gnomon_raster::shader::Interpolation::Perspective; r.below(5) as usize];
    d.program = (!r.one_in(8)).then_some(program);
    RenderPipeline {
        vertex: d.vertex_stage(),
        fragment: d.fragment_stage(),
        ..shaders(0, 0)
    }
}
