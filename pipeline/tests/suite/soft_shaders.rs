//! Shaders of soft shadow volumes against their f64 twins, each drawn over the screen of
//! a small GPU.

use std::sync::Arc;

use glam::DVec3;
use gnomon_pipeline::geometry::coverage::{LightPlane, SphereOutline, loop_visibility, umbra_side};
use gnomon_pipeline::world::light::LightShape;
use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    ColorAttachment, CommandList, Draw, Format, Gpu, GpuConfig, IndexBuffer, LoadOp, RenderPass,
    RenderPipeline, Sampler, StoreOp, SubmitReport, Subresource, TextureBinding, TextureDescriptor,
    TextureId, VertexBuffer,
};
use gnomon_shaders::coverage::{FlatLight, Image, Projector, SphereLight};
use gnomon_shaders::soft_volumes::{
    CountTo, CoverTo, ExactCoverage, HardCount, HardPlane, HardQuads, Penumbra,
};
use gnomon_shaders::split_volumes::{Halves, SplitPenumbra, Tables};
use gnomon_shaders::transform::{ClipFromWorld, FullScreen};

pub(crate) const SIDE: u32 = 64;
pub(crate) const COUNT: usize = (SIDE * SIDE) as usize;

pub(crate) fn gpu() -> Gpu {
    Gpu::new(GpuConfig {
        threads: 1,
        ..GpuConfig::default()
    })
    .unwrap()
}

pub(crate) fn texture(gpu: &mut Gpu, format: Format) -> TextureId {
    let desc = TextureDescriptor::d2("t", format, SIDE, SIDE);
    gpu.create_texture(&desc).unwrap()
}

pub(crate) fn full_screen(
    fragment: FragmentStage,
    target: ColorTargetState,
    from: &[TextureId],
) -> Draw {
    let pipeline = RenderPipeline {
        label: "test".into(),
        vertex: FullScreen.stage(),
        fragment: Some(fragment),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![target],
    };
    let binding = |&texture: &TextureId| TextureBinding {
        texture,
        sampler: Sampler::default(),
    };
    Draw {
        textures: from.iter().map(binding).collect(),
        ..Draw::vertices_only("test", &Arc::new(pipeline), 3)
    }
}

pub(crate) fn submit(
    gpu: &mut Gpu,
    to: TextureId,
    load: LoadOp<[f32; 4]>,
    draws: Vec<Draw>,
) -> SubmitReport {
    let pass = RenderPass {
        label: "test".into(),
        color: vec![ColorAttachment {
            texture: to,
            subresource: Subresource::default(),
            load,
            store: StoreOp::Store,
        }],
        depth_stencil: None,
        draws,
    };
    gpu.submit(&CommandList { passes: vec![pass] }).unwrap()
}

pub(crate) fn red(gpu: &Gpu, texture: TextureId) -> Vec<f32> {
    let texels = gpu.texture(texture).unwrap();
    let texels = texels.read_color(Subresource::default()).unwrap();
    texels.iter().map(|t| t.0[0]).collect()
}

/// A small multiplicative generator: the tests have to be the same everywhere.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn point(&mut self, size: f64) -> DVec3 {
        let mut one = || size * (2.0 * self.unit() - 1.0);
        DVec3::new(one(), one(), one())
    }
}

fn narrow(v: DVec3) -> [f32; 3] {
    v.to_array().map(|c| c as f32)
}

fn wide(v: DVec3) -> DVec3 {
    DVec3::from_array(narrow(v).map(f64::from))
}

/// The shader's light at the origin, facing -z, and the rows of its coordinates.
fn projector(shape: &LightShape) -> (Projector, [DVec3; 3]) {
    let rows = [DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z];
    let flat = |image, size: f64| {
        let rows = [rows[0] / size, rows[1] / size, rows[2]];
        let light = FlatLight {
            origin: [0.0; 3],
            far: None,
            axes: rows.map(narrow),
            image,
        };
        (Projector::Flat(light), rows)
    };
    match *shape {
        LightShape::Rectangle { edge_u, .. } => flat(Image::Square, edge_u.length() / 2.0),
        LightShape::Disc { radius, .. } => flat(Image::Disc, radius),
        LightShape::Sphere { radius, .. } => {
            let light = SphereLight {
                origin: [0.0; 3],
                far: None,
                radius: radius as f32,
                seen: true,
            };
            (Projector::Sphere(light), [DVec3::X, DVec3::Y, DVec3::Z])
        }
        _ => unreachable!(),
    }
}

