//! A technique with its settings as the value of a parameter.

/// A technique and the settings behind its name, not yet judged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Nested {
    /// Name of the technique.
    pub technique: String,
    /// Assignments `key=value`.
    pub settings: Vec<String>,
}

impl Nested {
    /// Parentheses keep colons of a technique within together: `A:first=(B:K=V):rest=C`. `None` where
    /// they do not match.
    pub fn parse(text: &str) -> Option<Self> {
        let mut parts = apart(text)?.into_iter();
        let settings = |part: String| match part.split_once('=') {
            Some((key, value)) => format!("{key}={}", without_parentheses(value)),
            None => part,
        };
        Some(Self {
            technique: parts.next()?,
            settings: parts.map(settings).collect(),
        })
    }
}

/// `text` cut at its colons outside parentheses; `None` where those do not match.
fn apart(text: &str) -> Option<Vec<String>> {
    let mut parts = vec![String::new()];
    let mut depth = 0usize;
    for c in text.chars() {
        match c {
            '(' => depth += 1,
            ')' => depth = depth.checked_sub(1)?,
            _ => {}
        }
        if c == ':' && depth == 0 {
            parts.push(String::new());
        } else {
            parts.last_mut()?.push(c);
        }
    }
    (depth == 0).then_some(parts)
}

fn without_parentheses(value: &str) -> &str {
    let inside = value.strip_prefix('(').and_then(|v| v.strip_suffix(')'));
    inside.unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parentheses_keep_settings_together() {
        let nested = Nested::parse("a:first=(b:k=1:l=(c:m=2)):rest=d").unwrap();
        assert_eq!(nested.technique, "a");
        assert_eq!(nested.settings, ["first=b:k=1:l=(c:m=2)", "rest=d"]);
        let inner = Nested::parse("b:k=1:l=(c:m=2)").unwrap();
        assert_eq!(inner.settings, ["k=1", "l=c:m=2"]);
        for wrong in ["a:first=(b", "a)", "a:b=)("] {
            assert!(Nested::parse(wrong).is_none(), "{wrong}");
        }
    }
}
