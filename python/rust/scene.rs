//! Scenes.

use std::path::PathBuf;
use std::sync::Arc;

use gnomon::documents::ScenesDocument;
use gnomon::pipeline::world::files::Outside;
use gnomon::pipeline::world::light::LightShape;
use gnomon::pipeline::world::mesh::Mesh;
use gnomon::pipeline::world::model::is_model;
use gnomon::pipeline::world::scene::environment::FittedMaps;
use gnomon::pipeline::world::scene::file::{self, Moment, SceneFileError};
use gnomon::pipeline::world::scene::{self, SceneError, SceneSource};
use numpy::PyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use serde_json::json;

use crate::errors::raise;
use crate::{arrays, json};

/// What `gnomon scenes --json` lists.
#[pyfunction]
pub(crate) fn scenes(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    let text = py.detach(|| json::text(&ScenesDocument::built_in()))?;
    json::loads(py, &text)
}

/// A scene at one moment, and where it is from.
#[pyclass(frozen, module = "gnomon")]
pub(crate) struct Scene {
    origin: Origin,
    time: f64,
    pub(crate) scene: Arc<scene::Scene>,
}

/// Where a scene's other moments are made from.
#[derive(Clone)]
enum Origin {
    Named(Box<SceneSource>),
    Text {
        text: Arc<str>,
        folder: PathBuf,
        outside: Outside,
    },
}

impl Origin {
    fn named(name: &str, outside: Outside) -> Result<Self, SceneError> {
        let source = SceneSource::open_with(name, outside)?;
        Ok(Self::Named(Box::new(source)))
    }

    fn at(self, time: f64) -> Result<Scene, SceneError> {
        let scene = match &self {
            Self::Named(source) => source.clone().at(time)?,
            Self::Text {
                text,
                folder,
                outside,
            } => {
                let mut moment = Moment {
                    time,
                    outside: *outside,
                    environment: None,
                    maps: &mut FittedMaps::default(),
                };
                file::parse_at(text, "<toml>", folder, &mut moment)?
            }
        };
        Ok(Scene {
            origin: self,
            time,
            scene: Arc::new(scene),
        })
    }
}

#[pymethods]
impl Scene {
    /// The scene called `name`, or that of a file, at `time`.
    #[new]
    #[pyo3(signature = (name, *, time = 0.0, allow_outside = false))]
    fn open(py: Python<'_>, name: PathBuf, time: f64, allow_outside: bool) -> PyResult<Self> {
        check_time(time)?;
        let Some(name) = name.to_str() else {
            return Err(PyValueError::new_err(format!(
                "scene {name:?} is no UTF-8; rename the file"
            )));
        };
        let outside = outside(allow_outside);
        let made = py.detach(|| Origin::named(name, outside)?.at(time));
        made.map_err(raise)
    }

    /// The scene of a file: a `.toml` scene or a model.
    #[staticmethod]
    #[pyo3(signature = (path, *, time = 0.0, allow_outside = false))]
    fn from_file(py: Python<'_>, path: PathBuf, time: f64, allow_outside: bool) -> PyResult<Self> {
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        if extension == "toml" || is_model(&path) {
            return Self::open(py, path, time, allow_outside);
        }
        Err(PyValueError::new_err(format!(
            "{}: not the name of a scene file; valid are .toml scenes and models \
             (.obj, .ply, .gltf, .glb)",
            path.display()
        )))
    }

    /// The scene that `text` describes; what it names is looked for in `folder`, by
    /// default the current one.
    #[staticmethod]
    #[pyo3(signature = (text, *, folder = None, time = 0.0, allow_outside = false))]
    fn from_toml(
        py: Python<'_>,
        text: &str,
        folder: Option<PathBuf>,
        time: f64,
        allow_outside: bool,
    ) -> PyResult<Self> {
        check_time(time)?;
        check_length(text)?;
        let origin = Origin::Text {
            text: text.into(),
            folder: folder.unwrap_or_else(|| PathBuf::from(".")),
            outside: outside(allow_outside),
        };
        py.detach(|| origin.at(time)).map_err(raise)
    }

    /// The same at another time.
    fn at(&self, py: Python<'_>, time: f64) -> PyResult<Self> {
        check_time(time)?;
        py.detach(|| self.origin.clone().at(time)).map_err(raise)
    }

