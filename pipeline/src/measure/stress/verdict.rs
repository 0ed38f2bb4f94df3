//! How far an error stays what it is at rest.

use core::fmt;

use super::curve::{Curve, Measured, Outcome};

/// What an error may be beside that at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Times that at rest.
    pub times: f64,
    /// And so much more: what pictures of few pixels differ by.
    pub plus: f64,
    /// Share of the pixels that were compared at rest and must be here, too: an error that is
    /// seen on few pixels says little.
    pub compared: f64,
}

impl Default for Limit {
    fn default() -> Self {
        Self {
            times: 1.25,
            plus: 1e-3,
            compared: 0.75,
        }
    }
}

impl Limit {
    /// The largest error that is none the worse, where that at rest is `rest`.
    #[must_use]
    pub fn most(&self, rest: f64) -> f64 {
        rest * self.times + self.plus
    }
}

/// Where a walk from rest ends.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// At the end of the axis, or of the scene: nothing was worse.
    Throughout,
    /// The error is larger there.
    Worse {
        /// The value.
        at: f64,
        /// The error.
        rmse: f64,
        /// Warnings that are not given at rest: the picture is not wrong in silence.
        warnings: Vec<&'static str>,
    },
    /// Picture and truth show other surfaces on too many pixels.
    Apart {
        /// The value.
        at: f64,
        /// Share of pixels that can be compared.
        compared: f64,
        /// Warnings that are not given at rest.
        warnings: Vec<&'static str>,
    },
    /// Nothing is drawn there, and it is said why.
    Refused {
        /// The value.
        at: f64,
        /// Why.
        reason: String,
    },
}

/// What became of a candidate along an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The axis, by name.
    pub axis: &'static str,
    /// The candidate, by name.
    pub candidate: String,
    /// The error at rest; `None` where nothing is drawn there.
    pub rest: Option<f64>,
    /// The least and greatest value to which the error stays within the limit, from rest.
    pub holds: [f64; 2],
    /// Why it ends there, towards smaller and towards larger values.
    pub ends: [End; 2],
    /// Pixels with no sane visibility, over all values.
    pub insane: usize,
}

impl Verdict {
    /// Of candidate number `candidate`, by the limit of [`Limit::default`].
    ///
    /// # Panics
    /// The curve has no such candidate.
    #[must_use]
    pub fn new(curve: &Curve, candidate: usize) -> Self {
        Self::within(curve, candidate, Limit::default())
    }

    /// The same by another limit.
    ///
    /// # Panics
    /// The curve has no such candidate.
    #[must_use]
    pub fn within(curve: &Curve, candidate: usize, limit: Limit) -> Self {
        let axis = &curve.axis;
        let rest = axis.values.iter().position(|v| *v == axis.rest);
        let rest = rest.expect("rest is one of the values");
        let outcome = |k: usize| {
            curve.points[k]
                .outcomes
                .as_ref()
                .ok()
                .map(|o| &o[candidate])
        };
        let at_rest = match outcome(rest) {
            Some(Outcome::Measured(measured)) => Some(measured),
            _ => None,
        };
        let walk = |steps: &mut dyn Iterator<Item = usize>| {
            let mut reached = axis.rest;
            for k in steps {
                let value = curve.points[k].value;
                // Where there is no scene nothing can be worse.
                let Some((outcome, at_rest)) = outcome(k).zip(at_rest) else {
                    continue;
                };
                match end(value, outcome, at_rest, limit) {
                    Some(end) => return (reached, end),
                    None => reached = value,
                }
            }
            (reached, End::Throughout)
        };
        let (least, below) = walk(&mut (0..rest).rev());
        let (most, above) = walk(&mut (rest + 1..axis.values.len()));
        let all = (0..curve.points.len()).filter_map(outcome);
        let insane = all.map(|o| match o {
            Outcome::Measured(m) => m.insane,
            _ => 0,
        });
        Self {
            axis: axis.name,
            candidate: curve.candidates[candidate].clone(),
            rest: at_rest.map(|m| m.rmse),
            holds: [least, most],
            ends: [below, above],
            insane: insane.sum(),
        }
    }

    /// Whether the error is nowhere larger than at rest, nothing is refused, and all is sane.
    #[must_use]
    pub fn holds_throughout(&self) -> bool {
        let whole = self.ends.iter().all(|e| *e == End::Throughout);
        self.rest.is_some() && whole && self.insane == 0
    }

    /// Whether the picture gets worse somewhere without a word.
    #[must_use]
    pub fn is_silent(&self) -> bool {
        let silent = |e: &End| match e {
            End::Worse { warnings, .. } | End::Apart { warnings, .. } => warnings.is_empty(),
            End::Throughout | End::Refused { .. } => false,
        };
        self.ends.iter().any(silent)
    }
}

/// Why a walk ends at `value`, if it does.
fn end(value: f64, outcome: &Outcome, rest: &Measured, limit: Limit) -> Option<End> {
    match outcome {
        Outcome::DoesNotApply => None,
        Outcome::Refused(reason) => Some(End::Refused {
            at: value,
            reason: reason.clone(),
        }),
        Outcome::Measured(m) => picture_end(value, m, rest, limit),
    }
}

