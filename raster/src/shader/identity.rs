//! Which shader a stage runs: a name, a version, and the uniforms as bytes.
//!
//! A stage made with [`VertexStage::named`] or [`FragmentStage::named`] can say what
//! it is, and a [`super::ShaderTable`] makes it again from that. Nothing is encoded
//! until somebody asks. Stages from closures, or by `into()`, have no identity.
//!
//! ```
//! use gnomon_raster::shader::{Fragment, FragmentShader, FragmentStage, Named, ShaderTable};
//! use gnomon_raster::{F32, Lanes, uniforms};
//!
//! struct Grey {
//!     level: f32,
//! }
//!
//! impl FragmentShader for Grey {
//!     #[inline(always)]
//!     fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
//!         f.set_color(0, [F32::splat(l, self.level); 4]);
//!     }
//! }
//! uniforms!(Grey { level });
//! impl Named for Grey {
//!     const NAME: &'static str = "grey";
//!     const VERSION: u32 = 1;
//! }
//!
//! let identity = FragmentStage::named(Grey { level: 0.5 }).identity().unwrap();
//! assert_eq!((identity.name.as_str(), identity.version), ("grey", 1));
//! assert_eq!(identity.uniforms, 0.5f32.to_le_bytes());
//!
//! let mut table = ShaderTable::default();
//! table.add_fragment::<Grey>()?;
//! let again = table.fragment(&identity)?;
//! assert_eq!(again.identity(), Some(identity));
//! # Ok::<(), gnomon_raster::shader::ShaderTableError>(())
//! ```

use std::sync::Arc;

use super::erased::{ErasedFragmentShader, ErasedVertexShader, NamedShader};
use super::{FragmentShader, FragmentStage, VertexShader, VertexStage};

/// A shader's name, and the version of what it computes.
pub trait Named {
    /// Unique among the shaders of a [`super::ShaderTable`], such as `surface.phong`.
    const NAME: &'static str;
    /// To be raised whenever equal uniforms may give other results than before.
    const VERSION: u32;
}

/// What a stage is.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ShaderIdentity {
    /// [`Named::NAME`].
    pub name: String,
    /// [`Named::VERSION`].
    pub version: u32,
    /// The shader's struct, as [`Uniforms`] writes it.
    pub uniforms: Vec<u8>,
}

impl ShaderIdentity {
    pub(super) fn of<S: Named + Uniforms>(shader: &S) -> Self {
        let mut uniforms = UniformWriter::default();
        shader.put(&mut uniforms);
        Self {
            name: S::NAME.to_owned(),
            version: S::VERSION,
            uniforms: uniforms.into_bytes(),
        }
    }
}

impl VertexStage {
    /// A shader that can say what it is.
    #[must_use]
    pub fn named<V: VertexShader + Uniforms + Named + 'static>(shader: V) -> Self {
        Self(Arc::new(NamedShader(shader)))
    }

    /// What it is; `None` for closures and shaders that were not [named](Self::named).
    #[must_use]
    pub fn identity(&self) -> Option<ShaderIdentity> {
        ErasedVertexShader::identity(&*self.0)
    }
}

impl FragmentStage {
    /// A shader that can say what it is.
    #[must_use]
    pub fn named<F: FragmentShader + Uniforms + Named + 'static>(shader: F) -> Self {
        Self(Arc::new(NamedShader(shader)))
    }

    /// What it is; `None` for closures and shaders that were not [named](Self::named).
    #[must_use]
    pub fn identity(&self) -> Option<ShaderIdentity> {
        ErasedFragmentShader::identity(&*self.0)
    }
}

/// A value that can be written as bytes and read again, to the bit. Given for numbers,
/// `bool`, arrays, pairs, lists and options; [`crate::uniforms`] gives it to structs
/// and enums of such.
pub trait Uniforms: Sized {
    /// Writes the value.
    fn put(&self, to: &mut UniformWriter);

    /// Reads a value that [`Uniforms::put`] wrote.
    ///
    /// # Errors
    /// Too few bytes, or bytes that mean nothing.
    fn take(from: &mut UniformReader<'_>) -> Result<Self, UniformError>;
}

/// Where uniforms are written to.
#[derive(Clone, Debug, Default)]
pub struct UniformWriter(Vec<u8>);

impl UniformWriter {
    /// Appends bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.0.extend_from_slice(bytes);
    }

