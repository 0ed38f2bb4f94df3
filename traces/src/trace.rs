//! A trace in memory: opened, asked for its frames, written.

use std::fs;
use std::path::Path;

use gnomon_raster::shader::ShaderTable;
use gnomon_raster::{DrawReport, PassReport, Recording, SubmitReport};
use serde::de::DeserializeOwned;

use crate::error::TraceError;
use crate::format::blob::Blobs;
use crate::format::decode::{Fault, Written};
use crate::format::file::{self, Contents};
use crate::format::section::{Entry, tag_text};
use crate::format::{columns, counters, v1};
use crate::meta::Meta;
use crate::shape::FrameShape;

pub(crate) const META: [u8; 4] = *b"META";
pub(crate) const BLOB: [u8; 4] = *b"BLOB";
pub(crate) const SHAD: [u8; 4] = *b"SHAD";
pub(crate) const FRAM: [u8; 4] = *b"FRAM";
pub(crate) const HASH: [u8; 4] = *b"HASH";
pub(crate) const COUN: [u8; 4] = *b"COUN";
pub(crate) const TRAF: [u8; 4] = *b"TRAF";
pub(crate) const TEXL: [u8; 4] = *b"TEXL";

/// Frames in a file.
///
/// Opening checks every section's hash and unpacks only the list of data; frames are
/// unpacked when they are asked for.
#[derive(Clone, Debug)]
pub struct Trace {
    file: Vec<u8>,
    contents: Contents,
    meta: Meta,
    blobs: Blobs,
}

/// A shader of a frame, as it was recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShaderNote {
    /// `vertex` or `fragment`.
    pub stage: &'static str,
    /// Its name.
    pub name: String,
    /// Its version.
    pub version: u32,
    /// Bytes of its uniforms.
    pub uniforms: usize,
}

/// A section, as `info` lists it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SectionNote {
    /// Its tag.
    pub tag: String,
    /// Its frame; 0 where it is of all.
    pub frame: u32,
    /// Its part, such as a pass; 0 where it is of all.
    pub part: u32,
    /// Where its header begins.
    pub offset: u64,
    /// Bytes in the file.
    pub stored: u64,
    /// Bytes unpacked.
    pub raw: u64,
}

/// What the runs of a recorded frame counted. Names of what shaders count themselves are
/// not kept.
#[derive(Clone, Debug, Default)]
pub struct FrameCounters {
    /// With zmin/zmax.
    pub skipping: SubmitReport,
    /// Without; `None` where no traffic was recorded.
    pub unskipped: Option<SubmitReport>,
}

