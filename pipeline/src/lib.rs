//! Scenes, geometry and shadow techniques.
//!
//! Seven wings, each of which knows only those before it: the [`world`] holds scenes
//! (meshes, lights, a camera); [`geometry`] derives what shadow algorithms consume,
//! such as silhouettes, infinite volumes and penumbra wedges; [`truth`] says in f64 what
//! the picture should have been. What a [`technique`] is comes next, the [`parts`] that
//! techniques share, and the [`techniques`]; [`measure`] runs and judges them.
//!
//! Conventions, everywhere: right-handed world, y up, triangles
//! counter-clockwise seen from outside, column vectors, matrices named
//! target-from-source (`clip_from_world`), depth 0 at the near plane and 1 at
//! infinity. Geometry is decided in f64 and rounded to f32 once, so every
//! result is the same on every machine; transcendental functions come from the
//! `libm` crate.
//!
//! ```
//! use gnomon_pipeline::world::adjacency::EdgeAdjacency;
//! use gnomon_pipeline::{geometry::volume::ShadowVolume, world::scene::builtin};
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
//! # Ok::<(), gnomon_pipeline::world::error::UnknownScene>(())
//! ```
//!
//! A [`technique`] turns a scene into commands for the emulated GPU, and
//! [`measure::render`] runs them:
//!
//! ```
//! use gnomon_pipeline::measure::render::{self, RenderSettings};
//! use gnomon_pipeline::world::scene::builtin;
//! use gnomon_pipeline::{technique, techniques};
//!
//! let scene = builtin::build("cylinder")?;
//! let shadows = techniques::find("shadow-volumes")?;
//! let params = technique::Params::parse(shadows, ["method=zfail"])?;
//! let settings = RenderSettings { size: [64, 48], ..RenderSettings::default() };
//! let picture = render::render(&scene, shadows, &params, &settings)?;
//! let shadowed = picture.visibility.iter().filter(|v| **v == 0.0).count();
//! assert!((100..400).contains(&shadowed), "{shadowed} pixels in shadow");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod geometry;
pub mod measure;
pub mod parts;
pub mod technique;
pub mod techniques;
pub mod truth;
pub mod world;
