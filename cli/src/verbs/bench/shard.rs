//! Part i of N of a plan.

/// Which part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shard {
    /// From 1.
    number: usize,
    /// How many there are.
    count: usize,
}

impl Shard {
    /// Whether cell number `index` of the plan is in it. Cells are dealt in turn, so
    /// that scenes, and slow techniques, are spread over all parts.
    pub(crate) fn takes(self, index: usize) -> bool {
        index % self.count == self.number - 1
    }
}

/// Parses `i/N`.
pub(crate) fn parse_shard(text: &str) -> Result<Shard, String> {
    let valid = "expected I/N, part I from 1 of N parts, such as 2/8";
    let (number, count) = text.split_once('/').ok_or(valid)?;
    let [number, count] = [number, count].map(|n| n.parse::<usize>().ok());
    match (number, count) {
        (Some(number), Some(count)) if (1..=count).contains(&number) => Ok(Shard { number, count }),
        _ => Err(valid.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For every N each cell is in one part, and parts differ by one cell at most.
    #[test]
    fn parts_are_disjoint_and_cover_everything() {
        for count in 1..=48 {
            let parts: Vec<Shard> = (1..=count)
                .map(|i| parse_shard(&format!("{i}/{count}")).unwrap())
                .collect();
            for cells in [0, 1, 2, 7, 48, 100] {
                let of = |p: &Shard| (0..cells).filter(|c| p.takes(*c)).count();
                let sizes: Vec<usize> = parts.iter().map(of).collect();
                assert_eq!(sizes.iter().sum::<usize>(), cells);
                let [least, most] = [sizes.iter().min(), sizes.iter().max()];
                assert!(most.unwrap() - least.unwrap() <= 1, "{sizes:?}");
            }
            for cell in 0..100 {
                assert_eq!(parts.iter().filter(|p| p.takes(cell)).count(), 1);
            }
        }
    }

    #[test]
    fn parts_that_are_none_are_refused() {
        for bad in [
            "", "1", "0/2", "3/2", "1/0", "-1/2", "a/b", "1/2/3", "1.5/2",
        ] {
            let message = parse_shard(bad).unwrap_err();
            assert!(message.contains("I/N"), "{bad}: {message}");
        }
    }
}
