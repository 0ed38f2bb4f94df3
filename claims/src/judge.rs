//! Whether what was measured bears out what was published.
//!
//! A published figure rarely comes with its scene and machine, so equality is asked
//! for of arithmetic only. Of an effect it is asked that it goes the same way, and
//! then that it has the published size within a factor, [`SLACK`] unless a claim
//! says otherwise.

/// By how much the size of an effect may differ from the published range, as a
/// factor both ways, for its size to count as roughly the same.
pub const SLACK: f64 = 2.0;

/// What was published of a figure.
#[derive(Clone, Debug, PartialEq)]
pub enum Theirs {
    /// Arithmetic: this very number.
    Exactly(f64),
    /// An effect within a range.
    Effect {
        /// Least published value.
        low: f64,
        /// Greatest published value.
        high: f64,
        /// The value that would mean no effect: 1 for ratios, 0 for savings.
        neutral: f64,
        /// Factor by which the range is widened both ways.
        slack: f64,
    },
    /// That there is no effect.
    None {
        /// The value that means so.
        neutral: f64,
        /// How far from it still counts as none.
        within: f64,
    },
    /// This or more.
    AtLeast(f64),
    /// This or less.
    AtMost(f64),
    /// Within these bounds, as they are.
    Within(f64, f64),
    /// Nothing that could be judged; the text is shown in place of a figure.
    Beside(&'static str),
}

/// The outcome of a comparison, from best to worst.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Judgement {
    /// There was nothing to judge.
    NotJudged,
    /// Direction and rough size hold.
    Holds,
    /// The direction holds, the size is another.
    DirectionOnly,
    /// It does not hold.
    DoesNotHold,
}

impl Judgement {
    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            Self::NotJudged => "not judged",
            Self::Holds => "holds",
            Self::DirectionOnly => "direction only",
            Self::DoesNotHold => "does not hold",
        }
    }

    /// Whether the direction holds; `None` without judgement.
    pub fn direction(self) -> Option<bool> {
        (self != Self::NotJudged).then_some(self != Self::DoesNotHold)
    }

    /// Whether the rough size holds; `None` without judgement.
    pub fn size(self) -> Option<bool> {
        (self != Self::NotJudged).then_some(self == Self::Holds)
    }
}

impl Theirs {
    /// A ratio of which 1 is no effect.
    pub fn ratio(low: f64, high: f64) -> Self {
        Self::Effect {
            low,
            high,
            neutral: 1.0,
            slack: SLACK,
        }
    }

    /// A share that is saved or lost, 0 being none.
    pub fn share(low: f64, high: f64) -> Self {
        Self::Effect {
            low,
            high,
            neutral: 0.0,
            slack: SLACK,
        }
    }

    /// Compares `ours`; what is not finite never holds.
    pub fn judge(&self, ours: f64) -> Judgement {
        let whole = |holds: bool| match holds {
            true => Judgement::Holds,
            false => Judgement::DoesNotHold,
        };
        if !ours.is_finite() && !matches!(self, Self::Beside(_)) {
            return Judgement::DoesNotHold;
        }
        match *self {
            Self::Exactly(value) => whole((ours - value).abs() <= 1e-9 * value.abs()),
            Self::Effect {
                low,
                high,
                neutral,
                slack,
            } => effect(ours, [low, high], neutral, slack),
            Self::None { neutral, within } => whole((ours - neutral).abs() <= within),
            Self::AtLeast(least) => whole(ours >= least),
            Self::AtMost(most) => whole(ours <= most),
            Self::Within(low, high) => whole((low..=high).contains(&ours)),
            Self::Beside(_) => Judgement::NotJudged,
        }
    }
}

fn effect(ours: f64, [low, high]: [f64; 2], neutral: f64, slack: f64) -> Judgement {
    let theirs = 0.5 * (low + high) - neutral;
    if (ours - neutral) * theirs <= 0.0 {
        return Judgement::DoesNotHold;
    }
    // Of negative figures the larger is the lesser in size.
    let [least, most] = [low.abs().min(high.abs()), low.abs().max(high.abs())];
    if (least / slack..=most * slack).contains(&ours.abs()) {
        Judgement::Holds
    } else {
        Judgement::DirectionOnly
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Judgement::{DirectionOnly, DoesNotHold, Holds, NotJudged};

    #[test]
    fn effects_have_direction_and_size() {
        let culling = Theirs::ratio(3.0, 4.0);
        let judged = [3.5, 1.5, 8.0, 8.1, 1.2, 1.0, 0.8, f64::NAN].map(|r| culling.judge(r));
        let expected = [
            Holds,
            Holds,
            Holds,
            DirectionOnly,
            DirectionOnly,
            DoesNotHold,
            DoesNotHold,
            DoesNotHold,
        ];
        assert_eq!(judged, expected);
    }

    #[test]
    fn losses_are_effects_too() {
        let slower = Theirs::share(-0.25, -0.2);
        let judged = [-0.2, -0.1, -0.05, -0.6, 0.2, 0.0].map(|r| slower.judge(r));
        let expected = [
            Holds,
            Holds,
            DirectionOnly,
            DirectionOnly,
            DoesNotHold,
            DoesNotHold,
        ];
        assert_eq!(judged, expected);
    }

    #[test]
    fn arithmetic_is_exact() {
        assert_eq!(Theirs::Exactly(331_776.0).judge(331_776.0), Holds);
        assert_eq!(Theirs::Exactly(331_776.0).judge(331_777.0), DoesNotHold);
        assert_eq!(Theirs::AtLeast(16.0).judge(15.0), DoesNotHold);
        assert_eq!(Theirs::AtMost(65.0).judge(66.0), DoesNotHold);
        assert_eq!(Theirs::Within(8.0, 32.0).judge(32.0), Holds);
        assert_eq!(Theirs::Within(8.0, 32.0).judge(2.0), DoesNotHold);
        let none = Theirs::None {
            neutral: 1.0,
            within: 0.1,
        };
        assert_eq!([1.05, 1.2].map(|r| none.judge(r)), [Holds, DoesNotHold]);
        assert_eq!(Theirs::Beside("-").judge(f64::NAN), NotJudged);
    }

    #[test]
    fn worse_is_greater() {
        assert!(NotJudged < Holds && Holds < DirectionOnly && DirectionOnly < DoesNotHold);
        assert_eq!(DirectionOnly.direction(), Some(true));
        assert_eq!(DirectionOnly.size(), Some(false));
        assert_eq!(NotJudged.size(), None);
    }
}
