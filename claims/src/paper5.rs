//! Paper V: even degrees of silhouette vertices.

use glam::DVec3;

use super::scenes::folded_cone;
use super::{Claim, Finding, Lab, Lines, Measure, ReproduceError, Theirs, Unit, Verdict};
use gnomon_pipeline::geometry::silhouette::{Orientation, Silhouette, light_facing};
use gnomon_pipeline::world::adjacency::EdgeAdjacency;
use gnomon_pipeline::world::light::HardLight;
use gnomon_pipeline::world::mesh::Mesh;

pub(super) const CLAIMS: &[Claim] = &[Claim::new(
    "paper5-even-degree",
    "paper V",
    Verdict::Arithmetic,
    "Silhouette vertices of closed meshes have an even number of silhouette edges; 2, 4, 6 \
     and 8 were seen.",
    even_degree,
)
.read_from(&[
    Lines::one(1815),
    Lines::one(1825),
    Lines::one(1834),
    Lines::one(1841),
])];

/// How many vertices have each number of silhouette edges.
#[derive(Default)]
struct Degrees(Vec<u64>);

impl Degrees {
    fn add(&mut self, mesh: &Mesh, silhouette: &Silhouette) {
        let mut degrees = vec![0usize; mesh.positions().len()];
        for end in silhouette.edges.iter().flatten() {
            degrees[*end as usize] += 1;
        }
        for degree in degrees.into_iter().filter(|d| *d > 0) {
            self.0.resize(self.0.len().max(degree + 1), 0);
            self.0[degree] += 1;
        }
    }

    fn of(&self, degree: usize) -> u64 {
        self.0.get(degree).copied().unwrap_or(0)
    }

    fn odd(&self) -> u64 {
        self.0.iter().skip(1).step_by(2).sum()
    }
}

/// Silhouettes from lights all round.
fn seen_from_all_sides(mesh: &Mesh, lights: u32, degrees: &mut Degrees) {
    let adjacency = EdgeAdjacency::new(mesh.triangles());
    for k in 0..lights {
        // A spiral over the sphere.
        let y = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(lights);
        let angle = 2.399_963_229_728_653 * f64::from(k);
        let ring = (1.0 - y * y).sqrt();
        let towards = DVec3::new(ring * libm::cos(angle), y, ring * libm::sin(angle));
        let facing = light_facing(mesh, HardLight::Point(towards * 7.0));
        let orientation = Orientation::closed(&facing);
        degrees.add(mesh, &Silhouette::new(mesh, &adjacency, &orientation));
    }
}

fn even_degree(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut degrees = Degrees::default();
    for name in ["creature", "columns", "spheres", "peer-c", "overlap"] {
        let scene = lab.scene(name)?;
        for caster in scene.casters() {
            seen_from_all_sides(&caster.mesh, 64, &mut degrees);
        }
    }
    let seen_in_scenes = (1..degrees.0.len()).filter(|d| degrees.of(*d) > 0).max();
    for folds in 2..=5 {
        seen_from_all_sides(&folded_cone(folds)?, 64, &mut degrees);
    }
    let mut measures = vec![Measure::new(
        "vertices of odd degree",
        Theirs::Exactly(0.0),
        degrees.odd() as f64,
        Unit::Count,
    )];
    measures.extend([2, 4, 6, 8].map(|degree| {
        Measure::new(
            format!("vertices of degree {degree}"),
            Theirs::AtLeast(1.0),
            degrees.of(degree) as f64,
            Unit::Count,
        )
    }));
    measures.push(Measure::beside(
        "greatest degree in the built-in scenes",
        "-",
        seen_in_scenes.unwrap_or(0) as f64,
        Unit::Count,
    ));
    Ok(Finding {
        scene: "casters of creature, columns, spheres, peer-c and overlap, and closed cones of \
            2 to 5 folds, from 64 lights each"
            .to_owned(),
        counted: "silhouette edges at each vertex, facing decided once a triangle".to_owned(),
        measures,
        reason: "A triangle's facing was decided more than once.".to_owned(),
        charts: Vec::new(),
    })
}
