//! `map_Kd` lines: options, then the name of a picture.

use gnomon_raster::state::AddressMode;

use super::library::unquoted;
use super::lines::name_without_comment;

/// What a line says.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MapLine {
    /// The names that it may mean: first as written, then without comment and quotes, then
    /// the end of a path of another machine.
    pub(super) names: Vec<String>,
    /// Added to coordinates, after `scale`; v counted from below.
    pub(super) offset: [f64; 2],
    pub(super) scale: [f64; 2],
    /// Outside 0..=1.
    pub(super) address: AddressMode,
}

/// Options with as many words as they have at most; numbers alone make three.
const OPTIONS: [(&str, usize); 11] = [
    ("-blendu", 1),
    ("-blendv", 1),
    ("-bm", 1),
    ("-boost", 1),
    ("-cc", 1),
    ("-clamp", 1),
    ("-imfchan", 1),
    ("-mm", 2),
    ("-texres", 1),
    ("-type", 1),
    ("-o", 3),
];

/// Reads the rest of a line; `None` where it names nothing.
pub(super) fn read(line: &str) -> Option<MapLine> {
    let mut out = MapLine {
        names: Vec::new(),
        offset: [0.0; 2],
        scale: [1.0; 2],
        address: AddressMode::Repeat,
    };
    let mut rest = line.trim();
    while let Some((option, after)) = option(rest) {
        rest = out.take(option, after);
    }
    out.name(rest);
    (!out.names.is_empty()).then_some(out)
}

/// A known option at the beginning, and what follows.
fn option(text: &str) -> Option<(&str, &str)> {
    let (word, rest) = text.split_once(char::is_whitespace)?;
    let known = matches!(word, "-s" | "-t") || OPTIONS.iter().any(|(name, _)| *name == word);
    known.then(|| (word, rest.trim_start()))
}

impl MapLine {
    /// Uses an option, and returns what follows it.
    fn take<'a>(&mut self, option: &str, after: &'a str) -> &'a str {
        let (numbers, behind) = numbers(after);
        let filled = |usual: f64| [0, 1].map(|k| numbers.get(k).copied().unwrap_or(usual));
        match option {
            "-s" => self.scale = filled(1.0),
            "-o" => self.offset = filled(0.0),
            "-t" => {}
            _ => {
                let words = OPTIONS.iter().find(|(name, _)| *name == option);
                let (words, rest) = words_of(after, words.map_or(0, |(_, count)| *count));
                if option == "-clamp" && words.eq_ignore_ascii_case("on") {
                    self.address = AddressMode::ClampToEdge;
                }
                return rest;
            }
        }
        behind
    }

    fn name(&mut self, rest: &str) {
        let bare = name_without_comment(rest);
        let plain = unquoted(bare);
        let end = plain.rsplit(['/', '\\']).next().unwrap_or_default();
        for name in [rest, unquoted(rest), bare, plain, end] {
            if !name.is_empty() && !self.names.iter().any(|n| n == name) {
                self.names.push(name.to_owned());
            }
        }
    }
}

/// Up to three numbers at the beginning, and what follows; a name may begin with digits.
fn numbers(text: &str) -> (Vec<f64>, &str) {
    let (mut found, mut rest) = (Vec::new(), text);
    while found.len() < 3 {
        let Some((word, after)) = rest.split_once(char::is_whitespace) else {
            break;
        };
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => found.push(number),
            _ => break,
        }
        rest = after.trim_start();
    }
    (found, rest)
}

/// That many words, and what follows.
fn words_of(text: &str, count: usize) -> (&str, &str) {
    let mut rest = text;
    for _ in 0..count {
        rest = rest
            .split_once(char::is_whitespace)
            .map_or("", |(_, after)| after.trim_start());
    }
    (text[..text.len() - rest.len()].trim_end(), rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(line: &str) -> Vec<String> {
        read(line).unwrap().names
    }

    #[test]
    fn options_are_told_from_names() {
        let plain = read("wood.png").unwrap();
        assert_eq!(plain.names, ["wood.png"]);
        assert_eq!((plain.offset, plain.scale), ([0.0; 2], [1.0; 2]));
        assert_eq!(plain.address, AddressMode::Repeat);
        let all = "-s 2 3 1 -o 0.5 -clamp on -bm 0.2 -mm 0 1 -blendu off my wood.png";
        let all = read(all).unwrap();
        assert_eq!(all.names, ["my wood.png"]);
        assert_eq!((all.scale, all.offset), ([2.0, 3.0], [0.5, 0.0]));
        assert_eq!(all.address, AddressMode::ClampToEdge);
        assert_eq!(names("-s 2 2 2 1.png"), ["1.png"]);
        assert_eq!(names("-clamp off 7.png"), ["7.png"]);
        assert_eq!(names("-x.png"), ["-x.png"]);
        assert_eq!(read("  "), None);
        // Whatever comes last is the name.
        assert_eq!(names("-s 1 1 1 "), ["1"]);
    }

    #[test]
    fn names_may_be_quoted_commented_and_of_other_machines() {
        assert_eq!(names("\"a b.png\""), ["\"a b.png\"", "a b.png"]);
        assert_eq!(names("a.png # old"), ["a.png # old", "a.png"]);
        assert_eq!(names("C:\\x\\a.png"), ["C:\\x\\a.png", "a.png"]);
    }
}
