//! The bounds that moments give, against distributions of a few depths: never below the
//! truth, and equal to it where they should be sharp (docs/papers.md, baselines).

use std::sync::Arc;

use gnomon_raster::shader::{Fragment, FragmentShader};
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    ColorAttachment, CommandList, Draw, F32, Format, Gpu, GpuConfig, Lanes, LoadOp, RenderPass,
    RenderPipeline, StoreOp, Subresource, TextureDescriptor,
};
use gnomon_shaders::moments::Moments;
use gnomon_shaders::transform::FullScreen;

/// Receivers' depths that are tried.
const DEPTHS: u32 = 64;
const LEAST: f32 = 1e-6;

/// Depths with their shares of a kernel.
type Mixture = &'static [[f32; 2]];

/// The bound at depth (column + 1/2) / [`DEPTHS`].
struct Probe {
    moments: Moments,
    mixture: Mixture,
}

impl FragmentShader for Probe {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let mut means = [F32::splat(l, 0.0); 4];
        for [depth, share] in self.mixture {
            let of = self.moments.of(l, F32::splat(l, *depth));
            for (mean, value) in means.iter_mut().zip(of) {
                *mean = *mean + value * *share;
            }
        }
        let depth = f.x() * (1.0 / DEPTHS as f32);
        let visible = self.moments.visible(l, means, depth, LEAST);
        f.set_color(0, [visible, depth, means[0], means[1]]);
    }
}

/// Depth and bound of each column.
fn bounds(moments: Moments, mixture: Mixture) -> Vec<[f64; 2]> {
    let mut gpu = Gpu::new(GpuConfig::default()).unwrap();
    let desc = TextureDescriptor::d2("bounds", Format::Rgba32Float, DEPTHS, 1);
    let texture = gpu.create_texture(&desc).unwrap();
    let pipeline = RenderPipeline {
        label: "bounds".into(),
        vertex: FullScreen.stage(),
        fragment: Some(Probe { moments, mixture }.into()),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::OPAQUE],
    };
    let pass = RenderPass {
        label: "bounds".into(),
        color: vec![ColorAttachment {
            texture,
            subresource: Subresource::default(),
            load: LoadOp::DontCare,
            store: StoreOp::Store,
        }],
        depth_stencil: None,
        draws: vec![Draw::vertices_only("bounds", &Arc::new(pipeline), 3)],
    };
    gpu.submit(&CommandList { passes: vec![pass] }).unwrap();
    let texels = gpu.texture(texture).unwrap();
    let texels = texels.read_color(Subresource::default()).unwrap();
    let values = texels.iter().map(|t| [t.0[1], t.0[0]].map(f64::from));
    values.collect()
}

/// The share that is no nearer than `depth`.
fn truth(mixture: Mixture, depth: f64) -> f64 {
    let beyond = mixture.iter().filter(|[z, _]| f64::from(*z) >= depth);
    beyond.map(|[_, share]| f64::from(*share)).sum()
}

const ALL: [Moments; 4] = [
    Moments::Variance,
    Moments::Exponential(5.0),
    Moments::Exponential(20.0),
    Moments::Four(1e-6),
];

const ONE: Mixture = &[[0.4, 1.0]];
const TWO: Mixture = &[[0.2, 0.3], [0.83, 0.7]];
const FAR: Mixture = &[[0.1, 0.9], [0.97, 0.1]];
const THREE: Mixture = &[[0.1, 0.2], [0.5, 0.5], [0.9, 0.3]];
const SPREAD: Mixture = &[
    [0.05, 0.2],
    [0.3, 0.2],
    [0.45, 0.2],
    [0.7, 0.2],
    [0.95, 0.2],
];

#[test]
fn no_bound_is_below_the_truth() {
    for mixture in [ONE, TWO, FAR, THREE, SPREAD] {
        for moments in ALL {
            for [depth, bound] in bounds(moments, mixture) {
                let least = truth(mixture, depth);
                assert!(
                    bound >= least - 2e-3 && bound <= 1.0,
                    "{moments:?} {mixture:?} at {depth}: {bound} below {least}"
                );
            }
        }
    }
}

/// How far the bound is above the truth between two depths, in the mean.
fn leak(moments: Moments, mixture: Mixture, between: [f64; 2]) -> f64 {
    let all = bounds(moments, mixture).into_iter();
    let inside = all.filter(|[d, _]| (between[0]..between[1]).contains(d));
    let leaks: Vec<f64> = inside
        .map(|[depth, bound]| bound - truth(mixture, depth))
        .collect();
    leaks.iter().sum::<f64>() / leaks.len() as f64
}

/// Four moments tell two depths apart whatever the receiver's; variance is sharp at the
/// farther one only, and exponentials nearly everywhere between, the more so the larger
/// the exponent.
#[test]
fn bounds_are_sharp_where_they_should_be() {
    for mixture in [TWO, FAR] {
        let [near, far] = [mixture[0][0], mixture[1][0]].map(f64::from);
        let between = [near + 0.1, far - 0.1];
        let [variance, weak, strong, four] = ALL.map(|m| leak(m, mixture, between));
        println!("{mixture:?}: {variance} {weak} {strong} {four}");
        assert!(four < 1e-3, "{four}");
        assert!(strong < 0.5 * weak && weak < 0.8 * variance, "{mixture:?}");
        let at_far = |m| leak(m, mixture, [far - 1.0 / f64::from(DEPTHS), far]);
        assert!(ALL.iter().all(|m| at_far(*m) < 0.08), "{mixture:?}");
    }
    // Five depths are too many for any of them.
    assert!(ALL.iter().all(|m| leak(*m, SPREAD, [0.0, 1.0]) > 0.05));
}

/// With its share of a spread distribution the bound of four moments is worse, never
/// wrong; without any it may be anything.
#[test]
fn the_moment_bias_only_leaks() {
    let sharp = leak(Moments::Four(1e-6), TWO, [0.3, 0.7]);
    let biased = leak(Moments::Four(1e-2), TWO, [0.3, 0.7]);
    assert!(biased > 2.0 * sharp && biased < 0.5, "{sharp} {biased}");
    for [depth, bound] in bounds(Moments::Four(0.0), ONE) {
        assert!((0.0..=1.0).contains(&bound), "{depth}: {bound}");
    }
}
