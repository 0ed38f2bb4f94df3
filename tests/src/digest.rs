//! A digest of what a run left behind.

use gnomon_raster::{ClientTraffic, Counters};

use crate::twin::Outcome;

/// FNV-1a over 64 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest(pub u64);

impl Default for Digest {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Digest {
    /// Takes bytes in.
    pub fn bytes(&mut self, bytes: &[u8]) {
        for b in bytes {
            self.0 = (self.0 ^ u64::from(*b)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// Takes another digest or a number in.
    pub fn number(&mut self, v: u64) {
        self.bytes(&v.to_le_bytes());
    }
}

/// Digest of all attachments and counters.
#[must_use]
pub fn digest(o: &Outcome) -> Digest {
    let mut d = Digest::default();
    for texel in o.color.iter().flatten().flatten() {
        d.bytes(&texel.to_le_bytes());
    }
    for depth in &o.depth {
        d.bytes(&depth.to_le_bytes());
    }
    d.bytes(&o.stencil);
    for pass in &o.passes {
        pass.draws.iter().for_each(|c| counters(&mut d, c));
        traffic(&mut d, &pass.clear);
    }
    d
}

/// The printed form names every field, so a new counter cannot be forgotten.
fn counters(d: &mut Digest, c: &Counters) {
    d.bytes(format!("{c:?}").as_bytes());
}

fn traffic(d: &mut Digest, t: &ClientTraffic) {
    d.bytes(format!("{t:?}").as_bytes());
}