    /// All that was written.
    #[must_use]
    pub fn into_bytes(self) -> Vec<u8> {
        self.0
    }
}

/// Where uniforms are read from.
#[derive(Clone, Debug)]
pub struct UniformReader<'a> {
    all: &'a [u8],
    at: usize,
}

impl<'a> UniformReader<'a> {
    /// A reader at the first of `bytes`.
    #[must_use]
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { all: bytes, at: 0 }
    }

    /// The next `N` bytes.
    ///
    /// # Errors
    /// There are not as many.
    pub fn bytes<const N: usize>(&mut self) -> Result<[u8; N], UniformError> {
        let left = &self.all[self.at..];
        let Some(bytes) = left.first_chunk() else {
            return Err(UniformError::Missing {
                at: self.at,
                wanted: N,
                left: left.len(),
            });
        };
        self.at += N;
        Ok(*bytes)
    }

    /// The error for a value, `wide` bytes just read, that means nothing.
    #[must_use]
    pub fn invalid(
        &self,
        wide: usize,
        what: &'static str,
        given: u64,
        valid: impl Into<String>,
    ) -> UniformError {
        UniformError::Invalid {
            at: self.at.saturating_sub(wide),
            what,
            given,
            valid: valid.into(),
        }
    }

    /// How many bytes are left.
    #[must_use]
    pub fn left(&self) -> usize {
        self.all.len() - self.at
    }

    /// Whether all bytes were read.
    ///
    /// # Errors
    /// There are some left.
    pub fn finish(&self) -> Result<(), UniformError> {
        match self.left() {
            0 => Ok(()),
            left => Err(UniformError::LeftOver { at: self.at, left }),
        }
    }
}

/// Why bytes are not the uniforms of a shader.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum UniformError {
    /// They end too early.
    #[error("{wanted} bytes are wanted at byte {at}, {left} are left")]
    Missing {
        /// Where the value starts.
        at: usize,
        /// Bytes of the value.
        wanted: usize,
        /// Bytes that are there.
        left: usize,
    },
    /// They go on behind the last uniform.
    #[error("the uniforms end at byte {at}, {left} bytes are left over")]
    LeftOver {
        /// Where the uniforms end.
        at: usize,
        /// Bytes behind that.
        left: usize,
    },
    /// No value is written so.
    #[error("{what} at byte {at} is {given}; valid is {valid}")]
    Invalid {
        /// Where it is.
        at: usize,
        /// What it should be.
        what: &'static str,
        /// What is there.
        given: u64,
        /// What could be there.
        valid: String,
    },
}

macro_rules! numbers {
    ($($number:ty),+) => { $(
        impl Uniforms for $number {
            fn put(&self, to: &mut UniformWriter) {
                to.bytes(&self.to_le_bytes());
            }

            fn take(from: &mut UniformReader<'_>) -> Result<Self, UniformError> {
                from.bytes().map(Self::from_le_bytes)
            }
        }
    )+ };
}
numbers!(u8, u32, i32, u64);

impl Uniforms for f32 {
    fn put(&self, to: &mut UniformWriter) {
        self.to_bits().put(to);
    }

    fn take(from: &mut UniformReader<'_>) -> Result<Self, UniformError> {
        u32::take(from).map(Self::from_bits)
    }
}

/// As a `u64`.
impl Uniforms for usize {
    fn put(&self, to: &mut UniformWriter) {
        (*self as u64).put(to);
    }

    fn take(from: &mut UniformReader<'_>) -> Result<Self, UniformError> {
        let given = u64::take(from)?;
        let fits = Self::try_from(given);
        fits.map_err(|_| from.invalid(8, "a size", given, format!("at most {}", Self::MAX)))
    }
}

impl Uniforms for bool {
    fn put(&self, to: &mut UniformWriter) {
        u8::from(*self).put(to);
    }

    fn take(from: &mut UniformReader<'_>) -> Result<Self, UniformError> {
        match u8::take(from)? {
            0 => Ok(false),
            1 => Ok(true),
            given => Err(from.invalid(1, "a bool", given.into(), "0 or 1")),
        }
    }
}

impl<T: Uniforms, const N: usize> Uniforms for [T; N] {
    fn put(&self, to: &mut UniformWriter) {
        self.iter().for_each(|v| v.put(to));
    }

