//! Material libraries: what `usemtl` names.
//!
//! As with the geometry, a scan of our own comes first, since tobj's errors
//! name no line. It hands tobj the statements that are used and valid; what is
//! not valid is a warning that names file and line, because a model without its
//! paint is still a model.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::str::FromStr;

use super::library::unquoted;
use super::lines::{keyword_and_rest, logical_lines, name_without_comment, without_comment};
use super::map::{self, MapLine};
use crate::world::material::Material;
use crate::world::tally::Tally;

/// Where a material gives no `Kd`.
const GREY: [f32; 3] = [0.7; 3];

/// Phong exponent of a material with `Ks` but no `Ns`.
const EXPONENT: f32 = 24.0;

/// Materials of all libraries of a model, by name.
#[derive(Debug, Default)]
pub(super) struct Materials {
    all: Vec<Material>,
    /// Of each its `map_Kd`, and the library that has it.
    maps_of: Vec<Option<(MapLine, String)>>,
    /// By the whole rest of their `newmtl` line.
    by_line: BTreeMap<String, usize>,
    /// By the name without comment and quotes.
    by_name: BTreeMap<String, usize>,
    /// Statements that are not valid.
    pub(super) bad: Tally,
    /// Reflectances outside 0..=1.
    pub(super) limited: Tally,
    /// Maps of other things than `Kd`, which are not read.
    pub(super) maps: Tally,
    /// Libraries read.
    pub(super) libraries: usize,
}

impl Materials {
    /// The material that the rest of a `usemtl` line names: as it is written, or
    /// else without comment and quotes.
    pub(super) fn find(&self, line: &str) -> Option<usize> {
        let name = bare(line);
        let by_line = |name| self.by_line.get(name);
        let found = by_line(line).or_else(|| by_line(name));
        found.or_else(|| self.by_name.get(name)).copied()
    }

    /// Material number `index`.
    pub(super) fn material(&self, index: usize) -> Material {
        self.all[index]
    }

    /// The picture of its base colour, and the name of its library.
    pub(super) fn map(&self, index: usize) -> Option<&(MapLine, String)> {
        self.maps_of[index].as_ref()
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.all.len()
    }

    /// Adds the library that a model calls `library`; of equal names the last one counts.
    /// `file` names it in warnings.
    pub(super) fn read(&mut self, bytes: &[u8], library: &str, file: &str) {
        self.libraries += 1;
        let mut scan = Scan::default();
        let lines = match logical_lines(bytes) {
            Ok(lines) => lines,
            Err(e) => return self.bad.add(|| format!("{file}: {e}")),
        };
        for (number, line) in lines {
            let at = || format!("{file}:{number}: '{}'", line.trim());
            match scan.line(&line) {
                Statement::Used | Statement::Ignored => {}
                Statement::Map => self.maps.add(at),
                Statement::Bad(expected) => {
                    self.bad.add(|| format!("{}; expected {expected}", at()))
                }
            }
        }
        match tobj::load_mtl_buf(&mut scan.valid.as_bytes()) {
            Ok((materials, _)) => {
                let maps = scan.maps.iter_mut().map(Option::take);
                for ((material, name), map) in materials.iter().zip(&scan.names).zip(maps) {
                    let map = map.map(|m| (m, library.to_owned()));
                    self.take(material, name, map, file);
                }
            }
            Err(e) => self.bad.add(|| format!("{file}: tobj: {e}")),
        }
    }

    fn take(&mut self, m: &tobj::Material, name: &str, map: Option<(MapLine, String)>, file: &str) {
        // A picture shows its own colours.
        let usual = if map.is_some() { [1.0; 3] } else { GREY };
        let highlights = m.illumination_model.is_none_or(|model| model >= 2);
        let specular = m.specular.filter(|_| highlights).unwrap_or_default();
        let mut reflectance = |rgb: [f64; 3]| {
            if rgb.iter().any(|v| !(0.0..=1.0).contains(v)) {
                self.limited
                    .add(|| format!("{file}: '{name}' with {rgb:?}"));
            }
            rgb.map(|v| v.clamp(0.0, 1.0) as f32)
        };
        let material = Material {
            albedo: reflectance(m.diffuse.unwrap_or(usual.map(f64::from))),
            specular: reflectance(specular),
            shininess: m.shininess.map_or(EXPONENT, |n| n as f32).max(1.0),
        };
        let index = self.all.len();
        self.all.push(material);
        self.maps_of.push(map);
        self.by_line.insert(name.to_owned(), index);
        self.by_name.insert(bare(name).to_owned(), index);
    }
}

/// The name in the rest of a line.
fn bare(line: &str) -> &str {
    unquoted(name_without_comment(line))
}

/// What a line of a library is.
enum Statement {
    Used,
    Ignored,
    Map,
    /// Not valid; what would be.
    Bad(&'static str),
}

/// Statements of material libraries that say nothing of what is used.
const IGNORED: [&str; 19] = [
    "Ka",
    "Ke",
    "Tf",
    "Tr",
    "d",
    "Ni",
    "sharpness",
    "halo",
    "Pr",
    "Pm",
    "Ps",
    "Pc",
    "Pcr",
    "aniso",
    "anisor",
    "Material",
    "vp",
    "Km",
    "g",
];

/// Statements that name pictures, besides those that begin with `map_`.
const MAPS: [&str; 6] = ["bump", "disp", "decal", "refl", "norm", "map"];

fn is_map(keyword: &str) -> bool {
    let keyword = keyword.to_ascii_lowercase();
    keyword.starts_with("map_") || MAPS.contains(&keyword.as_str())
}

/// The statements for tobj.
#[derive(Default)]
struct Scan {
    valid: String,
    /// The rest of each `newmtl` line; tobj knows materials by their number.
    names: Vec<String>,
    /// Of each material its `map_Kd`.
    maps: Vec<Option<MapLine>>,
    named: bool,
}

impl Scan {
    fn line(&mut self, line: &str) -> Statement {
        let Some((keyword, rest)) = keyword_and_rest(line) else {
            return Statement::Ignored;
        };
        let numbers = without_comment(rest).trim();
        match keyword {
            "newmtl" => self.name(rest),
            "Kd" | "Ks" => self.color(keyword, numbers),
            "Ns" => self.number(
                keyword,
                numbers,
                "one finite number from 0 after a newmtl",
                |v: &f32| v.is_finite() && *v >= 0.0,
            ),
            "illum" => self.number(
                keyword,
                numbers,
                "a whole number 0 to 255 after a newmtl",
                |_: &u8| true,
            ),
            base if base.eq_ignore_ascii_case("map_Kd") => self.map(rest),
            map if is_map(map) => Statement::Map,
            other if IGNORED.contains(&other) => Statement::Ignored,
            _ => Statement::Bad("a statement of material libraries"),
        }
    }

