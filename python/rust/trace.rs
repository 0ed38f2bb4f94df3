//! Traces: frames in files.

use std::path::{Path, PathBuf};

use gnomon::documents::{By, PixelDocument, TraceDocument, TrafficDocument, dram_bytes};
use gnomon::pipeline::world::files;
use gnomon::traces::history::{self, HistoryOptions};
use gnomon::traces::judged::MERGED;
use gnomon::traces::profile::{
    Judge, JudgeOptions, Order, PROFILES, Profile, ProfileError, profile,
};
use gnomon::traces::{self, Meta, RecordOptions, ReplayDepth, TraceError, guarded};
use numpy::{PyArray1, PyArray2, PyArray3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::accesses::{Accesses, WORDS};
use crate::errors::{of_system, raise, raise_history, raise_technique};
use crate::execution::{Execution, Given};
use crate::history::{EVENT_WORDS, event_rows, values};
use crate::replay::Replay;
use crate::scene::Scene;
use crate::settings::{GivenTechnique, chosen};
use crate::{arrays, json};

/// Bytes of a profile of one's own that are read at most.
const MAX_PROFILE: u64 = 1 << 20;

/// Names of the profiles that come with Gnomon.
#[pyfunction]
pub(crate) fn profiles() -> Vec<&'static str> {
    PROFILES.iter().map(|(name, _)| *name).collect()
}

/// Frames that were recorded.
#[pyclass(frozen, module = "gnomon._gnomon")]
pub(crate) struct Trace {
    trace: traces::Trace,
    /// Where it is from; empty where it was made here.
    path: PathBuf,
}

/// A document's text, rows of events, what attachments hold after each.
type PixelFound = (String, Py<PyArray2<u32>>, Py<PyArray3<u32>>);
/// A document's text, and bytes by place.
type Judged = (String, Option<Py<PyArray2<u64>>>);

#[pymethods]
impl Trace {
    #[staticmethod]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let trace = py.detach(|| traces::Trace::open(&path)).map_err(raise)?;
        Ok(Self { trace, path })
    }

    #[staticmethod]
    fn from_bytes(py: Python<'_>, data: &[u8]) -> PyResult<Self> {
        let data = data.to_vec();
        let trace = py.detach(|| traces::Trace::read(data)).map_err(raise)?;
        let path = PathBuf::new();
        Ok(Self { trace, path })
    }

    /// Writes the file; it appears whole or not at all.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let bytes = self.trace.to_bytes();
        let written = py.detach(|| files::write(&path, bytes));
        written.map_err(|e| {
            let message = format!(
                "{}: cannot be written: {e}; nothing was written",
                path.display()
            );
            of_system(e.kind(), message)
        })
    }

    fn to_bytes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, self.trace.to_bytes())
    }

    #[getter]
    fn frames(&self) -> usize {
        self.trace.frames()
    }

    #[getter]
    fn lost(&self) -> Option<&str> {
        self.trace.lost()
    }

    /// What `gnomon info --json` prints.
    fn info<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let document = py.detach(|| TraceDocument::new(&self.path, &self.trace));
        json::loads(py, &json::text(&document.map_err(raise)?)?)
    }

    /// Draws a frame again and compares.
    fn replay(
        &self,
        py: Python<'_>,
        frame: usize,
        deep: bool,
        execution: Given,
    ) -> PyResult<Replay> {
        let execution = Execution::new(execution)?;
        let depth = match deep {
            true => ReplayDepth::Draws,
            false => ReplayDepth::Ends,
        };
        let (trace, gpu) = (&self.trace, execution.gpu);
        let found = execution.run(py, || {
            let table = gnomon::shaders::table();
            let replayed = traces::replay(trace, frame, &table, gpu, depth).map_err(raise)?;
            Replay::read(&replayed)
        })?;
        found.into_arrays(py)
    }

    /// Everything that happened to a pixel.
    fn pixel(
        &self,
        py: Python<'_>,
        pixel: [u32; 2],
        frame: usize,
        image: Option<String>,
        execution: Given,
    ) -> PyResult<PixelFound> {
        let execution = Execution::new(execution)?;
        let config = execution.gpu;
        let history = execution.run(py, || {
            let table = gnomon::shaders::table();
            let recording = self.trace.recording(frame, &table).map_err(raise)?;
            let options = HistoryOptions { config, image };
            let found = guarded(frame, || history::pixel(&recording, &options, pixel));
            found.map_err(raise)?.map_err(raise_history)
        })?;
        let text = json::text(&PixelDocument::new(&history, frame))?;
        let rows: Vec<[u32; EVENT_WORDS]> = event_rows(&history);
        let shape = [history.events.len() + 1, history.attachments.len()];
        let values = arrays::blocks(py, shape, values(&history))?;
        Ok((text, arrays::rows(py, rows)?, values))
    }

    /// What a frame moves under a profile.
    fn traffic(
        &self,
        py: Python<'_>,
        profile: &str,
        by: &str,
        frame: usize,
        merged: bool,
    ) -> PyResult<Judged> {
        let by = find_by(by)?;
        let profile = find_profile(profile)?;
        if merged && profile.order != Order::Tiled {
            return Err(PyValueError::new_err(format!(
                "merged is True, and profile `{}` draws immediately; passes merge under \
                 profiles of tilers",
                profile.name
            )));
        }
        let options = JudgeOptions {
            pixels: by == By::Pixel,
            merged,
        };
        let judged = py.detach(|| self.judged(&profile, options, frame))?;
        let name = self.path.display().to_string();
        let text = json::text(&TrafficDocument::new(&name, &judged, by, merged))?;
        let size = match by {
            By::Pixel => judged.size,
            By::Tile => judged.grid,
            By::Pass | By::Draw | By::Client => return Ok((text, None)),
        };
        let places = arrays::image(py, size, dram_bytes(&judged, by))?;
        Ok((text, Some(places)))
    }

    /// The accesses of a frame, as words.
    fn accesses(&self, py: Python<'_>, frame: usize) -> PyResult<Py<PyArray1<u64>>> {
        let rows = py.detach(|| {
            let count = self.trace.event_count(frame)?;
            let mut rows = Accesses::with_room(count.unwrap_or(0));
            self.trace.events(frame, &mut rows)?;
            Ok::<_, TraceError>(rows)
        });
        let rows: Vec<[u64; WORDS]> = rows.map_err(raise)?.rows()?;
        arrays::line(py, rows.into_flattened())
    }
}

