//! The truth under a rendered depth buffer.
//!
//! A rasteriser snaps vertices to 1/256 pixel, the oracle does not; so at the
//! outline of an object the two may see different surfaces at one pixel, and at
//! a sharp edge different sides of it, to which the light is visible differently.
//! A comparison there would tell nothing of shadows. Such pixels are found by
//! their depth, and by an edge within 1/128 pixel; they are counted, and left out
//! of the errors of visibility.

use super::pixels::LeftOut;
use super::sight::{Match, Sight};
use crate::truth::metrics::MetricError;
use crate::truth::oracle::area::VisibilityImage;

/// The truth that a picture is held against.
#[derive(Clone, Debug, PartialEq)]
pub struct Aligned {
    /// NaN where no surface is seen, or where the picture shows another one.
    pub truth: VisibilityImage,
    /// Pixels without truth, by reason.
    pub left_out: LeftOut,
    /// What shading should have used: the truth, and where the picture shows
    /// another surface that of the neighbour nearest in depth. 1 where the
    /// picture shows none.
    pub for_shading: Vec<f32>,
    /// The same of green and blue, where the light has an image; else of all colours.
    pub other_colours: Option<[Vec<f32>; 2]>,
}

impl Aligned {
    pub(super) fn new(
        image: &VisibilityImage,
        sight: &Sight,
        depth: &[f32],
    ) -> Result<Self, MetricError> {
        let (size, expected) = (image.size, image.values.len());
        if depth.len() != expected {
            let found = depth.len();
            return Err(MetricError::WrongLength {
                size,
                expected,
                found,
            });
        }
        let matches = (0..expected).map(|i| sight.match_depth(i, depth[i]));
        let matches: Vec<Match> = matches.collect();
        let values = image.values.iter().zip(&matches);
        let truth = VisibilityImage {
            size,
            values: values
                .map(|(v, found)| if found.agrees() { *v } else { f64::NAN })
                .collect(),
        };
        let mut left_out = LeftOut::of(matches.iter().copied());
        let nameless = |(found, v): &(&Match, &f64)| **found == Match::Surface && v.is_nan();
        left_out.no_value = matches.iter().zip(&truth.values).filter(nameless).count();
        let shade = |i: usize| match depth[i] {
            1.0.. => 1.0,
            _ if matches[i].agrees() => truth.values[i] as f32,
            _ => borrowed(&truth, depth, i),
        };
        Ok(Self {
            left_out,
            for_shading: (0..expected).map(shade).collect(),
            other_colours: None,
            truth,
        })
    }
}

/// The truth of the neighbour whose rendered depth is nearest, the first of
/// several; 1 where no neighbour has one.
fn borrowed(truth: &VisibilityImage, depth: &[f32], pixel: usize) -> f32 {
    let [width, height] = truth.size.map(|s| s as usize);
    let (x, y) = (pixel % width, pixel / width);
    let columns = x.saturating_sub(1)..(x + 2).min(width);
    let rows = y.saturating_sub(1)..(y + 2).min(height);
    let near = rows.flat_map(|row| columns.clone().map(move |column| row * width + column));
    let known = near.filter(|i| !truth.values[*i].is_nan());
    let away = |i: &usize| (depth[*i] - depth[pixel]).abs();
    let nearest = known.min_by(|a, b| away(a).total_cmp(&away(b)));
    nearest.map_or(1.0, |i| truth.values[i] as f32)
}

#[cfg(test)]
mod tests {
    use crate::measure::comparison::{Reference, ReferenceKind};
    use crate::measure::render::{RenderSettings, render};
    use crate::technique::Params;
    use crate::techniques::find;
    use crate::world::scene::builtin;

    fn depth(name: &str, size: [u32; 2]) -> Vec<f32> {
        let technique = find("unshadowed").unwrap();
        let settings = RenderSettings {
            size,
            ..RenderSettings::default()
        };
        let scene = builtin::build(name).unwrap();
        let params = Params::defaults(technique);
        render(&scene, technique, &params, &settings).unwrap().depth
    }

    /// The rasteriser's surfaces are the oracle's but for a few at outlines; a
    /// picture of something else is not taken for one of them.
    #[test]
    fn surfaces_agree_but_at_outlines() {
        const SIZE: [u32; 2] = [120, 90];
        for name in [
            "parallel-plates",
            "cylinder",
            "creature",
            "columns",
            "peer-c",
            "adversarial-tiny",
            "adversarial-huge",
            "adversarial-offset",
        ] {
            let scene = builtin::build(name).unwrap();
            let truth = Reference::new(&scene, 0, SIZE, ReferenceKind::Exact, None, &|| {});
            let truth = truth.unwrap();
            let found = truth.under(&depth(name, SIZE)).unwrap();
            // The landscape has a facet for every pixel or two.
            let most = if name == "peer-c" { 1000 } else { 100 };
            let other = found.left_out.other_surface();
            assert!(other <= most, "{name}: {other}");
            let mut moved = depth(name, SIZE);
            moved.rotate_right(SIZE[0] as usize); // a row down
            let wrong = truth.under(&moved).unwrap().left_out.other_surface();
            assert!(wrong > 2 * most, "{name}: {wrong}");
        }
    }

    /// Of each pixel one reason.
    #[test]
    fn what_is_left_out_is_counted_by_reason() {
        const SIZE: [u32; 2] = [60, 45];
        let scene = builtin::build("cylinder").unwrap();
        let truth = Reference::new(&scene, 0, SIZE, ReferenceKind::Exact, None, &|| {}).unwrap();
        let depth = depth("cylinder", SIZE);
        let left_out = |depth: &[f32]| truth.under(depth).unwrap().left_out;
        let found = left_out(&depth);
        let surfaces = depth.iter().filter(|d| **d < 1.0).count();
        assert!(found.background > 100 && found.other_depth + found.missing_surface < 5);
        let bare = left_out(&vec![1.0; depth.len()]);
        assert!(
            bare.missing_surface + found.outline >= surfaces - 5,
            "{bare:?}"
        );
        assert_eq!((bare.background, bare.other_depth), (found.background, 0));
        let full = left_out(&vec![0.5; depth.len()]);
        assert_eq!((full.extra_surface, full.background), (found.background, 0));
        assert_eq!(full.other_depth, bare.missing_surface);
        assert_eq!(full.total(), depth.len());
    }

    #[test]
    fn shading_borrows_from_the_neighbour_nearest_in_depth() {
        const SIZE: [u32; 2] = [60, 45];
        let scene = builtin::build("cylinder").unwrap();
        let truth = Reference::new(&scene, 0, SIZE, ReferenceKind::Exact, None, &|| {}).unwrap();
        let mut depth = depth("cylinder", SIZE);
        let pixel = (20..2000).find(|i| truth.image.values[*i] == 0.0).unwrap();
        depth[pixel] += 1e-3;
        let found = truth.under(&depth).unwrap();
        assert!(found.truth.values[pixel].is_nan());
        assert!((0.0..=1.0).contains(&found.for_shading[pixel]));
        assert!(truth.under(&depth[1..]).is_err());
    }
}
