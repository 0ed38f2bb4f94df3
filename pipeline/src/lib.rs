//! Scenes, geometry and shadow techniques.
//!
//! From a [`scene::Scene`] (world-space meshes, lights, a camera) this crate
//! derives what hard and soft shadow algorithms consume: edge
//! [`adjacency`], [`silhouette`]s, infinite shadow [`volume`]s, and the f64
//! [`oracle`] that says what the picture should have been.
//!
//! Conventions, everywhere: right-handed world, y up, triangles
//! counter-clockwise seen from outside, column vectors, matrices named
//! target-from-source (`clip_from_world`), depth 0 at the near plane and 1 at
//! infinity. Geometry is decided in f64 and rounded to f32 once, so every
//! result is the same on every machine; transcendental functions come from the
//! pinned `libm` crate.
//!
//! ```
//! use gnomon_pipeline::{adjacency::EdgeAdjacency, light::HardLight};
//! use gnomon_pipeline::{scene::builtin, volume::ShadowVolume};
//!
//! let scene = builtin::build("peer-a")?;
//! let cylinder = &scene.casters().next().unwrap().mesh;
//! let adjacency = EdgeAdjacency::new(cylinder.triangles());
//! assert!(adjacency.closedness(cylinder).is_closed());
//!
//! let light = scene.lights[0].hard();
//! let volume = ShadowVolume::of_closed(cylinder, &adjacency, light);
//! assert_eq!(volume.light_cap().len() + volume.dark_cap().len(), 256);
//! assert_eq!(volume.sides().len(), 2 * 66); // two triangles per silhouette edge
//! # Ok::<(), gnomon_pipeline::error::UnknownScene>(())
//! ```
//!
//! A [`technique`] turns a scene into commands for the emulated GPU, and
//! [`render`] runs them:
//!
//! ```
//! use gnomon_pipeline::render::{self, RenderSettings};
//! use gnomon_pipeline::{scene::builtin, technique};
//!
//! let scene = builtin::build("cylinder")?;
//! let shadows = technique::find("shadow-volumes")?;
//! let params = technique::Params::parse(shadows, ["method=zfail"])?;
//! let settings = RenderSettings { size: [64, 48], ..RenderSettings::default() };
//! let picture = render::render(&scene, shadows, &params, &settings)?;
//! let shadowed = picture.visibility.iter().filter(|v| **v == 0.0).count();
//! assert!((100..400).contains(&shadowed), "{shadowed} pixels in shadow");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod adjacency;
pub mod area_light;
pub mod caster;
pub mod chart;
pub mod comparison;
pub mod convolution;
pub mod coverage;
pub mod environment;
pub mod error;
pub mod heat;
pub mod light;
pub mod light_samples;
pub mod mesh;
pub mod metrics;
pub mod obj;
pub mod oracle;
pub mod render;
pub mod reproduce;
pub mod scene;
pub mod shape;
pub mod silhouette;
pub mod silhouette_loops;
pub mod technique;
mod techniques;
pub mod tile_traffic;
pub mod volume;
pub mod wedge;
pub mod wedge_work;
pub mod winding;

pub use techniques::scene_wedges;