fn shapes() -> [LightShape; 3] {
    let centre = DVec3::ZERO;
    [
        LightShape::Rectangle {
            centre,
            edge_u: DVec3::X,
            edge_v: DVec3::NEG_Y,
        },
        LightShape::Disc {
            centre,
            normal: DVec3::NEG_Z,
            radius: 0.5,
        },
        LightShape::Sphere {
            centre,
            radius: 0.5,
        },
    ]
}

/// Signed coverage of random edges from random receivers, in lanes and in f64.
#[test]
fn lanes_agree_with_the_twin() {
    let mut random = Random(7);
    for shape in shapes() {
        let (light, rows) = projector(&shape);
        let plane = LightPlane::new(&shape, SphereOutline::Seen).unwrap();
        let (mut worst, mut compared, mut covering) = (0.0f64, 0, 0);
        for _ in 0..40 {
            let centre = DVec3::new(0.0, 0.0, -2.0) + random.point(0.5);
            let along = random.point(0.8);
            let ends = [centre - along, centre + along].map(wide);
            let normal = (ends[1] - ends[0]).cross(-ends[0]).normalize();
            let receivers: Vec<DVec3> = (0..COUNT)
                .map(|_| wide(DVec3::new(0.0, 0.0, -4.0) + random.point(0.9)))
                .collect();
            let mut gpu = gpu();
            let positions = texture(&mut gpu, Format::Rgba32Float);
            let out = texture(&mut gpu, Format::R32Float);
            let texels: Vec<[f32; 4]> = receivers
                .iter()
                .map(|p| [p.x as f32, p.y as f32, p.z as f32, 1.0])
                .collect();
            let target = gpu.texture_mut(positions).unwrap();
            target.write_color(Subresource::default(), &texels).unwrap();
            let shader = Penumbra {
                light,
                covering: ExactCoverage,
                edge: ends.map(|e| narrow(DVec3::from_array(rows.map(|r| r.dot(e))))),
                plane: HardPlane::through_centre(narrow(normal)),
                to: CoverTo::Visibility,
            };
            let draw = full_screen(shader.stage(), ColorTargetState::OPAQUE, &[positions; 2]);
            submit(&mut gpu, out, LoadOp::Clear([9.0; 4]), vec![draw]);
            for (p, got) in receivers.iter().zip(red(&gpu, out)) {
                let projection = plane.seen_from(*p).unwrap();
                let share = projection.coverage(ends);
                let sign = if umbra_side(DVec3::ZERO, ends, *p) {
                    1.0
                } else {
                    -1.0
                };
                // At the light's centre the coverage of one edge jumps.
                let near = projection.clip(ends).is_some_and(|[a, b]| {
                    let line = (b - a).normalize_or_zero();
                    let off = a.perp_dot(line).abs();
                    off < 1e-3 || a.length().min(b.length()) < 0.02
                });
                if !near {
                    worst = worst.max((f64::from(got) - sign * share).abs());
                    compared += 1;
                    covering += i32::from(share > 0.0);
                }
            }
        }
        println!("{shape:?}: {worst:e} of {compared}, {covering} covering");
        assert!(covering > 10_000 && worst < 1e-5, "{shape:?}: {worst:e}");
    }
}

/// Corners of a flat convex polygon between the light and the receivers, the
/// occluder on the left seen from the light.
fn occluder(random: &mut Random) -> Vec<DVec3> {
    let middle = DVec3::new(0.0, 0.0, -2.0) + random.point(0.35);
    let tilt = (DVec3::Z + random.point(0.4)).normalize();
    let (u, v) = tilt.any_orthonormal_pair();
    let n = 3 + (random.unit() * 5.0) as u32;
    let size = 0.15 + 0.5 * random.unit();
    let corner = |k: u32| {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(n);
        wide(middle + (u * libm::cos(angle) + v * libm::sin(angle)) * size)
    };
    let mut points: Vec<DVec3> = (0..n).map(corner).collect();
    if out_of_umbra(&points, 0).dot(middle) > 0.0 {
        points.reverse();
    }
    points
}

