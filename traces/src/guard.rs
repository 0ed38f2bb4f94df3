//! Shaders that a file's uniforms make panic.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::error::TraceError;

/// What `run` gives, which draws frame number `frame` of a file. Uniforms in a file may be
/// anything, and a shader that they make panic is an error of the file.
///
/// # Errors
/// [`TraceError::Stopped`] with the panic's words.
pub fn guarded<T>(frame: usize, run: impl FnOnce() -> T) -> Result<T, TraceError> {
    catch_unwind(AssertUnwindSafe(run)).map_err(|panic| TraceError::Stopped {
        frame,
        message: words(panic.as_ref()),
    })
}

fn words(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "no message".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_an_error_with_its_words() {
        assert_eq!(guarded(0, || 7).unwrap(), 7);
        let number = 3;
        let plain: Result<(), _> = guarded(2, || panic!("plain"));
        let numbered: Result<(), _> = guarded(2, || panic!("number {number}"));
        for (stopped, words) in [(plain, "plain"), (numbered, "number 3")] {
            let error = stopped.unwrap_err().to_string();
            assert!(
                error.contains(words) && error.contains("frame 2"),
                "{error}"
            );
        }
    }
}
