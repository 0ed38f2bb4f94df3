//! Coverage split over 8-bit buffers against sums of whole numbers, and silhouettes
//! combined: the shader's own splitting and resolving, drawn over the screen of a small
//! GPU.

use crate::drawing::drawn;
use crate::soft_shaders::{COUNT, Random, SIDE, full_screen, gpu, red, submit, texture};
use gnomon_pipeline::world::scene::builtin;
use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader, FragmentStage};
use gnomon_raster::state::ColorTargetState;
use gnomon_raster::{Format, Gpu, I32, Lanes, LoadOp, Subresource, TextureId};
use gnomon_shaders::split_volumes::resolve::{
    COUNT_BITS, Combination, ResolveSplit, ResolveTo, UNITS,
};
use gnomon_shaders::split_volumes::{CAPACITY, FULL, split};

/// The share in texture 0, split by the shader.
struct Contribution;

impl FragmentShader for Contribution {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 1,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let at = [f.column(), f.row(), I32::splat(l, 0)];
        let [share, ..] = f.fetch_texel(0, at, 0);
        f.set_color(0, split(l, share));
    }
}

/// A light's buffers: what is added and taken, depth and stencil, and one share a pixel.
struct Buffers {
    gpu: Gpu,
    split: [TextureId; 2],
    depth_stencil: TextureId,
    saturated: u64,
}

impl Buffers {
    fn new() -> Self {
        let mut gpu = gpu();
        let split = [(); 2].map(|()| texture(&mut gpu, Format::Rgba8Unorm));
        let depth_stencil = texture(&mut gpu, Format::Depth24Stencil8);
        Self {
            gpu,
            split,
            depth_stencil,
            saturated: 0,
        }
    }

    /// Empties buffer number `to` and adds shares, a value for each pixel.
    fn add(&mut self, to: usize, shares: &[Vec<f32>]) {
        let image = Subresource::default();
        let draws = shares.iter().map(|share| {
            let source = texture(&mut self.gpu, Format::R32Float);
            let texels: Vec<[f32; 4]> = share.iter().map(|s| [*s; 4]).collect();
            let target = self.gpu.texture_mut(source).unwrap();
            target.write_color(image, &texels).unwrap();
            let stage = FragmentStage::from(Contribution);
            full_screen(stage, ColorTargetState::ADDITIVE, &[source])
        });
        let draws = draws.collect();
        let clear = LoadOp::Clear([0.0; 4]);
        let report = submit(&mut self.gpu, self.split[to], clear, draws);
        let events = report.passes[0].totals().events;
        self.saturated += events.blend_saturated.iter().sum::<u64>();
    }

    fn count(&mut self, hard: i32) {
        let stencil = vec![(hard & i32::from(COUNT_BITS)) as u8; COUNT];
        let target = self.gpu.texture_mut(self.depth_stencil).unwrap();
        let image = Subresource::default();
        target
            .write_depth_stencil(image, &vec![1.0; COUNT], &stencil)
            .unwrap();
    }

    fn resolve(&mut self, shader: ResolveSplit, before: Option<TextureId>, to: TextureId) {
        let [added, taken] = self.split;
        let sources = [added, taken, self.depth_stencil].into_iter();
        let sources: Vec<_> = sources.chain(before).collect();
        let draw = full_screen(shader.stage(), ColorTargetState::OPAQUE, &sources);
        submit(&mut self.gpu, to, LoadOp::DontCare, vec![draw]);
    }
}

/// Visibility after contributions, of 4095ths, to either buffer and a hard count, and how
/// many channels saturated.
fn seen_after(values: [&[u32]; 2], hard: i32) -> (f32, u64) {
    let mut buffers = Buffers::new();
    for (to, values) in values.into_iter().enumerate() {
        // A little less, which is rounded to the nearest.
        let share = |v: &u32| (*v as f32 - 0.3).max(0.0) / FULL;
        let shares = values.iter().map(|v| vec![share(v); COUNT]);
        buffers.add(to, &shares.collect::<Vec<_>>());
    }
    buffers.count(hard);
    let out = texture(&mut buffers.gpu, Format::R32Float);
    let shader = ResolveSplit {
        rule: Combination::Sum,
        continued: false,
        added: false,
        to: ResolveTo::Share(1),
    };
    buffers.resolve(shader, None, out);
    (red(&buffers.gpu, out)[0], buffers.saturated)
}

