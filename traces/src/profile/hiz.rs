//! When HiZ may be used, and what it says of a block.

use gnomon_raster::state::{CompareFunction, StencilFaceState, StencilOperation};
use serde::Serialize;

use super::model::{Hiz, HizRules, Keeps};
use crate::shape::{DrawShape, PassShape};

/// Why a draw goes without HiZ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DisabledReason {
    /// The hardware has none.
    NoHiz,
    /// Nothing is attached, or depth is not tested, or so that HiZ cannot help.
    Compare,
    /// The depth bounds test is on.
    DepthBounds,
    /// The shader writes depth.
    ShaderDepth,
    /// The stencil is written where its test fails.
    StencilFailOp,
    /// The stencil is written where the depth test fails.
    DepthFailOp,
    /// Depth was compared in the other direction since the last clear.
    DirectionChanged,
    /// A draw before it left entries that cannot be relied on.
    ContentsInvalid,
    /// The entries do not fit into the memory on chip.
    NoMemory,
}

impl core::fmt::Display for DisabledReason {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::NoHiz => "the hardware has no HiZ",
            Self::Compare => "depth comparison",
            Self::DepthBounds => "depth bounds test",
            Self::ShaderDepth => "shader writes depth",
            Self::StencilFailOp => "stencil-fail operation",
            Self::DepthFailOp => "depth-fail operation",
            Self::DirectionChanged => "direction of comparison changed",
            Self::ContentsInvalid => "contents invalid until the next clear",
            Self::NoMemory => "no room on chip",
        })
    }
}

/// What HiZ does for a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct DrawHiz {
    /// The test, or why there is none.
    pub(super) test: Result<HizTest, DisabledReason>,
    /// What it writes reaches the entries.
    pub(super) updates: bool,
}

/// A draw's test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct HizTest {
    pub(super) compare: CompareFunction,
    keeps: Keeps,
    /// Front, back: fragments that fail the depth test are not without effect.
    acts: [bool; 2],
}

/// What an entry says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Decision {
    Unknown,
    /// Every fragment passes, or all fail and have an effect: depth is not read.
    Decided,
    /// The block is thrown away.
    Culled,
}

impl HizTest {
    /// Depths `[a, b]` against stored `[min, max]`.
    pub(super) fn decide(&self, [a, b]: [u32; 2], stored: [u32; 2], front: bool) -> Decision {
        let (pass, fail) = match self.keeps {
            Keeps::MinMax => outcome(self.compare, [a, b], stored),
            Keeps::Max | Keeps::Direction => (false, fails(self.compare, [a, b], stored)),
        };
        let fail = fail && !pass;
        match (pass, fail, self.acts[usize::from(!front)]) {
            (_, true, false) => Decision::Culled,
            (true, ..) | (_, true, true) => Decision::Decided,
            _ => Decision::Unknown,
        }
    }
}

fn outcome(c: CompareFunction, [a, b]: [u32; 2], [min, max]: [u32; 2]) -> (bool, bool) {
    let same = a == b && min == max && a == min;
    let apart = b < min || a > max;
    match c {
        CompareFunction::Less => (b < min, a >= max),
        CompareFunction::LessEqual => (b <= min, a > max),
        CompareFunction::Greater => (a > max, b <= min),
        CompareFunction::GreaterEqual => (a >= max, b < min),
        CompareFunction::Equal => (same, apart),
        CompareFunction::NotEqual => (apart, same),
        CompareFunction::Never | CompareFunction::Always => (false, false),
    }
}

/// With one end only.
fn fails(c: CompareFunction, [a, b]: [u32; 2], [min, max]: [u32; 2]) -> bool {
    match c {
        CompareFunction::Less => a >= max,
        CompareFunction::LessEqual | CompareFunction::Equal => a > max,
        CompareFunction::Greater => b <= min,
        CompareFunction::GreaterEqual => b < min,
        _ => false,
    }
}

