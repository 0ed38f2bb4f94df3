//! Where the eye is, as it is moved round its target.

use glam::DVec3;

/// How far a step goes, in degrees.
pub(super) const STEP: f64 = 5.0;
/// What a step of the zoom leaves of the distance.
const CLOSER: f64 = 0.9;
/// How close the eye comes, as a share of the target's distance from the origin: closer, there
/// are too few digits for a direction.
const NEAREST: f64 = 1e-9;
/// How near to straight above or below the eye goes, in degrees from the horizon.
const STEEPEST: f64 = 89.0;

/// An eye and what it looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    /// The eye.
    pub(super) eye: DVec3,
    /// What is in the middle of the picture.
    pub(super) target: DVec3,
    /// The scene's "up", round which the eye goes; any length but 0.
    pub(super) up: DVec3,
}

impl Pose {
    /// The eye moved on the sphere round its target: to its right and upwards, in degrees.
    /// It stops short of the poles.
    pub(super) fn orbited(&self, right: f64, above: f64) -> Self {
        let up = self.up / self.up.length();
        let arm = self.eye - self.target;
        let distance = arm.length();
        let height = libm::asin((arm.dot(up) / distance).clamp(-1.0, 1.0)).to_degrees();
        let flat = self.flat_direction(up);
        // Seen from above, the right-hand side of somebody who looks inwards is against
        // the clock.
        let (sin, cos) = sin_cos(right);
        let flat = flat * cos + up.cross(flat) * sin;
        let limit = STEEPEST.max(height.abs());
        let (sin, cos) = sin_cos((height + above).clamp(-limit, limit));
        Self {
            eye: self.target + (flat * cos + up * sin) * distance,
            ..*self
        }
    }

    /// Towards the eye along the ground, 1 long; right above its target any direction will do.
    fn flat_direction(&self, up: DVec3) -> DVec3 {
        let arm = self.eye - self.target;
        let flat = arm - up * arm.dot(up);
        if flat.length() > 1e-9 * arm.length() {
            return flat / flat.length();
        }
        let aside = if up.x.abs() < 0.5 { DVec3::X } else { DVec3::Z };
        let flat = aside - up * aside.dot(up);
        flat / flat.length()
    }

    /// So many steps closer, or farther away where there are fewer than none.
    pub(super) fn zoomed(&self, steps: i32) -> Self {
        let factor = if steps > 0 { CLOSER } else { 1.0 / CLOSER };
        let scale = (0..steps.unsigned_abs()).fold(1.0, |all, _| all * factor);
        let eye = self.target + (self.eye - self.target) * scale;
        let distance = (eye - self.target).length();
        let can_look = distance > NEAREST * self.target.length() && distance.is_finite();
        match can_look {
            true => Self { eye, ..*self },
            false => *self,
        }
    }
}

fn sin_cos(degrees: f64) -> (f64, f64) {
    let angle = degrees.to_radians();
    (libm::sin(angle), libm::cos(angle))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(eye: [f64; 3]) -> Pose {
        Pose {
            eye: eye.into(),
            target: DVec3::new(1.0, 0.5, -2.0),
            up: DVec3::Y * 3.0,
        }
    }

    fn right_of(pose: &Pose) -> DVec3 {
        (pose.target - pose.eye).cross(pose.up)
    }

    #[test]
    fn right_is_the_eyes_right_hand_side_and_up_is_up() {
        for eye in [[4.0, 2.0, 3.0], [1.0, -3.0, 5.0], [-2.0, 0.5, -2.0]] {
            let from = pose(eye);
            let right = from.orbited(5.0, 0.0);
            assert!((right.eye - from.eye).dot(right_of(&from)) > 0.0, "{eye:?}");
            assert!((right.eye.y - from.eye.y).abs() < 1e-12);
            let above = from.orbited(0.0, 5.0);
            assert!(above.eye.y > from.eye.y, "{eye:?}");
            for moved in [right, above] {
                let [a, b] = [from, moved].map(|p| (p.eye - p.target).length());
                assert!((a - b).abs() < 1e-12, "{eye:?}");
                assert_eq!(moved.target, from.target);
            }
        }
    }

    #[test]
    fn there_and_back_and_all_the_way_round_end_where_they_began() {
        let from = pose([4.0, 2.0, 3.0]);
        let near = |p: Pose| (p.eye - from.eye).length() < 1e-9;
        assert!(near(from.orbited(35.0, 12.0).orbited(-35.0, -12.0)));
        assert!(near((0..72).fold(from, |p, _| p.orbited(STEP, 0.0))));
        let turned = from.orbited(90.0, 0.0).eye - from.target;
        assert!(
            turned
                .dot((from.eye - from.target) * DVec3::new(1.0, 0.0, 1.0))
                .abs()
                < 1e-9
        );
        assert!(near(from.zoomed(7).zoomed(-7)));
    }

    #[test]
    fn the_eye_stops_short_of_the_poles_and_of_its_target() {
        let mut eye = pose([4.0, 2.0, 3.0]);
        for _ in 0..100 {
            eye = eye.orbited(0.0, STEP).zoomed(40);
            let arm = eye.eye - eye.target;
            assert!(arm.length() > 0.0 && arm.cross(eye.up).length() > 1e-3 * arm.length());
        }
        // Whoever is at the pole already comes down from it.
        let above = pose([1.0, 9.0, -2.0]);
        assert!((above.orbited(0.0, 5.0).eye - above.eye).length() < 1e-9);
        assert!(above.orbited(0.0, -5.0).eye.y < 9.0);
        assert!(eye.zoomed(-1_000_000).eye.is_finite());
    }
}