#[test]
fn thirty_six_full_contributions_fit_and_the_next_is_reported() {
    assert_eq!(CAPACITY, 36);
    let full = |n: usize| vec![4095; n];
    let some = |v: u32| v as f32 * 16.0 / UNITS;
    // 1 - 36 + 36 - 2047/4095, and the same with sides changed.
    assert_eq!(seen_after([&full(36), &[2047]], 36), (some(2048), 0));
    let part = [full(35), vec![2048]].concat();
    assert_eq!(seen_after([&part, &full(36)], 0), (some(2048), 0));
    let (seen, saturated) = seen_after([&full(37), &[2047]], 37);
    assert!(seen < 0.1, "the 37th is lost: {seen}");
    assert_eq!(saturated, u64::from(4 * SIDE * SIDE));
}

/// Additive and subtractive streams of random length against sums of whole numbers; the
/// hard count makes up for the whole part, below 0 too.
#[test]
fn random_streams_are_whole_sums() {
    let mut random = Random(3);
    let mut stream =
        |n: u32| -> Vec<u32> { (0..n).map(|_| (random.unit() * 4096.0) as u32).collect() };
    for (more, less) in [
        (1, 0),
        (3, 5),
        (9, 0),
        (20, 17),
        (36, 0),
        (36, 36),
        (36, 12),
        (5, 17),
    ] {
        let [added, taken] = [stream(more), stream(less)];
        let sum = |values: &[u32]| values.iter().sum::<u32>() as i32;
        let difference = sum(&added) - sum(&taken);
        let (whole, rest) = (difference.div_euclid(4095), difference.rem_euclid(4095));
        assert!(whole >= -8, "a count that wraps is told from one below 0");
        let (seen, saturated) = seen_after([&added, &taken], whole + 1);
        let want = rest as f32 * 16.0 / UNITS;
        assert_eq!((seen, saturated), (want, 0), "{more} {less}");
    }
}

/// What the rule makes of groups that hide so much, a case per pixel.
fn combined(groups: &[Vec<f32>], rule: Combination) -> Vec<f32> {
    let mut buffers = Buffers::new();
    let so_far = [(); 2].map(|()| texture(&mut buffers.gpu, Format::Rgba8Unorm));
    let out = texture(&mut buffers.gpu, Format::R32Float);
    for (turn, hidden) in groups.iter().enumerate() {
        buffers.add(1, std::slice::from_ref(hidden));
        let last = turn + 1 == groups.len();
        let shader = ResolveSplit {
            rule,
            continued: turn > 0,
            added: false,
            to: if last {
                ResolveTo::Share(1)
            } else {
                ResolveTo::Groups
            },
        };
        let before = (turn > 0).then(|| so_far[(turn + 1) % 2]);
        let to = if last { out } else { so_far[turn % 2] };
        buffers.resolve(shader, before, to);
    }
    red(&buffers.gpu, out).iter().map(|v| 1.0 - v).collect()
}

const RULES: [Combination; 3] = [Combination::Sum, Combination::Paper, Combination::Bounded];

/// Shares are rounded to 1/4095 first, the paper's rule to 1/65520 each time.
const ROUNDED: f32 = 3.0 * 0.5 / 4095.0;

/// 16% and 4% of the light: the sum is 20%, the paper's rule and the bounded one
/// give 18%.
#[test]
fn sixteen_and_four_are_eighteen() {
    let groups = [0.16, 0.04].map(|hidden| vec![hidden; COUNT]);
    for (rule, want) in RULES.into_iter().zip([0.20, 0.18, 0.18]) {
        let got = combined(&groups, rule)[0];
        assert!((got - want).abs() < ROUNDED, "{rule:?}: {got}");
    }
}

