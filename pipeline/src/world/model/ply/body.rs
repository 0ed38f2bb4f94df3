//! Points and polygons from the values behind the header.

use glam::DVec3;

use super::error::PlyProblem;
use super::header::{Element, Header, Property};
use super::values::{NoValue, Values};
use crate::world::tally::Tally;

/// Largest coordinate: what f32 holds.
const LARGEST: f64 = f32::MAX as f64;

/// A face, or a triangle of a strip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Polygon {
    /// How many corners it has, at least three.
    pub(super) corners: usize,
    /// The element that it is of.
    pub(super) of: &'static str,
    /// The number of that, from 0.
    pub(super) number: u64,
}

/// What a file has of what is drawn.
#[derive(Debug, Default)]
pub(super) struct Body {
    pub(super) points: Vec<DVec3>,
    pub(super) polygons: Vec<Polygon>,
    /// Their corners, one polygon after the other: indices of points, not yet checked.
    pub(super) corners: Vec<u32>,
    /// Faces with fewer than three corners.
    pub(super) skipped: Tally,
    /// Bytes behind the last element.
    pub(super) left_over: Tally,
    /// Triangles of all polygons so far.
    triangles: u64,
    /// Vertices or triangles at most: a byte of the file may be 40 here.
    most: u64,
}

impl Body {
    pub(super) fn of(header: &Header, rest: &[u8], most: u64) -> Result<Self, PlyProblem> {
        let mut body = Self {
            most,
            ..Self::default()
        };
        let mut values = Values::new(header.encoding, rest);
        for element in &header.elements {
            check_count(header, element, &values)?;
            let roles = roles(element)?;
            // Nothing of it is in the file.
            let count = if roles.is_empty() { 0 } else { element.count };
            for number in 0..count {
                body.element(element, &roles, number, &mut values)?;
            }
        }
        let left = values.left_over();
        (body.left_over).add_many(left, || format!("of {} bytes of data", rest.len()));
        Ok(body)
    }

    /// Reads element `number` of its kind.
    fn element(
        &mut self,
        element: &Element,
        roles: &[Role],
        number: u64,
        values: &mut Values<'_>,
    ) -> Result<(), PlyProblem> {
        let mut point = DVec3::ZERO;
        for (property, role) in element.properties.iter().zip(roles) {
            let at = Place {
                element,
                number,
                property,
            };
            if property.list.is_some() {
                let wanted = (*role != Role::None).then_some(3 * self.most);
                let list = at.list(values, wanted)?;
                match role {
                    Role::Face => self.face(&list, &at)?,
                    Role::Strip => self.strip(&list, &at)?,
                    _ => {}
                }
            } else {
                let value = at.value(values)?;
                if let Role::Axis(axis) = role {
                    if self.points.len() as u64 >= self.most {
                        return Err(at.too_much("vertices", self.most));
                    }
                    point[*axis] = coordinate(value, *axis, self.points.len())?;
                }
            }
        }
        if element.name == "vertex" {
            self.points.push(point);
        }
        Ok(())
    }

    /// Counts triangles before they are kept.
    fn count(&mut self, triangles: usize, at: &Place<'_>) -> Result<(), PlyProblem> {
        self.triangles += triangles as u64;
        if self.triangles > self.most {
            return Err(at.too_much("triangles", self.most));
        }
        Ok(())
    }

    fn face(&mut self, list: &[f64], at: &Place<'_>) -> Result<(), PlyProblem> {
        self.count(list.len().saturating_sub(2), at)?;
        for value in list {
            self.corners.push(at.index(*value)?);
        }
        if list.len() < 3 {
            self.skipped.add(|| format!("face {}", at.number));
            self.corners.truncate(self.corners.len() - list.len());
            return Ok(());
        }
        self.polygons.push(Polygon {
            corners: list.len(),
            of: "face",
            number: at.number,
        });
        Ok(())
    }

    /// Triangles of strips; -1 begins another one.
    fn strip(&mut self, list: &[f64], at: &Place<'_>) -> Result<(), PlyProblem> {
        for strip in list.split(|v| *v == -1.0) {
            let corners = strip.iter().map(|v| at.index(*v));
            let corners = corners.collect::<Result<Vec<_>, _>>()?;
            for (k, three) in corners.windows(3).enumerate() {
                let [a, b, c] = [three[0], three[1], three[2]];
                // Strips are joined by triangles without area.
                if a == b || b == c || c == a {
                    continue;
                }
                self.count(1, at)?;
                // Every other triangle of a strip is the other way round.
                self.corners
                    .extend(if k % 2 == 0 { [a, b, c] } else { [a, c, b] });
                self.polygons.push(Polygon {
                    corners: 3,
                    of: "tristrips",
                    number: at.number,
                });
            }
        }
        Ok(())
    }
}

