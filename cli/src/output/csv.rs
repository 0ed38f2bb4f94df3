//! Tables of values separated by commas (RFC 4180).

/// A cell, in quotation marks where it needs them.
pub(crate) fn cell(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

/// A line of cells that are quoted where they need it.
pub(crate) fn line(cells: impl Iterator<Item = String>) -> String {
    cells.map(|c| cell(&c)).collect::<Vec<_>>().join(",") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_with_commas_and_quotes_are_quoted() {
        let fields = ["a", "b,c", "say \"no\"", ""].map(str::to_owned);
        assert_eq!(line(fields.into_iter()), "a,\"b,c\",\"say \"\"no\"\"\",\n");
    }
}
