//! What is taken of a light through occlusion maps, against the formulas: one triangle over
//! the screen, one map over the world.

use std::sync::Arc;

use glam::DVec3;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    ColorAttachment, CommandList, Draw, Format, Gpu, GpuConfig, LoadOp, RenderPass, RenderPipeline,
    Sampler, StoreOp, Subresource, TextureBinding, TextureDescriptor, VertexBuffer,
};
use gnomon_shaders::deferred::obscured::{
    Combine, Highlight, ObscuredRadiance, OcclusionMap, Transported,
};
use gnomon_shaders::transform::ClipFromWorld;

const SIDE: u32 = 16;
/// Of the light.
const ENERGY: [f32; 3] = [3.0, 2.0, 0.5];
/// Transport towards the light, and how much of the light the object leaves itself.
const TRANSPORT: f32 = 0.25;
const OPEN: f32 = 0.75;
const NORMAL: [f32; 3] = [0.0, 0.0, 1.0];
const TOWARDS: [f32; 3] = [0.48, 0.0, 0.8771545];
const EYE: [f32; 3] = [-0.9, 0.1, 2.0];
const SHININESS: f32 = 6.0;

/// Positions -1..1 over the screen, at z = 0; a light's numbers at every vertex.
fn triangle() -> VertexBuffer {
    let vertex = |x: f32, y: f32| {
        let [nx, ny, nz] = NORMAL;
        [x, y, 0.0, nx, ny, nz, TRANSPORT, OPEN]
    };
    VertexBuffer {
        data: [vertex(-1.0, -1.0), vertex(3.0, -1.0), vertex(-1.0, 3.0)].concat(),
        stride: 8,
    }
}

/// Diffuse and glossy radiance taken, by pixel, where `maps` hide `hidden` each.
fn taken(maps: Vec<OcclusionMap>, hidden: f32, combine: Combine) -> [Vec<[f32; 4]>; 2] {
    let mut gpu = Gpu::new(GpuConfig::default()).unwrap();
    let mut texture = |format: Format, side: u32| {
        gpu.create_texture(&TextureDescriptor::d2("t", format, side, side))
            .unwrap()
    };
    let atlas = texture(Format::R32Float, 8);
    let targets = [0, 1].map(|_| texture(Format::Rgba32Float, SIDE));
    let texels = [[hidden, 0.0, 0.0, 0.0]; 64];
    let target = gpu.texture_mut(atlas).unwrap();
    target.write_color(Subresource::default(), &texels).unwrap();
    // Position to clip space as it is, half way down the depths.
    let rows = [
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.5],
        [0.0, 0.0, 0.0, 1.0],
    ];
    let shader = ObscuredRadiance {
        energy: ENERGY,
        combine,
        maps,
        highlight: Some(Highlight {
            towards: TOWARDS,
            eye: EYE,
            shininess: SHININESS,
        }),
    };
    let pipeline = RenderPipeline {
        label: "obscured".into(),
        vertex: Transported {
            clip_from_world: ClipFromWorld(rows),
            light: 0,
        }
        .stage(),
        fragment: Some(shader.stage()),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::OPAQUE; 2],
    };
    let draw = Draw {
        vertices: Some(Arc::new(triangle())),
        textures: vec![TextureBinding {
            texture: atlas,
            sampler: Sampler::default(),
        }],
        ..Draw::vertices_only("obscured", &Arc::new(pipeline), 3)
    };
    let attachment = |texture| ColorAttachment {
        texture,
        subresource: Subresource::default(),
        load: LoadOp::Clear([9.0; 4]),
        store: StoreOp::Store,
    };
    let pass = RenderPass {
        label: "obscured".into(),
        color: targets.map(attachment).to_vec(),
        depth_stencil: None,
        draws: vec![draw],
    };
    gpu.submit(&CommandList { passes: vec![pass] }).unwrap();
    targets.map(|t| {
        let texels = gpu.texture(t).unwrap();
        let texels = texels.read_color(Subresource::default()).unwrap();
        texels.iter().map(|t| t.0).collect()
    })
}

