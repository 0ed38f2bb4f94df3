//! Which values a parameter takes.

use std::fmt::{self, Display, Formatter};

use super::nested::Nested;

/// A value as declared: a default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A name of a choice.
    Word(&'static str),
    /// A whole number.
    Whole(u64),
    /// A decimal number.
    Decimal(f64),
}

impl Display for Value {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Word(word) => f.write_str(word),
            Self::Whole(number) => number.fmt(f),
            Self::Decimal(number) => number.fmt(f),
        }
    }
}

/// Which whole numbers of a range are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Whole {
    /// All.
    Any,
    /// 1, 2, 4, 8, ...
    PowerOfTwo,
    /// 1, 4, 9, 16, ...
    Square,
}

/// Decimal numbers up to infinity, which is not one of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decimals {
    /// Smallest number.
    pub low: f64,
    /// Whether `low` itself is taken.
    pub with_low: bool,
}

/// The values that a parameter takes. Ranges are inclusive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// One of these names.
    Words(&'static [&'static str]),
    /// One of these names, or a whole number.
    Whole {
        /// Names besides the numbers.
        words: &'static [&'static str],
        /// Smallest and largest number.
        range: [u64; 2],
        /// Which numbers of the range.
        kind: Whole,
    },
    /// One of these names, or a decimal number.
    Decimal {
        /// Names besides the numbers.
        words: &'static [&'static str],
        /// Which numbers.
        numbers: Decimals,
    },
    /// One of these names, or whole numbers from 0 with `+` between them.
    List {
        /// Names besides the lists.
        words: &'static [&'static str],
    },
    /// One of these names, or files of images with commas between them, which are read
    /// when the value is given.
    Images {
        /// Names besides the files.
        words: &'static [&'static str],
    },
    /// A technique with settings behind colons, which it judges itself:
    /// `NAME:KEY=VALUE:...`.
    Technique,
}

impl Domain {
    /// Names that are taken, besides numbers.
    pub fn words(&self) -> &'static [&'static str] {
        match *self {
            Self::Words(words)
            | Self::Whole { words, .. }
            | Self::Decimal { words, .. }
            | Self::List { words }
            | Self::Images { words } => words,
            Self::Technique => &[],
        }
    }

    /// Whether `text` is one of the values.
    pub fn takes(&self, text: &str) -> bool {
        if self.words().contains(&text) {
            return true;
        }
        match *self {
            Self::Words(_) => false,
            Self::Whole { range, kind, .. } => {
                text.parse().is_ok_and(|n| takes_whole(n, range, kind))
            }
            Self::Decimal { numbers, .. } => text.parse().is_ok_and(|x| takes_decimal(x, numbers)),
            Self::List { .. } => text.split('+').all(|n| n.parse::<u32>().is_ok()),
            Self::Images { .. } => text.split(',').all(|name| !name.is_empty()),
            Self::Technique => Nested::parse(text).is_some_and(|n| !n.technique.is_empty()),
        }
    }

    /// Whether two values of the domain mean the same.
    pub fn same(&self, a: &str, b: &str) -> bool {
        let equal_numbers =
            || matches!((a.parse::<f64>(), b.parse::<f64>()), (Ok(a), Ok(b)) if a == b);
        a == b || equal_numbers()
    }
}

fn takes_whole(n: u64, [first, last]: [u64; 2], kind: Whole) -> bool {
    let of_kind = match kind {
        Whole::Any => true,
        Whole::PowerOfTwo => n.is_power_of_two(),
        Whole::Square => n.isqrt() * n.isqrt() == n,
    };
    of_kind && (first..=last).contains(&n)
}

fn takes_decimal(x: f64, numbers: Decimals) -> bool {
    x.is_finite() && (x > numbers.low || (numbers.with_low && x == numbers.low))
}

/// What is valid, for people: `auto, or a number above 0`.
impl Display for Domain {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let words = self.words().join("|");
        let numbers = match *self {
            Self::Words(_) => return f.write_str(&words),
            Self::Whole { range, kind, .. } => whole_numbers(range, kind),
            Self::Decimal { numbers, .. } => decimal_numbers(numbers),
            Self::List { .. } => "whole numbers from 0 with + between them, such as 0+3".to_owned(),
            Self::Images { .. } => "image files with commas between them".to_owned(),
            Self::Technique => {
                "a technique: NAME:KEY=VALUE:..., in parentheses where VALUE is one with settings"
                    .to_owned()
            }
        };
        match &words[..] {
            "" => f.write_str(&numbers),
            words => write!(f, "{words}, or {numbers}"),
        }
    }
}

fn whole_numbers([first, last]: [u64; 2], kind: Whole) -> String {
    let range = match last {
        last if last >= u64::from(u32::MAX) => format!("from {first}"),
        last => format!("{first} to {last}"),
    };
    match kind {
        Whole::Any => format!("a whole number {range}"),
        Whole::PowerOfTwo => format!("a power of two, {range}"),
        Whole::Square => format!("square numbers {range}: 1, 4, 9, 16, 25, ..."),
    }
}

fn decimal_numbers(numbers: Decimals) -> String {
    let from = if numbers.with_low { "from" } else { "above" };
    format!("a number {from} {}", numbers.low)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TAPS: Domain = Domain::Whole {
        words: &[],
        range: [1, 64],
        kind: Whole::Any,
    };

    #[test]
    fn ranges_are_inclusive_and_said() {
        assert!(["1", "64"].iter().all(|n| TAPS.takes(n)));
        assert!(
            ["0", "65", "-1", "", "1.5", "box"]
                .iter()
                .all(|n| !TAPS.takes(n))
        );
        assert_eq!(TAPS.to_string(), "a whole number 1 to 64");
        let near = Domain::Decimal {
            words: &["auto"],
            numbers: Decimals {
                low: 0.0,
                with_low: false,
            },
        };
        assert!(near.takes("auto") && near.takes("1e-3"));
        assert!(["0", "-1", "inf", "NaN", ""].iter().all(|x| !near.takes(x)));
        assert_eq!(near.to_string(), "auto, or a number above 0");
    }

    #[test]
    fn squares_powers_and_lists() {
        let of = |kind| Domain::Whole {
            words: &[],
            range: [1, 1024],
            kind,
        };
        let squares = of(Whole::Square);
        assert!(squares.takes("1024") && squares.takes("9") && !squares.takes("8"));
        let powers = of(Whole::PowerOfTwo);
        assert!(powers.takes("8") && !powers.takes("9") && !powers.takes("2048"));
        let list = Domain::List {
            words: &["brightest"],
        };
        assert!(list.takes("0+3") && list.takes("brightest"));
        assert!(!list.takes("0+") && !list.takes("0+a"));
    }

    #[test]
    fn numbers_are_the_same_however_written() {
        assert!(TAPS.same("4", "04") && TAPS.same("0", "0.0") && !TAPS.same("4", "5"));
    }
}