    fn map(&mut self, rest: &str) -> Statement {
        let named = self.named;
        match (self.maps.last_mut().filter(|_| named), map::read(rest)) {
            (Some(own), Some(line)) => *own = Some(line),
            _ => return Statement::Bad("the name of a picture after a newmtl"),
        }
        Statement::Used
    }

    fn name(&mut self, name: &str) -> Statement {
        self.named = !bare(name).is_empty();
        if !self.named {
            return Statement::Bad("newmtl and a name");
        }
        let number = self.names.len().to_string();
        self.names.push(name.to_owned());
        self.maps.push(None);
        self.keep("newmtl", &number)
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

    fn number<T: FromStr + ToString>(
        &mut self,
        keyword: &str,
        rest: &str,
        expected: &'static str,
        valid: impl Fn(&T) -> bool,
    ) -> Statement {
        match rest.parse() {
            // Written anew, since tobj reads less than Rust does.
            Ok(value) if self.named && valid(&value) => self.keep(keyword, &value.to_string()),
            _ => Statement::Bad(expected),
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
        m.read(text.as_bytes(), "t.mtl", "t.mtl");
        m
    }

    #[test]
    fn colours_and_exponents_are_read() {
        let m = read(
            "# paint\nnewmtl red paint\nNs 96.5\nKa 0 0 0\nKd 0.8 0.1 0.1\nKs 0.5\nillum 2\nd 1\n\
             newmtl matt\nKd .25\nKs 1 1 1\nillum 1\nnewmtl bare\nNs 0\n",
        );
        let get = |name| m.find(name).map(|i| m.material(i));
        let red = get("red paint").unwrap();
        assert_eq!((red.albedo, red.specular), ([0.8, 0.1, 0.1], [0.5; 3]));
        assert_eq!(red.shininess, 96.5);
        // Illumination model 1 has no highlights.
        assert_eq!(
            get("matt"),
            Some(Material {
                shininess: EXPONENT,
                ..Material::matt([0.25; 3])
            })
        );
        assert_eq!(get("bare"), Some(Material::matt(GREY)));
        assert_eq!(get("blue"), None);
        assert_eq!([m.bad.count, m.limited.count, m.maps.count], [0; 3]);
    }

    #[test]
    fn what_is_not_valid_is_named_with_its_line() {
        let m = read(
            "Kd 1 1 1\nnewmtl a\nKd 1 x 1\nKd 2 -1 0.5\nKs nan\nNs -3\nillum few\nnewmtl\nmap_Ks a.png\nmap_Kd a.png\n",
        );
        assert_eq!((m.bad.count, m.limited.count, m.maps.count), (7, 1, 1));
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
        assert_eq!(m.material(m.find("a").unwrap()).albedo, [1.0, 0.0, 0.5]);
    }

    #[test]
    fn names_may_have_comments_and_signs() {
        let m = read(
            "newmtl red # brick\nKd 1 0 0 # red\nnewmtl Material #1\nKd 0 1 0#\n\
             newmtl Material #2\nKd 0 0 1\nnewmtl #fff\nillum 1 # none\nnewmtl # nobody\n",
        );
        let albedo = |name| m.find(name).map(|i| m.material(i).albedo);
        for name in ["red", "red # body", "\"red\"", "red # brick"] {
            assert_eq!(albedo(name), Some([1.0, 0.0, 0.0]), "{name}");
        }
        assert_eq!(albedo("Material #1"), Some([0.0, 1.0, 0.0]));
        assert_eq!(albedo("Material #2"), Some([0.0, 0.0, 1.0]));
        assert_eq!(albedo("#fff"), Some(GREY));
        assert_eq!(albedo("red#2"), None);
        assert_eq!(m.bad.count, 1, "{}", m.bad.first);
    }

    #[test]
    fn marks_line_ends_and_strange_statements_do_not_lose_paint() {
        let m = read("\u{feff}newmtl a\rKd\t0.5\r\nbump b.png\r\nMap_Kd c.png\nKD 1 1 1\n");
        assert_eq!(m.material(m.find("a").unwrap()).albedo, [0.5; 3]);
        assert_eq!((m.maps.count, m.bad.count), (1, 1));
        let (map, library) = m.map(m.find("a").unwrap()).unwrap();
        assert_eq!((&map.names[0][..], &library[..]), ("c.png", "t.mtl"));
        assert!(
            m.bad.first.contains("t.mtl:5: 'KD 1 1 1'"),
            "{}",
            m.bad.first
        );
        let mut wide = Materials::default();
        wide.read(b"\xff\xfen\0", "w.mtl", "w.mtl");
        assert!(wide.bad.first.contains("w.mtl: the text is UTF-16"));
    }
}
