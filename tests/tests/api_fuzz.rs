//! No use of the raster API makes it panic, however wrong: everything is done
//! or refused by a typed error.
//!
//! `GNOMON_FUZZ_SEED` and `GNOMON_FUZZ_CASES` choose the seeds.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

use gnomon_raster::Error;
use gnomon_tests::parallel;
use gnomon_tests::random::{Random, misuse};

fn setting(name: &str, default: u64) -> u64 {
    let text = std::env::var(name).ok();
    text.map_or(default, |t| {
        t.parse()
            .unwrap_or_else(|_| panic!("{name} is `{t}`; a number is needed"))
    })
}

/// The results of a seed, or what it panicked with.
fn tried(seed: u64) -> Result<Vec<Result<u64, Error>>, String> {
    catch_unwind(AssertUnwindSafe(|| misuse(Random::new(seed ^ 0xbad_c0de)))).map_err(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string))
            .unwrap_or_default()
    })
}

fn name(r: &Result<u64, Error>) -> String {
    match r {
        Ok(0) => "Ok".to_owned(),
        Ok(_) => "Drawn".to_owned(),
        Err(e) => {
            assert!(!e.to_string().is_empty());
            let text = format!("{e:?}");
            text.split([' ', '{']).next().unwrap_or_default().to_owned()
        }
    }
}

#[test]
fn nothing_panics() {
    let first = setting("GNOMON_FUZZ_SEED", 0);
    let cases = setting("GNOMON_FUZZ_CASES", 4000);
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let results = parallel::map(first..first + cases, |seed| (seed, tried(seed)));
    std::panic::set_hook(hook);
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    let mut panics = Vec::new();
    for (seed, result) in results {
        match result {
            Ok(all) => all
                .iter()
                .for_each(|r| *counts.entry(name(r)).or_default() += 1),
            Err(message) => panics.push(format!("seed {seed}: {message}")),
        }
    }
    println!("{counts:?}");
    assert!(
        panics.is_empty(),
        "{} of {cases} seeds panic:\n{}",
        panics.len(),
        panics[..panics.len().min(10)].join("\n")
    );
    // It must be fuzz, and not refuse everything for the same reason.
    let total: usize = counts.values().sum();
    if cases >= 4000 {
        assert!(counts.len() >= 18, "{counts:?}");
        assert!(
            counts["Ok"] > total / 5 && counts["Drawn"] > 300,
            "{counts:?}"
        );
    }
}
