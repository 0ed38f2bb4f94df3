use gnomon::prelude::*;

#[test]
fn an_orange_triangle_keeps_its_bits() -> Result<(), Error> {
    let mask = [[-1.0, -1.0, 0.6], [0.0, -1.0, 0.6], [-1.0, 1.0, 0.6]];
    let corners = [[-0.8, -0.8, 0.5], [0.8, -0.8, 0.5], [0.0, 0.8, 0.5]];
    let orange = ScalarFragmentOutput::color([1.0, 0.5, 0.0, 1.0]);
    let mut frame = FrameBuilder::new(64, 64)?;
    frame.draw(TriangleDraw::new("mask", &mask).stencil(StencilFaceState::REPLACE, 1));
    let draw = TriangleDraw::new("orange", &corners).stencil(StencilFaceState::EQUAL, 0);
    let frame = frame.draw(draw.shade(move |_| orange)).build();
    let pixels = frame
        .draw(GpuConfig::default())?
        .output("color")?
        .read_rgba8()?;
    assert_eq!(pixels[64 * 40 + 32], [255, 128, 0, 255]);
    assert_frame!("triangle", &frame);
    Ok(())
}
