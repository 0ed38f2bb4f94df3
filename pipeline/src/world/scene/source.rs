//! Scenes by name and time: a still scene is the same at all times.
//!
//! Each moment is made afresh from what was read, and from nothing of other
//! moments: so a frame of an animation is the still picture of its time, to the
//! bit.

use std::path::{Path, PathBuf};

use super::builtin::{self, BuiltinScene};
use super::file::{self, Moment};
use super::frame_model::load_at;
use super::{Scene, SceneError, View};
use crate::world::files::Outside;
use crate::world::model;
use crate::world::scene::environment::{EnvironmentRequest, FittedMaps};

/// Where scenes come from.
#[derive(Clone, Debug)]
pub struct SceneSource {
    kind: Kind,
    environment: Option<EnvironmentRequest>,
    maps: FittedMaps,
    view: View,
}

#[derive(Clone, Debug)]
enum Kind {
    Builtin(&'static BuiltinScene),
    File {
        path: PathBuf,
        text: String,
        outside: Outside,
    },
    /// A model that is the same at all times.
    Model(Box<Scene>),
    /// A model that moves.
    Moving {
        path: PathBuf,
        outside: Outside,
    },
}

impl SceneSource {
    /// The source called `name`: a `.toml` scene file, a model (`.obj`, `.ply`,
    /// `.gltf`, `.glb`) to be framed, or else a built-in name. What the file names must lie in its folder.
    ///
    /// # Errors
    /// The file cannot be read, or there is no built-in scene of that name.
    pub fn open(name: &str) -> Result<Self, SceneError> {
        Self::open_with(name, Outside::Refused)
    }

    /// The same; what the file names may lie outside its folder if that is allowed.
    ///
    /// # Errors
    /// As [`SceneSource::open`].
    pub fn open_with(name: &str, outside: Outside) -> Result<Self, SceneError> {
        let path = Path::new(name);
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        let kind = match extension.to_str() {
            Some("toml") => Kind::File {
                path: path.to_owned(),
                text: file::read(path)?,
                outside,
            },
            _ if model::is_model(path) => match load_at(path, outside, 0.0)? {
                (scene, false) => Kind::Model(Box::new(scene)),
                (_, true) => Kind::Moving {
                    path: path.to_owned(),
                    outside,
                },
            },
            _ => Kind::Builtin(builtin::find(name)?),
        };
        Ok(Self {
            kind,
            environment: None,
            maps: FittedMaps::default(),
            view: View::default(),
        })
    }

    /// Lights every scene by `environment` alone, whatever lights it has.
    #[must_use]
    pub fn with_environment(mut self, environment: Option<EnvironmentRequest>) -> Self {
        self.environment = environment;
        self
    }

    /// Looks at every scene from elsewhere, or under other lights.
    #[must_use]
    pub fn with_view(mut self, view: View) -> Self {
        self.view = view;
        self
    }

    /// `scene`, as this source made it without a view, looked at from `view`: what the source
    /// makes with that view, without reading anything again.
    ///
    /// # Errors
    /// The view is none: see [`ViewError`](super::ViewError).
    pub fn seen(&self, scene: &Scene, view: &View) -> Result<Scene, SceneError> {
        let mut seen = scene.clone();
        view.apply(&mut seen, self.is_framed())?;
        Ok(seen)
    }

    /// The scene at `time`, in seconds.
    ///
    /// # Errors
    /// A scene file or its meshes make no scene, or the environment is wrong.
    pub fn at(&mut self, time: f64) -> Result<Scene, SceneError> {
        let mut scene = match &self.kind {
            Kind::File {
                path,
                text,
                outside,
            } => {
                let mut moment = Moment {
                    time,
                    outside: *outside,
                    environment: self.environment.as_ref(),
                    maps: &mut self.maps,
                };
                let mut scene = file::named(path, text, &mut moment)?;
                self.view.apply(&mut scene, false)?;
                return Ok(scene);
            }
            Kind::Builtin(entry) => entry.at(time),
            Kind::Model(scene) => (**scene).clone(),
            Kind::Moving { path, outside } => load_at(path, *outside, time)?.0,
        };
        if let Some(environment) = &self.environment {
            environment.light(&mut scene, &mut self.maps)?;
        }
        self.view.apply(&mut scene, self.is_framed())?;
        Ok(scene)
    }

