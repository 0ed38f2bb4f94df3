//! Motion of a scene file's objects: rates and keyframes.

use glam::DVec3;

use super::SceneFileError;
use super::check::Source;
use super::schema::{KeyTable, MotionTable};

/// What motion adds to an object's own translation, and to its rotation in
/// degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Moved {
    pub(super) translate: DVec3,
    pub(super) rotate: DVec3,
}

/// Where `table` has taken an object by `time` (seconds).
pub(super) fn moved(
    source: &Source<'_>,
    table: Option<&MotionTable>,
    time: f64,
) -> Result<Moved, SceneFileError> {
    let Some(table) = table else {
        return Ok(Moved::default());
    };
    let mut moved = keyed(source, table, time)?;
    if let Some(velocity) = &table.velocity {
        moved.translate += source.finite("velocity", velocity)? * time;
    }
    if let Some(spin) = &table.spin {
        moved.rotate += source.finite("spin", spin)? * time;
    }
    Ok(moved)
}

/// A keyframe.
struct Key {
    time: f64,
    moved: Moved,
}

/// Linear between keys; before the first and after the last one as they are,
/// or from the beginning again.
fn keyed(source: &Source<'_>, table: &MotionTable, time: f64) -> Result<Moved, SceneFileError> {
    let mut keys: Vec<Key> = Vec::new();
    for key in &table.keys {
        let next = read(source, key)?;
        if let Some(last) = keys.last().filter(|last| last.time >= next.time) {
            let message = format!(
                "time is {}; valid is above {}, the time of the key before",
                next.time, last.time
            );
            return Err(source.error(key.time.span(), message));
        }
        keys.push(next);
    }
    let (Some(first), Some(last)) = (keys.first(), keys.last()) else {
        return Ok(Moved::default());
    };
    let length = last.time - first.time;
    let time = if table.repeat && length > 0.0 {
        first.time + (time - first.time).rem_euclid(length)
    } else {
        time.clamp(first.time, last.time)
    };
    let after = keys.partition_point(|k| k.time <= time);
    if after == 0 || after == keys.len() {
        return Ok(if after == 0 { first.moved } else { last.moved });
    }
    let (a, b) = (&keys[after - 1], &keys[after]);
    let share = (time - a.time) / (b.time - a.time);
    let between = |p: DVec3, q: DVec3| p + (q - p) * share;
    Ok(Moved {
        translate: between(a.moved.translate, b.moved.translate),
        rotate: between(a.moved.rotate, b.moved.rotate),
    })
}

fn read(source: &Source<'_>, key: &KeyTable) -> Result<Key, SceneFileError> {
    let vector = |name, value: &Option<_>| match value {
        Some(value) => source.finite(name, value),
        None => Ok(DVec3::ZERO),
    };
    Ok(Key {
        time: source.number("time", &key.time)?,
        moved: Moved {
            translate: vector("translate", &key.translate)?,
            rotate: vector("rotate", &key.rotate)?,
        },
    })
}
