//! Material libraries: what `usemtl` names.
//!
//! As with the geometry, a scan of our own comes first, since tobj's errors
//! name no line. It hands tobj the statements that are used and valid; what is
//! not valid is a warning that names file and line, because a model without its
//! paint is still a model.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::scan::{Tally, logical_lines};
use crate::world::material::Material;

/// Where a material gives no `Kd`.
const GREY: [f32; 3] = [0.7; 3];

/// Phong exponent of a material with `Ks` but no `Ns`.
const EXPONENT: f32 = 24.0;

/// Materials of all libraries of a model, by name.
#[derive(Debug, Default)]
pub(super) struct Materials {
    by_name: BTreeMap<String, Material>,
    /// Statements that are not valid.
    pub(super) bad: Tally,
    /// Reflectances outside 0..=1.
    pub(super) limited: Tally,
    /// Texture maps, which are not read.
    pub(super) maps: Tally,
    /// Libraries read.
    pub(super) libraries: usize,
}

impl Materials {
    /// The material called `name`.
    pub(super) fn get(&self, name: &str) -> Option<Material> {
        self.by_name.get(name).copied()
    }

    /// Adds a library; of equal names the last one counts. `file` names it in
    /// warnings.
    pub(super) fn read(&mut self, bytes: &[u8], file: &str) {
        let mut scan = Scan::default();
        for (number, line) in logical_lines(bytes) {
            let at = || format!("{file}:{number}: '{}'", line.trim());
            match scan.line(&line) {
                Statement::Used | Statement::Ignored => {}
                Statement::Map => self.maps.add(at),
                Statement::Bad(expected) => {
                    self.bad.add(|| format!("{}; expected {expected}", at()))
                }
            }
        }
        self.libraries += 1;
        match tobj::load_mtl_buf(&mut scan.valid.as_bytes()) {
            Ok((materials, _)) => materials.iter().for_each(|m| self.take(m, file)),
            Err(e) => self.bad.add(|| format!("{file}: tobj: {e}")),
        }
    }

    fn take(&mut self, m: &tobj::Material, file: &str) {
        let highlights = m.illumination_model.is_none_or(|model| model >= 2);
        let specular = m.specular.filter(|_| highlights).unwrap_or_default();
        let mut reflectance = |rgb: [f32; 3]| {
            if rgb.iter().any(|v| !(0.0..=1.0).contains(v)) {
                self.limited
                    .add(|| format!("{file}: '{}' with {rgb:?}", m.name));
            }
            rgb.map(|v| v.clamp(0.0, 1.0))
        };
        let material = Material {
            albedo: reflectance(m.diffuse.unwrap_or(GREY)),
            specular: reflectance(specular),
            shininess: m.shininess.unwrap_or(EXPONENT).max(1.0),
        };
        self.by_name.insert(m.name.clone(), material);
    }
}

/// What a line of a library is.
enum Statement {
    Used,
    Ignored,
    Map,
    /// Not valid; what would be.
    Bad(&'static str),
}

/// The statements for tobj.
#[derive(Default)]
struct Scan {
    valid: String,
    named: bool,
}

impl Scan {
    fn line(&mut self, line: &str) -> Statement {
        let line = line.trim();
        let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let rest = rest.trim();
        match keyword {
            "newmtl" => self.name(rest),
            "Kd" | "Ks" => self.color(keyword, rest),
            "Ns" => self.number(
                keyword,
                rest,
                "one finite number from 0 after a newmtl",
                |v: f32| v.is_finite() && v >= 0.0,
            ),
            "illum" => self.number(
                keyword,
                rest,
                "a whole number 0 to 255 after a newmtl",
                |_: u8| true,
            ),
            map if map.starts_with("map_") || map == "bump" || map == "disp" => Statement::Map,
            _ => Statement::Ignored,
        }
    }

    fn name(&mut self, name: &str) -> Statement {
        self.named = !name.is_empty();
        if !self.named {
            return Statement::Bad("newmtl and a name");
        }
        self.keep("newmtl", name)
    }

    /// One number is grey, three are red, green and blue.
    fn color(&mut self, keyword: &str, rest: &str) -> Statement {
        let numbers: Result<Vec<f32>, _> = rest.split_whitespace().map(str::parse).collect();
        match numbers.as_deref() {
            Ok([v]) if v.is_finite() && self.named => self.keep(keyword, &format!("{v} {v} {v}")),
            Ok([r, g, b]) if [r, g, b].iter().all(|v| v.is_finite()) && self.named => {
                self.keep(keyword, &format!("{r} {g} {b}"))
            }
            _ => Statement::Bad("one or three finite numbers after a newmtl"),
        }
    }

    fn number<T: std::str::FromStr>(
        &mut self,
        keyword: &str,
        rest: &str,
        expected: &'static str,
        valid: impl Fn(T) -> bool,
    ) -> Statement {
        if self.named && rest.parse().is_ok_and(valid) {
            self.keep(keyword, rest)
        } else {
            Statement::Bad(expected)
        }
    }

    fn keep(&mut self, keyword: &str, rest: &str) -> Statement {
        let _ = writeln!(self.valid, "{keyword} {rest}"); // writing to a String cannot fail
        Statement::Used
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Materials {
        let mut m = Materials::default();
        m.read(text.as_bytes(), "t.mtl");
        m
    }

    #[test]
    fn colours_and_exponents_are_read() {
        let m = read(
            "# paint\nnewmtl red paint\nNs 96.5\nKa 0 0 0\nKd 0.8 0.1 0.1\nKs 0.5\nillum 2\nd 1\n\
             newmtl matt\nKd .25\nKs 1 1 1\nillum 1\nnewmtl bare\nNs 0\n",
        );
        let red = m.get("red paint").unwrap();
        assert_eq!((red.albedo, red.specular), ([0.8, 0.1, 0.1], [0.5; 3]));
        assert_eq!(red.shininess, 96.5);
        // Illumination model 1 has no highlights.
        assert_eq!(
            m.get("matt"),
            Some(Material {
                shininess: EXPONENT,
                ..Material::matt([0.25; 3])
            })
        );
        assert_eq!(m.get("bare"), Some(Material::matt(GREY)));
        assert_eq!(m.get("blue"), None);
        assert_eq!([m.bad.count, m.limited.count, m.maps.count], [0; 3]);
    }

    #[test]
    fn what_is_not_valid_is_named_with_its_line() {
        let m = read(
            "Kd 1 1 1\nnewmtl a\nKd 1 x 1\nKd 2 -1 0.5\nKs nan\nNs -3\nillum few\nnewmtl\nmap_Kd a.png\n",
        );
        assert_eq!((m.bad.count, m.limited.count, m.maps.count), (6, 1, 1));
        assert_eq!(
            m.bad.first,
            "t.mtl:1: 'Kd 1 1 1'; expected one or three finite numbers after a newmtl"
        );
        assert!(
            m.limited.first.contains("t.mtl: 'a'"),
            "{}",
            m.limited.first
        );
        assert!(m.maps.first.starts_with("t.mtl:9:"));
        assert_eq!(m.get("a").unwrap().albedo, [1.0, 0.0, 0.5]);
    }
}
