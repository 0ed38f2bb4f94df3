//! Judging single values: finite, positive, in range; errors with their place.

use std::ops::{Range, RangeInclusive};

use glam::DVec3;

use super::SceneFileError;
use super::schema::{Count, Number, Triple};

/// The text being read, for places in messages.
pub(super) struct Source<'a> {
    pub(super) text: &'a str,
    pub(super) file: &'a str,
}

type Checked<T> = Result<T, SceneFileError>;

impl Source<'_> {
    /// An error at a span of the text.
    pub(super) fn error(&self, span: Range<usize>, message: String) -> SceneFileError {
        let before = self.text.get(..span.start).unwrap_or(self.text);
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        SceneFileError::Invalid {
            file: self.file.to_owned(),
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            message,
        }
    }

    /// Three finite numbers.
    pub(super) fn finite(&self, name: &str, value: &Triple) -> Checked<DVec3> {
        let v = DVec3::from(value.get_ref().0);
        if v.is_finite() {
            return Ok(v);
        }
        let message = format!(
            "{name} is {:?}; valid are three finite numbers",
            value.get_ref().0
        );
        Err(self.error(value.span(), message))
    }

    /// Three finite numbers that are not all zero.
    pub(super) fn direction(&self, name: &str, value: &Triple) -> Checked<DVec3> {
        let v = self.finite(name, value)?;
        if v.length() > 0.0 {
            return Ok(v);
        }
        let message = format!("{name} has no length; valid is any direction but [0, 0, 0]");
        Err(self.error(value.span(), message))
    }

    /// Linear RGB: not negative, and finite in f32.
    pub(super) fn colour(&self, name: &str, value: &Triple) -> Checked<[f32; 3]> {
        let rgb = self.finite(name, value)?.to_array();
        if rgb.iter().all(|c| (0.0..=f64::from(f32::MAX)).contains(c)) {
            return Ok(rgb.map(|c| c as f32));
        }
        let message = format!("{name} is {rgb:?}; valid are three numbers from 0 to 3.4e38");
        Err(self.error(value.span(), message))
    }

    /// A finite number.
    pub(super) fn number(&self, name: &str, value: &Number) -> Checked<f64> {
        self.number_where(name, value, "a finite number", |_| true)
    }

    /// A finite number above 0.
    pub(super) fn positive(&self, name: &str, value: &Number) -> Checked<f64> {
        self.number_where(name, value, "above 0 and finite", |x| x > 0.0)
    }

    /// A finite number that satisfies `valid`, which `rule` describes.
    pub(super) fn number_where(
        &self,
        name: &str,
        value: &Number,
        rule: &str,
        valid: impl Fn(f64) -> bool,
    ) -> Checked<f64> {
        let x = *value.get_ref();
        if x.is_finite() && valid(x) {
            return Ok(x);
        }
        Err(self.error(value.span(), format!("{name} is {x}; valid is {rule}")))
    }

    /// A whole number in a range.
    pub(super) fn count(
        &self,
        name: &str,
        value: &Count,
        range: RangeInclusive<u32>,
    ) -> Checked<u32> {
        let n = *value.get_ref();
        if range.contains(&n) {
            return Ok(n);
        }
        Err(self.error(value.span(), format!("{name} is {n}; valid is {range:?}")))
    }
}