impl Trace {
    /// Opens a file.
    ///
    /// # Errors
    /// It cannot be read, is no trace, or is damaged. One that was cut short opens as far
    /// as it goes, see [`Trace::lost`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, TraceError> {
        let path = path.as_ref();
        let bytes = fs::read(path).map_err(|source| TraceError::File {
            path: path.to_owned(),
            source,
        })?;
        Self::read(bytes).map_err(|source| TraceError::InFile {
            path: path.to_owned(),
            source: Box::new(source),
        })
    }

    /// The trace that `bytes` are.
    ///
    /// # Errors
    /// As [`Trace::open`].
    pub fn read(bytes: Vec<u8>) -> Result<Self, TraceError> {
        let contents = file::read(&bytes)?;
        check_twins(&contents.entries)?;
        let mut trace = Self {
            file: bytes,
            contents,
            meta: Meta::default(),
            blobs: Blobs::default(),
        };
        let (entry, meta) = trace.needed(META, 0, 0)?;
        trace.meta = serde_json::from_slice(&meta).map_err(|e| entry.wrong(&e.to_string()))?;
        if let Some((entry, data)) = trace.section(BLOB, 0, 0)? {
            trace.blobs = Blobs::decode(&data).map_err(|e| entry.wrong(&e))?;
        }
        Ok(trace)
    }

    /// The trace that was just made of `meta`, `blobs` and the sections in `file`.
    pub(crate) fn made(file: Vec<u8>, meta: Meta, blobs: Blobs) -> Result<Self, TraceError> {
        let contents = file::read(&file)?;
        check_twins(&contents.entries)?;
        Ok(Self {
            file,
            contents,
            meta,
            blobs,
        })
    }

    /// Writes the file.
    ///
    /// # Errors
    /// What the system says.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), TraceError> {
        let path = path.as_ref();
        fs::write(path, &self.file).map_err(|source| TraceError::File {
            path: path.to_owned(),
            source,
        })
    }

    /// The file's bytes.
    #[must_use]
    pub fn to_bytes(&self) -> &[u8] {
        &self.file
    }

    /// What it says about itself.
    #[must_use]
    pub fn meta(&self) -> &Meta {
        &self.meta
    }

    /// How many frames there should be; of a file that was cut short some may be lost.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.meta.frames as usize
    }

    /// What of the file is lost, if it was cut short.
    #[must_use]
    pub fn lost(&self) -> Option<&str> {
        self.contents.lost.as_deref()
    }

    /// All sections, in their order.
    #[must_use]
    pub fn sections(&self) -> Vec<SectionNote> {
        let note = |e: &Entry| SectionNote {
            tag: tag_text(e.tag),
            frame: e.frame,
            part: e.part,
            offset: e.offset,
            stored: e.stored,
            raw: e.raw,
        };
        self.contents.entries.iter().map(note).collect()
    }

    /// 64 hex digits that are equal for equal runs, whatever packed them: over tags,
    /// versions and contents of all sections but notes and thumbnails.
    ///
    /// # Errors
    /// A section cannot be unpacked.
    pub fn id(&self) -> Result<String, TraceError> {
        let mut hasher = blake3::Hasher::new();
        for entry in &self.contents.entries {
            if [*b"NOTE", *b"THUM"].contains(&entry.tag) {
                continue;
            }
            let section = entry.unpack(&self.file)?;
            hasher.update(&section.tag);
            hasher.update(&section.version.to_le_bytes());
            hasher.update(&section.frame.to_le_bytes());
            hasher.update(&section.part.to_le_bytes());
            hasher.update(blake3::hash(&section.data).as_bytes());
        }
        Ok(hasher.finalize().to_hex().to_string())
    }

    /// What the frame does, without data and without code.
    ///
    /// # Errors
    /// There is no such frame, or it is damaged.
    pub fn shape(&self, frame: usize) -> Result<FrameShape, TraceError> {
        self.with_frame(frame, |written| written.shape().map_err(Fault::Data))
    }

    /// The frame, its shaders made by `table`.
    ///
    /// # Errors
    /// There is no such frame, it is damaged, or `table` does not have a shader of it.
    pub fn recording(&self, frame: usize, table: &ShaderTable) -> Result<Recording, TraceError> {
        self.with_frame(frame, |written| written.recording(table))
    }

    /// The shaders of a frame, each with different uniforms once.
    ///
    /// # Errors
    /// As [`Trace::shape`].
    pub fn shaders(&self, frame: usize) -> Result<Vec<ShaderNote>, TraceError> {
        let (_, shaders): (_, Vec<v1::Shader>) = self.decoded(SHAD, frame)?;
        let note = |s: v1::Shader| ShaderNote {
            stage: if s.stage == 0 { "vertex" } else { "fragment" },
            name: s.name,
            version: s.version,
            uniforms: s.uniforms.len(),
        };
        Ok(shaders.into_iter().map(note).collect())
    }

    /// What the frame's runs counted.
    ///
    /// # Errors
    /// As [`Trace::shape`].
    pub fn counters(&self, frame: usize) -> Result<FrameCounters, TraceError> {
        let shape = self.shape(frame)?;
        let (entry, counts): (_, v1::Counts) = self.decoded(COUN, frame)?;
        let report = |counts: &[v1::PassCounts]| report(&shape, counts);
        let skipping = report(&counts.skipping).map_err(|e| entry.wrong(&e))?;
        let unskipped = match counts.unskipped.is_empty() && !counts.skipping.is_empty() {
            true => None,
            false => Some(report(&counts.unskipped).map_err(|e| entry.wrong(&e))?),
        };
        Ok(FrameCounters {
            skipping,
            unskipped,
        })
    }

    /// Hashes of attachments and of what draws left.
    pub(crate) fn hashes(&self, frame: usize) -> Result<v1::Hashes, TraceError> {
        Ok(self.decoded(HASH, frame)?.1)
    }

    /// Which pipelines' fragment shaders a frame has, for messages.
    pub(crate) fn shader_of(&self, frame: usize, [pass, draw]: [usize; 2]) -> Option<String> {
        let (_, written): (_, v1::Frame) = self.decoded(FRAM, frame).ok()?;
        let (_, shaders): (_, Vec<v1::Shader>) = self.decoded(SHAD, frame).ok()?;
        let draw = written.passes.get(pass)?.draws.get(draw)?;
        let pipeline = written.pipelines.get(draw.pipeline as usize)?;
        let shader = pipeline.fragment.unwrap_or(pipeline.vertex);
        let shader = shaders.get(shader as usize)?;
        Some(format!("{} {}", shader.name, shader.version))
    }

    fn with_frame<T>(
        &self,
        frame: usize,
        make: impl FnOnce(&Written<'_>) -> Result<T, Fault>,
    ) -> Result<T, TraceError> {
        let (entry, written): (_, v1::Frame) = self.decoded(FRAM, frame)?;
        let (_, shaders): (_, Vec<v1::Shader>) = self.decoded(SHAD, frame)?;
        let written = Written {
            frame: &written,
            shaders: &shaders,
            blobs: &self.blobs,
        };
        make(&written).map_err(|fault| match fault {
            Fault::Data(reason) => entry.wrong(&reason),
            Fault::Shader(unmade) => TraceError::Shader {
                pass: unmade.pass,
                draw: unmade.draw,
                label: unmade.label,
                source: Box::new(unmade.source),
            },
        })
    }

    /// A section of a frame, as the plain data that it is.
    fn decoded<T: DeserializeOwned>(
        &self,
        tag: [u8; 4],
        frame: usize,
    ) -> Result<(Entry, T), TraceError> {
        if frame >= self.frames() {
            return Err(TraceError::NoSuchFrame {
                given: frame,
                count: self.frames(),
            });
        }
        let (entry, data) = self.needed(tag, frame as u32, 0)?;
        let taken = postcard::take_from_bytes(&data);
        match taken {
            Ok((value, [])) => Ok((entry, value)),
            Ok((_, rest)) => Err(entry.wrong(&format!("{} bytes are left over", rest.len()))),
            Err(e) => Err(entry.wrong(&e.to_string())),
        }
    }

    fn needed(&self, tag: [u8; 4], frame: u32, part: u32) -> Result<(Entry, Vec<u8>), TraceError> {
        let found = self.section(tag, frame, part)?;
        found.ok_or_else(|| TraceError::Missing {
            tag: tag_text(tag),
            frame: (![META, BLOB].contains(&tag)).then_some(frame),
            lost: self.contents.lost.clone(),
        })
    }

    /// A section, unpacked, if there is one.
    pub(crate) fn section(
        &self,
        tag: [u8; 4],
        frame: u32,
        part: u32,
    ) -> Result<Option<(Entry, Vec<u8>)>, TraceError> {
        match self.entry(tag, frame, part)? {
            Some(entry) => Ok(Some((entry, entry.unpack(&self.file)?.data))),
            None => Ok(None),
        }
    }

    /// Where a section is, if it is of a version that is known.
    fn entry(&self, tag: [u8; 4], frame: u32, part: u32) -> Result<Option<Entry>, TraceError> {
        let mut entries = self.contents.entries.iter();
        let found = entries.find(|e| (e.tag, e.frame, e.part) == (tag, frame, part));
        match found {
            Some(entry) if entry.version != v1::VERSION => {
                let (given, known) = (entry.version, v1::VERSION);
                let reason = format!("it is version {given}, version {known} is known here");
                Err(entry.wrong(&reason))
            }
            found => Ok(found.copied()),
        }
    }

    /// How many accesses of a frame are written down, as its sections say at their start:
    /// nothing else of them is read, or checked. `None` where none were recorded.
    ///
    /// # Errors
    /// There is no such frame, or a section cannot be read.
    pub fn event_count(&self, frame: usize) -> Result<Option<u64>, TraceError> {
        if !self.meta.traffic {
            return Ok(None);
        }
        let mut count = 0_u64;
        for pass in 0..self.shape(frame)?.passes.len() {
            let entry = self.entry(TRAF, frame as u32, pass as u32)?;
            let entry = entry.ok_or_else(|| self.missing(TRAF, frame))?;
            let records = columns::records(entry.peek(&self.file)?);
            count = count.saturating_add(records);
        }
        Ok(Some(count))
    }

    /// Whether a section is there.
    pub(crate) fn has(&self, tag: [u8; 4], frame: u32, part: u32) -> bool {
        let mut entries = self.contents.entries.iter();
        entries.any(|e| (e.tag, e.frame, e.part) == (tag, frame, part))
    }

    /// A section is needed that is not there.
    pub(crate) fn missing(&self, tag: [u8; 4], frame: usize) -> TraceError {
        TraceError::Missing {
            tag: tag_text(tag),
            frame: Some(frame as u32),
            lost: self.contents.lost.clone(),
        }
    }
}

