//! Recording: what a frame is, and what its two runs found.

mod runs;

use gnomon_raster::{GpuConfig, PassReport, Recording, SubmitReport};
use runs::Runs;

use crate::error::TraceError;
use crate::format::blob::Blobs;
use crate::format::encode::{Encoded, bytes_of, encode};
use crate::format::section::{Codec, Section};
use crate::format::{counters, file, v1};
use crate::frozen::freeze;
use crate::meta::{Meta, Mode};
use crate::trace::{BLOB, COUN, FRAM, HASH, META, SHAD, TEXL, TRAF, Trace};

/// How to record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordOptions {
    /// How to draw; none of it changes a byte of the trace. Both runs set their own
    /// [`GpuConfig::skip`].
    pub gpu: GpuConfig,
    /// Record block accesses: without them a trace is small, and replays, but says nothing
    /// of traffic.
    pub traffic: bool,
    /// Record what shaders gave in the place of the shaders ([`crate::frozen`]): the trace
    /// is larger, and needs no code to be drawn again. Closures can only be recorded so.
    pub frozen: bool,
}

impl Default for RecordOptions {
    fn default() -> Self {
        Self {
            gpu: GpuConfig::default(),
            traffic: true,
            frozen: false,
        }
    }
}

/// Records one frame.
///
/// ```
/// use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
/// use gnomon_raster::{
///     ColorAttachment, Draw, Format, LoadOp, Recording, RenderPass, RenderPipeline, StoreOp,
///     Subresource, TextureDescriptor, VertexBuffer,
/// };
/// use gnomon_shaders::surface::Constant;
/// use gnomon_shaders::transform::{ClipFromWorld, HomogeneousPoints};
/// use gnomon_traces::{Meta, RecordOptions, ReplayDepth, Trace, record, replay};
/// use std::sync::Arc;
///
/// // A frame of one's own: a triangle of one colour.
/// let mut frame = Recording::default();
/// let image = frame.create(&TextureDescriptor::d2("image", Format::Rgba8Unorm, 16, 16))?;
/// frame.name_output("color", image)?;
/// let identity = core::array::from_fn(|i| core::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }));
/// let pipeline = Arc::new(RenderPipeline {
///     label: "orange".into(),
///     vertex: HomogeneousPoints(ClipFromWorld(identity)).stage(),
///     fragment: Some(Constant([1.0, 0.5, 0.0, 1.0]).stage()),
///     primitive: PrimitiveState::default(),
///     depth_stencil: DepthStencilState::default(),
///     color_targets: vec![ColorTargetState::OPAQUE],
/// });
/// let corners = [[-1.0, -1.0, 0.5, 1.0], [1.0, -1.0, 0.5, 1.0], [0.0, 1.0, 0.5, 1.0]];
/// let vertices = VertexBuffer { data: corners.concat(), stride: 4 };
/// let draw = Draw {
///     vertices: Some(Arc::new(vertices)),
///     ..Draw::vertices_only("triangle", &pipeline, 3)
/// };
/// frame.list.passes.push(RenderPass {
///     label: "main".into(),
///     color: vec![ColorAttachment {
///         texture: image,
///         subresource: Subresource::default(),
///         load: LoadOp::Clear([0.0; 4]),
///         store: StoreOp::Store,
///     }],
///     depth_stencil: None,
///     draws: vec![draw],
/// });
///
/// // Recorded, read again, and replayed with the shaders of a table.
/// let trace = record(Meta::new("orange"), &frame, RecordOptions::default())?;
/// let again = Trace::read(trace.to_bytes().to_vec())?;
/// let table = gnomon_shaders::table();
/// let replayed = replay(&again, 0, &table, Default::default(), ReplayDepth::Draws)?;
/// assert!(replayed.difference.is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A stage has no identity, or the GPU refuses the frame.
pub fn record(
    meta: Meta,
    recording: &Recording,
    options: RecordOptions,
) -> Result<Trace, TraceError> {
    let mut recorder = Recorder::new(meta, options);
    recorder.add(recording)?;
    recorder.finish()
}

