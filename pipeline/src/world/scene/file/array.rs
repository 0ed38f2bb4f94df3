//! Arrays of an exact length: serde's own take the first elements and say nothing
//! of the others.

use std::fmt;
use std::marker::PhantomData;
use std::ops::Deref;

use serde::de::{Deserialize, Deserializer, Error, IgnoredAny, SeqAccess, Visitor};

/// `N` values, no more and no fewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Array<T, const N: usize>(pub(super) [T; N]);

impl<T, const N: usize> Deref for Array<T, N> {
    type Target = [T; N];

    fn deref(&self) -> &[T; N] {
        &self.0
    }
}

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for Array<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(Elements(PhantomData))
    }
}

struct Elements<T, const N: usize>(PhantomData<T>);

impl<'de, T: Deserialize<'de>, const N: usize> Visitor<'de> for Elements<T, N> {
    type Value = Array<T, N>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "an array of {N} numbers")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Array<T, N>, A::Error> {
        let mut elements = Vec::with_capacity(N);
        while elements.len() < N
            && let Some(next) = seq.next_element()?
        {
            elements.push(next);
        }
        let mut length = elements.len();
        while seq.next_element::<IgnoredAny>()?.is_some() {
            length += 1;
        }
        match elements.try_into() {
            Ok(array) if length == N => Ok(Array(array)),
            _ => Err(A::Error::invalid_length(length, &self)),
        }
    }
}
