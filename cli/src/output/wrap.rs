//! Text in lines of 80 columns.

/// Columns of a terminal that is not told otherwise.
pub(crate) const WIDTH: usize = 80;

/// `first` and then the words of `text`, in lines of at most 80 columns; lines
/// after the first begin with `indent` spaces.
pub(crate) fn hanging(first: &str, indent: usize, text: &str) -> String {
    let mut out = String::new();
    let mut line = first.to_owned();
    let mut is_fresh = true;
    for word in text.split_whitespace() {
        let space = usize::from(!is_fresh);
        if !is_fresh && line.chars().count() + space + word.chars().count() > WIDTH {
            out += &line;
            out.push('\n');
            line = " ".repeat(indent);
            is_fresh = true;
        }
        if !is_fresh {
            line.push(' ');
        }
        line += word;
        is_fresh = false;
    }
    out + line.trim_end() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_filled_and_no_longer() {
        let text = "word ".repeat(40);
        let wrapped = hanging("name  ", 6, &text);
        let lines: Vec<&str> = wrapped.lines().collect();
        assert_eq!(lines.len(), 3);
        assert_eq!(lines[0], format!("name  {}", "word ".repeat(15).trim_end()));
        assert!(lines[1].starts_with("      word") && lines.iter().all(|l| l.len() <= WIDTH));
        assert_eq!(wrapped.matches("word").count(), 40);
        assert_eq!(hanging("a  ", 3, ""), "a\n");
    }
}
