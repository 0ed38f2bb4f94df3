//! Where an animation has nodes at a time (glTF 2.0, §3.11 and appendix C).
//!
//! The first animation is played; before its first and after its last key a node stands as
//! there. Rotations go the shorter way round at constant speed.

use std::collections::BTreeMap;

use super::accessor;
use super::buffers::Buffers;
use super::error::{Checked, GltfProblem, element};
use super::notes::Notes;
use super::schema::{AnimationSampler, Root};

/// Keys of a file's animation at most.
const MOST_KEYS: u64 = 1 << 22;

/// What an animation says of a node; the rest is the node's own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Moved {
    pub(super) translation: Option<[f64; 3]>,
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
}

/// Nodes that an animation moves.
pub(super) type Pose = BTreeMap<usize, Moved>;

/// The pose of the first animation at `time`, in seconds.
pub(super) fn pose(
    root: &Root,
    buffers: &mut Buffers<'_>,
    time: f64,
    notes: &mut Notes,
) -> Checked<Pose> {
    let mut pose = Pose::new();
    let Some(animation) = root.animations.first() else {
        return Ok(pose);
    };
    let mut read = Keys {
        root,
        buffers,
        left: MOST_KEYS,
    };
    for (number, channel) in animation.channels.iter().enumerate() {
        let place = format!("animations[0].channels[{number}]");
        let Some(node) = channel.target.node else {
            (notes.channels).add(|| place.clone());
            continue;
        };
        element(&root.nodes, node, "nodes", &place)?;
        let sampler = element(
            &animation.samplers,
            channel.sampler,
            "samplers of the animation",
            &place,
        )?;
        let place = format!("animations[0].samplers[{}]", channel.sampler);
        let moved = pose.entry(node).or_default();
        match channel.target.path.as_str() {
            "translation" => moved.translation = Some(read.at(sampler, "VEC3", time, &place)?),
            "scale" => moved.scale = Some(read.at(sampler, "VEC3", time, &place)?),
            "rotation" => moved.rotation = Some(read.at(sampler, "VEC4", time, &place)?),
            _ => notes.channels.add(|| place.clone()),
        }
    }
    pose.retain(|_, moved| *moved != Moved::default());
    Ok(pose)
}

/// How values go from key to key.
#[derive(Clone, Copy, PartialEq)]
enum Interpolation {
    Step,
    Linear,
    Cubic,
}

/// Reads keys, and bounds what they add up to.
struct Keys<'r, 'b> {
    root: &'r Root,
    buffers: &'r mut Buffers<'b>,
    left: u64,
}

impl Keys<'_, '_> {
    /// The value of a sampler at a time.
    fn at<const N: usize>(
        &mut self,
        sampler: &AnimationSampler,
        kind: &'static str,
        time: f64,
        place: &str,
    ) -> Checked<[f64; N]> {
        let interpolation = match sampler.interpolation.as_deref() {
            None | Some("LINEAR") => Interpolation::Linear,
            Some("STEP") => Interpolation::Step,
            Some("CUBICSPLINE") => Interpolation::Cubic,
            Some(other) => {
                let (what, value) = ("interpolation", format!("'{other}'"));
                let valid = "LINEAR, STEP or CUBICSPLINE";
                return Err(GltfProblem::Bad { what, value, valid }.at(place));
            }
        };
        let times: Vec<[f64; 1]> = self.read(sampler.input, "SCALAR", place)?;
        let times: Vec<f64> = times.into_iter().map(|[t]| t).collect();
        check_times(&times, place)?;
        let values: Vec<[f64; N]> = self.read(sampler.output, kind, place)?;
        let each = if interpolation == Interpolation::Cubic {
            3
        } else {
            1
        };
        if values.len() != each * times.len()
            || values.as_flattened().iter().any(|v| !v.is_finite())
        {
            let (what, value) = ("output", format!("{} values", values.len()));
            let valid = "a finite one for each time of input, of cubic splines three";
            return Err(GltfProblem::Bad { what, value, valid }.at(place));
        }
        Ok(between(&times, &values, interpolation, time))
    }

    fn read<const N: usize>(
        &mut self,
        index: usize,
        kind: &'static str,
        place: &str,
    ) -> Checked<Vec<[f64; N]>> {
        let read = accessor::read(self.root, self.buffers, index, kind, self.left, place)?;
        self.left -= read.len() as u64;
        Ok(read)
    }
}

fn check_times(times: &[f64], place: &str) -> Checked<()> {
    let rising = times.windows(2).all(|t| t[0] < t[1]);
    if !times.is_empty() && rising && times.iter().all(|t| t.is_finite()) {
        return Ok(());
    }
    let (what, value) = ("input", format!("{} times", times.len()));
    let valid = "at least one, each finite and later than the one before";
    Err(GltfProblem::Bad { what, value, valid }.at(place))
}

