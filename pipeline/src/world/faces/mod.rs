//! From the polygons of a model to triangles: corners that add nothing go
//! (`corners`), the rest is cut (`polygon`, `boundary`), and points of equal
//! coordinates are one (`weld`). Knows no file format.

mod boundary;
mod corners;
mod polygon;
mod weld;

use glam::DVec3;

use crate::world::shape::Shape;
use crate::world::tally::Tally;
use crate::world::warning::SceneWarning;
use corners::drop_repeated;
use polygon::{Cut, Cutter};
pub(crate) use weld::first_equals;

/// Triangles, and what was amiss with the faces that they are of.
#[derive(Default)]
pub(crate) struct Triangles {
    /// Corners as indices of points.
    pub(crate) corners: Vec<[u32; 3]>,
    /// Corners that repeat others of their face.
    pub(crate) repeated: Tally,
    /// Faces of which too few corners are left.
    pub(crate) degenerate: Tally,
    /// Faces whose outline crosses itself.
    pub(crate) crossing: Tally,
    cutter: Cutter,
}

impl Triangles {
    /// Adds a face of at least three `corners`, which index `points`; returns how many
    /// triangles it has. `place` names it in warnings.
    pub(crate) fn face(
        &mut self,
        corners: &mut Vec<u32>,
        points: &[DVec3],
        place: impl Fn() -> String,
    ) -> usize {
        let dropped = drop_repeated(corners);
        if corners.len() < 3 {
            self.degenerate.add(place);
            return 0;
        }
        self.repeated.add_many(dropped, &place);
        let before = self.corners.len();
        let places: Vec<DVec3> = corners.iter().map(|c| points[*c as usize]).collect();
        if self.cutter.cut(corners, &places, &mut self.corners) == Cut::Crossing {
            self.crossing.add(place);
        }
        self.corners.len() - before
    }

    /// What was amiss: codes `crossing-polygons`, `repeated-corners`, `degenerate-faces`.
    pub(crate) fn warnings(&self) -> impl Iterator<Item = SceneWarning> {
        let all = [
            self.crossing.warning(
                "crossing-polygons",
                "polygons whose outline crosses itself were cut into fans, which no cut can do right; triangulate the file",
            ),
            self.repeated.warning(
                "repeated-corners",
                "corners that repeat others of their face were left out",
            ),
            self.degenerate.warning(
                "degenerate-faces",
                "faces whose corners repeat so that they cover nothing were left out",
            ),
        ];
        all.into_iter().flatten()
    }
}

/// The points that triangles use, in order of first use.
pub(crate) fn compact(points: &[DVec3], triangles: &[[u32; 3]]) -> Shape {
    let mut number = vec![u32::MAX; points.len()];
    let mut out = Shape::default();
    for triangle in triangles {
        out.triangles.push(triangle.map(|corner| {
            let own = &mut number[corner as usize];
            if *own == u32::MAX {
                *own = out.positions.len() as u32;
                out.positions.push(points[corner as usize]);
            }
            *own
        }));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_come_in_order_of_first_use() {
        let points = [0.0, 1.0, 2.0, 3.0].map(DVec3::splat);
        let shape = compact(&points, &[[3, 1, 0], [0, 1, 3]]);
        assert_eq!(shape.triangles, [[0, 1, 2], [2, 1, 0]]);
        assert_eq!(shape.positions, [3.0, 1.0, 0.0].map(DVec3::splat));
    }
}