/// Refuses counts that the file is too short for, before anything is kept of them.
fn check_count(header: &Header, element: &Element, values: &Values<'_>) -> Result<(), PlyProblem> {
    let least = element.least_bytes(header.encoding) as u64;
    // The last value of ASCII needs no blank.
    let left = values.left() as u64 + 1;
    let fits = element
        .count
        .checked_mul(least)
        .is_some_and(|all| all <= left);
    if fits {
        return Ok(());
    }
    Err(PlyProblem::TooMany {
        element: element.name.clone(),
        count: element.count,
        left: values.left(),
    })
}

/// What a property is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    None,
    Axis(usize),
    Face,
    Strip,
}

/// What each property of an element is used for.
fn roles(element: &Element) -> Result<Vec<Role>, PlyProblem> {
    let role = |property: &Property| {
        let list = property.list.is_some();
        match (element.name.as_str(), property.name.as_str()) {
            ("vertex", "x") if !list => Role::Axis(0),
            ("vertex", "y") if !list => Role::Axis(1),
            ("vertex", "z") if !list => Role::Axis(2),
            ("face", "vertex_indices" | "vertex_index") if list => Role::Face,
            ("tristrips", "vertex_indices" | "vertex_index") if list => Role::Strip,
            _ => Role::None,
        }
    };
    let roles: Vec<Role> = element.properties.iter().map(role).collect();
    let has = |role| roles.contains(&role);
    if element.name == "vertex" && !(0..3).all(|axis| has(Role::Axis(axis))) {
        return Err(PlyProblem::Lacks {
            missing: "the element 'vertex' lacks one of x, y and z",
            expected: "three properties such as 'property float x'",
        });
    }
    if element.name == "face" && element.count > 0 && !has(Role::Face) {
        return Err(PlyProblem::Lacks {
            missing: "the element 'face' has no list of vertices",
            expected: "'property list uchar int vertex_indices'",
        });
    }
    Ok(roles)
}

fn coordinate(value: f64, axis: usize, number: usize) -> Result<f64, PlyProblem> {
    if value.is_finite() && value.abs() <= LARGEST {
        return Ok(value);
    }
    Err(PlyProblem::NonFinite {
        number,
        axis: ['x', 'y', 'z'][axis],
        value,
    })
}

/// Where a value is, for messages.
struct Place<'a> {
    element: &'a Element,
    number: u64,
    property: &'a Property,
}

impl Place<'_> {
    fn value(&self, values: &mut Values<'_>) -> Result<f64, PlyProblem> {
        let value = values.next(self.property.scalar);
        value.map_err(|e| self.problem(e))
    }

    /// The values of a list, which are kept if so many at most are `wanted`.
    fn list(&self, values: &mut Values<'_>, wanted: Option<u64>) -> Result<Vec<f64>, PlyProblem> {
        let of = self.property.list.unwrap_or(self.property.scalar);
        let length = values.next(of).map_err(|e| self.problem(e))?;
        if !(0.0..=4294967295.0).contains(&length) || length.fract() != 0.0 {
            return Err(PlyProblem::BadLength {
                element: self.element.name.clone(),
                number: self.number,
                property: self.property.name.clone(),
                length,
            });
        }
        if let Some(most) = wanted.filter(|most| length as u64 > *most) {
            return Err(self.too_much("corners of one list", most));
        }
        // Nothing is set aside for what a length says: the values come or they do not.
        let mut list = Vec::new();
        for _ in 0..length as u64 {
            let value = self.value(values)?;
            if wanted.is_some() {
                list.push(value);
            }
        }
        Ok(list)
    }

    fn too_much(&self, what: &'static str, limit: u64) -> PlyProblem {
        PlyProblem::TooMuch {
            element: self.element.name.clone(),
            number: self.number,
            what,
            limit,
        }
    }

    fn problem(&self, e: NoValue) -> PlyProblem {
        match e {
            NoValue::End => PlyProblem::Truncated {
                element: self.element.name.clone(),
                number: self.number,
                count: self.element.count,
            },
            NoValue::NoNumber { text, line } => PlyProblem::NoNumber {
                text,
                line,
                element: self.element.name.clone(),
                number: self.number,
                property: self.property.name.clone(),
            },
        }
    }

    /// A whole number; whether there is such a vertex is known at the end.
    fn index(&self, value: f64) -> Result<u32, PlyProblem> {
        if (0.0..4294967295.0).contains(&value) && value.fract() == 0.0 {
            return Ok(value as u32);
        }
        Err(PlyProblem::BadIndex {
            element: self.element.name.clone(),
            number: self.number,
            index: value,
        })
    }
}