fn between<const N: usize>(
    times: &[f64],
    values: &[[f64; N]],
    interpolation: Interpolation,
    time: f64,
) -> [f64; N] {
    let key = |k: usize| match interpolation {
        Interpolation::Cubic => values[3 * k + 1],
        _ => values[k],
    };
    let after = times.partition_point(|t| *t <= time);
    if after == 0 || after == times.len() {
        return key(after.saturating_sub(1));
    }
    let before = after - 1;
    let step = times[after] - times[before];
    let s = (time - times[before]) / step;
    let (a, b) = (key(before), key(after));
    match interpolation {
        Interpolation::Step => a,
        Interpolation::Linear if N == 4 => turned(a, b, s),
        Interpolation::Linear => mix([(a, 1.0 - s), (b, s)]),
        Interpolation::Cubic => {
            let (leaving, arriving) = (values[3 * before + 2], values[3 * after]);
            let (s2, s3) = (s * s, s * s * s);
            mix([
                (a, 2.0 * s3 - 3.0 * s2 + 1.0),
                (leaving, step * (s3 - 2.0 * s2 + s)),
                (b, 3.0 * s2 - 2.0 * s3),
                (arriving, step * (s3 - s2)),
            ])
        }
    }
}

/// A sum with weights.
fn mix<const N: usize, const M: usize>(terms: [([f64; N], f64); M]) -> [f64; N] {
    let mut sum = [0.0; N];
    for (value, weight) in terms {
        for (s, v) in sum.iter_mut().zip(value) {
            *s += weight * v;
        }
    }
    sum
}

/// Between two quaternions of length 1, the shorter way round at constant speed.
fn turned<const N: usize>(a: [f64; N], b: [f64; N], s: f64) -> [f64; N] {
    let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    let sign = if dot < 0.0 { -1.0 } else { 1.0 };
    let cosine = dot.abs();
    // So near that a straight line is as good.
    if cosine > 0.9995 {
        return mix([(a, 1.0 - s), (b, sign * s)]);
    }
    let angle = libm::acos(cosine);
    let weight = |share: f64| libm::sin(share * angle) / libm::sin(angle);
    mix([(a, weight(1.0 - s)), (b, sign * weight(s))])
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMES: [f64; 3] = [1.0, 2.0, 4.0];

    #[test]
    fn values_go_from_key_to_key() {
        let values = [[0.0, 1.0, 0.0], [4.0, 1.0, -2.0], [0.0, 1.0, 0.0]];
        let at = |interpolation, t| between(&TIMES, &values, interpolation, t);
        for interpolation in [Interpolation::Step, Interpolation::Linear] {
            assert_eq!(at(interpolation, 0.0), values[0], "held before");
            assert_eq!(at(interpolation, 2.0), values[1]);
            assert_eq!(at(interpolation, 9.0), values[2], "and after");
        }
        assert_eq!(at(Interpolation::Linear, 1.25), [1.0, 1.0, -0.5]);
        assert_eq!(at(Interpolation::Linear, 3.5), [1.0, 1.0, -0.5]);
        assert_eq!(at(Interpolation::Step, 3.999), values[1]);
    }

    /// The spline of x = t², whose tangents are 2t, is that.
    #[test]
    fn cubic_splines_have_tangents() {
        let of = |t: f64| [[2.0 * t; 3], [t * t; 3], [2.0 * t; 3]];
        let mut values: Vec<[f64; 3]> = TIMES.into_iter().flat_map(of).collect();
        // Nothing arrives at the first key, and nothing leaves the last one.
        (values[0], values[8]) = ([99.0; 3], [99.0; 3]);
        for t in [1.0, 1.3, 2.0, 2.5, 3.75, 4.0] {
            let [x, ..] = between(&TIMES, &values, Interpolation::Cubic, t);
            assert!((x - t * t).abs() < 1e-12, "{t}: {x}");
        }
    }

    #[test]
    fn rotations_go_the_shorter_way_at_constant_speed() {
        let about_y = |degrees: f64| {
            let half = degrees.to_radians() / 2.0;
            [0.0, libm::sin(half), 0.0, libm::cos(half)]
        };
        let same = |a: [f64; 4], b: [f64; 4]| {
            let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
            assert!((dot.abs() - 1.0).abs() < 1e-12, "{a:?} {b:?}");
        };
        same(turned(about_y(10.0), about_y(130.0), 0.25), about_y(40.0));
        let other = about_y(130.0).map(|v| -v);
        same(turned(about_y(10.0), other, 0.25), about_y(40.0));
        same(turned(about_y(350.0), about_y(30.0), 0.5), about_y(10.0));
        let [_, y, _, w] = turned(about_y(1.0), about_y(2.0), 0.5);
        let length = (y * y + w * w).sqrt();
        same([0.0, y / length, 0.0, w / length], about_y(1.5));
    }
}
