//! Memory whose size the user decides: asked for, so that a shortage is an error and
//! not the end of the process.

use crate::error::Error;

/// Room for `n` more values in `v`. `what` names it in the error.
///
/// # Errors
/// Where the system does not give it.
pub fn reserve<T>(v: &mut Vec<T>, n: usize, what: impl FnOnce() -> String) -> Result<(), Error> {
    v.try_reserve_exact(n).map_err(|_| Error::OutOfMemory {
        what: what(),
        bytes: n as u64 * size_of::<T>() as u64,
    })
}

/// `n` times `value`.
///
/// # Errors
/// As [`reserve`].
pub fn filled<T: Clone>(
    value: T,
    n: usize,
    what: impl FnOnce() -> String,
) -> Result<Vec<T>, Error> {
    let mut v = Vec::new();
    reserve(&mut v, n, what)?;
    v.resize(n, value);
    Ok(v)
}

/// The `n` values of `values`.
///
/// # Errors
/// As [`reserve`].
pub fn collected<T>(
    values: impl Iterator<Item = T>,
    n: usize,
    what: impl FnOnce() -> String,
) -> Result<Vec<T>, Error> {
    let mut v = Vec::new();
    reserve(&mut v, n, what)?;
    v.extend(values);
    Ok(v)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shortage_is_an_error_with_name_and_bytes() {
        let what = || "everything".to_owned();
        let n = 1 << 58;
        let short = Error::OutOfMemory {
            what: what(),
            bytes: 1 << 60,
        };
        assert_eq!(filled(0u32, n, what), Err(short.clone()));
        assert_eq!(collected(0..n as u32, n, what), Err(short.clone()));
        let text = "everything takes 1152921504606846976 bytes, which the system does not give";
        assert_eq!(short.to_string(), text);
        assert_eq!(filled(7, 3, what), Ok(vec![7; 3]));
        assert_eq!(collected(1..4, 3, what), Ok(vec![1, 2, 3]));
    }
}
