//! The threads that oracles share; those of the emulated GPU are its own.

use std::error::Error as _;

use gnomon_raster::MAX_THREADS;
use rayon::ThreadPoolBuilder;

use crate::error::CliError;

/// The variable by which people choose the number of threads.
const VARIABLE: &str = "RAYON_NUM_THREADS";

/// Starts the threads, as many as the environment asks for, or one per core. Without
/// this the first user of them would, without a limit, and panic where it fails.
pub(crate) fn start() -> Result<(), CliError> {
    check(&std::env::var(VARIABLE).unwrap_or_default())?;
    match ThreadPoolBuilder::new().build_global() {
        // Somebody who calls us has threads already.
        Err(error) if error.source().is_some() => Err(error.into()),
        _ => Ok(()),
    }
}

/// Refuses more threads than the GPU takes. What is no number is not looked at by
/// rayon either.
fn check(value: &str) -> Result<(), CliError> {
    match value.trim().parse::<u128>() {
        Ok(threads) if threads > MAX_THREADS as u128 => Err(CliError::Variable {
            name: VARIABLE,
            value: value.to_owned(),
            valid: format!("expected at most {MAX_THREADS}, or 0 for one thread per core"),
        }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_beyond_the_limit_are_refused_with_it() {
        for fine in ["", "0", "4", "1024", "many", "-1"] {
            assert!(check(fine).is_ok(), "{fine}");
        }
        for wrong in ["1025", "100000", "99999999999999999999"] {
            let message = check(wrong).unwrap_err().to_string();
            for part in [VARIABLE, wrong, "1024"] {
                assert!(message.contains(part), "{message}");
            }
        }
    }

    /// The threads are there already, started by this test or another.
    #[test]
    fn starting_twice_is_no_error() {
        assert!(start().is_ok() && start().is_ok());
    }
}
