//! How many penumbra wedges cover a pixel's surface: a histogram from what draws
//! wrote.

use gnomon_raster::{AccessBatch, AccessObserver, BlockAccess, Wants};

use gnomon_pipeline::technique::{PassRole, Roles};

use super::{Lab, ReproduceError};
use gnomon_pipeline::world::scene::Scene;

/// Wedges by pixel.
pub(super) struct Overlaps {
    columns: usize,
    /// Writes of each pixel by the wedges of the group that is being drawn.
    writes: Vec<u32>,
    roles: Roles,
}

impl Overlaps {
    /// Runs a frame of `soft-shadow-volumes-optimised` with `set` on `scene` and
    /// counts, for each pixel, the wedges that wrote to it: one access each, which
    /// adds to both 8-bit buffers, to one of them 0.
    pub(super) fn measure(lab: &Lab, scene: &Scene, set: &[&str]) -> Result<Self, ReproduceError> {
        let (mut gpu, frame) = lab.frame(scene, "soft-shadow-volumes-optimised", set)?;
        let [width, height] = lab.size().map(|s| s as usize);
        let mut counted = Self {
            columns: width,
            writes: vec![0; width * height],
            roles: frame.roles,
        };
        gpu.submit_observed(&frame.recording.list, Wants::default(), &mut counted)?;
        Ok(counted)
    }

    /// Pixels by number of wedges, from 0.
    pub(super) fn histogram(&self) -> Vec<u64> {
        let mut pixels = vec![0; self.most() as usize + 1];
        for count in &self.writes {
            pixels[*count as usize] += 1;
        }
        pixels
    }

    pub(super) fn most(&self) -> u32 {
        self.writes.iter().copied().max().unwrap_or(0)
    }

    fn count(&mut self, access: &BlockAccess) {
        let rows = self.writes.len() / self.columns;
        for bit in (0..64).filter(|b| access.color_write[0] >> b & 1 == 1) {
            let x = 8 * usize::from(access.block[0]) + bit % 8;
            let y = 8 * usize::from(access.block[1]) + bit / 8;
            if x < self.columns && y < rows {
                self.writes[y * self.columns + x] += 1;
            }
        }
    }
}

impl AccessObserver for Overlaps {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        if self.roles.of_pass(pass) == PassRole::Wedges {
            batch.blocks.iter().for_each(|a| self.count(a));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accesses_are_counted_by_pixel() {
        let mut roles = Roles::default();
        roles.push(PassRole::HardCount, Vec::new());
        roles.push(PassRole::Wedges, Vec::new());
        let mut counted = Overlaps {
            columns: 10,
            writes: vec![0; 100],
            roles,
        };
        let mut access = BlockAccess {
            block: [1, 0],
            ..BlockAccess::default()
        };
        access.color_write[0] = 0b111 | 1 << 9; // x 8, 9 and outside; x 9, y 1
        counted.batch(0, &AccessBatch::new(&[access]));
        counted.batch(1, &AccessBatch::new(&[access]));
        counted.batch(1, &AccessBatch::new(&[access]));
        assert_eq!(counted.histogram(), [97, 0, 3]);
        assert_eq!((counted.writes[8], counted.writes[19]), (2, 2));
    }
}