    #[getter]
    fn name(&self) -> &str {
        &self.scene.name
    }

    #[getter]
    pub(crate) fn time(&self) -> f64 {
        self.time
    }

    /// Width and height that a scene file asks for.
    #[getter]
    fn size(&self) -> Option<(u32, u32)> {
        self.scene.size.map(|[w, h]| (w, h))
    }

    /// Kind and colour of each light.
    #[getter]
    fn lights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let lights = self.scene.lights.iter();
        let lights = lights.map(|l| json!({ "kind": kind(&l.shape), "color": l.colour }));
        json::loads(py, &json::text(&lights.collect::<Vec<_>>())?)
    }

    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let warnings = self.scene.warnings.iter();
        let warnings = warnings.map(gnomon::documents::WarningDocument::new);
        json::loads(py, &json::text(&warnings.collect::<Vec<_>>())?)
    }

    /// Objects in drawing order.
    #[getter]
    fn objects(&self) -> Vec<SceneObject> {
        let object = |o: &scene::Object| SceneObject {
            name: o.name.clone(),
            casts: o.casts,
            receives: o.receives,
            mesh: o.mesh.clone(),
            positions: PyOnceLock::new(),
            triangles: PyOnceLock::new(),
        };
        self.scene.objects.iter().map(object).collect()
    }

    fn __repr__(&self) -> String {
        let scene = &self.scene;
        format!(
            "<gnomon.Scene '{}' at {} s: {} objects, {} triangles, {} lights>",
            scene.name,
            self.time,
            scene.objects.len(),
            scene.triangle_count(),
            scene.lights.len(),
        )
    }
}

/// An object of a scene.
#[pyclass(frozen, module = "gnomon")]
pub(crate) struct SceneObject {
    #[pyo3(get)]
    name: String,
    #[pyo3(get)]
    casts: bool,
    #[pyo3(get)]
    receives: bool,
    mesh: Arc<Mesh>,
    positions: PyOnceLock<Py<PyArray2<f32>>>,
    triangles: PyOnceLock<Py<PyArray2<u32>>>,
}

#[pymethods]
impl SceneObject {
    /// Vertices in the world; the scene keeps its own.
    #[getter]
    fn positions(&self, py: Python<'_>) -> PyResult<Py<PyArray2<f32>>> {
        let made = || arrays::rows(py, self.mesh.positions().to_vec());
        Ok(self.positions.get_or_try_init(py, made)?.clone_ref(py))
    }

    /// Three vertices each, counter-clockwise seen from outside.
    #[getter]
    fn triangles(&self, py: Python<'_>) -> PyResult<Py<PyArray2<u32>>> {
        let made = || arrays::rows(py, self.mesh.triangles().to_vec());
        Ok(self.triangles.get_or_try_init(py, made)?.clone_ref(py))
    }

    fn __repr__(&self) -> String {
        let triangles = self.mesh.triangles().len();
        format!(
            "<gnomon.SceneObject '{}': {triangles} triangles>",
            self.name
        )
    }
}

fn kind(shape: &LightShape) -> &'static str {
    match shape {
        LightShape::Point { .. } => "point",
        LightShape::Directional { .. } => "directional",
        LightShape::Rectangle { .. } => "rectangle",
        LightShape::Disc { .. } => "disc",
        LightShape::Sphere { .. } => "sphere",
        LightShape::Polygon(_) => "polygon",
    }
}

fn outside(allowed: bool) -> Outside {
    match allowed {
        true => Outside::Allowed,
        false => Outside::Refused,
    }
}

fn check_time(time: f64) -> PyResult<()> {
    match time.is_finite() {
        true => Ok(()),
        false => Err(PyValueError::new_err(format!(
            "time is {time}; expected a finite number of seconds"
        ))),
    }
}

/// The limit of files holds for texts too.
fn check_length(text: &str) -> PyResult<()> {
    let limit = file::MAX_SCENE_BYTES;
    match text.len() as u64 <= limit {
        true => Ok(()),
        false => Err(raise(SceneFileError::Unreadable {
            file: "<toml>".to_owned(),
            source: gnomon::pipeline::world::files::FileError::TooLong { limit },
        })),
    }
}
