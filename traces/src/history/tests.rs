use std::sync::Arc;

use gnomon_raster::shader::{ScalarFragmentOutput, ScalarVertexOutput, per_fragment, per_vertex};
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    ColorAttachment, CommandList, DepthStencilAttachment, Draw, Format, FragmentEnd, GpuConfig,
    LoadOp, Recording, RenderPass, RenderPipeline, StoreOp, Subresource, TextureDescriptor,
    TextureId,
};

use super::{EventKind, HistoryError, HistoryOptions, Value, pixel};

const WHOLE: Subresource = Subresource { mip: 0, layer: 0 };

/// A big triangle, red in red.
fn triangle() -> Draw {
    let pipeline = RenderPipeline {
        label: "red".into(),
        vertex: per_vertex(&[], |v| {
            let [x, y] = [[-1.0, 3.0], [-1.0, -1.0], [3.0, -1.0]][v.vertex_index as usize % 3];
            ScalarVertexOutput {
                position: [x, y, 0.5, 1.0],
                ..Default::default()
            }
        }),
        fragment: Some(per_fragment(Default::default(), |_| ScalarFragmentOutput {
            color: [[1.0, 0.0, 0.0, 1.0]; 4],
            ..Default::default()
        })),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::OPAQUE],
    };
    Draw::vertices_only("triangle", &Arc::new(pipeline), 6)
}

fn color(texture: TextureId, load: LoadOp<[f32; 4]>, store: StoreOp) -> ColorAttachment {
    ColorAttachment {
        texture,
        subresource: WHOLE,
        load,
        store,
    }
}

fn pass(label: &str, color: Vec<ColorAttachment>, depth: Option<TextureId>) -> RenderPass {
    RenderPass {
        label: label.into(),
        draws: match color.len() {
            1 => vec![triangle()],
            _ => Vec::new(),
        },
        color,
        depth_stencil: depth.map(|texture| DepthStencilAttachment {
            texture,
            subresource: WHOLE,
            depth_load: LoadOp::Clear(1.0),
            depth_store: StoreOp::Discard,
            stencil_load: LoadOp::DontCare,
            stencil_store: StoreOp::Store,
        }),
    }
}

/// A map of another size, depth alone, then colour with that depth.
fn recording() -> Recording {
    let mut r = Recording::default();
    let image = |label, format, side| TextureDescriptor::d2(label, format, side, side);
    let map = r.create(&image("map", Format::Rgba8Unorm, 40)).unwrap();
    let depth = image("depth", Format::Depth24Stencil8, 16);
    let depth = r.create(&depth).unwrap();
    let out = r.create(&image("out", Format::Rgba8Unorm, 16)).unwrap();
    r.name_output("color", out).unwrap();
    r.name_output("map", map).unwrap();
    let clear = LoadOp::Clear([0.0, 0.2, 0.0, 1.0]);
    r.list = CommandList {
        passes: vec![
            pass("map", vec![color(map, clear, StoreOp::Store)], None),
            pass("early", Vec::new(), Some(depth)),
            pass(
                "late",
                vec![color(out, LoadOp::DontCare, StoreOp::Store)],
                Some(depth),
            ),
        ],
    };
    r
}

fn options(image: Option<&str>) -> HistoryOptions {
    HistoryOptions {
        config: GpuConfig {
            threads: 1,
            ..GpuConfig::default()
        },
        image: image.map(str::to_owned),
    }
}

/// Only passes that share an image with the one looked at are told of, depth alone too.
#[test]
fn a_history_follows_an_image_and_what_is_attached_beside_it() {
    let h = pixel(&recording(), &options(None), [3, 4]).unwrap();
    assert_eq!(h.size, [16, 16]);
    let labels: Vec<_> = h.attachments.iter().map(|a| a.label.as_str()).collect();
    assert_eq!(labels, ["depth", "out"]);
    let passes: Vec<_> = h.events.iter().map(|e| e.pass_label.as_str()).collect();
    // Load and store of the early pass; load, two triangles and store of the late one.
    assert_eq!(passes, ["early", "early", "late", "late", "late", "late"]);
    let map = pixel(&recording(), &options(Some("map")), [39, 39]).unwrap();
    assert_eq!((map.size, map.events.len()), ([40, 40], 3));
    assert_eq!(map.last, [Value::Color([255, 0, 0, 255])]);
}