/// Over all of the screen, in all of the atlas; occluders lie before z = 1.
fn everywhere() -> OcclusionMap {
    OcclusionMap {
        place: [
            [0.5, 0.0, 0.0, 0.5],
            [0.0, 0.5, 0.0, 0.5],
            [0.0, 0.0, 0.0, 1.0],
        ],
        below: [0.0, 0.0, -1.0, 1.0],
        cell: [0.0, 0.0, 8.0, 8.0],
    }
}

/// Where a pixel's middle is.
fn position(i: usize) -> DVec3 {
    let [x, y] = [i as u32 % SIDE, i as u32 / SIDE].map(f64::from);
    let side = f64::from(SIDE);
    DVec3::new(
        (x + 0.5) / side * 2.0 - 1.0,
        1.0 - (y + 0.5) / side * 2.0,
        0.0,
    )
}

/// Phong's lobe round the mirrored light, over π.
fn phong(p: DVec3) -> f64 {
    let wide = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let (normal, towards) = (wide(NORMAL), wide(TOWARDS));
    let mirrored = normal * (2.0 * normal.dot(towards)) - towards;
    let cosine = mirrored.dot((wide(EYE) - p).normalize()).max(0.0);
    libm::pow(cosine, f64::from(SHININESS)) / std::f64::consts::PI
}

/// Equations 8 and 15: the light, times transport or the lobe and what the object leaves,
/// times what is hidden.
#[test]
fn what_is_taken_is_light_times_transport_times_occlusion() {
    let hidden = 0.6;
    let [diffuse, glossy] = taken(vec![everywhere()], hidden, Combine::Product);
    let mut brightest = 0.0f64;
    for (i, (d, g)) in diffuse.iter().zip(&glossy).enumerate() {
        let lobe = phong(position(i));
        brightest = brightest.max(lobe);
        for c in 0..3 {
            let lost = f64::from(ENERGY[c]) * f64::from(hidden);
            let expected = [lost * f64::from(TRANSPORT), lost * lobe * f64::from(OPEN)];
            for (got, expected) in [d[c], g[c]].into_iter().zip(expected) {
                assert!((f64::from(got) - expected).abs() < 1e-5, "{i}: {d:?} {g:?}");
            }
        }
    }
    assert!(brightest > 0.1, "{brightest}");
}

/// Occluders hide nothing from what lies nearer to the light than all of them.
#[test]
fn nothing_is_taken_before_the_occluders() {
    let split = OcclusionMap {
        // Above 0 on the right half alone.
        below: [1.0, 0.0, 0.0, 0.0],
        ..everywhere()
    };
    let [diffuse, glossy] = taken(vec![split], 1.0, Combine::Product);
    for (i, (d, g)) in diffuse.iter().zip(&glossy).enumerate() {
        let is_behind = position(i).x > 0.0;
        assert_eq!(d[0] > 0.0, is_behind, "{i}: {d:?}");
        assert_eq!(
            g[0] > 0.0,
            is_behind && phong(position(i)) > 0.0,
            "{i}: {g:?}"
        );
    }
}

/// Two maps, in the four ways.
#[test]
fn groups_are_combined_as_their_names_say() {
    let expected = [
        (Combine::Product, 1.0 - 0.4 * 0.4),
        (Combine::Min, 0.6),
        (Combine::Sum, 1.0),
        (Combine::Midpoint, 0.8),
    ];
    for (combine, share) in expected {
        let [diffuse, _] = taken(vec![everywhere(); 2], 0.6, combine);
        let all = ENERGY[0] * TRANSPORT;
        assert!(
            diffuse.iter().all(|d| (d[0] - all * share).abs() < 1e-6),
            "{combine:?}: {}",
            diffuse[0][0] / all
        );
    }
}
