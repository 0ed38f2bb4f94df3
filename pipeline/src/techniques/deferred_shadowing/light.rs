//! The environment in spherical harmonics.

use std::sync::Arc;

use super::sources::map_hash;
use crate::geometry::harmonics::{Basis, Product, Rotation};
use crate::world::environment::CubeMap;
use crate::world::environment::cube::direction;
use crate::world::memo::Memo;

/// Light of an environment, by colour.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct HarmonicLight {
    /// Coefficients.
    pub(super) light: [Vec<f64>; 3],
    /// As a matrix; none where nothing is glossy.
    pub(super) product: Option<[Product; 3]>,
}

static KEPT: Memo<HarmonicLight> = Memo::new(4 << 20);

impl HarmonicLight {
    /// Of a map: energy of each texel at its middle. Kept by content.
    pub(super) fn of_map(cube: &CubeMap, bands: usize, glossy_bands: Option<usize>) -> Arc<Self> {
        let mut hasher = map_hash(cube);
        hasher.update(&[bands as u8, glossy_bands.map_or(0, |b| b as u8)]);
        let key = *hasher.finalize().as_bytes();
        KEPT.get(key, |_| 32 << 10, || Self::new(cube, bands, glossy_bands))
    }

    fn new(cube: &CubeMap, bands: usize, glossy_bands: Option<usize>) -> Self {
        let most = glossy_bands.map_or(bands, |g| g.max(bands));
        let basis = Basis::new(most);
        let mut y = vec![0.0; most * most];
        let mut light = [(); 3].map(|()| vec![0.0; bands * bands]);
        let mut product = glossy_bands.map(|g| [(); 3].map(|()| Product::dark(g)));
        let side = cube.side();
        for (i, units) in cube.texels().iter().enumerate() {
            let at = [i % side, i / side % side].map(|k| 0.5 * (cube.edge(k) + cube.edge(k + 1)));
            basis.write(direction(i / (side * side), at).normalize(), &mut y);
            for (c, energy) in cube.energy(*units).into_iter().enumerate() {
                light[c]
                    .iter_mut()
                    .zip(&y)
                    .for_each(|(v, y)| *v += energy * y);
                if let Some(product) = &mut product {
                    product[c].add(energy, &y);
                }
            }
        }
        Self { light, product }
    }

    /// Of `bands` bands, turned: by the inverse of an object's turn, it is the light in
    /// the object's axes.
    pub(super) fn turned(&self, by: &Rotation) -> [Vec<f64>; 3] {
        self.light.each_ref().map(|light| by.apply(light))
    }
}
