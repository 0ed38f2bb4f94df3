//! What is in a trace, as JSON.

use std::path::Path;

use gnomon_traces::{Meta, Trace, TraceError};
use serde::Serialize;

/// What a trace says of itself, and what is in it.
#[derive(Serialize)]
pub struct TraceDocument {
    pub(crate) file: String,
    pub(crate) bytes: u64,
    pub(crate) id: String,
    #[serde(flatten)]
    pub(crate) meta: Meta,
    pub(crate) lost: Option<String>,
    pub(crate) contents: Vec<FrameDocument>,
    pub(crate) sections: Vec<SectionDocument>,
}

#[derive(Serialize)]
pub(crate) struct FrameDocument {
    pub(crate) passes: Vec<PassDocument>,
    pub(crate) textures: usize,
    pub(crate) shaders: Vec<String>,
    /// Block accesses; absent where none were recorded.
    pub(crate) events: Option<u64>,
}

#[derive(Serialize)]
pub(crate) struct PassDocument {
    pub(crate) name: String,
    pub(crate) draws: usize,
    pub(crate) attachments: usize,
}

#[derive(Serialize)]
pub(crate) struct SectionDocument {
    pub(crate) tag: String,
    pub(crate) frame: u32,
    pub(crate) part: u32,
    pub(crate) offset: u64,
    pub(crate) stored_bytes: u64,
    pub(crate) raw_bytes: u64,
}

impl TraceDocument {
    /// Of `trace`, which is the file at `path`.
    ///
    /// # Errors
    /// A section cannot be read.
    pub fn new(path: &Path, trace: &Trace) -> Result<Self, TraceError> {
        let mut contents = Vec::new();
        for frame in 0..trace.frames() {
            match FrameDocument::new(trace, frame) {
                Ok(document) => contents.push(document),
                // The rest was cut off, which `lost` says.
                Err(TraceError::Missing { .. }) if trace.lost().is_some() => break,
                Err(error) => return Err(error),
            }
        }
        let sections = trace.sections().into_iter().map(|s| SectionDocument {
            tag: s.tag,
            frame: s.frame,
            part: s.part,
            offset: s.offset,
            stored_bytes: s.stored,
            raw_bytes: s.raw,
        });
        Ok(Self {
            file: path.display().to_string(),
            bytes: trace.to_bytes().len() as u64,
            id: trace.id()?,
            meta: trace.meta().clone(),
            lost: trace.lost().map(str::to_owned),
            contents,
            sections: sections.collect(),
        })
    }
}

impl FrameDocument {
    fn new(trace: &Trace, frame: usize) -> Result<Self, TraceError> {
        let shape = trace.shape(frame)?;
        let mut shaders: Vec<String> = trace
            .shaders(frame)?
            .into_iter()
            .map(|s| format!("{} {}", s.name, s.version))
            .collect();
        shaders.sort();
        shaders.dedup();
        let passes = shape.passes.iter().map(|pass| PassDocument {
            name: pass.label.clone(),
            draws: pass.draws.len(),
            attachments: pass.color.len() + usize::from(pass.depth_stencil.is_some()),
        });
        Ok(Self {
            passes: passes.collect(),
            textures: shape.textures.len(),
            shaders,
            events: trace.event_count(frame)?,
        })
    }
}
