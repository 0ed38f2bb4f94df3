//! The order of events: by triangle, block row and block column, whichever worker has
//! taken them down.

use crate::tile::Turn;

/// Finds the order of a run's events.
#[derive(Default)]
pub(super) struct Order {
    /// Where the events of each triangle begin, then where they end.
    ends: Vec<u32>,
    /// Place in the upper half, number in the lower, triangle by triangle.
    events: Vec<u64>,
    order: Vec<u32>,
}

impl Order {
    /// Numbers of the events that have these `turns`, first to last: a counting sort by
    /// triangle, of which there are about as many as events, then each triangle's few.
    pub(super) fn of(&mut self, turns: &[Turn]) -> &[u32] {
        let mut triangles = 0;
        for turn in turns {
            triangles = triangles.max(turn.triangle as usize + 1);
        }
        self.count(turns, triangles);
        self.events.clear();
        self.events.resize(turns.len(), 0);
        for (number, turn) in turns.iter().enumerate() {
            let end = &mut self.ends[turn.triangle as usize];
            self.events[*end as usize] = u64::from(turn.place) << 32 | number as u64;
            *end += 1;
        }
        let mut start = 0;
        for &end in &self.ends {
            let own = &mut self.events[start..end as usize];
            if own.len() > 1 {
                own.sort_unstable();
            }
            start = end as usize;
        }
        self.order.clear();
        self.order.reserve(self.events.len());
        for &event in &self.events {
            self.order.push(event as u32);
        }
        &self.order
    }

    /// Where each triangle's events begin.
    fn count(&mut self, turns: &[Turn], triangles: usize) {
        self.ends.clear();
        self.ends.resize(triangles, 0);
        for turn in turns {
            self.ends[turn.triangle as usize] += 1;
        }
        let mut sum = 0;
        for end in &mut self.ends {
            (*end, sum) = (sum, sum + *end);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_are_ordered_by_triangle_then_place() {
        let turn = |triangle, row: u32, column| Turn {
            triangle,
            place: row << 16 | column,
        };
        let turns = [
            turn(5, 0, 0),
            turn(2, 7, 1),
            turn(2, 1, 7),
            turn(0, 3, 3),
            turn(2, 1, 6),
            turn(5, 0, 1),
        ];
        let mut order = Order::default();
        assert_eq!(order.of(&turns), [3, 4, 2, 1, 0, 5]);
        // Memory of one run leaves nothing in the next.
        assert_eq!(order.of(&turns[1..3]), [1, 0]);
        assert_eq!(order.of(&[]), [0; 0]);
    }
}
