//! One pass over OBJ text: validation with line numbers, warnings, the geometry
//! rewritten for tobj, and which faces use which material.

use std::fmt::Write as _;

use glam::DVec3;

use super::ObjProblem;
use super::mtl::Materials;
use super::polygon::fan_is_valid;
use crate::world::material::MaterialPart;
use crate::world::warning::SceneWarning;

/// What a scan found.
#[derive(Debug, Default)]
pub(super) struct Scan {
    /// The `v` and `f` lines, one object, indices absolute, positions only.
    pub(super) geometry: String,
    /// Faces with at least three corners.
    pub(super) faces: usize,
    positions: Vec<DVec3>,
    object: Option<String>,
    libraries: Vec<String>,
    /// Names after `usemtl`, each once.
    names: Vec<String>,
    /// The name in force.
    current: Option<usize>,
    /// Triangles of each face, and its name.
    painted: Vec<(usize, Option<usize>)>,
    concave: Tally,
    skipped: Tally,
    unsupported: Tally,
}

/// A problem at a line.
pub(super) struct ScanError {
    pub(super) line: usize,
    pub(super) object: Option<String>,
    pub(super) problem: ObjProblem,
}

/// How often, and first where.
#[derive(Debug, Default)]
pub(super) struct Tally {
    pub(super) count: usize,
    pub(super) first: String,
}

impl Tally {
    pub(super) fn add(&mut self, first: impl FnOnce() -> String) {
        if self.count == 0 {
            self.first = first();
        }
        self.count += 1;
    }
}

impl Scan {
    pub(super) fn of(bytes: &[u8]) -> Result<Self, ScanError> {
        let mut scan = Self::default();
        for (number, line) in logical_lines(bytes) {
            if let Err(problem) = scan.line(number, &line) {
                return Err(ScanError {
                    line: number,
                    object: scan.object,
                    problem,
                });
            }
        }
        Ok(scan)
    }

    fn line(&mut self, number: usize, line: &str) -> Result<(), ObjProblem> {
        let mut words = line.split_whitespace();
        let Some(keyword) = words.next() else {
            return Ok(());
        };
        match keyword {
            "v" => self.vertex(line, words)?,
            "f" => self.face(number, words)?,
            "o" | "g" => self.object = Some(words.collect::<Vec<_>>().join(" ")),
            "mtllib" => self.libraries.extend(words.map(str::to_owned)),
            "usemtl" => self.use_material(line.trim_start()[keyword.len()..].trim()),
            "vn" | "vt" | "vp" | "s" | "l" | "p" => {}
            comment if comment.starts_with('#') => {}
            other => self
                .unsupported
                .add(|| format!("'{other}' in line {number}")),
        }
        Ok(())
    }

    fn use_material(&mut self, name: &str) {
        let known = self.names.iter().position(|n| n == name);
        self.current = Some(known.unwrap_or_else(|| {
            self.names.push(name.to_owned());
            self.names.len() - 1
        }));
    }

