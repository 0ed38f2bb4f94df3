//! Numbers for people.

/// A count in at most five characters: `0`, `950`, `12.3k`, `4.56M`.
pub(crate) fn count(n: u64) -> String {
    scaled(n, &["", "k", "M", "G", "T", "P", "E"])
}

/// A count in at most four characters, two digits of it: `950`, `12k`, `4.6M`.
pub(crate) fn rough_count(n: u64) -> String {
    rounded(n, &["", "k", "M", "G", "T", "P", "E"], 2)
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
    rounded(n, units, 3)
}

/// `n` in the unit that leaves at most three digits before the point, with as many
/// behind it as make `digits`.
fn rounded(n: u64, units: &[&str], digits: usize) -> String {
    let mut value = n as f64;
    let mut unit = 0;
    while value >= 999.5 && unit + 1 < units.len() {
        value /= 1e3;
        unit += 1;
    }
    let whole = match value {
        _ if value >= 99.95 => 3,
        _ if value >= 9.995 => 2,
        _ => 1,
    };
    let decimals = if unit == 0 {
        0
    } else {
        digits.saturating_sub(whole)
    };
    format!("{value:.decimals$}{}", units[unit])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rough_numbers_keep_two_digits() {
        let shown = [950, 1000, 12_345, 99_960, 999_500, 4_560_000].map(rough_count);
        assert_eq!(shown, ["950", "1.0k", "12k", "100k", "1.0M", "4.6M"]);
    }

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
