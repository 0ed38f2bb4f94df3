//! Typed parameters: what a technique declares, and how it reads them.

use std::marker::PhantomData;

use super::condition::Condition;
use super::domain::{Decimals, Domain, Value, Whole};
use super::nested::Nested;
use crate::world::light_image::LightSequence;

/// A parameter without its type: what lists, help and sweeps need to know.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParamInfo {
    /// Name on the command line.
    pub name: &'static str,
    /// Value where none is given.
    pub default: Value,
    /// Values that it takes.
    pub domain: Domain,
    /// Unit of its numbers, where they have one.
    pub unit: Option<&'static str>,
    /// One line for people.
    pub summary: &'static str,
    /// When it has an effect.
    pub applies: Condition,
}

/// A closed set of values with names; [`choices!`](crate::choices) writes it for an
/// enum.
pub trait Choice: Copy + 'static {
    /// Names, in the order of [`Self::ALL`].
    const NAMES: &'static [&'static str];
    /// All values.
    const ALL: &'static [Self];
}

/// An enum whose variants are the values of a parameter, with their names:
///
/// ```
/// gnomon_pipeline::choices! {
///     /// How depths are filtered.
///     pub enum Kernel {
///         /// A mean.
///         Box = "box",
///         /// A spline.
///         Bicubic = "bicubic",
///     }
/// }
/// assert_eq!(Kernel::Bicubic.word(), "bicubic");
/// ```
#[macro_export]
macro_rules! choices {
    ($(#[$meta:meta])* $vis:vis enum $name:ident {
        $($(#[$variant_meta:meta])* $variant:ident = $word:literal),+ $(,)?
    }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        $vis enum $name {
            $($(#[$variant_meta])* $variant),+
        }

        impl $crate::technique::Choice for $name {
            const NAMES: &'static [&'static str] = &[$($word),+];
            const ALL: &'static [Self] = &[$(Self::$variant),+];
        }

        impl $name {
            /// Its name on the command line.
            $vis const fn word(self) -> &'static str {
                <Self as $crate::technique::Choice>::NAMES[self as usize]
            }
        }
    };
}

/// What parameters are read as.
pub trait Setting: Sized {
    /// The value that `text`, which the parameter's domain takes, means; `None` for
    /// texts beyond it.
    fn read(text: &str) -> Option<Self>;
}

impl<T: Choice> Setting for T {
    fn read(text: &str) -> Option<Self> {
        let at = T::NAMES.iter().position(|name| *name == text)?;
        T::ALL.get(at).copied()
    }
}

impl Setting for bool {
    fn read(text: &str) -> Option<Self> {
        match text {
            "on" => Some(true),
            "off" => Some(false),
            _ => None,
        }
    }
}

/// Numbers that parameters are read as.
pub trait Number: std::str::FromStr {}

impl Number for u32 {}
impl Number for u64 {}
impl Number for usize {}
impl Number for f64 {}

macro_rules! numbers_are_settings {
    ($($number:ty),+) => {
        $(impl Setting for $number {
            fn read(text: &str) -> Option<Self> {
                text.parse().ok()
            }
        })+
    };
}

numbers_are_settings!(u32, u64, usize, f64);

/// A number, or `None` for a name.
impl<T: Number> Setting for Option<T> {
    fn read(text: &str) -> Option<Self> {
        Some(text.parse().ok())
    }
}

/// Numbers, or `None` for a name.
impl Setting for Option<Vec<usize>> {
    fn read(text: &str) -> Option<Self> {
        Some(text.split('+').map(|n| n.parse().ok()).collect())
    }
}

impl Setting for Nested {
    fn read(text: &str) -> Option<Self> {
        Self::parse(text)
    }
}

/// A parameter whose values are read as `T`.
pub struct Param<T> {
    /// What is declared.
    pub info: ParamInfo,
    of: PhantomData<fn() -> T>,
}

impl<T> Clone for Param<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Param<T> {}

impl<T> Param<T> {
    const fn new(
        name: &'static str,
        default: Value,
        domain: Domain,
        summary: &'static str,
    ) -> Self {
        Self {
            info: ParamInfo {
                name,
                default,
                domain,
                unit: None,
                summary,
                applies: Condition::Always,
            },
            of: PhantomData,
        }
    }

    /// The same with another default.
    pub const fn with_default(mut self, default: Value) -> Self {
        self.info.default = default;
        self
    }

    /// The same with another summary.
    pub const fn with_summary(mut self, summary: &'static str) -> Self {
        self.info.summary = summary;
        self
    }

    /// Numbers of `unit`.
    pub const fn unit(mut self, unit: &'static str) -> Self {
        self.info.unit = Some(unit);
        self
    }

    /// Without effect elsewhere.
    pub const fn when(mut self, applies: Condition) -> Self {
        self.info.applies = applies;
        self
    }
}

impl<T: Choice> Param<T> {
    /// One of the names of `T`; `default` is one of them.
    pub const fn choice(name: &'static str, default: &'static str, summary: &'static str) -> Self {
        Self::new(name, Value::Word(default), Domain::Words(T::NAMES), summary)
    }
}

impl Param<bool> {
    /// `on` or `off`.
    pub const fn switch(name: &'static str, on: bool, summary: &'static str) -> Self {
        let default = Value::Word(if on { "on" } else { "off" });
        Self::new(name, default, Domain::Words(&["on", "off"]), summary)
    }
}

impl<T: Number> Param<T> {
    /// Whole numbers of an inclusive range.
    pub const fn whole(
        name: &'static str,
        default: u64,
        range: [u64; 2],
        summary: &'static str,
    ) -> Self {
        Self::of_kind(name, default, range, Whole::Any, summary)
    }

    /// Powers of two of an inclusive range.
    pub const fn power_of_two(
        name: &'static str,
        default: u64,
        range: [u64; 2],
        summary: &'static str,
    ) -> Self {
        Self::of_kind(name, default, range, Whole::PowerOfTwo, summary)
    }

    /// Square numbers of an inclusive range.
    pub const fn square(
        name: &'static str,
        default: u64,
        range: [u64; 2],
        summary: &'static str,
    ) -> Self {
        Self::of_kind(name, default, range, Whole::Square, summary)
    }

    const fn of_kind(
        name: &'static str,
        default: u64,
        range: [u64; 2],
        kind: Whole,
        summary: &'static str,
    ) -> Self {
        let domain = Domain::Whole {
            words: &[],
            range,
            kind,
        };
        Self::new(name, Value::Whole(default), domain, summary)
    }
}

impl Param<f64> {
    /// Decimal numbers from `low`.
    pub const fn decimal(
        name: &'static str,
        default: f64,
        low: f64,
        summary: &'static str,
    ) -> Self {
        Self::decimals(
            name,
            default,
            Decimals {
                low,
                with_low: true,
            },
            summary,
        )
    }

    /// Decimal numbers above `low`.
    pub const fn decimal_above(
        name: &'static str,
        default: f64,
        low: f64,
        summary: &'static str,
    ) -> Self {
        let numbers = Decimals {
            low,
            with_low: false,
        };
        Self::decimals(name, default, numbers, summary)
    }

    const fn decimals(
        name: &'static str,
        default: f64,
        numbers: Decimals,
        summary: &'static str,
    ) -> Self {
        let domain = Domain::Decimal {
            words: &[],
            numbers,
        };
        Self::new(name, Value::Decimal(default), domain, summary)
    }
}

impl Param<Option<f64>> {
    /// Decimal numbers, or the first of `words`, the default, which is read as `None`.
    pub const fn decimal_or(
        words: &'static [&'static str],
        name: &'static str,
        numbers: Decimals,
        summary: &'static str,
    ) -> Self {
        let domain = Domain::Decimal { words, numbers };
        Self::new(name, Value::Word(words[0]), domain, summary)
    }
}

impl<T: Number> Param<Option<T>> {
    /// Whole numbers, or the first of `words`, the default, which is read as `None`.
    pub const fn whole_or(
        words: &'static [&'static str],
        name: &'static str,
        range: [u64; 2],
        kind: Whole,
        summary: &'static str,
    ) -> Self {
        let domain = Domain::Whole { words, range, kind };
        Self::new(name, Value::Word(words[0]), domain, summary)
    }
}

