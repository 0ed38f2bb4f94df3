//! A first test of a frame.
use gnomon::prelude::*;
#[test]
fn an_orange_triangle_keeps_its_bits() {
    let mask = TriangleDraw::new("mask", &[[-1., -1., 0.5], [0., -1., 0.5], [0., 1., 0.5]]);
    let mask = mask.stencil(StencilFaceState::REPLACE, 1);
    let shown = TriangleDraw::new("shown", &[[-1., -1., 0.5], [1., -1., 0.4], [0., 1., 0.5]]);
    let shown = shown.stencil(StencilFaceState::EQUAL, 0);
    let orange = ScalarFragmentOutput::color([1.0, 0.5, 0.0, 1.0]);
    let mut frame = FrameBuilder::new(64, 64).unwrap();
    let frame = frame.draw(mask).draw(shown.shade(move |_| orange)).build();
    let drawn = frame.draw(GpuConfig::default()).unwrap();
    assert_eq!(drawn.read_rgba8("color").unwrap()[2600], [255, 128, 0, 255]);
    assert_frame!("triangle", &frame);
}