/// Normal of the hard plane of edge k of a loop.
fn out_of_umbra(points: &[DVec3], k: usize) -> DVec3 {
    let (a, b) = (points[k], points[(k + 1) % points.len()]);
    (b - a).cross(-a).normalize()
}

/// A flat convex occluder: the hard count and the coverage of all its edges, added
/// up in lanes, against f64 (which `coverage_identity.rs` holds against polygon
/// clipping).
#[test]
fn a_convex_occluder_hides_in_lanes_what_it_hides_in_f64() {
    let mut random = Random(23);
    for shape in shapes() {
        let (light, rows) = projector(&shape);
        let plane = LightPlane::new(&shape, SphereOutline::Seen).unwrap();
        let (mut worst, mut partly, mut without_count) = (0.0f64, 0, 0);
        for _ in 0..25 {
            let points = occluder(&mut random);
            let normals: Vec<DVec3> = (0..points.len())
                .map(|k| wide(out_of_umbra(&points, k)))
                .collect();
            let receivers: Vec<DVec3> = (0..COUNT)
                .map(|_| wide(DVec3::new(0.0, 0.0, -4.0) + random.point(0.9)))
                .collect();
            let hard = |p: &DVec3| {
                let inside = normals.iter().all(|n| n.dot(*p) < 0.0);
                if inside { 0.0 } else { 1.0 }
            };
            let mut gpu = gpu();
            let positions = texture(&mut gpu, Format::Rgba32Float);
            let out = texture(&mut gpu, Format::R32Float);
            let mut write = |to, texels: Vec<[f32; 4]>| {
                let target = gpu.texture_mut(to).unwrap();
                target.write_color(Subresource::default(), &texels).unwrap();
            };
            let at = |p: &DVec3| [p.x as f32, p.y as f32, p.z as f32, 1.0];
            write(positions, receivers.iter().map(at).collect());
            write(out, receivers.iter().map(|p| [hard(p); 4]).collect());
            let edges = (0..points.len()).map(|k| {
                let ends = [points[k], points[(k + 1) % points.len()]];
                let shader = Penumbra {
                    light,
                    covering: ExactCoverage,
                    edge: ends.map(|e| narrow(DVec3::from_array(rows.map(|r| r.dot(e))))),
                    plane: HardPlane::through_centre(narrow(normals[k])),
                    to: CoverTo::Visibility,
                };
                full_screen(shader.stage(), ColorTargetState::ADDITIVE, &[positions; 2])
            });
            let draws = edges.collect();
            submit(&mut gpu, out, LoadOp::Load, draws);
            for (p, got) in receivers.iter().zip(red(&gpu, out)) {
                let projection = plane.seen_from(*p).unwrap();
                // The coverage of one edge jumps where it ends at the light's centre;
                // and here sides were decided by another tree of operations.
                let degenerate = (0..points.len()).any(|k| {
                    let image = projection.homogeneous(points[k]);
                    (image.truncate() / image.z).length() < 0.02 || normals[k].dot(*p).abs() < 1e-5
                });
                if degenerate {
                    continue;
                }
                let truth = loop_visibility(&plane, &points, *p).unwrap();
                worst = worst.max((f64::from(got) - truth).abs());
                partly += i32::from(truth > 0.001 && truth < 0.999);
                let uncounted = f64::from(got + 1.0 - hard(p));
                without_count += i32::from((uncounted - truth).abs() > 0.9);
            }
        }
        println!("{shape:?}: {worst:e}, {partly} partly lit");
        assert!(worst < 1e-5 && partly > 10_000, "{shape:?}: {worst:e}");
        assert!(without_count > 1000, "negative control: {without_count}");
    }
}

