//! Which passes and draws of two frames are the same ones: the longest common
//! subsequence of their labels.

/// An item of one list, of the other, or of both.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pair {
    /// In both, at these places.
    Both(usize, usize),
    /// In the first only.
    First(usize),
    /// In the second only.
    Second(usize),
}

/// Pairs the items of `a` and `b` that are equal, in order, as many as possible. What is
/// left over stands where it stood; of neighbours those of `a` come first.
pub(super) fn align<T: PartialEq>(a: &[T], b: &[T]) -> Vec<Pair> {
    let start = a.iter().zip(b).take_while(|(x, y)| x == y).count();
    let (rest_a, rest_b) = (&a[start..], &b[start..]);
    let ends = rest_a.iter().rev().zip(rest_b.iter().rev());
    let end = ends.take_while(|(x, y)| x == y).count();
    let mut pairs: Vec<Pair> = (0..start).map(|i| Pair::Both(i, i)).collect();
    let middle = (&rest_a[..rest_a.len() - end], &rest_b[..rest_b.len() - end]);
    pairs.extend(
        longest(middle.0, middle.1)
            .into_iter()
            .map(|p| p.moved(start)),
    );
    let tail = (0..end).rev();
    pairs.extend(tail.map(|k| Pair::Both(a.len() - 1 - k, b.len() - 1 - k)));
    pairs
}

impl Pair {
    fn moved(self, by: usize) -> Self {
        match self {
            Self::Both(i, j) => Self::Both(i + by, j + by),
            Self::First(i) => Self::First(i + by),
            Self::Second(j) => Self::Second(j + by),
        }
    }
}

/// The pairs of what has no common beginning and end.
fn longest<T: PartialEq>(a: &[T], b: &[T]) -> Vec<Pair> {
    let lengths = common_lengths(a, b);
    let at = |i: usize, j: usize| lengths[i * (b.len() + 1) + j];
    let (mut i, mut j) = (0, 0);
    let mut pairs = Vec::new();
    while i < a.len() || j < b.len() {
        if i < a.len() && j < b.len() && a[i] == b[j] {
            pairs.push(Pair::Both(i, j));
            (i, j) = (i + 1, j + 1);
        } else if i < a.len() && (j == b.len() || at(i + 1, j) >= at(i, j + 1)) {
            pairs.push(Pair::First(i));
            i += 1;
        } else {
            pairs.push(Pair::Second(j));
            j += 1;
        }
    }
    pairs
}

/// Length of the longest common subsequence of `a[i..]` and `b[j..]`, by i and j.
fn common_lengths<T: PartialEq>(a: &[T], b: &[T]) -> Vec<u32> {
    let across = b.len() + 1;
    let mut lengths = vec![0; (a.len() + 1) * across];
    for i in (0..a.len()).rev() {
        for j in (0..b.len()).rev() {
            lengths[i * across + j] = if a[i] == b[j] {
                lengths[(i + 1) * across + j + 1] + 1
            } else {
                lengths[(i + 1) * across + j].max(lengths[i * across + j + 1])
            };
        }
    }
    lengths
}

#[cfg(test)]
mod tests {
    use super::Pair::{Both, First, Second};
    use super::*;

    #[test]
    fn equal_items_are_paired_and_the_rest_keeps_its_place() {
        assert_eq!(align(b"abc", b"abc"), [Both(0, 0), Both(1, 1), Both(2, 2)]);
        assert_eq!(
            align(b"abc", b"axc"),
            [Both(0, 0), First(1), Second(1), Both(2, 2)]
        );
        assert_eq!(align(b"ac", b"abc"), [Both(0, 0), Second(1), Both(1, 2)]);
        assert_eq!(align(b"aab", b"ab"), [Both(0, 0), First(1), Both(2, 1)]);
        assert_eq!(align(b"", b"a"), [Second(0)]);
        assert_eq!(align::<u8>(b"", b""), []);
    }

    /// As many pairs as a search over all subsequences finds, each item once, in order.
    #[test]
    fn no_alignment_has_more_pairs() {
        let word = |n: u32| -> Vec<u32> { (0..6).map(|k| n / 3u32.pow(k) % 3).collect() };
        for n in (0..729).step_by(13) {
            for m in (0..729).step_by(17) {
                let (a, b) = (word(n), word(m));
                let pairs = align(&a, &b);
                let count = pairs.iter().filter(|p| matches!(p, Both(..))).count();
                let most = (0..64u32).filter_map(|set| {
                    let chosen: Vec<_> =
                        (0..6).filter(|k| set >> k & 1 != 0).map(|k| a[k]).collect();
                    let mut rest = b.iter();
                    chosen
                        .iter()
                        .all(|x| rest.any(|y| y == x))
                        .then_some(chosen.len())
                });
                assert_eq!(count, most.max().unwrap(), "{a:?} {b:?}");
                let firsts = pairs.iter().filter_map(|p| match *p {
                    Both(i, _) | First(i) => Some(i),
                    Second(_) => None,
                });
                assert_eq!(firsts.collect::<Vec<_>>(), (0..6).collect::<Vec<_>>());
                let seconds = pairs.iter().filter_map(|p| match *p {
                    Both(_, j) | Second(j) => Some(j),
                    First(_) => None,
                });
                assert_eq!(seconds.collect::<Vec<_>>(), (0..6).collect::<Vec<_>>());
            }
        }
    }
}
