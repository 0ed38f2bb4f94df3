//! Corners of a face that add nothing to it.

/// Removes corners that repeat the one before them, and ways there and back
/// again (`a b a`), which enclose nothing; what is left has no such place, also
/// across its end. Returns how many were removed. Edges of the outline that
/// remain are those that were not walked both ways at once, so that a closed
/// solid stays closed.
pub(super) fn drop_repeated(corners: &mut Vec<u32>) -> usize {
    let before = corners.len();
    let mut kept: Vec<u32> = Vec::with_capacity(before);
    for &corner in corners.iter() {
        push(&mut kept, corner);
    }
    // The end meets the beginning.
    let mut start = 0;
    while kept.len() - start > 1 {
        let (first, last) = (kept[start], kept[kept.len() - 1]);
        if first == last {
            kept.pop();
        } else if kept.len() - start > 2 && kept[kept.len() - 2] == first {
            kept.truncate(kept.len() - 2);
        } else if kept.len() - start > 2 && kept[start + 1] == last {
            start += 2;
        } else {
            break;
        }
    }
    kept.drain(..start);
    *corners = kept;
    before - corners.len()
}

fn push(kept: &mut Vec<u32>, corner: u32) {
    if let [.., back, _] = kept[..]
        && back == corner
    {
        kept.pop();
    } else if kept.last() != Some(&corner) {
        kept.push(corner);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(corners: &[u32], expected: &[u32]) {
        let mut kept = corners.to_vec();
        assert_eq!(drop_repeated(&mut kept), corners.len() - expected.len());
        assert_eq!(kept, expected, "{corners:?}");
    }

    #[test]
    fn what_encloses_nothing_goes() {
        check(&[1, 2, 3], &[1, 2, 3]);
        check(&[5, 8, 7, 7], &[5, 8, 7]);
        check(&[5, 5, 8, 8, 7, 5], &[5, 8, 7]);
        check(&[1, 2, 3, 2], &[1, 2]);
        check(&[1, 2, 3, 9, 3, 4], &[1, 2, 3, 4]);
        check(&[1, 9, 1, 2, 3], &[1, 2, 3]);
        check(&[1, 2, 3, 4, 3, 2], &[1, 2]);
        check(&[2, 3, 1, 3], &[2, 3]);
        check(&[3, 1, 2, 4, 1], &[2, 4, 1]);
        check(&[7, 7, 7], &[7]);
        check(&[], &[]);
    }

    #[test]
    fn bridges_to_holes_stay() {
        check(&[1, 2, 3, 4, 1, 5, 6, 7, 5], &[1, 2, 3, 4, 1, 5, 6, 7, 5]);
    }
}
