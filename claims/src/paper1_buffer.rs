//! How many bits paper I's light-intensity buffer needs, and what fewer shades cost.

use gnomon_pipeline::technique::{Frame, VisibilityOutput};
use gnomon_pipeline::world::scene::Scene;
use gnomon_raster::{CommandList, Gpu, LoadOp, RenderPass, Subresource, TextureId};

use super::{Claim, Finding, Lab, Lines, Measure, ReproduceError, Theirs, Unit, Verdict};

pub(super) const CLAIMS: &[Claim] = &[Claim::new(
    "paper1-buffer-bits",
    "paper I, §4",
    Verdict::Counters,
    "A signed 16-bit light-intensity buffer is right; for certain scenes one of 12 bits may \
     suffice, and one of 8 bits at the cost of fewer shades in the penumbra.",
    buffer_bits,
)
.read_from(&[Lines::to(643, 647)])];

const TECHNIQUE: &str = "penumbra-wedges";

const SCENES: [&str; 4] = ["eg-logo", "cylinder", "columns", "creature"];

/// The least and the greatest number that a buffer holds at any time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Range {
    least: i32,
    greatest: i32,
}

impl Range {
    fn of(values: impl Iterator<Item = i32>) -> Self {
        let start = Self {
            least: 0,
            greatest: 0,
        };
        values.fold(start, |all, v| Self {
            least: all.least.min(v),
            greatest: all.greatest.max(v),
        })
    }

    fn with(self, other: Self) -> Self {
        Self {
            least: self.least.min(other.least),
            greatest: self.greatest.max(other.greatest),
        }
    }

    /// Bits of a signed number that holds all of it.
    fn bits(self) -> u32 {
        let holds = |bits: &u32| {
            let end = 1i32 << (bits - 1);
            -end <= self.least && self.greatest < end
        };
        (1..=31).find(holds).unwrap_or(32)
    }

    /// As many shades in place of 255 that signed `bits` hold the range.
    fn shades(self, bits: u32) -> u32 {
        let most = (1u32 << (bits - 1)) - 1;
        let farthest = self.greatest.max(-self.least).max(1) as u32;
        (most * 255 / farthest).clamp(1, 255)
    }
}

/// What the buffer holds between the draws of a frame of one light.
fn range(lab: &Lab, scene: &Scene, set: &[&str]) -> Result<Range, ReproduceError> {
    let (mut gpu, frame) = lab.frame(scene, TECHNIQUE, set)?;
    let buffer = light_intensity(&frame)?;
    let mut all = Range::of(std::iter::empty());
    for pass in &frame.recording.list.passes {
        if pass.color.iter().all(|c| c.texture != buffer) {
            gpu.submit(&list(pass.clone()))?;
            continue;
        }
        for step in steps(pass) {
            gpu.submit(&list(step))?;
            all = all.with(held(&gpu, buffer)?);
        }
    }
    Ok(all)
}

fn light_intensity(frame: &Frame) -> Result<TextureId, ReproduceError> {
    match frame.outputs.visibility {
        VisibilityOutput::Red { texture, .. } => Ok(texture),
        _ => Err(ReproduceError::Recorded(
            "penumbra-wedges keeps no light-intensity buffer".to_owned(),
        )),
    }
}

fn list(pass: RenderPass) -> CommandList {
    CommandList { passes: vec![pass] }
}

/// The pass draw by draw; the first clears, if any.
fn steps(pass: &RenderPass) -> impl Iterator<Item = RenderPass> {
    let empty = RenderPass {
        draws: Vec::new(),
        ..pass.clone()
    };
    let drawing = pass.draws.iter().map(|draw| {
        let mut one = RenderPass {
            draws: vec![draw.clone()],
            ..pass.clone()
        };
        one.color.iter_mut().for_each(|c| c.load = LoadOp::Load);
        one
    });
    std::iter::once(empty).chain(drawing)
}

fn held(gpu: &Gpu, buffer: TextureId) -> Result<Range, ReproduceError> {
    let texels = gpu.texture(buffer)?.read_color(Subresource::default())?;
    Ok(Range::of(
        texels.iter().map(|t| i32::from(t.0[0] as u16 as i16)),
    ))
}

fn buffer_bits(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    let (mut sixteen, mut twelve) = (0, 0);
    for name in SCENES {
        let scene = lab.scene(name)?;
        let whole = range(lab, &scene, &[])?;
        sixteen += u32::from(whole.bits() <= 16);
        twelve += u32::from(whole.bits() <= 12);
        measures.push(count(format!("{name}: bits for 255 shades"), whole.bits()));
        let shades = whole.shades(8);
        let few = format!("shades={shades}");
        measures.push(count(format!("{name}: shades in 8 bits"), shades));
        measures.push(Measure::new(
            format!("{name}: bits that those need"),
            Theirs::AtMost(8.0),
            f64::from(range(lab, &scene, &[&few])?.bits()),
            Unit::Count,
        ));
        for set in ["shades=255", &few] {
            let done = lab.render(&scene, TECHNIQUE, &[set])?;
            let rmse = lab.score(&scene, &done)?.error.rmse;
            measures.push(Measure::beside(
                format!("{name}: RMSE, {set}"),
                "-",
                rmse,
                Unit::Number,
            ));
        }
    }
    let all = f64::from(SCENES.len() as u32);
    measures.insert(0, scenes("scenes that 16 bits hold", all, sixteen));
    measures.insert(1, scenes("scenes that 12 bits hold", 1.0, twelve));
    Ok(Finding {
        scene: lab.describe(&SCENES.join(", ")),
        counted: "the least and greatest number that any pixel of the buffer holds between two \
                  draws, at full light of 255 and of as many shades as keep it within 8 bits"
            .to_owned(),
        measures,
        reason: "The scenes are ours, under the sphere round their light; a buffer counts the \
                 overlaps of wedges in the picture, so that more casters behind each other \
                 need more bits."
            .to_owned(),
        charts: Vec::new(),
    })
}

fn count(what: String, n: u32) -> Measure {
    Measure::beside(what, "-", f64::from(n), Unit::Count)
}

fn scenes(what: &str, least: f64, found: u32) -> Measure {
    Measure::new(what, Theirs::AtLeast(least), f64::from(found), Unit::Count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::lab;

    #[test]
    fn bits_hold_both_ends() {
        let of = |values: &[i32]| Range::of(values.iter().copied());
        assert_eq!(of(&[255]).bits(), 9);
        assert_eq!(of(&[127, -128]).bits(), 8);
        assert_eq!(of(&[0, -129]).bits(), 9);
        assert_eq!(of(&[2047]).bits(), 12);
        assert_eq!(of(&[2048]).bits(), 13);
        assert_eq!(of(&[255, -765]).shades(8), 127 * 255 / 765);
        assert_eq!(of(&[3]).shades(8), 255);
    }

    /// A buffer is looked at between draws: what wedges take back again is in its range.
    #[test]
    fn ranges_are_of_all_times() {
        let lab = lab();
        let scene = lab.scene("creature").unwrap();
        let (mut gpu, frame) = lab.frame(&scene, TECHNIQUE, &[]).unwrap();
        let buffer = light_intensity(&frame).unwrap();
        gpu.submit(&frame.recording.list).unwrap();
        let last = held(&gpu, buffer).unwrap();
        let all = range(&lab, &scene, &[]).unwrap();
        assert_eq!(all, all.with(last));
        assert!(all.greatest > last.greatest, "{all:?}, at last {last:?}");
    }
}
