//! The smallest part of a set that still has an effect.

/// The smallest part of `candidates`, in their order, for which `holds`, where it holds
/// for all of them and for whatever contains a part for which it holds. Where that is not
/// so, some part for which it holds, or all. Of n candidates k are found with about
/// k·log₂(n/k) + 2k questions (QuickXplain, Junker 2004).
pub(super) fn minimise<T: Copy + Ord, E>(
    candidates: &[T],
    mut holds: impl FnMut(&[T]) -> Result<bool, E>,
) -> Result<Vec<T>, E> {
    let mut found = explain(&mut Vec::new(), false, candidates, &mut holds)?;
    found.sort_unstable();
    if found.len() < candidates.len() && !holds(&found)? {
        return Ok(candidates.to_vec());
    }
    Ok(found)
}

fn explain<T: Copy + Ord, E>(
    given: &mut Vec<T>,
    is_new: bool,
    candidates: &[T],
    holds: &mut impl FnMut(&[T]) -> Result<bool, E>,
) -> Result<Vec<T>, E> {
    if is_new && holds(&sorted(given))? {
        return Ok(Vec::new());
    }
    if candidates.len() <= 1 {
        return Ok(candidates.to_vec());
    }
    let (first, second) = candidates.split_at(candidates.len() / 2);
    let of_second = with(given, first, |given| explain(given, true, second, holds))?;
    let is_new = !of_second.is_empty();
    let mut found = with(given, &of_second, |given| {
        explain(given, is_new, first, holds)
    })?;
    found.extend(of_second);
    Ok(found)
}

/// `act` while `more` is given too.
fn with<T: Copy, R>(given: &mut Vec<T>, more: &[T], act: impl FnOnce(&mut Vec<T>) -> R) -> R {
    let before = given.len();
    given.extend_from_slice(more);
    let result = act(given);
    given.truncate(before);
    result
}

fn sorted<T: Copy + Ord>(of: &[T]) -> Vec<T> {
    let mut sorted = of.to_vec();
    sorted.sort_unstable();
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search(n: usize, wanted: &[usize]) -> (Vec<usize>, usize) {
        let all: Vec<_> = (0..n).collect();
        let mut asked = 0;
        let found = minimise(&all, |part| {
            asked += 1;
            Ok::<_, ()>(wanted.iter().all(|w| part.contains(w)))
        });
        (found.unwrap(), asked)
    }

    #[test]
    fn one_of_many_is_found_in_logarithmic_time() {
        for n in [1, 2, 7, 64, 1000] {
            for wanted in [0, n / 3, n - 1] {
                let (found, asked) = search(n, &[wanted]);
                assert_eq!(found, [wanted]);
                assert!(asked <= 2 * n.ilog2() as usize + 4, "{n}: {asked}");
            }
        }
    }

    #[test]
    fn several_that_are_needed_together_are_found_together() {
        assert_eq!(search(40, &[3, 4, 39]).0, [3, 4, 39]);
        assert_eq!(search(3, &[0, 1, 2]).0, [0, 1, 2]);
    }

    /// Two that undo each other: no part is better than all.
    #[test]
    fn what_is_not_monotone_still_gives_something_that_holds() {
        let all: Vec<usize> = (0..8).collect();
        let odd = |part: &[usize]| Ok::<_, ()>(part.len() == 8 || part == [5]);
        let found = minimise(&all, odd).unwrap();
        assert!(found == [5] || found == all, "{found:?}");
    }
}
