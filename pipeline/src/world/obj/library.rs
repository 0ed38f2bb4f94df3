//! Finding what `mtllib` names, and which material `usemtl` means.

use super::lines::name_without_comment;

/// The names that the rest of a `mtllib` line may mean: first what is tried, in
/// order, whether it is there, as `exists` knows. Names may contain blanks and the
/// sign of a comment, may be quoted, and may be several: so the whole line is
/// tried, then parts of it, longer ones first.
pub(super) fn names(rest: &str, mut exists: impl FnMut(&str) -> bool) -> Vec<String> {
    let bare = name_without_comment(rest);
    for whole in [rest, unquoted(rest), bare, unquoted(bare)] {
        if !whole.is_empty() && exists(whole) {
            return vec![whole.to_owned()];
        }
    }
    let words: Vec<&str> = words(bare);
    let mut names = Vec::new();
    let mut at = 0;
    while at < words.len() {
        let end = longest(&words, at, &mut exists);
        names.push(joined(&words[at..end]));
        at = end;
    }
    names
}

/// The end of the longest run of words from `at` that is the name of a file, or
/// else of the shortest that looks like one.
fn longest(words: &[&str], at: usize, exists: &mut impl FnMut(&str) -> bool) -> usize {
    /// Words of one name that are tried at most, so that no line tries for ever.
    const MOST: usize = 16;
    let ends = || at + 1..=words.len().min(at + MOST);
    let found = ends().rev().find(|&end| exists(&joined(&words[at..end])));
    let library = |end: &usize| words[*end - 1].to_ascii_lowercase().ends_with(".mtl");
    found.or_else(|| ends().find(library)).unwrap_or(at + 1)
}

fn joined(words: &[&str]) -> String {
    words.join(" ")
}

/// Words, quoted ones whole and without the quotes.
fn words(text: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let quoted = matches!(first, '"' | '\'');
        let inner = &rest[if quoted { 1 } else { 0 }..];
        let end = match quoted {
            true => inner.find(first),
            false => inner.find(char::is_whitespace),
        };
        let (word, after) = inner.split_at(end.unwrap_or(inner.len()));
        words.push(word.trim());
        let mut after = after.chars();
        after.next();
        rest = after.as_str().trim_start();
    }
    words.retain(|w| !w.is_empty());
    words
}

/// The name without the quotes round it.
pub(super) fn unquoted(name: &str) -> &str {
    let inner = |quote: char| name.strip_prefix(quote)?.strip_suffix(quote);
    inner('"').or(inner('\'')).map_or(name, str::trim)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(rest: &str, files: &[&str], expected: &[&str]) {
        assert_eq!(names(rest, |n| files.contains(&n)), expected, "{rest}");
    }

    #[test]
    fn a_name_may_have_blanks_quotes_and_comments() {
        check("a.mtl", &[], &["a.mtl"]);
        check("my paint.mtl", &["my paint.mtl"], &["my paint.mtl"]);
        check("my paint.mtl", &[], &["my paint.mtl"]);
        check("my paint.mtl # old", &["my paint.mtl"], &["my paint.mtl"]);
        check("\"my paint.mtl\"", &["my paint.mtl"], &["my paint.mtl"]);
        check("a #1.mtl", &["a #1.mtl"], &["a #1.mtl"]);
        check("a#1.mtl # x", &["a#1.mtl"], &["a#1.mtl"]);
        check("a.mtl # b.mtl", &["a.mtl", "b.mtl"], &["a.mtl"]);
        check("", &[], &[]);
        check("# none", &[], &[]);
    }

    #[test]
    fn a_line_may_have_several_names() {
        check("a.mtl b.mtl", &["a.mtl", "b.mtl"], &["a.mtl", "b.mtl"]);
        check(
            "a b.mtl c.mtl",
            &["a b.mtl", "c.mtl"],
            &["a b.mtl", "c.mtl"],
        );
        check("a b.mtl c d.mtl", &[], &["a b.mtl", "c d.mtl"]);
        check("'a b.mtl' \"c.mtl\"", &[], &["a b.mtl", "c.mtl"]);
        check("x\ty", &["y"], &["x", "y"]);
        check("\"open", &[], &["open"]);
    }
}
