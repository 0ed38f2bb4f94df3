//! What is said of a frame's light views: figures and warnings.

use super::super::light_view::{Fitted, Views};
use super::super::lit_tiles::LitTiles;
use crate::parts::shadowed_frame::Notes;
use crate::technique::{Figure, Warning};

/// What is said of one light's views. `label` adds the light's number where there
/// are several.
pub(crate) struct MapNotes<'a> {
    notes: &'a mut Notes,
    label: &'a dyn Fn(&str) -> String,
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

/// A light's views, counted together.
#[derive(Default)]
pub(crate) struct ViewsOfLight {
    /// Views that there should be and are not.
    pub(crate) missing: usize,
    views: usize,
    cut: usize,
    limited: usize,
    /// Largest of the views.
    bias: f64,
    texel: f64,
    range: Option<[f64; 2]>,
    /// What a technique chose for its views, the least of each.
    figures: Vec<(&'static str, f64)>,
    /// What a technique found amiss, in so many views.
    warnings: Vec<([&'static str; 3], usize)>,
}

impl ViewsOfLight {
    /// Of one of the views.
    pub(crate) fn add_figures(&mut self, figures: &[(&'static str, f64)]) {
        for &(name, value) in figures {
            match self.figures.iter_mut().find(|(n, _)| *n == name) {
                Some((_, least)) => *least = least.min(value),
                None => self.figures.push((name, value)),
            }
        }
    }

    /// Of one of the views.
    pub(crate) fn add_warnings(&mut self, warnings: &[[&'static str; 3]]) {
        for warning in warnings {
            match self.warnings.iter_mut().find(|(known, _)| known == warning) {
                Some((_, count)) => *count += 1,
                None => self.warnings.push((*warning, 1)),
            }
        }
    }

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
}

impl<'a> MapNotes<'a> {
    pub(crate) fn new(notes: &'a mut Notes, label: &'a dyn Fn(&str) -> String) -> Self {
        Self { notes, label }
    }

    /// Tiles in which the light's look-ups are left out.
    pub(crate) fn skipped(&mut self, tiles: &LitTiles) {
        self.figure("skipped-tiles", tiles.skipped() as f64);
    }

    /// Figures and warnings of `views`, drawn with `slope`.
    pub(crate) fn add(&mut self, views: ViewsOfLight, slope: f64, hints: Hints) {
        self.warn_of(&views, hints);
        self.figure("views", views.views as f64);
        if let Some([near, far]) = views.range {
            self.figure("bias", views.bias);
            self.figure("slope-bias", slope);
            self.figure("texel", views.texel);
            self.figure("near", near);
            self.figure("far", far);
        }
        for ([code, what, hint], count) in views.warnings {
            self.warn(code, count, what, hint);
        }
        for (name, value) in views.figures {
            self.figure(name, value);
        }
    }

    /// Where views are limited, what the near distance cuts is beyond them as well:
    /// one hint is enough.
    fn warn_of(&mut self, views: &ViewsOfLight, hints: Hints) {
        let limited = views.limited + views.missing;
        if limited > 0 {
            self.warn(
                "view-limited",
                limited,
                "views do not hold all casters that matter, for those are too near to the light \
                 or beside it",
                hints.limited,
            );
        } else if views.cut > 0 {
            self.warn(
                "casters-at-near-distance",
                views.cut,
                "triangles of casters reach nearer to the light than is looked at and are cut there",
                hints.cut,
            );
        }
    }

    fn figure(&mut self, name: &str, value: f64) {
        let name = (self.label)(name);
        self.notes.figures.push(Figure { name, value });
    }

    fn warn(&mut self, code: &'static str, count: usize, what: &str, hint: &str) {
        let message = format!("{}: {count} {what}; {hint}", (self.label)("light view"));
        self.notes.warnings.push(Warning {
            code,
            count,
            message,
        });
    }
}