    fn take(from: &mut UniformReader<'_>) -> Result<Self, UniformError> {
        let all: Vec<T> = (0..N).map(|_| T::take(from)).collect::<Result<_, _>>()?;
        Ok(all
            .try_into()
            .unwrap_or_else(|_| unreachable!("N were read")))
    }
}

impl<A: Uniforms, B: Uniforms> Uniforms for (A, B) {
    fn put(&self, to: &mut UniformWriter) {
        self.0.put(to);
        self.1.put(to);
    }

    fn take(from: &mut UniformReader<'_>) -> Result<Self, UniformError> {
        Ok((A::take(from)?, B::take(from)?))
    }
}

fn put_list<T: Uniforms>(list: &[T], to: &mut UniformWriter) {
    list.len().put(to);
    list.iter().for_each(|v| v.put(to));
}

/// A list whose elements take at least a byte each.
fn take_list<T: Uniforms>(from: &mut UniformReader<'_>) -> Result<Vec<T>, UniformError> {
    let count = usize::take(from)?;
    let most = from.left();
    if count > most {
        return Err(from.invalid(8, "a length", count as u64, format!("at most {most} here")));
    }
    (0..count).map(|_| T::take(from)).collect()
}

impl<T: Uniforms> Uniforms for Vec<T> {
    fn put(&self, to: &mut UniformWriter) {
        put_list(self, to);
    }

    fn take(from: &mut UniformReader<'_>) -> Result<Self, UniformError> {
        take_list(from)
    }
}

impl<T: Uniforms> Uniforms for Arc<[T]> {
    fn put(&self, to: &mut UniformWriter) {
        put_list(self, to);
    }

    fn take(from: &mut UniformReader<'_>) -> Result<Self, UniformError> {
        take_list(from).map(Into::into)
    }
}

impl<T: Uniforms> Uniforms for Option<T> {
    fn put(&self, to: &mut UniformWriter) {
        self.is_some().put(to);
        if let Some(value) = self {
            value.put(to);
        }
    }

    fn take(from: &mut UniformReader<'_>) -> Result<Self, UniformError> {
        match bool::take(from)? {
            true => T::take(from).map(Some),
            false => Ok(None),
        }
    }
}