/// No section is there twice: one of both would be ignored.
fn check_twins(entries: &[Entry]) -> Result<(), TraceError> {
    let mut seen = std::collections::BTreeSet::new();
    let mut twins = entries.iter();
    match twins.find(|e| !seen.insert((e.tag, e.frame, e.part))) {
        Some(twin) => Err(twin.wrong("there is one of its tag, frame and part before it")),
        None => Ok(()),
    }
}

/// Counters with the labels of what they are of.
fn report(shape: &FrameShape, counts: &[v1::PassCounts]) -> Result<SubmitReport, String> {
    if counts.len() != shape.passes.len() {
        let (given, wanted) = (counts.len(), shape.passes.len());
        return Err(format!("it counts {given} passes, the frame has {wanted}"));
    }
    let mut passes = Vec::new();
    for (pass, counts) in shape.passes.iter().zip(counts) {
        if counts.draws.len() != pass.draws.len() {
            let (given, wanted) = (counts.draws.len(), pass.draws.len());
            return Err(format!(
                "it counts {given} draws, `{}` has {wanted}",
                pass.label
            ));
        }
        let draws = pass.draws.iter().zip(&counts.draws);
        let draws = draws.map(|(draw, counts)| {
            Ok(DrawReport {
                label: draw.label.clone(),
                counters: counters::from_list(counts)?,
                counted: &[],
            })
        });
        passes.push(PassReport {
            label: pass.label.clone(),
            draws: draws.collect::<Result<_, String>>()?,
            clear: counters::clear_from_list(&counts.clear)?,
            time: std::time::Duration::ZERO,
        });
    }
    Ok(SubmitReport { passes })
}