impl Trace {
    fn judged(
        &self,
        profile: &Profile,
        options: JudgeOptions,
        frame: usize,
    ) -> PyResult<gnomon::traces::profile::Traffic> {
        let shape = self.trace.shape(frame).map_err(raise)?;
        let mut judge = Judge::with_options(profile, &shape, options).map_err(raise)?;
        self.trace.events(frame, &mut judge).map_err(raise)?;
        let mut judged = judge.finish();
        if options.merged {
            judged.profile += MERGED;
        }
        Ok(judged)
    }
}

/// Records a frame.
#[pyfunction]
pub(crate) fn record(
    py: Python<'_>,
    scene: &Scene,
    technique: GivenTechnique,
    size: [u32; 2],
    execution: Given,
    traffic: bool,
    frozen: bool,
) -> PyResult<Trace> {
    let (technique, params) = chosen(&technique, execution.3, None)?;
    let execution = Execution::new(execution)?;
    let meta = Meta {
        producer: format!("gnomon {}", env!("CARGO_PKG_VERSION")),
        scene: scene.scene.name.clone(),
        technique: technique.name().to_owned(),
        params: params
            .iter()
            .map(|(k, v)| (k.to_owned(), v.to_owned()))
            .collect(),
        size,
        time: scene.time(),
        ..Meta::default()
    };
    let options = RecordOptions {
        gpu: execution.gpu,
        traffic,
        frozen,
    };
    let scene = scene.scene.clone();
    let trace = execution.run(py, || {
        let frame = technique
            .frame(&scene, size, &params)
            .map_err(raise_technique)?;
        traces::record(meta, &frame.recording, options).map_err(raise)
    })?;
    let path = PathBuf::new();
    Ok(Trace { trace, path })
}

fn find_by(name: &str) -> PyResult<By> {
    let found = By::ALL.into_iter().find(|by| by.name() == name);
    found.ok_or_else(|| {
        let names = By::ALL.map(By::name).join(", ");
        PyValueError::new_err(format!("by is '{name}'; valid are: {names}"))
    })
}

/// A profile by name, or from a file of the user's.
fn find_profile(name: &str) -> PyResult<Profile> {
    let path = Path::new(name);
    if PROFILES.iter().any(|(known, _)| *known == name) || path.extension().is_none() {
        return profile(name).map_err(raise);
    }
    let bytes = files::read(path, MAX_PROFILE).map_err(|e| {
        let message = format!("{name}: {e}");
        match e {
            files::FileError::Unreadable(io) => of_system(io.kind(), message),
            _ => PyValueError::new_err(message),
        }
    })?;
    let text = String::from_utf8(bytes).map_err(|e| {
        raise(ProfileError::Syntax {
            file: name.to_owned(),
            error: e.to_string(),
        })
    })?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    Profile::parse(&stem, name, &text).map_err(raise)
}
