//! The emulated GPU: a tiled, SIMD, bit-exact, traffic-counting rasteriser.
//!
//! State, commands and formats in the vocabulary of WebGPU and Vulkan; shaders
//! as Rust code over lanes or as closures; the same bits for every thread count,
//! execution tile and SIMD level; every access to depth, stencil, colour and
//! textures counted. It knows nothing of shadows, files or serialisation.
//!
//! A frame is data: a [`Recording`] holds textures, commands and named results, and
//! stages say which shaders they run ([`shader::ShaderIdentity`]). Who wants to know what
//! each primitive did to each 8×8 block listens as an [`AccessObserver`].
//!
//! ```
//! use gnomon_raster::shader::{FragmentOutputs, ScalarFragmentOutput, ScalarVertexOutput, per_fragment, per_vertex};
//! use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
//! use gnomon_raster::{
//!     ColorAttachment, CommandList, Draw, Format, Gpu, GpuConfig, LoadOp, RenderPass, RenderPipeline, StoreOp,
//!     Subresource, TextureDescriptor,
//! };
//! use std::sync::Arc;
//!
//! // A triangle over the lower left half of a 4×4 image.
//! let corners = [[-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
//! let pipeline = Arc::new(RenderPipeline {
//!     label: "orange".into(),
//!     vertex: per_vertex(&[], move |v| {
//!         let [x, y] = corners[v.vertex_index as usize];
//!         ScalarVertexOutput { position: [x, y, 0.5, 1.0], ..Default::default() }
//!     }),
//!     fragment: Some(per_fragment(FragmentOutputs::default(), |_| {
//!         ScalarFragmentOutput::color([1.0, 0.5, 0.0, 1.0])
//!     })),
//!     primitive: PrimitiveState::default(),
//!     depth_stencil: DepthStencilState::default(),
//!     color_targets: vec![ColorTargetState::OPAQUE],
//! });
//!
//! let mut gpu = Gpu::new(GpuConfig { threads: 1, ..GpuConfig::default() })?;
//! let image = gpu.create_texture(&TextureDescriptor::d2("image", Format::Rgba8Unorm, 4, 4))?;
//! let report = gpu.submit(&CommandList {
//!     passes: vec![RenderPass {
//!         label: "main".into(),
//!         color: vec![ColorAttachment {
//!             texture: image,
//!             subresource: Subresource::default(),
//!             load: LoadOp::Clear([0.0; 4]),
//!             store: StoreOp::Store,
//!         }],
//!         depth_stencil: None,
//!         draws: vec![Draw::vertices_only("triangle", &pipeline, 3)],
//!     }],
//! })?;
//!
//! let texels = gpu.texture(image)?.read_raw(Subresource::default())?;
//! let covered: Vec<u32> = texels.iter().map(|t| u32::from(*t == [255, 128, 0, 255])).collect();
//! // Centres on the diagonal belong to the other half (the top-left rule).
//! assert_eq!(covered, [0, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 1, 1, 1, 0]);
//! let counted = report.passes[0].draws[0].counters;
//! assert_eq!(counted.fragments.written, 6);
//! assert_eq!(counted.traffic.color[0].write_bytes, 24);
//! # Ok::<(), gnomon_raster::Error>(())
//! ```
//!
//! # Stack
//!
//! Rendering needs less than a megabyte of stack at every SIMD level, beside what
//! shaders need, in builds without optimisation too: measured are 96 KiB (AVX-512) to
//! 320 KiB (scalar) there, and about a tenth in optimised ones. With
//! [`GpuConfig::threads`] 1 it is the caller's, otherwise workers', which have 4 MiB.

mod command;
mod counters;
mod depth_plane;
mod error;
mod execute;
pub mod format;
mod frame_builder;
mod geometry;
mod gpu;
mod limits;
pub mod math;
pub mod memory;
mod observer;
mod recording;
mod sampling;
pub mod shader;
pub mod simd;
pub mod state;
pub mod texture;
mod tile;

pub use command::*;
pub use counters::*;
pub use error::Error;
pub use execute::worker_threads;
pub use format::Format;
pub use frame_builder::{FrameBuilder, TriangleDraw};
pub use gpu::{DrawReport, Gpu, GpuConfig, PassReport, SubmitReport};
pub use limits::*;
pub use observer::*;
pub use recording::{Drawn, RecordedTexture, Recording};
pub use simd::{F32, I32, LANES, Lanes, Mask, SimdLevel, U32};
pub use state::{AddressMode, FilterMode, Sampler};
pub use texture::{Subresource, Texture, TextureDescriptor, TextureDimension, TextureId};
