//! Seeded cases for the tests of wedges and coverage.
#![allow(dead_code, reason = "each test binary uses a part")]

use glam::{DVec3, DVec4};
use gnomon_pipeline::geometry::area_light::AreaLight;
use gnomon_pipeline::geometry::wedge::WedgeMesh;
use gnomon_pipeline::geometry::wedge::polyhedron::{End, Ends, Polyhedron};
use gnomon_pipeline::world::light::LightShape;

/// SplitMix64: a fixed stream per seed.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    pub(crate) fn in_box(&mut self, half: f64) -> DVec3 {
        DVec3::from([(); 3].map(|()| self.range(-half, half)))
    }

    /// Uniform on the sphere.
    pub(crate) fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.in_box(1.0);
            if v.length_squared() < 1.0 && v.length_squared() > 0.01 {
                return v.normalize();
            }
        }
    }
}

/// Right-handed frame of a light: u, v, and the lit side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) centre: DVec3,
    pub(crate) axes: [DVec3; 3],
}

impl Frame {
    pub(crate) fn random(random: &mut Random) -> Self {
        let n = random.direction();
        let u = n.cross(random.direction()).normalize();
        Self {
            centre: random.in_box(3.0),
            axes: [u, n.cross(u), n],
        }
    }

    pub(crate) fn at(&self, x: f64, y: f64, z: f64) -> DVec3 {
        self.centre + self.axes[0] * x + self.axes[1] * y + self.axes[2] * z
    }
}

/// Kinds of light, all about 1 across.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Square,
    Rectangle,
    Parallelogram,
    Disc,
    Sphere,
}

pub(crate) const KINDS: [Kind; 5] = [
    Kind::Square,
    Kind::Rectangle,
    Kind::Parallelogram,
    Kind::Disc,
    Kind::Sphere,
];

pub(crate) fn shape(kind: Kind, frame: &Frame) -> LightShape {
    let [u, v, n] = frame.axes;
    let centre = frame.centre;
    let rectangle = |edge_u, edge_v| LightShape::Rectangle {
        centre,
        edge_u,
        edge_v,
    };
    match kind {
        Kind::Square => rectangle(u, v),
        Kind::Rectangle => rectangle(u * 1.6, v * 0.4),
        Kind::Parallelogram => rectangle(u * 1.2 + v * 0.5, v * 0.9 - u * 0.2),
        Kind::Disc => LightShape::Disc {
            centre,
            normal: n,
            radius: 0.5,
        },
        Kind::Sphere => LightShape::Sphere {
            centre,
            radius: 0.5,
        },
    }
}

pub(crate) fn light(kind: Kind, frame: &Frame) -> AreaLight {
    AreaLight::new(&shape(kind, frame)).unwrap()
}

/// A random point of the light.
pub(crate) fn light_point(shape: &LightShape, random: &mut Random) -> DVec3 {
    match *shape {
        LightShape::Rectangle {
            centre,
            edge_u,
            edge_v,
        } => {
            let on_corner = random.below(4) == 0; // where the penumbra's planes are
            let [s, t] = [(); 2].map(|()| random.range(-0.5, 0.5));
            let snap = |x: f64| if on_corner { x.signum() * 0.5 } else { x };
            centre + edge_u * snap(s) + edge_v * snap(t)
        }
        LightShape::Disc {
            centre,
            normal,
            radius,
        } => {
            let d = random.direction();
            let flat = (d - normal * normal.dot(d)).normalize();
            centre + flat * (radius * random.unit().sqrt().max(random.unit()))
        }
        LightShape::Sphere { centre, radius } => centre + random.direction() * radius,
        _ => unreachable!("lights with area only"),
    }
}

/// A point of the light; half the time one where a ray from `e` grazes it, which
/// is where the penumbra ends.
pub(crate) fn grazing_point(shape: &LightShape, e: DVec3, random: &mut Random) -> DVec3 {
    if random.below(2) == 0 {
        return light_point(shape, random);
    }
    match *shape {
        LightShape::Sphere { centre, radius } => {
            let axis = (e - centre).normalize();
            let across = axis.cross(random.direction()).normalize();
            let sine = radius / (e - centre).length();
            centre + (axis * sine + across * (1.0 - sine * sine).sqrt()) * radius
        }
        LightShape::Disc {
            centre,
            normal,
            radius,
        } => centre + normal.cross(random.direction()).normalize() * radius,
        _ => light_point(shape, random),
    }
}

/// An edge in front of the light and clear of it, as long as asked.
pub(crate) fn edge(frame: &Frame, random: &mut Random, length: [f64; 2]) -> [DVec3; 2] {
    loop {
        let [x, y] = [(); 2].map(|()| random.range(-2.0, 2.0));
        let middle = frame.at(x, y, random.range(0.8, 4.0));
        let half = random.direction() * (0.5 * random.range(length[0], length[1]));
        let ends = [middle - half, middle + half];
        let clear = |e: &DVec3| frame.axes[2].dot(*e - frame.centre) > 0.6;
        if ends.iter().all(clear) {
            return ends;
        }
    }
}

/// Apexes and rays of a polyhedron.
pub(crate) fn generators(volume: &Polyhedron) -> (Vec<DVec3>, Vec<DVec3>) {
    match volume.ends() {
        Ends::Two([a, b]) => (vec![a.apex, b.apex], [&a.rays[..], &b.rays[..]].concat()),
        Ends::One(End { apex, rays }) => (vec![*apex], rays.clone()),
        Ends::HalfSpace(plane) => {
            let (u, v) = plane.normal.any_orthonormal_pair();
            (vec![plane.point], vec![u, v, -u, -v, plane.normal])
        }
    }
}

/// A random point inside, often near the boundary: few rays take part.
pub(crate) fn inside(volume: &Polyhedron, random: &mut Random) -> DVec3 {
    let (apexes, rays) = generators(volume);
    let t = random.unit();
    let start = apexes[0] + (apexes[apexes.len() - 1] - apexes[0]) * t;
    rays.iter().fold(start, |p, ray| {
        let takes_part = random.below(3) == 0;
        p + *ray * (random.unit() * if takes_part { 4.0 } else { 0.01 })
    })
}

/// How often a closed homogeneous mesh winds round `p`, before rounding.
pub(crate) fn winding(mesh: &WedgeMesh, p: DVec3) -> f64 {
    let seen = |i: u32| {
        let v: DVec4 = mesh.vertices[i as usize];
        (v.truncate() - p * v.w).normalize()
    };
    let angles = mesh.triangles.iter().map(|t| {
        let [a, b, c] = t.map(seen);
        let bottom = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
        2.0 * libm::atan2(a.dot(b.cross(c)), bottom)
    });
    angles.sum::<f64>() / (4.0 * std::f64::consts::PI)
}
