//! What the memory of other hardware would make of a frame's accesses.
//!
//! A [`Profile`] says how hardware orders, culls, caches and compresses accesses; a
//! [`Judge`] hears those of a frame, drawn with skipping off so that every rule of HiZ can
//! be applied to them, and charges bytes to draws, clients and places. It needs
//! [`Wants::depth_ranges`](gnomon_raster::Wants::depth_ranges),
//! [`Wants::texels`](gnomon_raster::Wants::texels) and a [`Witness`](crate::Witness).

mod attachments;
mod builtin;
mod cache;
mod charge;
pub mod codec;
mod error;
mod facts;
mod hiz;
mod judge;
mod merge;
mod model;
mod plan;
mod support;
mod surface;
mod tiles;
mod traffic;

pub use builtin::{PROFILES, profile};
pub use cache::{CacheCounts, DirtyBytes};
pub use charge::{Amount, Client, Levels};
pub use error::ProfileError;
pub use facts::Fact;
pub use hiz::DisabledReason;
pub use judge::{Judge, JudgeOptions};
pub use merge::{MergeRefusal, PassMerge};
pub use model::{CacheKind, Hiz, HizRules, Keeps, Order, Port, Profile, Tile};
pub use traffic::{HizCounts, Traffic, TrafficRow};