/// Between the largest and the sum, at most all; the paper's rule depends on the
/// order of more than two, the others do not.
#[test]
fn rules_stay_between_the_largest_and_the_sum() {
    let mut random = Random(9);
    for n in 2..=6 {
        let mut some = |_| -> Vec<f32> {
            let share = |_| (random.unit() * 4095.0).round() as f32 / FULL;
            (0..COUNT).map(share).collect()
        };
        let groups: Vec<Vec<f32>> = (0..n).map(&mut some).collect();
        for rule in RULES {
            for (i, got) in combined(&groups, rule).into_iter().enumerate() {
                let all = groups.iter().map(|g| g[i]);
                let most = all.clone().fold(0.0, f32::max);
                let sum = all.sum::<f32>().min(1.0);
                assert!(
                    got >= most - 5e-5 && got <= sum + 5e-5,
                    "{rule:?} {n}: {most} {got} {sum}"
                );
            }
        }
    }
    for (order, paper) in [([0.5, 0.3, 0.2], 0.75), ([0.2, 0.3, 0.5], 0.70)] {
        let groups = order.map(|hidden| vec![hidden; COUNT]);
        for (rule, want) in RULES.into_iter().zip([1.0, paper, 0.75]) {
            let got = combined(&groups, rule)[0];
            assert!((got - want).abs() < ROUNDED, "{rule:?} {order:?}: {got}");
        }
    }
}

/// Three bytes hold what sixty-four parts show, and their mean is that of whole numbers.
#[test]
fn parts_add_up_exactly() {
    let mut buffers = Buffers::new();
    let so_far = [(); 2].map(|()| texture(&mut buffers.gpu, Format::Rgba8Unorm));
    let out = texture(&mut buffers.gpu, Format::Rg8Unorm);
    let mut random = Random(21);
    let mut sums = vec![0u64; COUNT];
    for part in 0..64 {
        let hidden: Vec<u64> = (0..COUNT)
            .map(|_| (random.unit() * 4096.0) as u64)
            .collect();
        let hidden = if part < 40 { vec![0; COUNT] } else { hidden };
        let shares = hidden.iter().map(|h| *h as f32 / FULL).collect();
        buffers.add(1, &[shares]);
        let last = part == 63;
        let shader = ResolveSplit {
            rule: Combination::Sum,
            continued: false,
            added: part > 0,
            to: if last {
                ResolveTo::Bytes(64)
            } else {
                ResolveTo::Parts
            },
        };
        let before = (part > 0).then(|| so_far[(part + 1) % 2]);
        let to = if last { out } else { so_far[part % 2] };
        buffers.resolve(shader, before, to);
        for (sum, h) in sums.iter_mut().zip(&hidden) {
            *sum += 16 * (4095 - h);
        }
    }
    let texels = buffers.gpu.texture(out).unwrap();
    let texels = texels.read_color(Subresource::default()).unwrap();
    for (texel, sum) in texels.iter().zip(sums) {
        let [high, low] = [texel.0[0], texel.0[1]].map(|c| f64::from(c * 255.0).round());
        let mean = sum as f64 / 64.0;
        assert_eq!(high * 256.0 + low, mean.round_ties_even());
    }
}

/// Where all surfaces face the light, limiting visibility by what they see of it, in floats,
/// leaves what bytes hold: the mean of the parts.
#[test]
fn parts_in_a_float_are_the_mean_that_bytes_hold() {
    let scene = builtin::build("parallel-plates").unwrap();
    for split in ["split=1", "split=2", "split=3"] {
        let [bytes, float] = ["horizon=off", "horizon=on"].map(|horizon| {
            let set = [split, horizon];
            drawn(&scene, "soft-shadow-volumes-optimised", &set, [60, 40]).visibility
        });
        let seen = || bytes.iter().zip(&float).filter(|(b, _)| b.is_finite());
        let most = seen().map(|(b, f)| (b - f).abs()).fold(0.0, f32::max);
        assert!(most <= 1.0 / UNITS, "{split}: {most}");
        assert!(seen().any(|(b, _)| *b < 0.5), "{split}");
    }
}
