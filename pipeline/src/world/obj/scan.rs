//! One pass over OBJ text: what it says, statement by statement, with the lines
//! of what is wrong or left out.

use std::collections::BTreeMap;

use glam::DVec3;

use super::lines::{self, keyword_and_rest, logical_lines, without_comment};
use super::{ObjError, ObjProblem};
use crate::world::tally::Tally;

/// Largest coordinate: what f32 holds.
const LARGEST: f64 = f32::MAX as f64;

/// What a file says.
#[derive(Debug, Default)]
pub(super) struct Scan {
    /// The `v` lines.
    pub(super) points: Vec<DVec3>,
    /// Faces of at least three corners.
    pub(super) faces: Vec<Face>,
    /// Their corners, face after face: indices into `points`.
    pub(super) corners: Vec<u32>,
    /// The `vt` lines: u, and v counted from below.
    pub(super) texels: Vec<[f64; 2]>,
    /// Of each corner an index into `texels`, from 0; below 0 where it has none.
    pub(super) corner_texels: Vec<i64>,
    /// The rest of each `mtllib` line, trimmed.
    pub(super) libraries: Vec<String>,
    /// The rest of `usemtl` lines, trimmed, each once.
    pub(super) materials: Vec<String>,
    /// Faces with fewer than three corners.
    pub(super) skipped: Tally,
    /// Statements that are not read.
    pub(super) unsupported: Tally,
    /// Texture coordinates that are no numbers, or that there are none of.
    pub(super) bad_texels: Tally,
    objects: Vec<String>,
    /// Places of names in `materials`.
    material_numbers: BTreeMap<String, u32>,
    material: Option<u32>,
}

/// A face as it is written.
#[derive(Debug)]
pub(super) struct Face {
    /// How many corners it has.
    pub(super) corners: usize,
    /// Its line.
    pub(super) line: usize,
    /// Its material, an index into the names.
    pub(super) material: Option<u32>,
    /// The object that it belongs to, counted from 1.
    object: usize,
}

impl Scan {
    /// Reads `bytes`, which messages call `file`.
    pub(super) fn of(bytes: &[u8], file: &str) -> Result<Self, ObjError> {
        let mut scan = Self::default();
        let text = logical_lines(bytes).map_err(|e| ObjError::whole_file(file, e.into()))?;
        for (number, line) in text {
            if let Err(problem) = scan.line(number, &line) {
                return Err(scan.error(file, number, scan.objects.len(), problem));
            }
        }
        scan.check_corners(file)?;
        scan.check_texels();
        Ok(scan)
    }

    fn error(&self, file: &str, line: usize, object: usize, problem: ObjProblem) -> ObjError {
        ObjError {
            file: file.to_owned(),
            line: Some(line),
            object: object.checked_sub(1).map(|o| self.objects[o].clone()),
            problem,
        }
    }

    fn line(&mut self, number: usize, line: &str) -> Result<(), ObjProblem> {
        let Some((keyword, rest)) = keyword_and_rest(line) else {
            return Ok(());
        };
        match keyword {
            "v" => self.vertex(line, without_comment(rest))?,
            "f" => self.face(number, without_comment(rest))?,
            "o" | "g" => self
                .objects
                .push(lines::name_without_comment(rest).to_owned()),
            "mtllib" => self.libraries.push(rest.to_owned()),
            "usemtl" => self.use_material(rest),
            "vt" => self.texel(number, without_comment(rest)),
            "vn" | "vp" | "s" | "l" | "p" => {}
            other => self
                .unsupported
                .add(|| format!("'{other}' in line {number}")),
        }
        Ok(())
    }

    fn use_material(&mut self, name: &str) {
        let known = self.material_numbers.get(name).copied();
        self.material = Some(known.unwrap_or_else(|| {
            let number = self.materials.len() as u32;
            self.materials.push(name.to_owned());
            self.material_numbers.insert(name.to_owned(), number);
            number
        }));
    }

    /// `v x y z`; further numbers (a weight or a colour) are ignored.
    fn vertex(&mut self, line: &str, rest: &str) -> Result<(), ObjProblem> {
        let bad = || ObjProblem::BadVertex {
            line: line.trim().to_owned(),
        };
        let mut words = rest.split_whitespace();
        let mut point = [0.0_f64; 3];
        for coordinate in &mut point {
            let word = words.next().ok_or_else(bad)?;
            *coordinate = word.parse().map_err(|_| bad())?;
            if coordinate.is_nan() || coordinate.abs() > LARGEST {
                return Err(ObjProblem::NonFinite {
                    vertex: self.points.len() + 1,
                    value: word.to_owned(),
                });
            }
        }
        self.points.push(point.into());
        Ok(())
    }

