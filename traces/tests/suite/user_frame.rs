//! A frame as a user of the library writes it: two passes, depth, stencil, a texture.

use std::sync::Arc;

use gnomon_raster::shader::{
    FragmentOutputs, ScalarFragmentOutput, ScalarVertexOutput, per_fragment, per_vertex,
};
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    ColorAttachment, DepthStencilAttachment, Draw, Format, IndexBuffer, LoadOp, Recording,
    RenderPass, RenderPipeline, Sampler, StoreOp, Subresource, TextureBinding, TextureDescriptor,
    TextureId, VertexBuffer,
};
use gnomon_shaders::convolution::prefilter::CopyLevel;
use gnomon_shaders::surface::Constant;
use gnomon_shaders::transform::{ClipFromWorld, FullScreen, HomogeneousPoints};
use gnomon_traces::{Meta, RecordOptions, Trace, TraceError, record};

const SIZE: [u32; 2] = [72, 40];

fn pipeline(color: [f32; 4], depth_stencil: DepthStencilState) -> Arc<RenderPipeline> {
    let identity = core::array::from_fn(|i| core::array::from_fn(|j| f32::from(u8::from(i == j))));
    Arc::new(RenderPipeline {
        label: format!("{color:?}"),
        vertex: HomogeneousPoints(ClipFromWorld(identity)).stage(),
        fragment: Some(Constant(color).stage()),
        primitive: PrimitiveState::default(),
        depth_stencil,
        color_targets: vec![ColorTargetState::OPAQUE],
    })
}

fn color(texture: TextureId) -> ColorAttachment {
    ColorAttachment {
        texture,
        subresource: Subresource::default(),
        load: LoadOp::Clear([0.1, 0.2, 0.3, 1.0]),
        store: StoreOp::Store,
    }
}

/// Triangles over one another, then a copy of an image.
pub(crate) fn frame() -> Recording {
    frame_moved_by(0.0)
}

/// The same with its first corner farther right.
pub(crate) fn frame_moved_by(right: f32) -> Recording {
    let mut frame = Recording::default();
    let [w, h] = SIZE;
    let image = |label, format| TextureDescriptor::d2(label, format, w, h);
    let target = frame.create(&image("target", Format::Rgba8Unorm)).unwrap();
    let depth = frame
        .create(&image("depth", Format::Depth24Stencil8))
        .unwrap();
    let source = frame.create(&image("source", Format::Rgba16Float)).unwrap();
    let copy = frame.create(&image("copy", Format::Rgba16Float)).unwrap();
    let texels: Vec<_> = (0..w * h)
        .map(|i| [i as f32 * 0.25, 0.5, -1.0, 1.0])
        .collect();
    frame
        .write(source, Subresource::default(), &texels)
        .unwrap();
    frame.name_output("color", target).unwrap();
    frame.list.passes.push(triangles(target, depth, right));
    frame.list.passes.push(copying(source, copy));
    frame
}

fn triangles(target: TextureId, depth: TextureId, right: f32) -> RenderPass {
    let corner = |i: u32| {
        let [x, y] = [
            (i * 5 % 7) as f32 / 3.5 - 1.0,
            (i * 3 % 8) as f32 / 4.0 - 1.0,
        ];
        [x, y, (i % 5) as f32 / 5.0, 1.0]
    };
    let mut corners: Vec<[f32; 4]> = (0..12).map(corner).collect();
    corners[0][0] += right;
    let vertices = Arc::new(VertexBuffer {
        data: corners.concat(),
        stride: 4,
    });
    let indices = Arc::new(IndexBuffer::new((0..36).map(|i| i * 7 % 12).collect()));
    let opaque = pipeline([0.9, 0.4, 0.1, 1.0], DepthStencilState::opaque());
    let volume = pipeline([0.0, 0.0, 1.0, 1.0], DepthStencilState::z_fail_volumes());
    RenderPass {
        label: "triangles".into(),
        color: vec![color(target)],
        depth_stencil: Some(DepthStencilAttachment {
            texture: depth,
            subresource: Subresource::default(),
            depth_load: LoadOp::Clear(1.0),
            depth_store: StoreOp::Store,
            stencil_load: LoadOp::Clear(3),
            stencil_store: StoreOp::Store,
        }),
        draws: vec![
            Draw::indexed("opaque", &opaque, &vertices, &indices),
            Draw::indexed("volume", &volume, &vertices, &indices),
        ],
    }
}

fn copying(source: TextureId, copy: TextureId) -> RenderPass {
    let pipeline = Arc::new(RenderPipeline {
        label: "copy".into(),
        vertex: FullScreen.stage(),
        fragment: Some(
            CopyLevel {
                textures: 1,
                mip: 0,
            }
            .stage(),
        ),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::OPAQUE],
    });
    let mut draw = Draw::vertices_only("copy", &pipeline, 3);
    draw.textures.push(TextureBinding {
        texture: source,
        sampler: Sampler::default(),
    });
    RenderPass {
        label: "copying".into(),
        color: vec![color(copy)],
        depth_stencil: None,
        draws: vec![draw],
    }
}

/// The frame as a trace.
pub(crate) fn trace() -> Trace {
    record(Meta::new("user"), &frame(), RecordOptions::default()).unwrap()
}

/// Writes the golden of a user's frame; run once, when its format was new.
#[test]
#[ignore = "goldens are never written again"]
fn write_golden() {
    trace().write("tests/golden/v1/user-frame.gnt").unwrap();
}

#[test]
fn closures_cannot_be_recorded_by_name() {
    let refused = |vertex: bool| {
        let mut frame = frame();
        let draw = &mut frame.list.passes[0].draws[1];
        let mut pipeline = (*draw.pipeline).clone();
        if vertex {
            pipeline.vertex = per_vertex(&[], |_| ScalarVertexOutput::default());
        } else {
            let grey = ScalarFragmentOutput::color([0.5; 4]);
            pipeline.fragment = Some(per_fragment(FragmentOutputs::default(), move |_| grey));
        }
        draw.pipeline = Arc::new(pipeline);
        record(Meta::new("closure"), &frame, RecordOptions::default()).unwrap_err()
    };
    for (vertex, named) in [(true, "vertex"), (false, "fragment")] {
        let error = refused(vertex);
        assert!(matches!(&error, TraceError::NoIdentity { draw: 1, stage, .. } if *stage == named));
        let text = error.to_string();
        assert!(
            text.contains("draw 1 `volume` of pass `triangles`"),
            "{text}"
        );
        assert!(text.contains("record frozen"), "{text}");
    }
}
