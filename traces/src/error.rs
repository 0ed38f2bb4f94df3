//! What can be wrong with a trace.

use std::path::PathBuf;

use gnomon_raster::shader::ShaderTableError;

/// Why a trace cannot be written, read or replayed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TraceError {
    /// A file cannot be read or written.
    #[error("{}: {source}", .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file is not what it should be.
    #[error("{}: {source}", .path.display())]
    InFile {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        source: Box<TraceError>,
    },
    /// These bytes are no trace at all.
    #[error("not a trace: {reason}; a trace begins with the bytes 89 47 4E 54 0D 0A 1A 0A")]
    NotATrace {
        /// What is there instead.
        reason: String,
    },
    /// A later format.
    #[error(
        "trace format {major}.{minor} is newer than this program's {known}.x; a newer gnomon reads it"
    )]
    Format {
        /// Major version of the file.
        major: u16,
        /// Minor version of the file.
        minor: u16,
        /// The one that is known here.
        known: u16,
    },
    /// Bytes of a section are not what they were.
    #[error("section {tag} at byte {offset}: {reason}")]
    Section {
        /// Its tag.
        tag: String,
        /// Where its header begins.
        offset: u64,
        /// What is wrong.
        reason: String,
    },
    /// A section that is needed is not there.
    #[error("the trace has no section {tag}{}{}", .frame.map(|f| format!(" for frame {f}")).unwrap_or_default(), .lost.as_ref().map(|l| format!(": {l}")).unwrap_or_default())]
    Missing {
        /// Its tag.
        tag: String,
        /// Of which frame.
        frame: Option<u32>,
        /// What the file lost.
        lost: Option<String>,
    },
    /// No such frame.
    #[error("frame {given} is not in the trace; it has frames 0 to {}", .count.saturating_sub(1))]
    NoSuchFrame {
        /// The frame asked for.
        given: usize,
        /// How many there are.
        count: usize,
    },
    /// A shader cannot be made again.
    #[error("draw {draw} `{label}` of pass `{pass}`: {source}")]
    Shader {
        /// The pass's label.
        pass: String,
        /// The draw's number in the pass.
        draw: usize,
        /// The draw's label.
        label: String,
        /// Why.
        source: Box<ShaderTableError>,
    },
    /// A shader that has no name cannot be recorded by name.
    #[error(
        "draw {draw} `{label}` of pass `{pass}`: its {stage} shader has no identity (a closure?); \
         give it a name and uniforms, or record frozen"
    )]
    NoIdentity {
        /// The pass's label.
        pass: String,
        /// The draw's number in the pass.
        draw: usize,
        /// The draw's label.
        label: String,
        /// `vertex` or `fragment`.
        stage: &'static str,
    },
    /// The GPU refuses the frame.
    #[error("frame {frame}: {source}")]
    Gpu {
        /// The frame.
        frame: usize,
        /// Why.
        source: gnomon_raster::Error,
    },
    /// A shader panicked: its uniforms are none that it was made for.
    #[error(
        "frame {frame}: a shader stopped ({message}); the uniforms or the state in the trace are none that it can run with"
    )]
    Stopped {
        /// The frame.
        frame: usize,
        /// What it said.
        message: String,
    },
    /// There is nothing such to keep.
    #[error("{what} {given} are not there; valid is from 0 to {count}, the end behind the start")]
    Range {
        /// Frames, passes or draws.
        what: &'static str,
        /// What was asked for.
        given: String,
        /// How many there are.
        count: usize,
    },
    /// What would be kept is not what it was.
    #[error(
        "trimmed, {what} in pass {pass} of frame {frame} would be something else; nothing was written"
    )]
    Trimmed {
        /// The frame.
        frame: usize,
        /// The pass.
        pass: usize,
        /// What differs.
        what: String,
    },
}
