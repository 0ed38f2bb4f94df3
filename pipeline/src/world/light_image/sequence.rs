//! Images one after the other, and what a light shows at a place between two.

use std::sync::Arc;

use super::LightImage;

/// Images that a light shows one after the other, and from the first again.
#[derive(Clone, Debug, PartialEq)]
pub enum LightSequence {
    /// These, all of one side, at least one.
    Images(Arc<[LightImage]>),
    /// A fire without end.
    Fire,
}

/// What a light shows.
#[derive(Clone, Debug, PartialEq)]
pub struct LightMoment {
    /// The image, or the one before.
    pub image: LightImage,
    /// The one after and how much of it there is, between two.
    pub next: Option<(LightImage, f64)>,
}

impl LightSequence {
    /// What is shown at `position`: image number 0 at 0, and between two numbers both.
    pub fn at(&self, position: f64) -> LightMoment {
        let (whole, part) = (position.floor(), position - position.floor());
        let image = |number: f64| match self {
            Self::Images(images) => images[number.rem_euclid(images.len() as f64) as usize].clone(),
            Self::Fire => LightImage::fire(number.rem_euclid(f64::from(u32::MAX)) as u32),
        };
        let [image, next] = [whole, whole + 1.0].map(image);
        let between = part > 0.0 && image != next;
        LightMoment {
            image,
            next: between.then_some((next, part)),
        }
    }
}

impl LightMoment {
    /// The colours that are there: of two images the blend.
    pub fn blended(&self) -> LightImage {
        match &self.next {
            Some((next, part)) => self.image.blended(next, *part),
            None => self.image.clone(),
        }
    }

    /// How much of each colour of the blend comes from the image after.
    pub fn parts(&self) -> [f64; 3] {
        let Some((next, part)) = &self.next else {
            return [0.0; 3];
        };
        let (now, then) = (self.image.means(), next.means());
        [0, 1, 2].map(|c| {
            let [a, b] = [now[c] * (1.0 - part), then[c] * part];
            if a + b > 0.0 { b / (a + b) } else { *part }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(v: f32) -> LightImage {
        LightImage::of_picture([2, 2], &[[v; 3]; 4]).unwrap()
    }

    #[test]
    fn positions_wrap_and_lie_between_neighbours() {
        let all = LightSequence::Images([grey(1.0), grey(2.0), grey(4.0)].into());
        for (position, expected) in [(0.0, 1.0), (1.0, 2.0), (2.0, 4.0), (3.0, 1.0), (301.0, 2.0)] {
            let moment = all.at(position);
            assert_eq!((moment.image, moment.next), (grey(expected), None));
        }
        // From the last to the first.
        let moment = all.at(2.25);
        assert_eq!(moment.next, Some((grey(1.0), 0.25)));
        assert_eq!(moment.blended().means(), [3.25; 3]);
        assert_eq!(moment.parts(), [0.25 / 3.25; 3]);
        let one = LightSequence::Images([grey(1.0)].into());
        assert_eq!(one.at(0.5).next, None);
        let fire = LightSequence::Fire.at(1e12 + 0.5);
        assert!(fire.next.is_some());
    }
}