    /// Whether the scene is a model, with a ground that turns with the eye.
    fn is_framed(&self) -> bool {
        matches!(self.kind, Kind::Model(_) | Kind::Moving { .. })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_do_not_depend_on_each_other() {
        let mut source = SceneSource::open("walk").unwrap();
        let [early, late] = [0.25, 1.5].map(|t| source.at(t).unwrap());
        assert!(early != late && source.at(0.25).unwrap() == early);
        assert!(SceneSource::open("walk").unwrap().at(1.5).unwrap() == late);
        let mut still = SceneSource::open("cylinder").unwrap();
        assert!(still.at(0.0).unwrap() == still.at(9.0).unwrap());
    }

    /// A triangle that goes from 0 to 1 along x in a second: three corners, then the times,
    /// then two places.
    const MOVING: &str = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "scene": 0,
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "animations": [{"samplers": [{"input": 1, "output": 2}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 2, "type": "SCALAR"},
            {"bufferView": 0, "byteOffset": 44, "componentType": 5126, "count": 2, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 68}],
        "buffers": [{"byteLength": 68, "uri":
            "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAA="}]}"#;

    #[test]
    fn scenes_are_looked_at_again_without_being_read_again() {
        let view = View {
            eye: Some(glam::DVec3::new(2.0, 1.5, 6.0)),
            ..View::default()
        };
        let folder = crate::world::scratch::Scratch::made("seen-again");
        let model = folder.join("tent.obj");
        std::fs::write(
            &model,
            "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 1 0\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n",
        )
        .unwrap();
        let moving = folder.join("moving.gltf");
        std::fs::write(&moving, MOVING).unwrap();
        for name in ["walk", model.to_str().unwrap(), moving.to_str().unwrap()] {
            let mut source = SceneSource::open(name).unwrap();
            let plain = source.at(0.5).unwrap();
            let seen = source.seen(&plain, &view).unwrap();
            let made = source.clone().with_view(view.clone()).at(0.5).unwrap();
            assert!(seen == made && seen != plain, "{name}");
            // The ground of models lies across the new sight, that of scenes stays.
            let turned = seen.objects[0].mesh != plain.objects[0].mesh;
            assert_eq!(turned, name != "walk", "{name}");
        }
    }

    #[test]
    fn lights_beside_the_environment_of_a_file_are_refused() {
        let folder = crate::world::scratch::Scratch::made("view-environment");
        let path = folder.join("lit.toml");
        let text = "[camera]\neye = [0, 2, 5]\ntarget = [0, 0.5, 0]\n\
            [environment]\nmap = \"sky\"\nside = 32\nlights = 12\n\
            [[objects]]\nmesh.box = { size = [1, 1, 1] }\n";
        std::fs::write(&path, text).unwrap();
        let source = SceneSource::open(path.to_str().unwrap()).unwrap();
        let eye = Some(glam::DVec3::new(0.0, 3.0, 9.0));
        let mut view = View {
            eye,
            ..View::default()
        };
        let mut seen = source.clone().with_view(view.clone());
        assert!(seen.at(0.0).unwrap().environment.is_some());
        let light = crate::world::light::Light::horizontal_square(glam::DVec3::Y * 9.0, 0.5);
        view.lights = vec![light];
        let refused = source.with_view(view).at(0.0);
        let Err(SceneError::View(problem)) = refused else {
            panic!("{refused:?}");
        };
        assert_eq!(
            problem,
            crate::world::scene::ViewError::LightsBesideEnvironment
        );
        assert!(problem.to_string().contains("valid is one of them"));
    }

    #[test]
    fn an_environment_is_read_once_and_lights_every_moment() {
        let request = EnvironmentRequest::new("sky");
        let mut source = SceneSource::open("walk")
            .unwrap()
            .with_environment(Some(request));
        let [a, b] = [0.0, 0.5].map(|t| source.at(t).unwrap());
        assert!(a.lights.len() > 20 && a.lights.len() == b.lights.len());
        assert!(a.environment.unwrap().fit == b.environment.unwrap().fit);
        let wrong = EnvironmentRequest::new("nowhere.hdr");
        let mut source = SceneSource::open("walk")
            .unwrap()
            .with_environment(Some(wrong));
        assert!(
            source
                .at(0.0)
                .unwrap_err()
                .to_string()
                .contains("nowhere.hdr")
        );
    }
}
