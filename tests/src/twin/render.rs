//! Passes, draws and primitives in order.

use gnomon_raster::state::{PrimitiveTopology, Viewport};
use gnomon_raster::{BlockAccess, ClientTraffic, Counters, Format, LoadOp, StoreOp, Traffic};

use super::block::{Block, DrawContext, TriangleContext};
use super::case::{EventDetails, Log, Outcome, PassOutcome, TwinCase, TwinDraw, TwinPass};
use super::coverage::{ClipPlanes, DrawRect};
use super::depth::{DepthPlane, Encoding, range};
use super::image::{Images, depth_bytes, encode, texel_bytes};
use super::log::{BlockLog, look};
use super::setup::{Setup, Triangle};
use super::texture::Bound;
use super::varying::Varyings;
use super::vertex::{distinct, sequence, shade};

/// Renders a case with zmin/zmax tests.
#[must_use]
pub fn render(case: &TwinCase) -> Outcome {
    render_with(case, true)
}

/// Renders a case, with zmin/zmax tests or without.
#[must_use]
pub fn render_with(case: &TwinCase, skip: bool) -> Outcome {
    render_logging(case, skip, Log::default())
}

/// The same, and writes down what `log` asks for.
#[must_use]
pub fn render_logging(case: &TwinCase, skip: bool, log: Log) -> Outcome {
    let mut images = Images::new(case);
    let passes = case
        .passes
        .iter()
        .map(|p| run_pass(case, p, skip, log, &mut images))
        .collect();
    let (depth, stencil) = images
        .depth
        .map(|d| (d.depth, d.stencil))
        .unwrap_or_default();
    Outcome {
        color: images.color.into_iter().map(|i| i.texels).collect(),
        depth,
        stencil,
        passes,
    }
}

/// The events of a pass so far, and more of them.
#[derive(Default)]
struct Events {
    list: Vec<BlockAccess>,
    details: EventDetails,
}

fn run_pass(
    case: &TwinCase,
    pass: &TwinPass,
    skip: bool,
    log: Log,
    images: &mut Images,
) -> PassOutcome {
    let mut events = Events::default();
    look(log, case.size[0], images, &mut events.details);
    let clear = load(case, pass, images);
    look(log, case.size[0], images, &mut events.details);
    let mut draws = Vec::new();
    for (k, draw) in pass.draws.iter().enumerate() {
        draws.push(run_draw(
            case,
            pass,
            draw,
            k as u32,
            (skip, log),
            images,
            &mut events,
        ));
    }
    look(log, case.size[0], images, &mut events.details);
    store(pass, images);
    look(log, case.size[0], images, &mut events.details);
    PassOutcome {
        draws,
        clear,
        events: events.list,
        details: events.details,
    }
}

fn load(case: &TwinCase, pass: &TwinPass, images: &mut Images) -> ClientTraffic {
    let n = case.pixels() as u64;
    let mut clear = ClientTraffic::default();
    for (k, used) in pass.color.iter().enumerate() {
        let image = &mut images.color[used.image];
        let format = image.format;
        match used.load {
            LoadOp::Load => {}
            LoadOp::DontCare => image.texels.fill([0; 4]),
            LoadOp::Clear(c) => {
                image.texels.fill(encode(format, c));
                clear.color[k] = traffic(0, n, texel_bytes(format));
            }
        }
    }
    if let (Some(used), Some(image)) = (&pass.depth, &mut images.depth) {
        let (bytes, word) = depth_bytes(image.format);
        let mut packed = 0;
        match used.depth_load {
            LoadOp::Load => {}
            LoadOp::DontCare => image.depth.fill(0),
            LoadOp::Clear(d) => {
                image.depth.fill(Encoding::of(Some(image.format)).encode(d));
                clear.z = traffic(0, n, bytes);
                packed += n;
            }
        }
        match used.stencil_load {
            LoadOp::Load => {}
            LoadOp::DontCare => image.stencil.fill(0),
            LoadOp::Clear(s) => {
                image.stencil.fill(s);
                clear.stencil = traffic(0, n, 1);
                packed += n;
            }
        }
        clear.packed_depth_stencil = traffic(0, packed, word);
    }
    clear
}

fn store(pass: &TwinPass, images: &mut Images) {
    for used in pass.color.iter().filter(|u| u.store == StoreOp::Discard) {
        images.color[used.image].texels.fill([0; 4]);
    }
    if let (Some(used), Some(image)) = (&pass.depth, &mut images.depth) {
        if used.depth_store == StoreOp::Discard {
            image.depth.fill(0);
        }
        if used.stencil_store == StoreOp::Discard {
            image.stencil.fill(0);
        }
    }
}

