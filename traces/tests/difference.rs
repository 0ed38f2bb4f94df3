//! Two frames that differ in one thing: the thing, the first draw and the pixel are found.

use std::sync::Arc;

use gnomon_raster::shader::{
    Fragment, FragmentShader, FragmentStage, Named, Vertex, VertexShader, VertexStage,
};
use gnomon_raster::state::{
    ColorTargetState, CompareFunction, DepthState, DepthStencilState, PrimitiveState,
    StencilFaceState, StencilOperation, StencilState,
};
use gnomon_raster::{
    ColorAttachment, DepthStencilAttachment, Draw, F32, Format, GpuConfig, Lanes, LoadOp,
    Recording, RenderPass, RenderPipeline, StoreOp, Subresource, TextureDescriptor, VertexBuffer,
    uniforms,
};
use gnomon_traces::{DrawHashes, Place, Suspects, bisect, compare_states, first_difference};

struct Positions {
    scale: f32,
}

impl VertexShader for Positions {
    #[inline(always)]
    fn shade<L: Lanes>(&self, _: L, v: &mut Vertex<'_, L>) {
        let [x, y] = [v.attribute(0) * self.scale, v.attribute(1) * self.scale];
        v.set_position([x, y, v.attribute(2), v.attribute(3)]);
    }
}
uniforms!(Positions { scale });
impl Named for Positions {
    const NAME: &'static str = "positions";
    const VERSION: u32 = 1;
}

struct Grey {
    level: f32,
}

impl FragmentShader for Grey {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        f.set_color(0, [F32::splat(l, self.level); 4]);
    }
}
uniforms!(Grey { level });
impl Named for Grey {
    const NAME: &'static str = "grey";
    const VERSION: u32 = 1;
}

const COUNTING: StencilFaceState = StencilFaceState {
    compare: CompareFunction::Always,
    fail_op: StencilOperation::Keep,
    depth_fail_op: StencilOperation::Keep,
    pass_op: StencilOperation::IncrementWrap,
    read_mask: 0xff,
    write_mask: 0xff,
};

fn pipeline(fragment: Option<f32>, face: StencilFaceState) -> Arc<RenderPipeline> {
    Arc::new(RenderPipeline {
        label: "pipeline".into(),
        vertex: VertexStage::named(Positions { scale: 1.0 }),
        fragment: fragment.map(|level| FragmentStage::named(Grey { level })),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState {
            depth: DepthState {
                compare: CompareFunction::Always,
                write: false,
                bounds: None,
            },
            stencil: StencilState {
                front: face,
                back: face,
            },
            ..DepthStencilState::default()
        },
        color_targets: vec![ColorTargetState::OPAQUE],
    })
}

/// A triangle around a corner of the screen.
fn triangle(label: &str, pipeline: &Arc<RenderPipeline>, size: f32) -> Draw {
    let at = |x: f32, y: f32| [x, y, 0.5, 1.0];
    let data = [at(-1.0, -1.0), at(-1.0 + size, -1.0), at(-1.0, -1.0 + size)].concat();
    let vertices = Arc::new(VertexBuffer { data, stride: 4 });
    Draw {
        vertices: Some(vertices),
        ..Draw::vertices_only(label, pipeline, 3)
    }
}

/// Eight volumes that count, then a floor wherever the count is not zero.
fn frame() -> Recording {
    let mut frame = Recording::default();
    let color = frame
        .create(&TextureDescriptor::d2(
            "picture",
            Format::Rgba8Unorm,
            150,
            90,
        ))
        .unwrap();
    let depth = frame
        .create(&TextureDescriptor::d2(
            "depth",
            Format::Depth24Stencil8,
            150,
            90,
        ))
        .unwrap();
    frame.name_output("picture", color).unwrap();
    let volumes = pipeline(None, COUNTING);
    let equal = StencilFaceState {
        compare: CompareFunction::NotEqual,
        pass_op: StencilOperation::Keep,
        ..COUNTING
    };
    let mut draws: Vec<Draw> = (0..8)
        .map(|i| triangle(&format!("volume {i}"), &volumes, 0.3 + 0.2 * i as f32))
        .collect();
    draws.push(triangle("floor", &pipeline(Some(0.5), equal), 4.0));
    frame.list.passes.push(RenderPass {
        label: "main".into(),
        color: vec![ColorAttachment {
            texture: color,
            subresource: Subresource::default(),
            load: LoadOp::Clear([0.0; 4]),
            store: StoreOp::Store,
        }],
        depth_stencil: Some(DepthStencilAttachment {
            texture: depth,
            subresource: Subresource::default(),
            depth_load: LoadOp::Clear(1.0),
            depth_store: StoreOp::Store,
            stencil_load: LoadOp::Clear(0),
            stencil_store: StoreOp::Discard,
        }),
        draws,
    });
    frame
}

