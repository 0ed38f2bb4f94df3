//! What is said of a frame's light views: figures and warnings.

use super::super::light_view::{Fitted, Views};
use super::super::lit_tiles::LitTiles;
use crate::technique::{Figure, Warning};

/// What is said of the views of a frame.
#[derive(Default)]
pub(crate) struct Notes {
    pub(crate) warnings: Vec<Warning>,
    pub(crate) figures: Vec<Figure>,
}

impl Notes {
    /// Tiles in which a light's look-ups are left out.
    pub(crate) fn skipped(&mut self, tiles: &LitTiles, label: &dyn Fn(&str) -> String) {
        self.figures.push(Figure {
            name: label("skipped-tiles"),
            value: tiles.skipped() as f64,
        });
    }
}

/// What can be done about views that do not hold what they should.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Hints {
    cut: &'static str,
    limited: &'static str,
}

impl Hints {
    /// With these parameters. A cube looks all round, so that only what is next to
    /// the light is beyond it, where a smaller near distance would not help: views
    /// would have to be wider still.
    pub(crate) fn of(views: Views, near: Option<f64>) -> Self {
        Self {
            cut: match near {
                Some(_) => "set near to less, or to auto",
                None => "set near to less than the figure `near`, or move them off the light",
            },
            limited: match views {
                Views::Planar => "set view to cube or auto",
                Views::Auto | Views::Cube => "move them off the light",
            },
        }
    }
}

/// What is to be said of a light's views, together.
#[derive(Default)]
pub(crate) struct Said {
    /// Views that there should be and are not.
    pub(crate) missing: usize,
    views: usize,
    cut: usize,
    limited: usize,
    /// Largest of the views.
    bias: f64,
    texel: f64,
    range: Option<[f64; 2]>,
}

impl Said {
    pub(crate) fn add(&mut self, fitted: &Fitted, bias: f64, size: u32) {
        self.views += 1;
        self.cut += fitted.cut;
        self.limited += usize::from(fitted.limited);
        self.bias = self.bias.max(bias);
        let [near, far] = fitted.range;
        self.texel = self.texel.max(fitted.texel_at_far(size));
        let [nearest, farthest] = self.range.unwrap_or([near, far]);
        self.range = Some([nearest.min(near), farthest.max(far)]);
    }

    /// `label` adds the light's number where there are several.
    pub(crate) fn into_notes(
        self,
        slope: f64,
        hints: Hints,
        label: &dyn Fn(&str) -> String,
        notes: &mut Notes,
    ) {
        self.warn(hints, label, notes);
        let mut figure = |name: &str, value: f64| {
            let name = label(name);
            notes.figures.push(Figure { name, value });
        };
        figure("views", self.views as f64);
        if let Some([near, far]) = self.range {
            figure("bias", self.bias);
            figure("slope-bias", slope);
            figure("texel", self.texel);
            figure("near", near);
            figure("far", far);
        }
    }

    /// Where views are limited, what the near distance cuts is beyond them as well:
    /// one hint is enough.
    fn warn(&self, hints: Hints, label: &dyn Fn(&str) -> String, notes: &mut Notes) {
        let mut warn = |code, count: usize, what: &str, hint: &str| {
            let message = format!("{}: {count} {what}; {hint}", label("light view"));
            notes.warnings.push(Warning {
                code,
                count,
                message,
            });
        };
        let limited = self.limited + self.missing;
        if limited > 0 {
            warn(
                "view-limited",
                limited,
                "views do not hold all casters that matter, for those are too near to the light \
                 or beside it",
                hints.limited,
            );
        } else if self.cut > 0 {
            warn(
                "casters-at-near-distance",
                self.cut,
                "triangles of casters reach nearer to the light than is looked at and are cut there",
                hints.cut,
            );
        }
    }
}