/// Counts one quad over the whole screen, seen from outside it.
fn count_everywhere(normal: DVec3, positions: TextureId) -> Draw {
    let identity = [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|k| if i == k { 1.0 } else { 0.0 }));
    let pipeline = RenderPipeline {
        label: "count".into(),
        vertex: HardQuads {
            clip_from_world: ClipFromWorld(identity),
            offsets: false,
        }
        .stage(),
        fragment: Some(
            HardCount {
                origin: [0.0; 3],
                to: CountTo::Visibility,
            }
            .stage(),
        ),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::ADDITIVE],
    };
    let corners = [[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]];
    let [x, y, z] = narrow(normal);
    let vertex = |[u, v]: [f32; 2]| [u, v, 0.0, 1.0, x, y, z, 0.0];
    let vertices = VertexBuffer {
        data: corners.into_iter().flat_map(vertex).collect(),
        stride: 8,
    };
    let indices = Arc::new(IndexBuffer::new(vec![0, 1, 2]));
    let mut draw = Draw::indexed("count", &Arc::new(pipeline), &Arc::new(vertices), &indices);
    draw.textures = vec![TextureBinding {
        texture: positions,
        sampler: Sampler::default(),
    }];
    draw
}

/// An edge longer than the light is wide, its hard plane's normal, and receivers on
/// that plane behind the middle of the edge, and -2 to 2 ulp off.
fn receivers_on_a_plane(random: &mut Random) -> ([DVec3; 2], DVec3, Vec<[f32; 4]>) {
    let slope = random.point(0.3);
    let along = DVec3::new(1.5, slope.x, 0.0);
    let middle = DVec3::new(0.0, slope.y, -2.0);
    let ends = [middle - along, middle + along].map(wide);
    let normal = (ends[1] - ends[0]).cross(-ends[0]).normalize();
    let nudged = |v: f64, ulps: i32| f32::from_bits(((v as f32).to_bits() as i32 + ulps) as u32);
    let receiver = |k: usize| {
        let e = ends[0] + (ends[1] - ends[0]) * (0.4 + 0.2 * random.unit());
        let p = e * (1.5 + random.unit());
        [p.x as f32, nudged(p.y, k as i32 % 5 - 2), p.z as f32, 1.0]
    };
    let texels = (0..COUNT).map(receiver).collect();
    (ends, normal, texels)
}

/// Half of the light is seen on a quad's plane, and a few ulp beside it: count and
/// sign agree to the bit. With another plane for the sign they would not.
#[test]
fn count_and_sign_agree_next_to_the_plane() {
    let mut random = Random(11);
    let (light, rows) = projector(&shapes()[0]);
    let mut mismatched = 0;
    for _ in 0..20 {
        let (ends, normal, texels) = receivers_on_a_plane(&mut random);
        let mut gpu = gpu();
        let positions = texture(&mut gpu, Format::Rgba32Float);
        let target = gpu.texture_mut(positions).unwrap();
        target.write_color(Subresource::default(), &texels).unwrap();
        let mut seen_with = |plane: DVec3| {
            let shader = Penumbra {
                light,
                covering: ExactCoverage,
                edge: ends.map(|e| narrow(DVec3::from_array(rows.map(|r| r.dot(e))))),
                plane: HardPlane::through_centre(narrow(plane)),
                to: CoverTo::Visibility,
            };
            let out = texture(&mut gpu, Format::R32Float);
            let wedge = full_screen(shader.stage(), ColorTargetState::ADDITIVE, &[positions; 2]);
            let draws = vec![count_everywhere(normal, positions), wedge];
            submit(&mut gpu, out, LoadOp::Clear([1.0; 4]), draws);
            red(&gpu, out)
        };
        for v in seen_with(normal) {
            assert!((v - 0.5).abs() < 1e-4, "{v}");
        }
        let other = (normal + DVec3::new(0.0, 0.0, 3e-7)).normalize();
        mismatched += seen_with(other)
            .iter()
            .filter(|v| (**v - 0.5).abs() > 0.9)
            .count();
    }
    assert!(mismatched > 1000, "negative control: {mismatched}");
}