fn changed(change: impl FnOnce(&mut Vec<Draw>)) -> Recording {
    let mut frame = frame();
    change(&mut frame.list.passes[0].draws);
    frame
}

fn config() -> GpuConfig {
    GpuConfig {
        threads: 1,
        ..GpuConfig::default()
    }
}

fn hashes(of: &Recording) -> DrawHashes {
    DrawHashes::of(of, config()).unwrap()
}

fn first(a: &Recording, b: &Recording) -> Option<gnomon_traces::FirstDifference> {
    first_difference([a, b], [&hashes(a), &hashes(b)], config()).unwrap()
}

#[test]
fn equal_frames_differ_in_nothing() {
    let (a, b) = (frame(), frame());
    assert_eq!(compare_states(&a, &b), []);
    assert_eq!(first(&a, &b), None);
    let none = bisect(&a, &b, Suspects::State, config()).unwrap_err();
    assert!(none.to_string().contains("same bits"), "{none}");
}

#[test]
fn one_operation_of_one_draw_is_found() {
    let b = changed(|draws| {
        let p = Arc::make_mut(&mut draws[7].pipeline);
        p.depth_stencil.stencil.front.pass_op = StencilOperation::Invert;
        p.depth_stencil.stencil.back.pass_op = StencilOperation::Invert;
    });
    // The front face alone is drawn: the back's operation is no cause.
    let a = frame();
    let states = compare_states(&a, &b);
    assert_eq!(states.len(), 2);
    assert_eq!(states[0].field, "depth_stencil.stencil.front.pass_op");
    assert_eq!(
        states[0].values,
        [Some("IncrementWrap".into()), Some("Invert".into())]
    );
    let first = first(&a, &b).unwrap();
    assert_eq!(first.draws, [Some([0, 7]); 2]);
    assert_eq!(first.labels, ["main", "volume 7"]);
    let [stencil] = &first.attachments[..] else {
        panic!("{first:?}")
    };
    assert_eq!(
        (stencil.aspect, stencil.values),
        ("stencil", [[1, 0, 0, 0], [255, 0, 0, 0]])
    );
}

#[test]
fn the_cause_of_a_pixel_is_found_among_many_changes() {
    let a = frame();
    let b = changed(|draws| {
        for draw in &mut draws[..8] {
            draw.stencil_reference = [3, 3]; // no operation uses it
        }
        let p = Arc::make_mut(&mut draws[8].pipeline);
        p.depth_stencil.stencil.front.compare = CompareFunction::Always;
        p.depth_stencil.bias.constant = 1.0; // depth is not looked at
        p.fragment = Some(FragmentStage::named(Grey { level: 0.5 }));
    });
    let cause = bisect(&a, &b, Suspects::State, config()).unwrap();
    assert_eq!(cause.of, 10);
    let [only] = &cause.differences[..] else {
        panic!("{cause:?}")
    };
    assert_eq!(only.field, "depth_stencil.stencil.front.compare");
    assert!(matches!(&only.place, Place::Draw { label, .. } if label == "floor"));
    assert_eq!(cause.pixel.aspect, "color");
    assert_eq!(cause.pixel.values, [[0; 4], [128; 4]]);
    assert!(cause.replays <= 4 + 8, "{} replays", cause.replays);
}

#[test]
fn uniforms_vertices_and_draws_are_told_and_blamed() {
    let a = frame();
    let b = changed(|draws| {
        Arc::make_mut(&mut draws[8].pipeline).fragment =
            Some(FragmentStage::named(Grey { level: 0.25 }));
    });
    let states = compare_states(&a, &b);
    assert_eq!(
        states[0].at.as_deref(),
        Some("uniforms, byte 0: 0.5 and 0.25")
    );
    let cause = bisect(&a, &b, Suspects::Shaders, config()).unwrap();
    assert_eq!(cause.differences, states);

    let mut b = frame();
    b.list.passes[0].draws[7] = triangle("volume 7", &a.list.passes[0].draws[7].pipeline, 1.9);
    let states = compare_states(&a, &b);
    assert!(
        states[0]
            .at
            .as_deref()
            .unwrap()
            .starts_with("vertex 1, float 0: 0.7"),
        "{states:?}"
    );
    assert_eq!(
        bisect(&a, &b, Suspects::State, config())
            .unwrap()
            .differences,
        states
    );
    let shaders = bisect(&a, &b, Suspects::Shaders, config()).unwrap_err();
    assert!(shaders.to_string().contains("0 differences"), "{shaders}");

    let b = changed(|draws| drop(draws.remove(7)));
    let first = first(&a, &b).unwrap();
    assert_eq!(first.draws, [Some([0, 7]), None]);
    let cause = bisect(&a, &b, Suspects::State, config()).unwrap();
    assert_eq!(cause.differences[0].field, "draw");
    assert_eq!(cause.differences[0].values[1], None);
}

