//! The hash that names transport.

use super::{TRANSPORT_VERSION, TransportObject, TransportSettings};

/// Hash of everything that decides transport: geometry to the bit, and settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TransportKey(pub(super) [u8; 32]);

impl TransportKey {
    /// Of an object.
    pub fn of(object: &TransportObject<'_>, settings: TransportSettings) -> Self {
        let mut hasher = blake3::Hasher::new();
        let mut add = |values: &mut dyn Iterator<Item = u32>| {
            let bytes: Vec<u8> = values.flat_map(u32::to_le_bytes).collect();
            hasher.update(&bytes);
        };
        let [bands, glossy, directions] =
            [settings.bands, settings.glossy_bands, settings.directions].map(|n| n as u32);
        let counts = [object.positions.len(), object.triangles.len()].map(|n| n as u32);
        let version = [TRANSPORT_VERSION, u32::from(object.casts)];
        add(&mut [version, [bands, glossy], [directions, 0], counts]
            .concat()
            .into_iter());
        let floats = object.positions.iter().chain(object.normals).flatten();
        add(&mut floats.map(|c| c.to_bits()));
        add(&mut object.triangles.iter().flatten().copied());
        Self(*hasher.finalize().as_bytes())
    }

    /// The hash.
    pub fn bytes(&self) -> [u8; 32] {
        self.0
    }

    /// Name of a file of such transport.
    pub fn file_name(&self) -> String {
        format!("{}.gnomprt", blake3::Hash::from_bytes(self.0).to_hex())
    }
}
