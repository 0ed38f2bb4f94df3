//! Several samples of each pixel: the frame is drawn as many times as large, and its colours
//! are resolved by a pass of its own, which is counted as every other.

use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{LoadOp, RenderPass, RenderPipeline, TextureDescriptor};
use gnomon_shaders::box_resolve::BoxResolve;
use gnomon_shaders::transform::FullScreen;

use crate::parts::visibility::{attachment, binding, full_screen};
use crate::technique::{Frame, PassRole, TechniqueError};

/// Samples along a side of a pixel at most.
pub const MAX_SUPERSAMPLE: u32 = 8;

/// Adds the pass that resolves `side` × `side` samples of each pixel of a picture of `size`.
pub(super) fn resolved(
    mut frame: Frame,
    [width, height]: [u32; 2],
    side: u32,
) -> Result<Frame, TechniqueError> {
    let samples = frame.outputs.color;
    let recording = &mut frame.recording;
    let format = recording.texture(samples)?.descriptor().format;
    let desc = TextureDescriptor::d2("resolved color", format, width, height);
    let color = recording.create(&desc)?;
    let pipeline = RenderPipeline {
        label: "resolve samples".into(),
        vertex: FullScreen.stage(),
        fragment: Some(BoxResolve { side }.stage()),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::OPAQUE],
    };
    recording.list.passes.push(RenderPass {
        label: "resolve samples".into(),
        color: vec![attachment(color, LoadOp::DontCare)],
        depth_stencil: None,
        draws: vec![full_screen(pipeline, vec![binding(samples)])],
    });
    recording.name_output("color", color)?;
    frame.roles.push(PassRole::ResolveSamples, Vec::new());
    frame.outputs.color = color;
    Ok(frame)
}

/// Of each pixel what `resolve` makes of its samples, row by row from the first.
pub(super) fn each_pixel<T: Copy>(
    samples: &[T],
    [width, height]: [u32; 2],
    side: u32,
    resolve: impl Fn(&mut dyn Iterator<Item = T>) -> T,
) -> Vec<T> {
    let (columns, side) = (width as usize * side as usize, side as usize);
    let pixel = |x: usize, y: usize| {
        let rows = y * side..(y + 1) * side;
        let mut own = rows.flat_map(|row| {
            let first = row * columns + x * side;
            samples[first..first + side].iter().copied()
        });
        resolve(&mut own)
    };
    let all = (0..height as usize).flat_map(|y| (0..width as usize).map(move |x| (x, y)));
    all.map(|(x, y)| pixel(x, y)).collect()
}

/// The mean of what is a number; NaN where nothing is.
pub(super) fn mean(samples: &mut dyn Iterator<Item = f32>) -> f32 {
    let (mut sum, mut count) = (0.0_f64, 0.0_f64);
    for value in samples.filter(|v| !v.is_nan()) {
        sum += f64::from(value);
        count += 1.0;
    }
    (sum / count) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_of_a_pixel_are_those_that_it_covers() {
        let samples: Vec<u32> = (0..24).collect();
        let firsts = each_pixel(&samples, [3, 2], 2, |s| s.next().unwrap());
        assert_eq!(firsts, [0, 2, 4, 12, 14, 16]);
        let sums = each_pixel(&samples, [3, 2], 2, |s| s.sum());
        assert_eq!(sums[4], 14 + 15 + 20 + 21);
        assert_eq!(mean(&mut [1.0, f32::NAN, 0.5].into_iter()), 0.75);
        assert!(mean(&mut [f32::NAN].into_iter()).is_nan());
    }
}
