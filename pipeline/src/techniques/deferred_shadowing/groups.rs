//! Occluders that share a map (§4.2.3).

use glam::DVec3;

use super::bodies::Body;
use super::settings::Groups;

/// Bodies that are projected together.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Group {
    /// Indices into the bodies, ascending.
    pub(super) bodies: Vec<usize>,
    pub(super) low: DVec3,
    pub(super) high: DVec3,
}

impl Group {
    fn of(body: usize, bodies: &[Body<'_>]) -> Self {
        Self {
            bodies: vec![body],
            low: bodies[body].low,
            high: bodies[body].high,
        }
    }

    /// The point that the occluder plane passes through.
    pub(super) fn centre(&self) -> DVec3 {
        (self.low + self.high) * 0.5
    }

    fn touches(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    fn join(&mut self, other: Self) {
        self.bodies.extend(other.bodies);
        self.bodies.sort_unstable();
        self.low = self.low.min(other.low);
        self.high = self.high.max(other.high);
    }
}

/// Groups of the bodies that can hide light from body `receiver`.
pub(super) fn groups(bodies: &[Body<'_>], receiver: usize, how: Groups) -> Vec<Group> {
    let others = (0..bodies.len()).filter(|&b| b != receiver && bodies[b].object.casts);
    let mut groups: Vec<Group> = Vec::new();
    for body in others {
        let mut group = Group::of(body, bodies);
        if how != Groups::Each {
            // Joining makes the box larger, and others may touch it then.
            while let Some(near) = groups
                .iter()
                .position(|g| how == Groups::All || g.touches(&group))
            {
                group.join(groups.remove(near));
            }
        }
        groups.push(group);
    }
    groups.sort_by(|a, b| a.bodies.cmp(&b.bodies));
    groups
}