    /// `vt u v`; v is 0 where it is not given. What is wrong is (0, 0): a model without its
    /// paint is still a model.
    fn texel(&mut self, line: usize, rest: &str) {
        let mut words = rest.split_whitespace();
        let number = |word: Option<&str>| match word {
            Some(word) => word.parse().ok().filter(|v: &f64| v.abs() <= LARGEST),
            None => Some(0.0),
        };
        let first = words.next();
        let read = match (first.and_then(|w| number(Some(w))), number(words.next())) {
            (Some(u), Some(v)) => [u, v],
            _ => {
                self.bad_texels.add(|| format!("line {line}"));
                [0.0; 2]
            }
        };
        self.texels.push(read);
    }

    /// As [`Self::check_corners`], of texture coordinates: those that there are not are left
    /// out.
    fn check_texels(&mut self) {
        let count = self.texels.len() as i64;
        for texel in &mut self.corner_texels {
            if *texel >= count {
                (self.bad_texels).add(|| format!("vt {} of {count}", *texel + 1));
                *texel = NO_TEXEL;
            }
        }
    }

    fn face(&mut self, line: usize, rest: &str) -> Result<(), ObjProblem> {
        let before = self.corners.len();
        let mut bad = Vec::new();
        for word in rest.split_whitespace() {
            self.corners.push(corner(word, self.points.len())?);
            let at = texel(word, self.texels.len());
            if at.is_none() {
                bad.push(word);
            }
            self.corner_texels.push(at.unwrap_or(NO_TEXEL));
        }
        let corners = self.corners.len() - before;
        if corners < 3 {
            self.skipped.add(|| format!("line {line}"));
            self.corners.truncate(before);
            self.corner_texels.truncate(before);
            return Ok(());
        }
        // As those that are too high: of faces that are drawn.
        for word in bad {
            (self.bad_texels).add(|| format!("'{word}' in line {line}"));
        }
        self.faces.push(Face {
            corners,
            line,
            material: self.material,
            object: self.objects.len(),
        });
        Ok(())
    }

    /// Vertices may follow the faces that use them, so only the end tells which
    /// indices are too high.
    fn check_corners(&self, file: &str) -> Result<(), ObjError> {
        let mut next = 0;
        for face in &self.faces {
            let corners = &self.corners[next..next + face.corners];
            next += face.corners;
            if let Some(corner) = corners.iter().find(|c| **c as usize >= self.points.len()) {
                let problem = ObjProblem::OutOfRange {
                    index: i64::from(*corner) + 1,
                    vertices: self.points.len(),
                };
                return Err(self.error(file, face.line, face.object, problem));
            }
        }
        Ok(())
    }
}

/// The index of a face corner, from 0, after that many `vertices`.
fn corner(word: &str, vertices: usize) -> Result<u32, ObjProblem> {
    let bad = || ObjProblem::BadCorner {
        value: word.to_owned(),
    };
    let position = word.split('/').next().unwrap_or_default();
    let index: i64 = position.parse().map_err(|_| bad())?;
    let absolute = match index {
        0 => return Err(bad()),
        1.. => index - 1,
        _ => index.saturating_add(vertices as i64),
    };
    let too_far = if index < 0 {
        ObjProblem::BeforeFirst { index, vertices }
    } else {
        // More than a file can define.
        ObjProblem::OutOfRange { index, vertices }
    };
    u32::try_from(absolute).map_err(|_| too_far)
}

/// Of a corner without texture coordinates.
const NO_TEXEL: i64 = -1;

/// The place of a corner's texture coordinates after that many `texels`, which may be too
/// high; `None` where the word says nothing that can be.
fn texel(word: &str, texels: usize) -> Option<i64> {
    let index: i64 = match word.split('/').nth(1) {
        None | Some("") => return Some(NO_TEXEL),
        Some(index) => index.parse().ok()?,
    };
    match index {
        1.. => Some(index - 1),
        0 => None,
        _ => index.checked_add(texels as i64).filter(|at| *at >= 0),
    }
}