#[test]
fn what_a_pass_begins_with_is_told_and_blamed() {
    let a = frame();
    let mut b = frame();
    b.list.passes[0].color[0].load = LoadOp::Clear([1.0; 4]);
    let cause = bisect(&a, &b, Suspects::State, config()).unwrap();
    assert_eq!(cause.differences[0].field, "color[0]");
    assert!(matches!(
        cause.differences[0].place,
        Place::Pass {
            numbers: [Some(0), Some(0)],
            ..
        }
    ));
}

/// One change in each draw in turn: told as the only one, first seen where it was made.
#[test]
fn a_single_change_in_any_draw_is_found() {
    type Change = (&'static str, fn(&mut Draw));
    let a = frame();
    let changes: [Change; 4] = [
        ("depth_stencil.stencil.front.pass_op", |d| {
            let p = Arc::make_mut(&mut d.pipeline);
            p.depth_stencil.stencil.front.pass_op = StencilOperation::DecrementWrap;
        }),
        ("depth_stencil.depth.compare", |d| {
            Arc::make_mut(&mut d.pipeline).depth_stencil.depth.compare = CompareFunction::Never;
        }),
        ("vertex shader", |d| {
            Arc::make_mut(&mut d.pipeline).vertex = VertexStage::named(Positions { scale: 0.9 });
        }),
        ("vertices", |d| {
            let mut buffer = (**d.vertices.as_ref().unwrap()).clone();
            buffer.data[4] -= 0.1;
            d.vertices = Some(Arc::new(buffer));
        }),
    ];
    for number in 0..8 {
        for (field, change) in changes {
            let b = changed(|draws| change(&mut draws[number]));
            let states = compare_states(&a, &b);
            let [only] = &states[..] else {
                panic!("{states:?}")
            };
            assert_eq!(only.field, field);
            let place = first(&a, &b).unwrap_or_else(|| panic!("{number} {field}"));
            assert_eq!(place.draws, [Some([0, number]); 2], "{field}");
        }
    }
}

/// A draw that writes what is there already, over more or fewer blocks.
fn same_again(size: f32) -> Draw {
    let always = StencilFaceState {
        pass_op: StencilOperation::Keep,
        ..COUNTING
    };
    triangle("same again", &pipeline(Some(0.0), always), size)
}

#[test]
fn which_blocks_were_written_is_no_difference_where_they_hold_the_same() {
    let a = changed(|draws| draws.insert(0, same_again(0.5)));
    let b = changed(|draws| draws.insert(0, same_again(2.0)));
    assert_ne!(hashes(&a).tiles(0, 0), hashes(&b).tiles(0, 0));
    assert_eq!(first(&a, &b), None);
    let b = changed(|draws| {
        draws[5].count = 0;
        draws.insert(0, same_again(2.0));
    });
    let found = first(&a, &b).unwrap();
    assert_eq!(found.draws, [Some([0, 6]); 2]);
    assert_eq!(found.attachments[0].aspect, "stencil");
}

/// The same pass twice, the second on the depth and stencil that the first left, which
/// forgets its stencil.
fn twice() -> Recording {
    let mut frame = frame();
    let mut second = frame.list.passes[0].clone();
    second.label = "again".into();
    let depth = second.depth_stencil.as_mut().unwrap();
    depth.depth_load = LoadOp::Load;
    depth.stencil_load = LoadOp::Load;
    second.draws[..8].iter_mut().for_each(|d| d.count = 0);
    second.draws.insert(0, same_again(2.0));
    frame.list.passes.push(second);
    frame
}

#[test]
fn a_difference_in_a_later_pass_is_found_on_what_the_earlier_left() {
    let mut a = twice();
    a.list.passes[1].draws[0] = same_again(0.5);
    let mut b = twice();
    // Whatever is counted now stays, and the floor sees it.
    b.list.passes[1].draws[8].count = 3;
    let found = first(&a, &b).unwrap();
    assert_eq!(found.draws, [Some([1, 8]); 2]);
    let [stencil] = &found.attachments[..] else {
        panic!("{found:?}")
    };
    // The first pass forgot its counts.
    assert_eq!(stencil.values, [[0; 4], [1, 0, 0, 0]]);
}