/// Records frame after frame.
pub struct Recorder {
    meta: Meta,
    options: RecordOptions,
    blobs: Blobs,
    packed: Vec<Vec<u8>>,
    frames: u32,
}

impl Recorder {
    /// For a trace that says `meta` of itself; producer, number of frames and traffic are
    /// filled in.
    #[must_use]
    pub fn new(meta: Meta, options: RecordOptions) -> Self {
        Self {
            meta,
            options,
            blobs: Blobs::default(),
            packed: Vec::new(),
            frames: 0,
        }
    }

    /// Records the next frame.
    ///
    /// # Errors
    /// A stage has no identity, or the GPU refuses the frame.
    pub fn add(&mut self, recording: &Recording) -> Result<(), TraceError> {
        let frozen = match self.options.frozen {
            true => Some(freeze(recording, self.options.gpu).map_err(|e| self.refused(e))?),
            false => None,
        };
        let written = frozen.as_ref().unwrap_or(recording);
        let Encoded { frame, shaders } = encode(written, &mut self.blobs)?;
        let runs = runs::run(recording, self.options.gpu, self.options.traffic);
        let Runs { drawn, observed } = runs.map_err(|e| self.refused(e))?;
        let passes = |r: &SubmitReport| r.passes.iter().map(pass_counts).collect();
        let mut hashes = v1::Hashes {
            ends: drawn.ends,
            draws: Vec::new(),
        };
        let mut counts = v1::Counts {
            skipping: passes(&drawn.report),
            unskipped: Vec::new(),
        };
        let mut traffic = Vec::new();
        if let Some(observed) = observed {
            counts.unskipped = passes(&observed.report);
            hashes.draws = observed.hashes.lists();
            traffic = observed.passes;
        }
        self.section(SHAD, 0, bytes_of(&shaders));
        self.section(FRAM, 0, bytes_of(&frame));
        self.section(HASH, 0, bytes_of(&hashes));
        self.section(COUN, 0, bytes_of(&counts));
        for (number, pass) in traffic.into_iter().enumerate() {
            self.section(TRAF, number, pass.events);
            self.section(TEXL, number, pass.texels);
        }
        self.frames += 1;
        Ok(())
    }

    /// The trace.
    ///
    /// # Errors
    /// Two sections of the file would be the same, which is a fault of this crate.
    pub fn finish(self) -> Result<Trace, TraceError> {
        let meta = Meta {
            producer: match self.meta.producer.as_str() {
                "" => format!("gnomon-traces {}", env!("CARGO_PKG_VERSION")),
                given => given.to_owned(),
            },
            frames: self.frames,
            traffic: self.options.traffic,
            mode: match self.options.frozen {
                true => Mode::Frozen,
                false => Mode::Live,
            },
            ..self.meta
        };
        let said = serde_json::to_vec(&meta).expect("plain data in memory");
        let head = [
            pack(META, 0, 0, said),
            pack(BLOB, 0, 0, self.blobs.encode()),
        ];
        let sections = head.iter().chain(&self.packed);
        let file = file::assemble(sections.map(Vec::as_slice));
        Trace::made(file, meta, self.blobs)
    }

    fn section(&mut self, tag: [u8; 4], part: usize, data: Vec<u8>) {
        self.packed.push(pack(tag, self.frames, part as u32, data));
    }

    fn refused(&self, source: gnomon_raster::Error) -> TraceError {
        TraceError::Gpu {
            frame: self.frames as usize,
            source,
        }
    }
}

fn pack(tag: [u8; 4], frame: u32, part: u32, data: Vec<u8>) -> Vec<u8> {
    let section = Section {
        tag,
        version: v1::VERSION,
        frame,
        part,
        data,
    };
    section.pack(Codec::Zstd)
}

fn pass_counts(pass: &PassReport) -> v1::PassCounts {
    let draws = pass.draws.iter();
    v1::PassCounts {
        clear: counters::clear_list(&pass.clear),
        draws: draws.map(|d| counters::list(&d.counters)).collect(),
    }
}
