//! Whether surfaces at the depth of a wedge's front face are inside of it (paper II): the
//! penumbra's shader on faces at depth 0, over surfaces there, a little before and behind.

use crate::soft_shaders::{COUNT, full_screen, gpu, red, submit, texture};
use gnomon_raster::state::ColorTargetState;
use gnomon_raster::{Format, LoadOp, Subresource};
use gnomon_shaders::penumbra::inside::{FrontTest, WedgeInside};
use gnomon_shaders::penumbra::intensity::{IntensityRates, Interpolation};
use gnomon_shaders::penumbra::plane::ScreenPlane;
use gnomon_shaders::penumbra::tiles::WedgePlanes;

/// One step of a depth of 24 bits.
const STEP: f32 = 1.0 / 16_777_215.0;

/// What a face that is tested so adds to full light, over surfaces at `depth`; planes have
/// the values `front` and 1 everywhere.
fn added(test: FrontTest, depth: f32, front: f32) -> f32 {
    let constant = |value: f32| ScreenPlane([0.0, 0.0, value, 0.0]);
    let mut gpu = gpu();
    let surface = texture(&mut gpu, Format::R32Float);
    let target = gpu.texture_mut(surface).unwrap();
    target
        .write_color(Subresource::default(), &[[depth; 4]; COUNT])
        .unwrap();
    let out = texture(&mut gpu, Format::R16Sint);
    let shader = WedgeInside {
        wedge: WedgePlanes {
            planes: [front, 1.0, 1.0, 1.0].map(constant),
            front_margin: 0.02,
            bottom: None,
        },
        rates: IntensityRates {
            back_over_front: [1.0; 2],
            first_over_second: 1.0,
            interpolation: Interpolation::Linear,
        },
        front: test,
        classes: None,
    };
    let draw = full_screen(shader.stage(), ColorTargetState::ADDITIVE, &[surface]);
    submit(&mut gpu, out, LoadOp::Clear([0.0; 4]), vec![draw]);
    red(&gpu, out)[0]
}

/// A ray that enters by the front has passed it when the surface is behind, and not at it:
/// the umbra's test is "less".
#[test]
fn surfaces_at_a_front_that_rays_enter_by_are_before_it() {
    assert_eq!(added(FrontTest::Entered, 0.0, 0.0), 0.0);
    assert_eq!(added(FrontTest::Entered, STEP, 0.0), 255.0);
}

/// One that leaves by it is inside up to and at the front.
#[test]
fn surfaces_at_a_front_that_rays_leave_by_are_inside() {
    assert_eq!(added(FrontTest::Left, 0.0, 0.0), 255.0);
    assert_eq!(added(FrontTest::Left, STEP, 0.0), 0.0);
}

/// The depth test decides where the plane's own value is within rounding of 0, and there
/// is full light; farther out the plane does.
#[test]
fn depth_decides_within_the_margin_of_the_front_plane() {
    assert_eq!(added(FrontTest::Entered, STEP, -0.01), 255.0);
    assert_eq!(added(FrontTest::Entered, STEP, -0.03), 0.0);
}