/// The entry of a block that holds depths `[min, max]` of `depth_bits` bits.
pub(super) fn entry(hiz: &Hiz, depth_bits: u32, [min, max]: [u32; 2]) -> [u32; 2] {
    let dropped = depth_bits.saturating_sub(hiz.bits);
    let low = (1_u32 << dropped) - 1;
    [min & !low, max | low]
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Direction {
    Less,
    Greater,
}

fn direction(c: CompareFunction) -> Option<Direction> {
    match c {
        CompareFunction::Less | CompareFunction::LessEqual => Some(Direction::Less),
        CompareFunction::Greater | CompareFunction::GreaterEqual => Some(Direction::Greater),
        _ => None,
    }
}

/// What has become of the entries of an image since it was cleared.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contents {
    valid: bool,
    direction: Option<Direction>,
    /// Low-resolution Z is not written for the rest of the pass.
    frozen: bool,
}

impl Contents {
    pub(super) const INVALID: Self = Self {
        valid: false,
        direction: None,
        frozen: false,
    };

    /// Depth is cleared.
    pub(super) fn clear(&mut self) {
        *self = Self {
            valid: true,
            ..Self::INVALID
        };
    }

    pub(super) fn begin_pass(&mut self) {
        self.frozen = false;
    }

    /// The next draw, as its profile's rules have it.
    pub(super) fn draw(&mut self, hiz: &Hiz, pass: &PassShape, draw: &DrawShape) -> DrawHiz {
        let state = State::of(pass, draw);
        let (test, updates) = match hiz.rules {
            HizRules::None => (Err(DisabledReason::NoHiz), false),
            HizRules::Gnomon => (gnomon(&state), true),
            HizRules::Attila => self.attila(&state),
            HizRules::R300 => self.r300(&state),
            HizRules::Adreno => self.adreno(&state),
        };
        let test = test.map(|()| HizTest {
            compare: state.compare,
            keeps: hiz.keeps,
            acts: match hiz.rules {
                HizRules::Gnomon => state.faces.map(|f| writes(f, [true, true, false])),
                // Where fragments that fail have an effect the test is off, or the
                // hardware does not look.
                _ => [false; 2],
            },
        });
        DrawHiz { test, updates }
    }

    fn usable(&self) -> Result<(), DisabledReason> {
        self.valid
            .then_some(())
            .ok_or(DisabledReason::ContentsInvalid)
    }

    /// ATTILA looks at the front face only.
    fn attila(&mut self, s: &State) -> (Result<(), DisabledReason>, bool) {
        use CompareFunction as C;
        let test = if !matches!(s.compare, C::Less | C::LessEqual | C::Equal) {
            Err(DisabledReason::Compare)
        } else {
            s.plain()
                .and_then(|()| fail_operations(&s.faces[..1]))
                .and_then(|()| self.usable())
        };
        if s.write && !matches!(s.compare, C::Never | C::Less | C::LessEqual) {
            self.valid = false;
        }
        (test, true)
    }

    fn r300(&mut self, s: &State) -> (Result<(), DisabledReason>, bool) {
        use CompareFunction as C;
        let allowed = s
            .plain_or_always()
            .and_then(|()| self.r300_direction(s.compare))
            .and_then(|()| fail_operations(&s.faces))
            .and_then(|()| self.usable());
        if allowed.is_ok() {
            // What has no direction is taken for Less.
            let first = direction(s.compare).or(Some(Direction::Less));
            self.direction = self.direction.or(first);
        } else if s.write {
            self.valid = false;
        }
        // Nothing can be thrown away for a comparison that needs no depth.
        let test = allowed.and(match s.compare {
            C::Always | C::Never => Err(DisabledReason::Compare),
            _ => Ok(()),
        });
        (test, true)
    }

    fn r300_direction(&self, compare: CompareFunction) -> Result<(), DisabledReason> {
        use CompareFunction as C;
        match (self.direction, direction(compare)) {
            _ if matches!(compare, C::Equal | C::NotEqual) => Err(DisabledReason::Compare),
            (Some(known), Some(now)) if known != now => Err(DisabledReason::DirectionChanged),
            _ => Ok(()),
        }
    }

