//! Edges that may be contours from some receiver.

use glam::DVec3;

use super::patches::{Patches, Plane};
use crate::geometry::caster::{Caster, Counting};
use crate::world::mesh::Mesh;

/// No patch.
pub const NONE: u32 = u32::MAX;

/// How D changes across a contour, from which facets face the receiver: `a` and `b` are 1
/// where those of [`ContourEdge::patches`] do, else 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Jump {
    /// `a - b`: of closed casters, where facets that face the light count.
    Facing,
    /// `2 (a - b)`: where facets of both sides count.
    Both,
    /// `2 a - 1`: an edge of one facet, which ends there, where both sides count.
    Lone,
}

impl Jump {
    /// Factor of `a - b`, and what is taken off.
    pub fn weights(self) -> [f64; 2] {
        match self {
            Self::Facing => [1.0, 0.0],
            Self::Both => [2.0, 0.0],
            Self::Lone => [2.0, 1.0],
        }
    }
}

/// An edge with the facets on its sides: seen from before it, the first has it on its left
/// from the first end to the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContourEdge {
    /// World space.
    pub ends: [DVec3; 2],
    /// Numbers of the facets' planes; the second is [`NONE`] of lone edges.
    pub patches: [u32; 2],
    /// What it does to D.
    pub jump: Jump,
}

/// A triangle that counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// World space.
    pub corners: [DVec3; 3],
    /// Number of its plane.
    pub patch: u32,
    /// Whether it counts from both sides, or only where it faces the light.
    pub both: bool,
}

/// What all casters of a scene have for one light.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineCasters {
    /// Planes of facets.
    pub planes: Vec<Plane>,
    /// All triangles.
    pub facets: Vec<Facet>,
    /// All edges between planes.
    pub edges: Vec<ContourEdge>,
    /// How many edges there are up to the end of each caster.
    pub ends: Vec<u32>,
}

impl LineCasters {
    /// Adds a mesh that was examined and counts so; the number of its first plane.
    pub fn push(
        &mut self,
        mesh: &Mesh,
        caster: &Caster,
        patches: &Patches,
        counting: Counting,
    ) -> u32 {
        let first = self.planes.len() as u32;
        let both = counting == Counting::AllTriangles;
        self.planes.extend(&patches.planes);
        let own = patches.of_triangle.iter().enumerate();
        self.facets.extend(own.map(|(t, patch)| Facet {
            corners: mesh.corners(t),
            patch: first + patch,
            both,
        }));
        for edge in caster.adjacency().edges() {
            let ends = [edge.low, edge.high].map(|v| mesh.position(v));
            let walk = |ascending: bool| {
                let own = edge.uses.iter().filter(move |u| u.ascending == ascending);
                own.map(|u| first + patches.of_triangle[u.triangle as usize])
            };
            self.push_edge(ends, walk(true), walk(false), both);
        }
        self.ends.push(self.edges.len() as u32);
        first
    }

    /// Facets that walk an edge one way and the other, in pairs as far as they go.
    fn push_edge(
        &mut self,
        ends: [DVec3; 2],
        up: impl Iterator<Item = u32>,
        down: impl Iterator<Item = u32>,
        both: bool,
    ) {
        let [low, high] = ends;
        let (mut up, mut down) = (up, down);
        loop {
            let (ends, patches, lone) = match (up.next(), down.next()) {
                (Some(a), Some(b)) => ([low, high], [a, b], false),
                (Some(a), None) => ([low, high], [a, NONE], true),
                (None, Some(b)) => ([high, low], [b, NONE], true),
                (None, None) => return,
            };
            let jump = match (lone, both) {
                (true, _) => Jump::Lone,
                (false, true) => Jump::Both,
                (false, false) => Jump::Facing,
            };
            if patches[0] != patches[1] && low != high {
                self.edges.push(ContourEdge {
                    ends,
                    patches,
                    jump,
                });
            }
        }
    }

    /// How many of some edges there are up to the end of each caster; their numbers ascend.
    pub fn ends_of(&self, numbers: &[u32]) -> Vec<u32> {
        let up_to = |end: &u32| numbers.partition_point(|n| n < end) as u32;
        self.ends.iter().map(up_to).collect()
    }

    /// Numbers of the edges that may be met on the way to the light whose hull has these
    /// `corners`: those with facets not all before or all behind all of it. `slack` is what
    /// counts as neither.
    pub fn candidates(&self, corners: &[DVec3], slack: f64) -> Vec<u32> {
        let side = |p: &Plane| side(p, corners, slack);
        let sides: Vec<i8> = self.planes.iter().map(side).collect();
        let may = |e: &ContourEdge| {
            let [a, b] = e.patches;
            b == NONE || sides[a as usize] == 0 || sides[a as usize] != sides[b as usize]
        };
        let numbers = 0..self.edges.len() as u32;
        numbers.filter(|k| may(&self.edges[*k as usize])).collect()
    }
}

/// 1 or -1 where all corners are before or behind the plane, else 0.
fn side(plane: &Plane, corners: &[DVec3], slack: f64) -> i8 {
    let empty = [f64::INFINITY, f64::NEG_INFINITY];
    let [low, high] = corners.iter().fold(empty, |[low, high], c| {
        let height = plane.height(*c);
        [low.min(height), high.max(height)]
    });
    match () {
        () if low > slack => 1,
        () if high < -slack => -1,
        () => 0,
    }
}