impl Param<Option<Vec<usize>>> {
    /// Numbers with `+` between them, or the first of `words`, the default, which is
    /// read as `None`.
    pub const fn list_or(
        words: &'static [&'static str],
        name: &'static str,
        summary: &'static str,
    ) -> Self {
        let domain = Domain::List { words };
        Self::new(name, Value::Word(words[0]), domain, summary)
    }
}

impl Param<LightSequence> {
    /// Files of images with commas between them, or one of `words`, of which the first
    /// is the default; read by [`Params::images`](super::Params::images).
    pub const fn images(
        words: &'static [&'static str],
        name: &'static str,
        summary: &'static str,
    ) -> Self {
        Self::new(
            name,
            Value::Word(words[0]),
            Domain::Images { words },
            summary,
        )
    }
}

impl Param<Nested> {
    /// A technique with its settings.
    pub const fn technique(
        name: &'static str,
        default: &'static str,
        summary: &'static str,
    ) -> Self {
        Self::new(name, Value::Word(default), Domain::Technique, summary)
    }
}

/// Number of parameters of all `lists`; for [`param_list!`](crate::param_list).
pub const fn count(lists: &[&[ParamInfo]]) -> usize {
    let (mut k, mut all) = (0, 0);
    while k < lists.len() {
        all += lists[k].len();
        k += 1;
    }
    all
}

/// `lists` one after the other, `N` in all and not none; for
/// [`param_list!`](crate::param_list).
pub const fn join<const N: usize>(lists: &[&[ParamInfo]]) -> [ParamInfo; N] {
    let mut all = [lists[0][0]; N];
    let (mut list, mut at) = (0, 0);
    while list < lists.len() {
        let mut k = 0;
        while k < lists[list].len() {
            all[at] = lists[list][k];
            (k, at) = (k + 1, at + 1);
        }
        list += 1;
    }
    all
}

/// Lists of [`ParamInfo`] as one `&'static` list: a technique's own parameters, and
/// those that several techniques share.
#[macro_export]
macro_rules! param_list {
    ($($list:expr),+ $(,)?) => {{
        const LISTS: &[&[$crate::technique::ParamInfo]] = &[$($list),+];
        const ALL: [$crate::technique::ParamInfo; $crate::technique::count(LISTS)] =
            $crate::technique::join(LISTS);
        &ALL
    }};
}
