//! Where the sum of soft shadow volumes is not the truth, and why.

use gnomon_pipeline::measure::visibility_sum::{Cause, Causes};
use gnomon_pipeline::truth::oracle::area::AreaOracle;

use super::Source;
use super::sums::{Place, Sums, each_pixel};
use crate::draw::{Canvas, Legend, Picture, Swatch, heat};

/// What counts as off.
const OFF: f64 = 0.05;

const CAUSES: [(Cause, [u8; 3], &str); 3] = [
    (
        Cause::Overlap,
        [0, 114, 178],
        "overlap: hidden twice, too dark",
    ),
    (
        Cause::TakenAway,
        [230, 159, 0],
        "single silhouette: taken away, too bright",
    ),
    (
        Cause::OtherSilhouettes,
        [204, 121, 167],
        "other points' silhouettes hide more",
    ),
];

/// One light of the scene, with what its sum should be.
struct Judged<'a> {
    sums: &'a Sums,
    light: usize,
    causes: Causes,
    oracle: AreaOracle,
}

pub(super) fn draw(source: &Source<'_>) -> Picture {
    let picture = source.picture();
    let sums = Sums::new(source.scene);
    let judged = judged(source, &sums);
    let found = each_pixel(source.scene, picture.size, |place| {
        let causes = judged.iter().filter_map(|j| j.cause(place));
        // One colour a pixel: the worst.
        causes.reduce(|a, b| if b.1 > a.1 { b } else { a })
    });
    let mut canvas = Canvas::dimmed(&picture, 0.45);
    let width = picture.size[0] as usize;
    let mut pixels = [0usize; CAUSES.len()];
    for (i, found) in found.into_iter().enumerate() {
        let Some((cause, error)) = found.flatten() else {
            continue;
        };
        let number = CAUSES.iter().position(|(c, _, _)| *c == cause);
        let number = number.expect("every cause has a colour");
        pixels[number] += 1;
        let at = [(i % width) as u32, (i / width) as u32];
        canvas.mix(at, CAUSES[number].1, (0.45 + error).min(1.0) as f32);
    }
    let swatches = CAUSES.iter().zip(pixels);
    let mut notes = vec![format!(
        "stronger where the error is larger; pixels that are off by less than {OFF} are as they are"
    )];
    notes.extend(sums.notes());
    let legend = Legend {
        title: "Artefacts: where the papers' sum is not what is seen of the light".to_owned(),
        swatches: swatches
            .map(|((_, colour, what), n)| Swatch::new(*colour, format!("{what}: {n} pixels")))
            .collect(),
        notes,
        ..Legend::default()
    };
    legend.below(canvas, heat)
}

fn judged<'a>(source: &Source<'_>, sums: &'a Sums) -> Vec<Judged<'a>> {
    let of = |light: usize| {
        let number = sums.lights[light].0;
        let (_, oracle) = AreaOracle::of_scene(source.scene, number).ok()?;
        let causes = Causes::new(source.scene, number).ok()?;
        Some(Judged {
            sums,
            light,
            causes,
            oracle,
        })
    };
    (0..sums.lights.len()).filter_map(of).collect()
}

impl Judged<'_> {
    /// Why the sum is off, and by how much; `None` where it is not.
    fn cause(&self, place: &Place<'_>) -> Option<(Cause, f64)> {
        let seen = self.sums.lights[self.light]
            .1
            .seen_from(place.receiver.point)?;
        let truth = self.oracle.visibility(&place.receiver);
        let is_off = |sum: f64| (sum.clamp(0.0, 1.0) - truth).abs() > OFF;
        if !is_off(seen.sum()) {
            return None;
        }
        // Facets without area have no plane.
        place.receiver.normal?;
        // The surface's own plane hides too, which only the sum over triangles knows.
        let own = &place.surfaces.corners()[place.surface as usize];
        let sum = self.causes.summed(&place.receiver, own);
        let cause = || self.causes.of(&place.receiver, own, truth);
        is_off(sum).then(|| (cause(), (sum.clamp(0.0, 1.0) - truth).abs()))
    }
}