#[test]
fn clears_and_stores_are_events_that_chain() {
    let h = pixel(&recording(), &options(None), [3, 4]).unwrap();
    let depth: Vec<_> = h.events.iter().map(|e| e.depth_stencil.unwrap()).collect();
    let far = Value::DepthStencil(0xff_ffff, 0);
    assert_eq!(
        (depth[0].before, depth[0].after),
        (Value::DepthStencil(0, 0), far)
    );
    assert_eq!(
        (depth[1].before, depth[1].after),
        (far, Value::DepthStencil(0, 0))
    );
    assert!(matches!(h.events[1].kind, EventKind::Store { .. }));
    let red = Value::Color([255, 0, 0, 255]);
    let colors: Vec<_> = h.events[2..].iter().map(|e| e.color[0].after).collect();
    assert_eq!(colors, [Value::Color([0; 4]), red, red, red]);
    let (_, second) = h.fragment(4).unwrap();
    assert_eq!((second.primitive, second.end), (1, FragmentEnd::Written));
    assert_eq!(
        second.outputs,
        Some(vec![[1.0f32, 0.0, 0.0, 1.0].map(f32::to_bits)])
    );
}

#[test]
fn what_does_not_chain_is_a_fault() {
    let r = recording();
    let attachments = super::attachments::Attachments::of(&r, None).unwrap();
    let mut gpu = gnomon_raster::Gpu::new(options(None).config).unwrap();
    gpu.load(&r).unwrap();
    let first = attachments.read(&gpu, [3, 4]).unwrap();
    let mut found = super::fragments(&mut gpu, &r, [3, 4]).unwrap();
    let last = attachments.read(&gpu, [3, 4]).unwrap();
    let events = |found: &[_], last: &[_]| {
        super::event::events(&r, &attachments, found, first.clone(), last)
    };
    assert!(events(&found, &last).is_ok());
    let e = events(&found, &first).map(|_| ()).unwrap_err();
    assert!(
        matches!(e, HistoryError::Broken { ref what, .. } if what == "out"),
        "{e}"
    );
    // The first is of the map's pass, which is not followed.
    found[2].record.color[0][0][1] = 7;
    let e = events(&found, &last).map(|_| ()).unwrap_err();
    assert!(matches!(e, HistoryError::Broken { pass: 2, .. }), "{e}");
}

#[test]
fn a_debugger_is_led_to_the_fragment() {
    let (r, o) = (recording(), options(None));
    let h = pixel(&r, &o, [3, 4]).unwrap();
    let d = h.debug(&r, &o, 4).unwrap();
    // The map's pass has two fragments at the place, too; rows 0 to 3 are two packets.
    assert_eq!(d.commands[1], "ignore 1 3");
    assert_eq!(d.commands[5], "ignore 2 2");
    assert!(d.is_run && d.fragment.unwrap().identity.is_none());
    let numbers: Vec<_> = d.vertices.iter().map(|v| v.number).collect();
    assert_eq!(numbers, [3, 4, 5]);
    assert_eq!(d.vertices[0].position, [-1.0, 3.0, 0.5, 1.0]);
    let e = h.debug(&r, &o, 0).unwrap_err().to_string();
    assert_eq!(e, "the pixel has no fragment 0; fragments are 3, 4");
}

#[test]
fn what_is_not_there_is_said() {
    let ask = |image, at| {
        let h = pixel(&recording(), &options(image), at);
        h.map(|_| ()).unwrap_err().to_string()
    };
    assert_eq!(
        ask(None, [16, 0]),
        "pixel (16, 0) is outside of the image; valid are columns 0 to 15 and rows 0 to 15"
    );
    assert_eq!(
        ask(Some("colour"), [0, 0]),
        "the frame has no output `colour`; it has color, map"
    );
    let empty = pixel(&Recording::default(), &options(None), [0, 0]);
    assert_eq!(empty.unwrap_err(), HistoryError::NotDrawn);
}