/// Makes a struct or an enum [`Uniforms`](crate::shader::Uniforms): its fields in the
/// order given, an enum's behind a byte with the variant's number. A field or variant
/// that is forgotten does not compile. Numbers of variants stay what they are; new
/// variants get new ones.
///
/// ```
/// use gnomon_raster::uniforms;
///
/// struct Flat;
/// struct Level(f32);
/// struct Tinted<S> { surface: S, tint: [f32; 3] }
/// enum To { Visibility, Share(f32) }
///
/// uniforms!(Flat);
/// uniforms!(Level(level));
/// uniforms!(Tinted<S> { surface, tint });
/// uniforms!(enum To { 0: Visibility, 1: Share(share) });
/// ```
#[macro_export]
macro_rules! uniforms {
    (enum $name:ident { $($number:literal: $variant:ident $(($($field:ident),+))?),+ $(,)? }) => {
        impl $crate::shader::Uniforms for $name {
            fn put(&self, to: &mut $crate::shader::UniformWriter) {
                match self {
                    $(Self::$variant $(($($field),+))? => {
                        to.bytes(&[$number]);
                        $($($crate::shader::Uniforms::put($field, to);)+)?
                    })+
                }
            }

            fn take(
                from: &mut $crate::shader::UniformReader<'_>,
            ) -> ::core::result::Result<Self, $crate::shader::UniformError> {
                let [number] = from.bytes()?;
                match number {
                    $($number => {
                        $($(let $field = $crate::shader::Uniforms::take(from)?;)+)?
                        ::core::result::Result::Ok(Self::$variant $(($($field),+))?)
                    })+
                    other => ::core::result::Result::Err(from.invalid(
                        1,
                        ::core::stringify!($name),
                        ::core::convert::From::from(other),
                        ::core::concat!($(
                            ::core::stringify!($number), " (", ::core::stringify!($variant), ") "
                        ),+).trim_end(),
                    )),
                }
            }
        }
    };
    ($name:ident $(<$parameter:ident>)? { $($field:ident),+ $(,)? }) => {
        impl$(<$parameter: $crate::shader::Uniforms>)? $crate::shader::Uniforms
            for $name$(<$parameter>)?
        {
            fn put(&self, to: &mut $crate::shader::UniformWriter) {
                let Self { $($field),+ } = self;
                $($crate::shader::Uniforms::put($field, to);)+
            }

            fn take(
                from: &mut $crate::shader::UniformReader<'_>,
            ) -> ::core::result::Result<Self, $crate::shader::UniformError> {
                $(let $field = $crate::shader::Uniforms::take(from)?;)+
                ::core::result::Result::Ok(Self { $($field),+ })
            }
        }
    };
    ($name:ident ($($field:ident),+)) => {
        impl $crate::shader::Uniforms for $name {
            fn put(&self, to: &mut $crate::shader::UniformWriter) {
                let Self($($field),+) = self;
                $($crate::shader::Uniforms::put($field, to);)+
            }

            fn take(
                from: &mut $crate::shader::UniformReader<'_>,
            ) -> ::core::result::Result<Self, $crate::shader::UniformError> {
                $(let $field = $crate::shader::Uniforms::take(from)?;)+
                ::core::result::Result::Ok(Self($($field),+))
            }
        }
    };
    ($name:ident) => {
        impl $crate::shader::Uniforms for $name {
            fn put(&self, _: &mut $crate::shader::UniformWriter) {}

            fn take(
                _: &mut $crate::shader::UniformReader<'_>,
            ) -> ::core::result::Result<Self, $crate::shader::UniformError> {
                ::core::result::Result::Ok(Self)
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Clone, Debug, PartialEq)]
    enum To {
        Visibility,
        Share(f32),
        Both([u32; 2], bool),
    }
    uniforms!(enum To { 0: Visibility, 7: Share(share), 2: Both(size, on) });

    #[derive(Clone, Debug, PartialEq)]
    struct All<S> {
        surface: S,
        list: Vec<(f32, i32)>,
        shared: Arc<[u64]>,
        maybe: Option<usize>,
    }
    uniforms!(All<S> { surface, list, shared, maybe });

    fn bytes(of: &impl Uniforms) -> Vec<u8> {
        let mut to = UniformWriter::default();
        of.put(&mut to);
        to.into_bytes()
    }

    fn read<T: Uniforms>(bytes: &[u8]) -> Result<T, UniformError> {
        let mut from = UniformReader::new(bytes);
        let value = T::take(&mut from)?;
        from.finish()?;
        Ok(value)
    }

    fn all(surface: To) -> All<To> {
        All {
            surface,
            list: vec![(-0.0, -1), (1.5, i32::MAX)],
            shared: vec![u64::MAX, 0].into(),
            maybe: Some(3),
        }
    }

    #[test]
    fn values_are_read_as_they_were_written() {
        let shared = [To::Visibility, To::Share(0.1), To::Both([1, 2], true)];
        for value in shared.map(all) {
            assert_eq!(read(&bytes(&value)), Ok(value));
        }
        let nan = f32::from_bits(0xffc1_2345);
        let again: f32 = read(&bytes(&nan)).unwrap();
        assert_eq!(again.to_bits(), nan.to_bits());
        assert_eq!(bytes(&To::Share(1.0)), [7, 0, 0, 128, 63]);
    }

    /// Whatever is cut off or added is an error that says where.
    #[test]
    fn bytes_that_are_not_the_uniforms_are_refused() {
        let whole = bytes(&all(To::Both([1, 2], true)));
        for end in 0..whole.len() {
            let cut: Result<All<To>, _> = read(&whole[..end]);
            assert!(cut.is_err(), "{end} bytes are enough");
        }
        let more = [&whole[..], &[0, 0]].concat();
        let error = read::<All<To>>(&more).unwrap_err();
        let at = whole.len();
        assert_eq!(error, UniformError::LeftOver { at, left: 2 });
        let message = |bytes: &[u8]| read::<To>(bytes).unwrap_err().to_string();
        assert_eq!(
            message(&[5]),
            "To at byte 0 is 5; valid is 0 (Visibility) 7 (Share) 2 (Both)"
        );
        assert_eq!(message(&[7, 1]), "4 bytes are wanted at byte 1, 1 are left");
        assert!(message(&[2, 0, 0, 0, 0, 0, 0, 0, 0, 2]).contains("bool at byte 9 is 2"));
        let huge = read::<Vec<f32>>(&bytes(&u64::MAX)).unwrap_err();
        assert!(huge.to_string().contains("at most"), "{huge}");
    }
}
