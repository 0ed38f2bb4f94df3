//! Which maps a receiver needs under a light, and the turns in which an atlas makes
//! them.

use super::bodies::Body;
use super::groups::{Group, groups};
use super::placing::{PlacedMap, Receiver, place};
use super::settings::Settings;
use super::sources::Source;

/// Bodies that take shadow, with their occluders.
pub(super) struct Receivers<'b, 'a> {
    bodies: &'b [Body<'a>],
    all: Vec<(usize, Receiver<'b, 'a>, Vec<Group>)>,
}

/// The maps of one receiver under one light.
pub(super) struct Job {
    /// Index into the bodies.
    pub(super) body: usize,
    /// Number of the light.
    pub(super) light: usize,
    /// A place for each group of occluders, so that others keep theirs when a group
    /// begins or ceases to hide anything.
    pub(super) maps: Vec<Option<PlacedMap>>,
}

impl Job {
    /// Whether anything is hidden.
    pub(super) fn hides(&self) -> bool {
        self.maps.iter().any(Option::is_some)
    }

    /// Maps with their numbers.
    pub(super) fn placed(&self) -> impl Iterator<Item = (usize, &PlacedMap)> {
        let maps = self.maps.iter().enumerate();
        maps.filter_map(|(k, map)| Some((k, map.as_ref()?)))
    }
}

impl<'b, 'a> Receivers<'b, 'a> {
    pub(super) fn new(bodies: &'b [Body<'a>], settings: &Settings) -> Self {
        let receiving = (0..bodies.len()).filter(|&b| bodies[b].object.receives);
        let with_groups = |b: usize| {
            let groups = groups(bodies, b, settings.groups);
            (!groups.is_empty()).then(|| (b, Receiver::new(&bodies[b]), groups))
        };
        Self {
            bodies,
            all: receiving.filter_map(with_groups).collect(),
        }
    }

    /// Most maps of one light.
    pub(super) fn most_maps(&self) -> usize {
        self.all.iter().map(|(_, _, groups)| groups.len()).sum()
    }

    /// What each receiver needs under a light; nothing where `wanted` does not want it.
    pub(super) fn jobs(
        &self,
        light: usize,
        source: &Source,
        settings: &Settings,
        wanted: impl Fn(usize) -> bool,
    ) -> Vec<Job> {
        let how = (settings.plane, settings.side);
        let job = |(body, receiver, groups): &(usize, Receiver<'b, 'a>, Vec<Group>)| {
            let wanted = wanted(*body);
            let map = |group| match wanted {
                true => place(receiver, group, self.bodies, source, how),
                false => None,
            };
            Job {
                body: *body,
                light,
                maps: groups.iter().map(map).collect(),
            }
        };
        self.all.iter().map(job).collect()
    }
}

/// Jobs in turns of at most `capacity` maps; one that needs more by itself is cut off
/// there, and the number of maps left out counted.
pub(super) fn turns(jobs: Vec<Job>, capacity: usize) -> (Vec<Vec<Job>>, usize) {
    let (mut turns, mut left_out, mut used) = (Vec::<Vec<Job>>::new(), 0, capacity);
    for mut job in jobs {
        if job.maps.len() > capacity {
            job.maps.retain(Option::is_some);
            left_out += job.maps.len().saturating_sub(capacity);
            job.maps.truncate(capacity);
        }
        if used + job.maps.len() > capacity {
            turns.push(Vec::new());
            used = 0;
        }
        used += job.maps.len();
        if let Some(turn) = turns.last_mut() {
            turn.push(job);
        }
    }
    (turns, left_out)
}

/// Numbers about maps, summed over lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct MapCounts {
    pub(super) maps: usize,
    pub(super) across_plane: usize,
    pub(super) left_out: usize,
}

impl MapCounts {
    pub(super) fn add(&mut self, jobs: &[Job]) {
        let maps = || jobs.iter().flat_map(|j| j.maps.iter().flatten());
        self.maps += maps().count();
        self.across_plane += maps().filter(|m| m.across_plane).count();
    }
}
