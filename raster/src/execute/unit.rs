//! A pass as runs of primitives: units, jobs and batches, and what vertices cost.

use std::borrow::Cow;

use super::prepare::Prepared;
use crate::command::{Draw, Referenced};
use crate::counters::{Counters, Traffic};
use crate::error::Error;
use crate::memory::collected;

/// Vertices of one instance of a draw.
pub(super) struct Unit<'a> {
    pub(super) draw: usize,
    pub(super) instance: u32,
    /// Vertex numbers and, with indices, positions among them.
    pub(super) referenced: Cow<'a, Referenced>,
    pub(super) primitives: u32,
    /// Number of the first primitive in the draw.
    pub(super) first_primitive: u32,
}

/// A run of primitives of a unit.
#[derive(Clone, Copy)]
pub(super) struct Job {
    pub(super) unit: usize,
    pub(super) first: u32,
    pub(super) primitives: u32,
}

/// Units of all draws, in submission order.
pub(super) fn units<'a>(prepared: &[Prepared<'a>]) -> Result<Vec<Unit<'a>>, Error> {
    let mut units = Vec::new();
    for (number, p) in prepared.iter().enumerate() {
        let d = p.draw;
        let primitives = d.count / d.pipeline.primitive.topology.vertices();
        if primitives == 0 {
            continue;
        }
        for instance in 0..d.instances {
            units.push(Unit {
                draw: number,
                instance,
                referenced: referenced(d, primitives)?,
                primitives,
                first_primitive: instance * primitives,
            });
        }
    }
    Ok(units)
}

/// Chunks of all units, in batches of `size` primitives; at least one batch, for the load
/// operations.
pub(super) fn batches(units: &[Unit<'_>], chunk: u32, size: u32) -> Vec<Vec<Job>> {
    let mut batches = vec![Vec::new()];
    let mut room = size;
    for (u, unit) in units.iter().enumerate() {
        for first in (0..unit.primitives).step_by(chunk as usize) {
            let primitives = chunk.min(unit.primitives - first);
            if room < primitives {
                batches.push(Vec::new());
                room = size;
            }
            room -= primitives;
            batches.last_mut().expect("never empty").push(Job {
                unit: u,
                first,
                primitives,
            });
        }
    }
    batches
}

fn referenced(d: &Draw, primitives: u32) -> Result<Cow<'_, Referenced>, Error> {
    let used = (primitives * d.pipeline.primitive.topology.vertices()) as usize;
    let first = d.first as usize;
    let numbers = || format!("draw `{}`: its list of {used} vertices", d.label);
    Ok(match &d.indices {
        None => Cow::Owned(Referenced {
            vertices: collected(d.first..d.first + used as u32, used, numbers)?,
            local: Vec::new(),
        }),
        Some(b) if first == 0 && used == b.indices().len() => Cow::Borrowed(b.referenced()),
        Some(b) => Cow::Owned(Referenced::of(&b.indices()[first..first + used])),
    })
}

/// Vertex and index traffic of draw number `number` (rules §8).
pub(super) fn vertex_traffic(d: &Draw, units: &[Unit<'_>], number: usize) -> Counters {
    let mut c = Counters::default();
    // Units are in the order of draws; a pass may have thousands.
    let first = units.partition_point(|u| u.draw < number);
    let mine = || units[first..].iter().take_while(|u| u.draw == number);
    let invocations: u64 = mine().map(|u| u.referenced.vertices.len() as u64).sum();
    c.primitives.vertex_shader_invocations = invocations;
    let read = |accesses: u64, bytes: u64| Traffic {
        read_accesses: accesses,
        read_bytes: accesses * bytes,
        ..Traffic::default()
    };
    if let Some(v) = &d.vertices {
        c.traffic.vertex = read(invocations, 4 * v.stride as u64);
    }
    if d.indices.is_some() {
        let per = u64::from(d.pipeline.primitive.topology.vertices());
        c.traffic.index = read(mine().map(|u| u64::from(u.primitives) * per).sum(), 4);
    }
    c
}