fn picture_end(at: f64, m: &Measured, rest: &Measured, limit: Limit) -> Option<End> {
    let new = m.warnings.iter().filter(|w| !rest.warnings.contains(w));
    let warnings = new.copied().collect();
    let (rmse, compared) = (m.rmse, m.compared);
    if compared < rest.compared * limit.compared || rmse.is_nan() {
        return Some(End::Apart {
            at,
            compared,
            warnings,
        });
    }
    (rmse > limit.most(rest.rmse)).then_some(End::Worse { at, rmse, warnings })
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(rest) = self.rest else {
            return write!(f, "no picture of the scene at rest");
        };
        let [least, most] = self.holds;
        write!(
            f,
            "{} at rest, {}",
            short(rest),
            match least == most {
                true => "nowhere else".to_owned(),
                false => format!("holds from {} to {}", short(least), short(most)),
            }
        )?;
        for end in &self.ends {
            match end {
                End::Throughout => {}
                End::Worse { at, rmse, warnings } => {
                    write!(
                        f,
                        "; {} at {} ({})",
                        short(*rmse),
                        short(*at),
                        told(warnings)
                    )?;
                }
                End::Apart {
                    at,
                    compared,
                    warnings,
                } => {
                    let share = short(100.0 * compared);
                    write!(f, "; {share} % of pixels show the same at {}", short(*at))?;
                    write!(f, " ({})", told(warnings))?;
                }
                End::Refused { at, reason } => write!(f, "; refused at {}: {reason}", short(*at))?,
            }
        }
        match self.insane {
            0 => Ok(()),
            n => write!(f, "; {n} pixels are no visibility"),
        }
    }
}

fn told(warnings: &[&str]) -> String {
    match warnings.is_empty() {
        true => "in silence".to_owned(),
        false => format!("warned: {}", warnings.join(", ")),
    }
}

/// A number in as few characters as say it.
fn short(x: f64) -> String {
    match x.abs() {
        a if a != 0.0 && !(1e-3..1e4).contains(&a) => format!("{x:.1e}"),
        _ => format!("{:.4}", x)
            .trim_end_matches('0')
            .trim_end_matches('.')
            .to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::axis::Axis;
    use super::super::curve::Point;
    use super::*;

    fn measured(rmse: f64, warnings: &[&'static str]) -> Outcome {
        Outcome::Measured(Measured {
            rmse,
            max: rmse,
            compared: 1.0,
            insane: 0,
            warnings: warnings.to_vec(),
        })
    }

    /// A curve over 0.01 to 1000 in decades, with the scene at rest at 1.
    fn curve(outcomes: [Result<Outcome, String>; 6]) -> Curve {
        let mut axis = Axis::find("scale").unwrap();
        axis.keep(|v| (0.009..2e3).contains(&v));
        let values = axis.values.clone().into_iter();
        let points = values.zip(outcomes).map(|(value, o)| Point {
            value,
            outcomes: o.map(|o| vec![o]),
        });
        Curve {
            points: points.collect(),
            candidates: vec!["it".to_owned()],
            axis,
        }
    }

    #[test]
    fn walks_end_at_the_first_that_is_worse() {
        let flat = || Ok(measured(0.01, &["always"]));
        let curve = curve([
            Ok(measured(0.5, &["always", "told"])),
            Ok(measured(0.0134, &[])),
            flat(),
            flat(),
            Ok(measured(0.2, &["always"])),
            flat(),
        ]);
        let verdict = Verdict::new(&curve, 0);
        assert!((verdict.holds[0] - 0.1).abs() < 1e-12 && verdict.holds[1] == 10.0);
        assert!(matches!(&verdict.ends[0], End::Worse { warnings, .. } if warnings == &["told"]));
        assert!(verdict.is_silent() && !verdict.holds_throughout());
        assert_eq!(
            verdict.to_string(),
            "0.01 at rest, holds from 0.1 to 10; 0.5 at 0.01 (warned: told); 0.2 at 100 (in silence)"
        );
    }

    #[test]
    fn scenes_that_are_gone_end_nothing_and_refusals_do() {
        let flat = || Ok(measured(0.01, &[]));
        let gone = || Err("nothing is left".to_owned());
        let whole = curve([gone(), flat(), flat(), gone(), flat(), gone()]);
        let verdict = Verdict::new(&whole, 0);
        assert!(
            verdict.holds_throughout() && !verdict.is_silent(),
            "{verdict}"
        );
        let refused = || Ok(Outcome::Refused("no".to_owned()));
        let ends = curve([flat(), flat(), flat(), flat(), refused(), flat()]);
        let verdict = Verdict::new(&ends, 0);
        assert_eq!(verdict.holds[1], 10.0);
        assert!(!verdict.holds_throughout() && !verdict.is_silent());
    }

    #[test]
    fn what_is_no_number_is_worse() {
        let flat = || Ok(measured(0.01, &[]));
        let nan = Ok(measured(f64::NAN, &[]));
        let curve = curve([flat(), flat(), flat(), nan, flat(), flat()]);
        assert_eq!(Verdict::new(&curve, 0).holds[1], 1.0);
    }

    #[test]
    fn errors_of_few_pixels_do_not_hold() {
        let flat = || Ok(measured(0.01, &[]));
        let few = |share: f64| match measured(0.0, &["told"]) {
            Outcome::Measured(m) => Ok(Outcome::Measured(Measured {
                compared: share,
                ..m
            })),
            other => Ok(other),
        };
        let curve = curve([flat(), few(0.74), flat(), few(0.76), few(0.2), flat()]);
        let verdict = Verdict::new(&curve, 0);
        assert_eq!(verdict.holds, [1.0, 10.0]);
        assert!(
            !verdict.holds_throughout() && !verdict.is_silent(),
            "{verdict}"
        );
    }
}