/// The same with coverage of 12 bits in two buffers: what they add up to, before
/// anything is clamped, stays within 0..=4095.
#[test]
fn split_coverage_stays_in_range_next_to_the_plane() {
    let mut random = Random(12);
    let (light, rows) = projector(&shapes()[0]);
    let mut outside = 0;
    for _ in 0..20 {
        let (ends, normal, texels) = receivers_on_a_plane(&mut random);
        let mut gpu = gpu();
        let positions = texture(&mut gpu, Format::Rgba32Float);
        let target = gpu.texture_mut(positions).unwrap();
        target.write_color(Subresource::default(), &texels).unwrap();
        let hard = texture(&mut gpu, Format::R32Float);
        let count = count_everywhere(normal, positions);
        submit(&mut gpu, hard, LoadOp::Clear([1.0; 4]), vec![count]);
        let hard = red(&gpu, hard);
        let mut whole = |plane: DVec3, halves| -> Vec<f32> {
            let shader = SplitPenumbra {
                light,
                edge: ends.map(|e| narrow(DVec3::from_array(rows.map(|r| r.dot(e))))),
                plane: HardPlane::through_centre(narrow(plane)),
                tables: Tables::default(),
                halves,
            };
            let buffer = texture(&mut gpu, Format::Rgba8Unorm);
            let wedge = full_screen(shader.stage(), ColorTargetState::ADDITIVE, &[positions]);
            submit(&mut gpu, buffer, LoadOp::Clear([0.0; 4]), vec![wedge]);
            let texels = gpu.texture(buffer).unwrap();
            let texels = texels.read_color(Subresource::default()).unwrap();
            let value = |t: [f32; 4]| {
                let [a, b, c, d] = t.map(|c| (c * 255.0).round());
                a + 8.0 * b + 64.0 * c + 512.0 * d
            };
            texels.iter().map(|t| value(t.0)).collect()
        };
        let mut visible = |plane: DVec3| -> Vec<f32> {
            let [inner, outer] = [Halves::Inner, Halves::Outer].map(|h| whole(plane, h));
            let sums = hard.iter().zip(inner.iter().zip(&outer));
            sums.map(|(hard, (inner, outer))| 4095.0 * hard + inner - outer)
                .collect()
        };
        for v in visible(normal) {
            assert!((v - 2047.5).abs() <= 1.0, "{v}");
        }
        let other = (normal + DVec3::new(0.0, 0.0, 3e-7)).normalize();
        let leaves = |v: &&f32| !(0.0..=4095.0).contains(*v);
        outside += visible(other).iter().filter(leaves).count();
    }
    assert!(outside > 1000, "negative control: {outside}");
}

/// An edge in m pieces covers what it does in one.
#[test]
fn pieces_of_an_edge_cover_what_it_does() {
    let mut random = Random(5);
    let (light, rows) = projector(&shapes()[0]);
    let ends = [DVec3::new(-0.9, 0.13, -2.0), DVec3::new(0.8, 0.31, -2.2)].map(wide);
    let normal = (ends[1] - ends[0]).cross(-ends[0]).normalize();
    let texels: Vec<[f32; 4]> = (0..COUNT)
        .map(|_| {
            let [x, y, z] = narrow(DVec3::new(0.0, 0.3, -4.0) + random.point(0.8));
            [x, y, z, 1.0]
        })
        .collect();
    let mut gpu = gpu();
    let positions = texture(&mut gpu, Format::Rgba32Float);
    let target = gpu.texture_mut(positions).unwrap();
    target.write_color(Subresource::default(), &texels).unwrap();
    let mut covered = |m: u32| {
        let at = |k: u32| ends[0] + (ends[1] - ends[0]) * (f64::from(k) / f64::from(m));
        let pieces = (0..m).map(|k| {
            let piece = [at(k), at(k + 1)];
            let shader = Penumbra {
                light,
                covering: ExactCoverage,
                edge: piece.map(|e| narrow(DVec3::from_array(rows.map(|r| r.dot(e))))),
                plane: HardPlane::through_centre(narrow(normal)),
                to: CoverTo::Visibility,
            };
            full_screen(shader.stage(), ColorTargetState::ADDITIVE, &[positions; 2])
        });
        let draws = pieces.collect();
        let out = texture(&mut gpu, Format::R32Float);
        submit(&mut gpu, out, LoadOp::Clear([0.0; 4]), draws);
        red(&gpu, out)
    };
    let whole = covered(1);
    for m in [2, 5, 16, 64] {
        let drift = whole.iter().zip(covered(m)).map(|(a, b)| (a - b).abs());
        let drift = drift.fold(0.0, f32::max);
        println!("{m} pieces: {drift:e}");
        assert!(drift < 1e-5, "{m}: {drift:e}");
    }
}