fn run_draw(
    case: &TwinCase,
    pass: &TwinPass,
    draw: &TwinDraw,
    number: u32,
    (skip, log): (bool, Log),
    images: &mut Images,
    events: &mut Events,
) -> Counters {
    let viewport = draw.viewport.unwrap_or_else(|| whole(case.size));
    let depth_format = pass
        .depth
        .as_ref()
        .and(images.depth.as_ref())
        .map(|d| d.format);
    let ctx = DrawContext {
        pass,
        draw,
        size: case.size,
        rect: DrawRect::new(case.size, &viewport, draw.scissor),
        encoding: Encoding::of(depth_format),
        depth_range: range(&viewport),
        skip,
        log,
        textures: draw
            .textures
            .iter()
            .map(|t| Bound::new(case, images, t))
            .collect(),
    };
    let mut counters = Counters::default();
    let first_event = events.list.len();
    for triangle in triangles(draw, &Setup::new(&draw.primitive, viewport), &mut counters) {
        run_triangle(
            &ctx,
            &triangle,
            &viewport,
            number,
            images,
            &mut counters,
            events,
        );
    }
    fixed_function_traffic(
        &mut counters,
        &events.list[first_event..],
        depth_format,
        pass,
        images,
    );
    counters
}

fn whole([w, h]: [u32; 2]) -> Viewport {
    Viewport {
        x: 0.0,
        y: 0.0,
        width: w as f32,
        height: h as f32,
        min_depth: 0.0,
        max_depth: 1.0,
    }
}

/// Everything before pixels, with its counters.
fn triangles(draw: &TwinDraw, setup: &Setup<'_>, c: &mut Counters) -> Vec<Triangle> {
    let corners = match setup.state.topology {
        PrimitiveTopology::TriangleList => 3,
        PrimitiveTopology::LineList => 2,
        PrimitiveTopology::PointList => 1,
    };
    let mut sequence = sequence(draw);
    sequence.truncate(sequence.len() / corners * corners);
    let mut list = Vec::new();
    let mut number = 0;
    for instance in 0..draw.instances {
        let invocations = distinct(&sequence);
        c.primitives.vertex_shader_invocations += invocations;
        if draw.vertex_source == super::VertexSource::Buffer {
            c.traffic.vertex.read_accesses += invocations;
            c.traffic.vertex.read_bytes += invocations * 4 * (4 + draw.interpolation.len() as u64);
        }
        for primitive in sequence.chunks_exact(corners) {
            if draw.indices.is_some() {
                c.traffic.index.read_accesses += corners as u64;
                c.traffic.index.read_bytes += 4 * corners as u64;
            }
            let vertices: Vec<_> = primitive
                .iter()
                .map(|&i| shade(draw, i, instance))
                .collect();
            list.extend(setup.triangles(&vertices, number, &mut c.primitives));
            number += 1;
        }
    }
    list
}

fn run_triangle(
    ctx: &DrawContext<'_>,
    triangle: &Triangle,
    viewport: &Viewport,
    draw: u32,
    images: &mut Images,
    counters: &mut Counters,
    events: &mut Events,
) {
    let tri = TriangleContext {
        triangle,
        depth: DepthPlane::new(
            triangle,
            ctx.encoding,
            &ctx.draw.depth_stencil.bias,
            viewport,
        ),
        varyings: Varyings::new(triangle, &ctx.draw.interpolation),
        clip_planes: ClipPlanes::new(triangle, &ctx.draw.primitive.clip_planes),
    };
    counters.primitives.steep_depth_planes += u64::from(tri.depth.is_steep());
    for y in (0..ctx.size[1]).step_by(8) {
        for x in (0..ctx.size[0]).step_by(8) {
            let access = BlockAccess {
                draw,
                primitive: triangle.primitive,
                piece: triangle.piece,
                block: [(x / 8) as u16, (y / 8) as u16],
                front: triangle.front,
                ..BlockAccess::default()
            };
            let block = Block {
                ctx,
                tri: &tri,
                images,
                counters,
                access,
                x,
                y,
                log: BlockLog::new(events.list.len(), &mut events.details),
            };
            events.list.extend(block.run());
        }
    }
}

fn traffic(reads: u64, writes: u64, bytes: u64) -> Traffic {
    Traffic {
        read_accesses: reads,
        read_bytes: reads * bytes,
        write_accesses: writes,
        write_bytes: writes * bytes,
    }
}

/// Traffic of depth, stencil, zmin/zmax and colour, from the accesses.
fn fixed_function_traffic(
    c: &mut Counters,
    events: &[BlockAccess],
    depth: Option<Format>,
    pass: &TwinPass,
    images: &Images,
) {
    let sum = |mask: &dyn Fn(&BlockAccess) -> u64| {
        events.iter().map(|e| u64::from(mask(e).count_ones())).sum()
    };
    let z: [u64; 2] = [sum(&|e| e.z_read), sum(&|e| e.z_write)];
    let s: [u64; 2] = [sum(&|e| e.stencil_read), sum(&|e| e.stencil_write)];
    let (bytes, word) = depth.map_or((0, 0), depth_bytes);
    c.traffic.z = traffic(z[0], z[1], bytes);
    c.traffic.stencil = traffic(s[0], s[1], 1);
    c.traffic.packed_depth_stencil = traffic(z[0] + s[0], z[1] + s[1], word);
    c.traffic.hiz = traffic(sum(&|e| e.hiz_read.into()), sum(&|e| e.hiz_write.into()), 8);
    for (k, used) in pass.color.iter().enumerate() {
        let bytes = texel_bytes(images.color[used.image].format);
        c.traffic.color[k] = traffic(sum(&|e| e.color_read[k]), sum(&|e| e.color_write[k]), bytes);
    }
}
