//! Operations of the wedge shaders, counted by running them: see
//! [`gnomon_raster::shader::Operations`] for what one is.
//!
//! The papers count instructions of vertex and pixel shaders of 2003, each of which works
//! on up to four floats at once, so numbers of theirs and ours are not to be compared
//! with one another, only ratios.

use gnomon_raster::shader::Operations;
use gnomon_shaders::coverage::{FlatLight, Image, Projector, SphereLight};
use gnomon_shaders::coverage_table::CoverageTable;
use gnomon_shaders::soft_volumes::{CoverTo, Covering, ExactCoverage, HardPlane, Penumbra};
use gnomon_shaders::split_volumes::textured::SplitTextured;
use gnomon_shaders::split_volumes::{Halves, SplitPenumbra, Tables};

/// A light that shaders project on: what they do depends on its kind alone.
fn rectangle() -> Projector {
    Projector::Flat(FlatLight {
        origin: [0.0; 3],
        far: None,
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        image: Image::Square,
    })
}

fn sphere() -> Projector {
    Projector::Sphere(SphereLight {
        origin: [0.0; 3],
        far: None,
        radius: 1.0,
        seen: false, // as in paper IV
    })
}

fn plane() -> HardPlane {
    HardPlane::through_centre([0.0, 1.0, 0.0])
}

fn paper3<C: Covering + 'static>(covering: C) -> Operations {
    Operations::of(&Penumbra {
        light: rectangle(),
        covering,
        edge: [[0.0; 3]; 2],
        plane: plane(),
        to: CoverTo::Visibility,
    })
}

/// Paper III, closed form, rectangle.
pub(super) fn paper3_exact() -> Operations {
    paper3(ExactCoverage)
}

/// Paper III, 4D texture, the nearest entry, rectangle.
pub(super) fn paper3_table() -> Operations {
    paper3(CoverageTable {
        size: 32,
        linear: false,
        vertex_centred: false,
        whole: false,
    })
}

fn paper4(light: Projector, tables: Tables) -> Operations {
    Operations::of(&SplitPenumbra {
        light,
        edge: [[0.0; 3]; 2],
        plane: plane(),
        tables,
        halves: Halves::Both,
    })
}

/// What paper IV looks up.
const LOOKED_UP: Tables = Tables {
    coverage: true,
    split: true,
};

/// Paper IV, arithmetic, rectangle.
pub(super) fn paper4_arithmetic() -> Operations {
    paper4(rectangle(), Tables::default())
}

/// Paper IV, all tables, rectangle.
pub(super) fn paper4_tables() -> Operations {
    paper4(rectangle(), LOOKED_UP)
}

/// Paper IV, all tables, sphere.
pub(super) fn paper4_sphere() -> Operations {
    paper4(sphere(), LOOKED_UP)
}

/// Paper IV, 4D texture, rectangle.
pub(super) fn paper4_textured() -> Operations {
    Operations::of(&SplitTextured {
        light: rectangle(),
        covering: CoverageTable {
            size: 32,
            linear: false,
            vertex_centred: false,
            whole: false,
        },
        edge: [[0.0; 3]; 2],
        plane: plane(),
        halves: Halves::Both,
        colors: 1,
    })
}

/// The papers' own figures: instructions with texture loads (paper III, §4; paper
/// IV, §6).
pub(super) mod published {
    /// Paper III's shader.
    pub(in super::super) const PAPER3: u64 = 250;
    /// Paper IV's for rectangles: 60 arithmetic, 5 loads.
    pub(in super::super) const PAPER4: u64 = 65;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Look-ups are the papers': position, two angles, area and split; position and table.
    #[test]
    fn look_ups_are_those_of_the_papers() {
        assert_eq!(paper3_exact().look_ups, 1);
        assert_eq!(paper3_table().look_ups, 2);
        assert_eq!(paper4_arithmetic().look_ups, 1);
        assert_eq!(paper4_tables().look_ups, 5);
        assert_eq!(paper4_sphere().look_ups, 5);
        assert_eq!(paper4_textured().look_ups, 2);
    }

    /// With the closed form besides, tables would take half as many operations more.
    #[test]
    fn tables_compute_nothing_that_they_replace() {
        let of = |coverage, split| paper4(rectangle(), Tables { coverage, split });
        let [none, coverage] = [false, true].map(|c| of(c, false).operations);
        println!("arithmetic {none}, coverage looked up {coverage}");
        assert!(coverage < none + 30, "{coverage} {none}");
        assert!(
            of(false, true).operations < none,
            "the split is looked up alone"
        );
    }

    /// Shaders that do more have more operations.
    #[test]
    fn operations_are_counted() {
        assert!(paper3_exact().operations > 100);
        assert!(paper4_arithmetic().operations > paper3_exact().operations);
        assert!(paper4_sphere().operations != paper4_tables().operations);
    }
}
