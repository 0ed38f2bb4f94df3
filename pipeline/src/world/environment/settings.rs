//! How a map is read.

use super::EnvironmentError;

/// How a map becomes an environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapSettings {
    /// Most texels along a side of a cube face; coarser maps have fewer.
    pub side: usize,
    /// Turn about +y in degrees, counter-clockwise seen from above.
    pub turn: f64,
    /// Factor of all radiance, above 0.
    pub brightness: f64,
}

impl Default for MapSettings {
    fn default() -> Self {
        Self {
            side: 128,
            turn: 0.0,
            brightness: 1.0,
        }
    }
}

impl MapSettings {
    pub(super) fn check(&self) -> Result<(), EnvironmentError> {
        let bad = |what, value, valid| EnvironmentError::Setting { what, value, valid };
        if !(1..=1024).contains(&self.side) {
            return Err(bad("side", self.side as f64, "1 to 1024 texels"));
        }
        if !self.turn.is_finite() {
            return Err(bad("turn", self.turn, "a finite number of degrees"));
        }
        if !(self.brightness > 0.0 && self.brightness.is_finite()) {
            return Err(bad("brightness", self.brightness, "above 0 and finite"));
        }
        Ok(())
    }
}
