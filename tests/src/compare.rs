//! The first difference between two outcomes, in words.

use crate::twin::Outcome;

/// Where `gpu` first differs from `twin`; `None` if nowhere.
#[must_use]
pub fn difference(twin: &Outcome, gpu: &Outcome, width: u32) -> Option<String> {
    counters(twin, gpu).or_else(|| attachments(twin, gpu, width))
}

/// As [`difference`], for attachments alone.
#[must_use]
pub fn attachments(twin: &Outcome, gpu: &Outcome, width: u32) -> Option<String> {
    for (i, (a, b)) in twin.color.iter().zip(&gpu.color).enumerate() {
        if let Some(d) = first(&format!("colour image {i}"), a, b, width) {
            return Some(d);
        }
    }
    first("depth", &twin.depth, &gpu.depth, width)
        .or_else(|| first("stencil", &twin.stencil, &gpu.stencil, width))
}

/// The first differing counter of the first differing draw, and how many differ.
fn counters(twin: &Outcome, gpu: &Outcome) -> Option<String> {
    for (p, (a, b)) in twin.passes.iter().zip(&gpu.passes).enumerate() {
        if let Some(d) = lines(&format!("pass {p}, clear"), &a.clear, &b.clear) {
            return Some(d);
        }
        for (k, (a, b)) in a.draws.iter().zip(&b.draws).enumerate() {
            if let Some(d) = lines(&format!("pass {p}, draw {k}"), a, b) {
                return Some(d);
            }
        }
        if a.draws.len() != b.draws.len() {
            return Some(format!(
                "pass {p}: twin reports {} draws, GPU {}",
                a.draws.len(),
                b.draws.len()
            ));
        }
    }
    (twin.passes.len() != gpu.passes.len()).then(|| {
        format!(
            "twin reports {} passes, GPU {}",
            twin.passes.len(),
            gpu.passes.len()
        )
    })
}

/// Differing fields of two values with the same printed structure.
fn lines<T: std::fmt::Debug + PartialEq>(what: &str, a: &T, b: &T) -> Option<String> {
    if a == b {
        return None;
    }
    let (a, b) = (format!("{a:#?}"), format!("{b:#?}"));
    let mut path: Vec<(usize, String)> = Vec::new();
    let mut found = Vec::new();
    for (l, r) in a.lines().zip(b.lines()) {
        let indent = l.len() - l.trim_start().len();
        path.retain(|(i, _)| *i < indent);
        if l != r {
            let names: Vec<_> = path.iter().map(|(_, n)| n.as_str()).collect();
            found.push(format!(
                "{} {}: GPU {}",
                names.join("."),
                l.trim(),
                r.trim()
            ));
        }
        path.push((
            indent,
            l.trim()
                .split(&[':', ' ', '('][..])
                .next()
                .unwrap_or("")
                .to_owned(),
        ));
    }
    Some(format!("{what}: twin {}", found.join("; ")))
}

fn first<T: std::fmt::Debug + PartialEq>(
    what: &str,
    a: &[T],
    b: &[T],
    width: u32,
) -> Option<String> {
    if a.len() != b.len() {
        return Some(format!(
            "{what}: twin has {} pixels, GPU {}",
            a.len(),
            b.len()
        ));
    }
    let i = (0..a.len()).find(|&i| a[i] != b[i])?;
    let n = (0..a.len()).filter(|&i| a[i] != b[i]).count();
    let (x, y) = (i % width as usize, i / width as usize);
    Some(format!(
        "{what}, pixel ({x}, {y}): twin {:x?}, GPU {:x?} ({n} pixels differ)",
        a[i], b[i]
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twin::{EventDetails, PassOutcome};
    use gnomon_raster::{ClientTraffic, Counters};

    fn outcome() -> Outcome {
        let pass = PassOutcome {
            draws: vec![Counters::default()],
            clear: ClientTraffic::default(),
            events: Vec::new(),
            details: EventDetails::default(),
        };
        Outcome {
            color: vec![vec![[1, 2, 3, 4]; 6]],
            depth: Vec::new(),
            stencil: Vec::new(),
            passes: vec![pass],
        }
    }

    #[test]
    fn the_first_difference_is_named() {
        let (a, mut b) = (outcome(), outcome());
        assert_eq!(difference(&a, &b, 3), None);
        b.color[0][4][2] = 9;
        let d = difference(&a, &b, 3).unwrap();
        assert!(
            d.starts_with("colour image 0, pixel (1, 1): twin [1, 2, 3, 4], GPU [1, 2, 9, 4]"),
            "{d}"
        );
        b.passes[0].draws[0].traffic.z.read_bytes = 3;
        let d = difference(&a, &b, 3).unwrap();
        assert!(
            d.contains("draw 0") && d.contains("traffic.z read_bytes: 0,: GPU read_bytes: 3,"),
            "{d}"
        );
    }
}
