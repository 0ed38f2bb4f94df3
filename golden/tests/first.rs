//! A first test of a frame.

use gnomon_golden::{assert_frame, triangles};
use gnomon_raster::shader::ScalarFragmentOutput;

#[test]
fn an_orange_triangle_keeps_its_bits() {
    let corners = [[-0.8, -0.8, 0.5], [0.8, -0.8, 0.5], [0.0, 0.8, 0.5]];
    let orange = [1.0, 0.5, 0.0, 1.0];
    let frame = triangles([64, 64], &corners, move |_| {
        ScalarFragmentOutput::color(orange)
    });
    assert_frame!("triangle", &frame.unwrap());
}