    /// `v x y z`; further numbers (a weight or a colour) are ignored.
    fn vertex<'a>(
        &mut self,
        line: &str,
        words: impl Iterator<Item = &'a str>,
    ) -> Result<(), ObjProblem> {
        let bad = || ObjProblem::BadVertex {
            line: line.trim().to_owned(),
        };
        let mut position = [0.0; 3];
        let mut written = 0;
        self.geometry.push('v');
        for (coordinate, word) in position.iter_mut().zip(words) {
            let value: f32 = word.parse().map_err(|_| bad())?;
            if !value.is_finite() {
                return Err(ObjProblem::NonFinite {
                    vertex: self.positions.len() + 1,
                    value: word.to_owned(),
                });
            }
            *coordinate = f64::from(value);
            written += 1;
            let _ = write!(self.geometry, " {word}"); // writing to a String cannot fail
        }
        self.geometry.push('\n');
        self.positions.push(position.into());
        if written == 3 { Ok(()) } else { Err(bad()) }
    }

    fn face<'a>(
        &mut self,
        number: usize,
        words: impl Iterator<Item = &'a str>,
    ) -> Result<(), ObjProblem> {
        let corners = words
            .map(|word| self.corner(word))
            .collect::<Result<Vec<usize>, _>>()?;
        if corners.len() < 3 {
            self.skipped.add(|| format!("line {number}"));
            return Ok(());
        }
        let polygon: Vec<DVec3> = corners.iter().map(|&i| self.positions[i]).collect();
        if !fan_is_valid(&polygon) {
            self.concave.add(|| format!("line {number}"));
        }
        self.painted.push((corners.len() - 2, self.current));
        self.geometry.push('f');
        for corner in corners {
            let _ = write!(self.geometry, " {}", corner + 1);
        }
        self.geometry.push('\n');
        self.faces += 1;
        Ok(())
    }

    /// 0-based position index of a face corner.
    fn corner(&self, word: &str) -> Result<usize, ObjProblem> {
        let bad = || ObjProblem::BadCorner {
            value: word.to_owned(),
        };
        let position = word.split('/').next().unwrap_or_default();
        let index: i64 = position.parse().map_err(|_| bad())?;
        let vertices = self.positions.len();
        let absolute = match index {
            0 => return Err(bad()),
            1.. => index - 1,
            _ => index.saturating_add(vertices as i64),
        };
        match usize::try_from(absolute) {
            Ok(i) if i < vertices => Ok(i),
            _ => Err(ObjProblem::OutOfRange { index, vertices }),
        }
    }

    /// Reads the material libraries. `library` gives a file's name for messages
    /// and its bytes, if it can be read.
    pub(super) fn paint(&self, library: &Library<'_>) -> Paint {
        let mut paint = Paint::default();
        for name in &self.libraries {
            match library(name) {
                Some((file, bytes)) => paint.materials.read(&bytes, &file),
                None => paint.missing.add(|| format!("'{name}'")),
            }
        }
        paint
    }

    /// The materials in use, each with its triangles, in order of first use.
    pub(super) fn parts(&self, paint: &mut Paint) -> Vec<MaterialPart> {
        let mut of_name: Vec<Vec<u32>> = vec![Vec::new(); self.names.len()];
        let mut next = 0;
        for &(triangles, name) in &self.painted {
            let range = next..next + triangles as u32;
            next = range.end;
            if let Some(name) = name {
                of_name[name].extend(range);
            }
        }
        let mut parts = Vec::new();
        for (name, triangles) in self.names.iter().zip(of_name) {
            match paint.materials.get(name) {
                Some(material) => parts.push(MaterialPart {
                    material,
                    triangles,
                }),
                None if paint.materials.libraries > 0 => {
                    paint.unknown.add(|| format!("'{name}'"));
                }
                None => {}
            }
        }
        parts.retain(|p| !p.triangles.is_empty());
        parts
    }

    pub(super) fn warnings(&self, paint: &Paint) -> Vec<SceneWarning> {
        [
            ("concave-polygons", &self.concave, "polygons that are not convex were cut into fans, which is wrong for them; triangulate the file"),
            ("skipped-faces", &self.skipped, "faces with fewer than three corners were skipped"),
            ("unsupported-statements", &self.unsupported, "statements were ignored; only polygons are read"),
            ("missing-mtl", &paint.missing, "material libraries are missing or cannot be read; their faces are drawn in one material"),
            ("bad-mtl", &paint.materials.bad, "statements of material libraries are not valid and were left out"),
            ("limited-mtl", &paint.materials.limited, "reflectances were limited to 0..=1"),
            ("ignored-maps", &paint.materials.maps, "texture maps were ignored; only Kd, Ks and Ns are used"),
            ("unknown-material", &paint.unknown, "materials are used that no library defines"),
        ]
        .into_iter()
        .filter(|(_, tally, _)| tally.count > 0)
        .map(|(code, tally, what)| SceneWarning {
            code,
            count: tally.count,
            message: format!("{what} (first: {})", tally.first),
        })
        .collect()
    }
}

/// Gives a material library's name for messages and its bytes.
pub(super) type Library<'a> = dyn Fn(&str) -> Option<(String, Vec<u8>)> + 'a;

/// What the material libraries said.
#[derive(Default)]
pub(super) struct Paint {
    materials: Materials,
    missing: Tally,
    unknown: Tally,
}

/// Lines with their numbers from 1, a trailing backslash joining the next line.
/// Bytes that are not UTF-8 become U+FFFD, so comments may be in any encoding.
pub(super) fn logical_lines(bytes: &[u8]) -> impl Iterator<Item = (usize, String)> {
    let mut lines = bytes.split(|b| *b == b'\n').enumerate();
    std::iter::from_fn(move || {
        let (index, first) = lines.next()?;
        let mut text = String::from_utf8_lossy(first).trim_end().to_owned();
        while text.ends_with('\\') {
            text.pop();
            let Some((_, next)) = lines.next() else { break };
            text.push_str(String::from_utf8_lossy(next).trim_end());
        }
        Some((index + 1, text))
    })
}