    fn adreno(&mut self, s: &State) -> (Result<(), DisabledReason>, bool) {
        use CompareFunction as C;
        let one_way = direction(s.compare);
        let changed = matches!((self.direction, one_way), (Some(a), Some(b)) if a != b);
        let test = if one_way.is_none() {
            Err(DisabledReason::Compare)
        } else if changed {
            Err(DisabledReason::DirectionChanged)
        } else {
            s.plain()
                .and_then(|()| fail_operations(&s.faces))
                .and_then(|()| self.usable())
        };
        let may_kill = s.faces.iter().any(|f| f.compare != C::Always);
        let depends = s.faces.iter().any(depends_on_depth);
        self.frozen |= may_kill || depends;
        if s.write && (matches!(s.compare, C::Always | C::NotEqual) || changed) {
            self.valid = false;
        }
        if s.write && self.valid {
            self.direction = self.direction.or(one_way);
        }
        (
            test,
            s.write && !self.frozen && !s.discards && !s.shader_depth,
        )
    }
}

/// What the rules look at.
struct State {
    attached: bool,
    compare: CompareFunction,
    write: bool,
    bounds: bool,
    shader_depth: bool,
    discards: bool,
    faces: [StencilFaceState; 2],
}

impl State {
    fn of(pass: &PassShape, draw: &DrawShape) -> Self {
        let ds = &draw.depth_stencil;
        let fragment = draw.fragment.unwrap_or_default();
        Self {
            attached: pass.depth_stencil.is_some(),
            compare: ds.depth.compare,
            write: ds.depth.write,
            bounds: ds.depth.bounds.is_some(),
            shader_depth: fragment.depth,
            discards: fragment.discards,
            faces: [ds.stencil.front, ds.stencil.back],
        }
    }

    /// Depth is tested, and as it is interpolated.
    fn plain(&self) -> Result<(), DisabledReason> {
        match self.compare.reads_stored() {
            true => self.plain_or_always(),
            false => Err(DisabledReason::Compare),
        }
    }

    /// As [`Self::plain`], if depth is tested at all.
    fn plain_or_always(&self) -> Result<(), DisabledReason> {
        if !self.attached {
            return Err(DisabledReason::Compare);
        }
        if self.bounds {
            return Err(DisabledReason::DepthBounds);
        }
        match self.shader_depth {
            true => Err(DisabledReason::ShaderDepth),
            false => Ok(()),
        }
    }
}

fn gnomon(s: &State) -> Result<(), DisabledReason> {
    s.plain()
}

/// Whether any of fail, depth fail and pass, where `which`, can change the stencil.
fn writes(face: StencilFaceState, which: [bool; 3]) -> bool {
    let operations = [face.fail_op, face.depth_fail_op, face.pass_op];
    let changes = |(op, asked): (StencilOperation, bool)| asked && op != StencilOperation::Keep;
    face.write_mask != 0 && operations.into_iter().zip(which).any(changes)
}

fn fail_operations(faces: &[StencilFaceState]) -> Result<(), DisabledReason> {
    let any = |which| faces.iter().any(|f| writes(*f, which));
    if any([false, true, false]) {
        return Err(DisabledReason::DepthFailOp);
    }
    match any([true, false, false]) {
        true => Err(DisabledReason::StencilFailOp),
        false => Ok(()),
    }
}

/// The stencil that is written depends on the depth test.
fn depends_on_depth(face: &StencilFaceState) -> bool {
    face.write_mask != 0 && face.depth_fail_op != face.pass_op
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All depths of the one range against all of the other, for every comparison: what is
    /// said of ranges is said where it holds for each pair, and nowhere else.
    #[test]
    fn ranges_say_what_all_their_depths_say() {
        let ranges = || (0..4u32).flat_map(|low| (low..4).map(move |high| [low, high]));
        for c in CompareFunction::ALL {
            if matches!(c, CompareFunction::Never | CompareFunction::Always) {
                continue;
            }
            for ([a, b], [min, max]) in ranges().flat_map(|x| ranges().map(move |y| (x, y))) {
                let each = || (a..=b).flat_map(|f| (min..=max).map(move |s| c.test(f, s)));
                let told = outcome(c, [a, b], [min, max]);
                let truth = (each().all(|p| p), each().all(|p| !p));
                assert_eq!(told, truth, "{c:?} {a}..{b} {min}..{max}");
                // One end is kept: of Equal the largest only, of NotEqual nothing follows.
                let known = match c {
                    CompareFunction::Equal => a > max,
                    CompareFunction::NotEqual => false,
                    _ => truth.1,
                };
                assert_eq!(
                    fails(c, [a, b], [min, max]),
                    known,
                    "{c:?} {a}..{b} {min}..{max}"
                );
            }
        }
    }
}
