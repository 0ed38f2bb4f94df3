//! Numbers for people.

/// A count in at most five characters: `0`, `950`, `12.3k`, `4.56M`.
pub(crate) fn count(n: u64) -> String {
    scaled(n, &["", "k", "M", "G", "T", "P", "E"])
}

/// Bytes, decimal units: `950 B`, `12.3 kB`, `4.56 MB`.
pub(crate) fn bytes(n: u64) -> String {
    scaled(n, &[" B", " kB", " MB", " GB", " TB", " PB", " EB"])
}

/// Milliseconds: `0.12 ms`, `12.3 ms`, `1.23 s`.
pub(crate) fn milliseconds(ms: f64) -> String {
    match ms {
        _ if ms >= 9_999.5 => format!("{:.1} s", ms / 1e3),
        _ if ms >= 999.5 => format!("{:.2} s", ms / 1e3),
        _ if ms >= 99.5 => format!("{ms:.0} ms"),
        _ if ms >= 9.95 => format!("{ms:.1} ms"),
        _ => format!("{ms:.2} ms"),
    }
}

/// An error between -1 and 1 in at most six characters, and a sign where it is
/// below 0: `0`, `0.1234`, `0.0012`, `3.4e-5`.
pub(crate) fn error(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        0.001.. => format!("{value:.4}"),
        _ => format!("{value:.1e}"),
    }
}

/// `part` of `whole` in per cent; `-` of nothing, `<1%` of little.
pub(crate) fn percent(part: u64, whole: u64) -> String {
    if whole == 0 {
        return "-".to_owned();
    }
    let percent = 100.0 * part as f64 / whole as f64;
    if part > 0 && percent < 0.5 {
        return "<1%".to_owned();
    }
    format!("{percent:.0}%")
}

fn scaled(n: u64, units: &[&str]) -> String {
    let mut value = n as f64;
    let mut unit = 0;
    while value >= 999.5 && unit + 1 < units.len() {
        value /= 1e3;
        unit += 1;
    }
    let decimals = match value {
        _ if unit == 0 || value >= 99.95 => 0,
        _ if value >= 9.995 => 1,
        _ => 2,
    };
    format!("{value:.decimals$}{}", units[unit])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_three_digits() {
        let shown = [0, 999, 1000, 12_345, 99_960, 999_499, 999_500, 4_560_000].map(count);
        let expected = [
            "0", "999", "1.00k", "12.3k", "100k", "999k", "1.00M", "4.56M",
        ];
        assert_eq!(shown, expected);
        assert_eq!(bytes(1_500), "1.50 kB");
        assert_eq!(count(u64::MAX), "18.4E");
        assert_eq!(
            [0.5, 55.0, 123.4, 2345.0].map(milliseconds),
            ["0.50 ms", "55.0 ms", "123 ms", "2.35 s"].map(str::to_owned)
        );
        assert_eq!(
            [0.0, -0.25, 0.0012, 3.44e-5, -1.0].map(error),
            ["0", "-0.2500", "0.0012", "3.4e-5", "-1.0000"].map(str::to_owned)
        );
        assert_eq!(
            (percent(1, 3), percent(0, 0)),
            ("33%".to_owned(), "-".to_owned())
        );
    }
}
