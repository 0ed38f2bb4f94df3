//! Another eye and other lights for a scene.

use glam::DVec3;

use super::{Camera, Scene, frame_model, near};
use crate::world::light::Light;

/// What takes the place of a scene's own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    /// The eye.
    pub eye: Option<DVec3>,
    /// What is in the middle of the picture.
    pub target: Option<DVec3>,
    /// Vertical field of view, degrees, between 0 and 180.
    pub fov_y_degrees: Option<f64>,
    /// Lights, instead of the scene's, if there are any.
    pub lights: Vec<Light>,
}

/// Why a view cannot be had.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
pub enum ViewError {
    /// The eye looks nowhere.
    #[error("the eye and its target are both {at}; valid is any other point for one of them")]
    NoSight {
        /// Where both are.
        at: DVec3,
    },
    /// Lights for a scene that a map lights, with ambient light and background.
    #[error(
        "lights are given for a scene that [environment] lights; valid is one of them: \
         leave the lights out, or take [environment] out of the scene"
    )]
    LightsBesideEnvironment,
    /// A value that is not valid.
    #[error("{what} is {value}; valid is {valid}")]
    Bad {
        /// Name of the value.
        what: &'static str,
        /// As given.
        value: String,
        /// What would be valid.
        valid: &'static str,
    },
}

impl View {
    /// Gives `scene` what there is; of a framed model the ground is turned to the eye.
    /// Whoever looks along the scene's "up" has -z up in the picture.
    ///
    /// # Errors
    /// The eye is its target, a value is not valid, or there are lights beside an
    /// environment.
    pub(super) fn apply(&self, scene: &mut Scene, framed: bool) -> Result<(), ViewError> {
        if !self.lights.is_empty() {
            if scene.environment.is_some() {
                return Err(ViewError::LightsBesideEnvironment);
            }
            scene.lights.clone_from(&self.lights);
        }
        if let Some(fov) = self.fov_y_degrees {
            if !(fov > 0.0 && fov < 180.0) {
                return Err(ViewError::Bad {
                    what: "the field of view",
                    value: fov.to_string(),
                    valid: "above 0 and below 180 (degrees, vertical)",
                });
            }
            scene.camera.fov_y_degrees = fov;
        }
        if self.eye.is_none() && self.target.is_none() {
            return Ok(());
        }
        self.look(&mut scene.camera)?;
        if framed {
            frame_model::turn_ground(scene);
        }
        scene.camera.near = near::derived(scene);
        Ok(())
    }

    fn look(&self, camera: &mut Camera) -> Result<(), ViewError> {
        camera.eye = self.eye.unwrap_or(camera.eye);
        camera.target = self.target.unwrap_or(camera.target);
        for (what, point) in [("the eye", camera.eye), ("the target", camera.target)] {
            if !point.is_finite() {
                return Err(ViewError::Bad {
                    what,
                    value: point.to_string(),
                    valid: "three finite numbers",
                });
            }
        }
        let sight = camera.target - camera.eye;
        if sight.length() == 0.0 {
            return Err(ViewError::NoSight { at: camera.eye });
        }
        // A sine below 1e-9 leaves no digits for the direction of "right".
        if sight.cross(camera.up).length() <= 1e-9 * sight.length() * camera.up.length() {
            camera.up = -DVec3::Z;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::scene::builtin;

    fn view(eye: [f64; 3], target: Option<[f64; 3]>) -> View {
        View {
            eye: Some(eye.into()),
            target: target.map(DVec3::from),
            ..View::default()
        }
    }

    #[test]
    fn what_is_given_takes_the_place_of_what_was() {
        let mut scene = builtin::build("cylinder").unwrap();
        let before = scene.clone();
        View::default().apply(&mut scene, false).unwrap();
        assert!(scene == before);
        let light = Light::horizontal_square(DVec3::Y * 9.0, 0.5);
        let mut lit = view([0.0, 3.0, 9.0], None);
        (lit.fov_y_degrees, lit.lights) = (Some(30.0), vec![light.clone()]);
        lit.apply(&mut scene, false).unwrap();
        assert_eq!(scene.lights, [light]);
        assert_eq!(
            (scene.camera.fov_y_degrees, scene.camera.eye.z),
            (30.0, 9.0)
        );
        assert_eq!(scene.camera.target, before.camera.target);
        assert!(
            scene.camera.near > before.camera.near,
            "the near plane follows"
        );
    }

    #[test]
    fn straight_down_has_a_right_hand_side() {
        let mut scene = builtin::build("cylinder").unwrap();
        view([0.0, 5.0, 0.0], Some([0.0; 3]))
            .apply(&mut scene, false)
            .unwrap();
        assert_eq!(scene.camera.basis()[0], DVec3::X);
    }

    #[test]
    fn views_that_are_none_are_refused() {
        let mut scene = builtin::build("cylinder").unwrap();
        let nowhere = view([1.0; 3], Some([1.0; 3])).apply(&mut scene, false);
        assert!(nowhere.unwrap_err().to_string().contains("[1, 1, 1]"));
        let wide = View {
            fov_y_degrees: Some(180.0),
            ..View::default()
        };
        assert!(
            wide.apply(&mut scene, false)
                .unwrap_err()
                .to_string()
                .contains("below 180")
        );
        assert!(view([f64::NAN; 3], None).apply(&mut scene, false).is_err());
    }
}
