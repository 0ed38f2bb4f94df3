//! Lists of edges that stay from frame to frame: of casters, lights and receivers that did
//! not move.

use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::*;

use super::blocks::BlockBounds;
use super::edges::ContourEdge;
use super::light::{Extent, LineLight};
use super::lists::{Culling, LEVELS, Part};

/// Bytes of lists that are kept at most; what is beyond is made in each frame.
const MOST_BYTES: usize = 256 << 20;

/// Hash of everything that something was made from.
type Key = [u8; 32];

/// What a caster had before in each square of the first level, if it was there.
pub(super) type OfCaster<'a> = Option<&'a BTreeMap<Key, Arc<Part>>>;

/// Lists of a frame for the next one.
#[derive(Debug, Default)]
pub struct KeptLists {
    casters: BTreeMap<Key, BTreeMap<Key, Arc<Part>>>,
    bytes: usize,
}

/// Hashes of casters before a light.
pub(super) struct Keys(Vec<Key>);

impl Keys {
    /// Of each caster's edges, the planes beside them, and what all of them have in common.
    pub(super) fn new(culling: &Culling<'_>) -> Self {
        let mut common = Numbers::default();
        common.add([culling.largest()]);
        common.add_light(culling.light());
        let of = |edges: &[ContourEdge]| {
            let mut own = common.clone();
            for edge in edges {
                own.add(edge.ends.iter().flat_map(|e| e.to_array()));
                for plane in edge.patches.map(|p| culling.plane(p)) {
                    let normal = plane.map_or([f64::NAN; 3], |p| p.normal.to_array());
                    own.add(normal);
                    own.add([plane.map_or(0.0, |p| p.offset)]);
                }
            }
            own.key()
        };
        Self(culling.casters().map(of).collect())
    }

    /// Of the receivers in a square of the first level.
    pub(super) fn of_square(blocks: &BlockBounds, at: [u32; 2]) -> Key {
        let mut all = Numbers::default();
        for y in 0..LEVELS[0] {
            for x in 0..LEVELS[0] {
                let bounds = blocks.square([at[0] + x, at[1] + y], 1);
                all.add(bounds.low.to_array());
                all.add(bounds.high.to_array());
            }
        }
        all.key()
    }
}

impl KeptLists {
    /// The parts of each square, whose receivers have that key.
    pub(super) fn new<'a>(
        keys: &Keys,
        squares: impl Iterator<Item = (Key, &'a [Arc<Part>])>,
    ) -> Self {
        let mut own = Self::default();
        for (square, parts) in squares {
            for (caster, part) in keys.0.iter().zip(parts) {
                let bytes = part.bytes();
                if own.bytes + bytes > MOST_BYTES {
                    return own;
                }
                own.bytes += bytes;
                let of_caster = own.casters.entry(*caster).or_default();
                of_caster.insert(square, part.clone());
            }
        }
        own
    }

    /// What each caster had.
    pub(super) fn of(&self, keys: &Keys) -> Vec<OfCaster<'_>> {
        keys.0.iter().map(|key| self.casters.get(key)).collect()
    }

    /// Adds those of another light.
    pub fn join(&mut self, other: Self) {
        if self.bytes + other.bytes <= MOST_BYTES {
            self.bytes += other.bytes;
            self.casters.extend(other.casters);
        }
    }
}

impl Part {
    /// With what maps take for it.
    fn bytes(&self) -> usize {
        let lists = self.lists.iter().map(|(_, list)| 32 + 4 * list.len());
        128 + lists.sum::<usize>()
    }
}

/// Numbers to be hashed, by their bits.
#[derive(Clone, Default)]
struct Numbers(Vec<u8>);

impl Numbers {
    fn add(&mut self, numbers: impl IntoIterator<Item = f64>) {
        for number in numbers {
            self.0.extend(number.to_bits().to_le_bytes());
        }
    }

    fn add_light(&mut self, light: &LineLight) {
        self.add(light.frame.centre.to_array());
        self.add(light.frame.axes.iter().flat_map(|a| a.to_array()));
        match &light.extent {
            Extent::Polygon(corners) => self.add(corners.iter().flatten().copied()),
            Extent::Disc(radius) => self.add([f64::NEG_INFINITY, *radius]),
            Extent::Sphere(radius) => self.add([f64::INFINITY, *radius]),
        }
    }

    fn key(&self) -> Key {
        *blake3::hash(&self.0).as_bytes()
    }
}
