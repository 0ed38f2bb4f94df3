//! What else the machine does.

/// The load average of the last minute, where the system tells it.
pub(super) fn average() -> Option<f64> {
    parse(&std::fs::read_to_string("/proc/loadavg").ok()?)
}

fn parse(text: &str) -> Option<f64> {
    let first = text.split_whitespace().next()?;
    first.parse().ok().filter(|load: &f64| load.is_finite())
}

/// Processors.
pub(super) fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_number_is_the_last_minute() {
        assert_eq!(parse("2.52 2.01 1.99 3/812 4711\n"), Some(2.52));
        assert_eq!([parse(""), parse("busy"), parse("inf 1 1")], [None; 3]);
    }
}
