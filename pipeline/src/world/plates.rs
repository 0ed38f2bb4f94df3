//! Parallel square light, plate and floor: soft shadow in closed form.

/// Light, plate and floor are parallel, square and centred on one axis, sides
/// aligned. Distances are measured from the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParallelPlates {
    /// Half the side of the light.
    pub light_half: f64,
    /// Half the side of the plate.
    pub plate_half: f64,
    /// Distance of the plate from the light.
    pub plate_distance: f64,
    /// Distance of the floor from the light; beyond the plate.
    pub floor_distance: f64,
}

impl ParallelPlates {
    /// Visible fraction of the light at floor point `(x, z)` from the axis.
    pub fn visibility(&self, x: f64, z: f64) -> f64 {
        1.0 - self.covered(x) * self.covered(z)
    }

    /// Half side of the square in which the light is hidden altogether;
    /// negative where there is no umbra.
    pub fn umbra_half(&self) -> f64 {
        self.shadow_half() - self.blur_half()
    }

    /// Half side of the square outside which the light is visible altogether.
    pub fn penumbra_half(&self) -> f64 {
        self.shadow_half() + self.blur_half()
    }

    /// Floor distance at which the umbra vanishes; `None` when the plate is at
    /// least as large as the light and it never does.
    pub fn umbra_end(&self) -> Option<f64> {
        let excess = self.light_half - self.plate_half;
        (excess > 0.0).then(|| self.light_half * self.plate_distance / excess)
    }

    /// Fraction of the light's extent hidden along one axis:
    /// `|[-B, B] n [x-A, x+A]| / 2A`.
    fn covered(&self, x: f64) -> f64 {
        let (a, b) = (self.blur_half(), self.shadow_half());
        let overlap = b.min(x + a) - (-b).max(x - a);
        overlap.max(0.0) / (2.0 * a)
    }

    /// Half side of the light's image on the floor through a point of the plate (A).
    fn blur_half(&self) -> f64 {
        self.light_half * (self.floor_distance - self.plate_distance) / self.plate_distance
    }

    /// Half side of the plate's shadow from the light's centre (B).
    fn shadow_half(&self) -> f64 {
        self.plate_half * self.floor_distance / self.plate_distance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plates(floor_distance: f64) -> ParallelPlates {
        ParallelPlates {
            light_half: 0.5,
            plate_half: 0.3,
            plate_distance: 2.0,
            floor_distance,
        }
    }

    /// Fraction of light points seen, by brute force.
    fn sampled(p: ParallelPlates, x: f64, z: f64) -> f64 {
        const N: i32 = 400;
        let seen = |at: f64, s: i32| {
            let light = p.light_half * ((2.0 * f64::from(s) + 1.0) / f64::from(N) - 1.0);
            let on_plate = light + (at - light) * p.plate_distance / p.floor_distance;
            on_plate.abs() > p.plate_half
        };
        let hidden = |at: f64| (0..N).filter(|&s| !seen(at, s)).count() as f64 / f64::from(N);
        1.0 - hidden(x) * hidden(z)
    }

    #[test]
    fn closed_form_agrees_with_sampling() {
        for d in [3.0, 4.9, 5.1, 8.0] {
            for (x, z) in [(0.0, 0.0), (0.3, 0.1), (0.6, 0.5), (1.4, 0.2), (3.0, 0.0)] {
                let error = (plates(d).visibility(x, z) - sampled(plates(d), x, z)).abs();
                assert!(error < 0.01, "d={d} x={x} z={z}: {error}");
            }
        }
    }

    #[test]
    fn the_umbra_vanishes_at_five() {
        assert_eq!(plates(3.0).umbra_end(), Some(5.0));
        assert!(plates(4.9).umbra_half() > 0.0 && plates(5.1).umbra_half() < 0.0);
        assert_eq!(plates(4.9).visibility(0.0, 0.0), 0.0);
        assert!(plates(5.1).visibility(0.0, 0.0) > 0.0);
        assert_eq!(
            plates(3.0).visibility(plates(3.0).penumbra_half() + 1e-9, 0.0),
            1.0
        );
    }
}
