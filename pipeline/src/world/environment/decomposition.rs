//! An environment cut into regions, each of which a light stands for (Kollig and Keller,
//! "Efficient Illumination by High Dynamic Range Images", 2003, as Tamura et al. 2006
//! use it).
//!
//! Lloyd's relaxation on the sphere: every texel belongs to the nearest site, and every
//! site moves to the mean of its texels' directions weighted by their luminance, until
//! no texel changes sides. Sites begin where the running sum of luminance passes equal
//! shares, moved by a seed. A site without texels goes where most luminance is far from
//! its own. Ties go to the lowest number, everywhere.
//!
//! Regions are all of the sphere, and energy is counted in whole units: lights sum to
//! the map exactly.

use glam::DVec3;

use super::cube::{CubeMap, direction, luminance, sum};

/// How to cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DecompositionSettings {
    /// Number of regions; fewer where the map has fewer texels.
    pub lights: usize,
    /// Moves the sites that relaxation begins with.
    pub seed: u64,
}

/// A region and the light that stands for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Unit vector to the centroid.
    pub towards: DVec3,
    /// Energy of its texels, in units of the map.
    pub energy: [u64; 3],
    /// Its solid angle, steradians.
    pub angle: f64,
    /// Solid angle of the square from which as much light would spread as much:
    /// six times the mean square of the distance to the centroid. Less than the region's where
    /// it has a small bright spot.
    pub spread: f64,
}

/// Most steps of relaxation; it has settled long before.
const MOST_STEPS: usize = 64;

/// Cuts `cube`; regions with energy, brightest first.
pub fn decompose(cube: &CubeMap, settings: &DecompositionSettings) -> Vec<Region> {
    let texels = texels(cube);
    let mut sites = first_sites(&texels, settings);
    let mut owner = vec![0; texels.len()];
    for step in 0..MOST_STEPS {
        let nearest: Vec<usize> = texels.iter().map(|t| t.nearest(&sites)).collect();
        if step > 0 && nearest == owner {
            break;
        }
        owner = nearest;
        move_sites(&mut sites, &texels, &owner);
    }
    let mut regions: Vec<Region> = (0..sites.len())
        .filter_map(|site| region(cube, &texels, &owner, site))
        .collect();
    // A stable sort: equals stay in the order of their sites.
    regions.sort_by_key(|r| std::cmp::Reverse(luminance(r.energy)));
    regions
}

struct Texel {
    towards: DVec3,
    luminance: u64,
}

impl Texel {
    /// Number of the nearest site, the first of equals.
    fn nearest(&self, sites: &[DVec3]) -> usize {
        let near = |best: (usize, f64), (site, at): (usize, &DVec3)| {
            let cosine = at.dot(self.towards);
            if cosine > best.1 {
                (site, cosine)
            } else {
                best
            }
        };
        sites
            .iter()
            .enumerate()
            .fold((0, f64::NEG_INFINITY), near)
            .0
    }

    /// What it would cost to leave it to a site.
    fn cost(&self, site: DVec3) -> f64 {
        self.luminance as f64 * (self.towards - site).length_squared()
    }
}

fn texels(cube: &CubeMap) -> Vec<Texel> {
    let side = cube.side();
    let middle = |k: usize| 0.5 * (cube.edge(k) + cube.edge(k + 1));
    let texel = |(i, energy): (usize, &[u64; 3])| {
        let at = [i % side, i / side % side].map(middle);
        Texel {
            towards: direction(i / (side * side), at).normalize(),
            luminance: luminance(*energy),
        }
    };
    cube.texels().iter().enumerate().map(texel).collect()
}

/// Where the running sum of luminance passes equal shares.
fn first_sites(texels: &[Texel], settings: &DecompositionSettings) -> Vec<DVec3> {
    let count = settings.lights.clamp(1, texels.len());
    let total: u64 = texels.iter().map(|t| t.luminance).sum();
    let shift = share(settings.seed);
    let (mut texel, mut before) = (0, 0u64);
    let mut site = |k: usize| {
        let wanted = (k as f64 + shift) / count as f64 * total as f64;
        while texel + 1 < texels.len() && (before + texels[texel].luminance) as f64 <= wanted {
            before += texels[texel].luminance;
            texel += 1;
        }
        texels[texel].towards
    };
    (0..count).map(&mut site).collect()
}

/// A number in 0..1 for each seed (splitmix64).
fn share(seed: u64) -> f64 {
    let mut z = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 11) as f64 / (1u64 << 53) as f64
}

/// Each site to the centroid of what it owns.
fn move_sites(sites: &mut [DVec3], texels: &[Texel], owner: &[usize]) {
    let mut sums = vec![(DVec3::ZERO, DVec3::ZERO, 0usize); sites.len()];
    for (texel, &site) in texels.iter().zip(owner) {
        let (bright, plain, count) = &mut sums[site];
        *bright += texel.towards * texel.luminance as f64;
        *plain += texel.towards;
        *count += 1;
    }
    let old = sites.to_vec();
    let mut taken: Vec<usize> = Vec::new();
    for (site, (bright, plain, count)) in sums.into_iter().enumerate() {
        sites[site] = if count == 0 {
            let texel = farthest(texels, owner, &old, &taken);
            taken.push(texel);
            texels[texel].towards
        } else {
            // A region without light is where it is.
            let mean = bright.normalize_or(plain.normalize_or_zero());
            if mean == DVec3::ZERO { old[site] } else { mean }
        };
    }
}

/// The texel that costs most where it is, the first of equals, and none of `taken`.
fn farthest(texels: &[Texel], owner: &[usize], sites: &[DVec3], taken: &[usize]) -> usize {
    let mut best = (0, f64::NEG_INFINITY);
    for (i, texel) in texels.iter().enumerate() {
        let cost = texel.cost(sites[owner[i]]);
        if cost > best.1 && !taken.contains(&i) {
            best = (i, cost);
        }
    }
    best.0
}

fn region(cube: &CubeMap, texels: &[Texel], owner: &[usize], site: usize) -> Option<Region> {
    let own: Vec<usize> = (0..texels.len()).filter(|&i| owner[i] == site).collect();
    let energies: Vec<[u64; 3]> = own.iter().map(|&i| cube.texels()[i]).collect();
    let energy = sum(&energies);
    let total = luminance(energy);
    if total == 0 {
        return None;
    }
    let weighted = |i: usize| texels[i].towards * texels[i].luminance as f64;
    let towards = own.iter().map(|&i| weighted(i)).sum::<DVec3>();
    let towards = towards.normalize_or(texels[own[0]].towards);
    // Of a square of area A the mean square distance from the middle is A / 6; texels
    // are squares themselves.
    let spread = |i: &usize| {
        texels[*i].cost(towards) * 6.0 + texels[*i].luminance as f64 * cube.texel_angle(*i)
    };
    Some(Region {
        towards,
        energy,
        angle: own.iter().map(|&i| cube.texel_angle(i)).sum(),
        spread: own.iter().map(spread).sum::<f64>() / total as f64,
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::world::environment::{Environment, MapSettings, SKY};

    fn sky(side: usize) -> CubeMap {
        let settings = MapSettings {
            side,
            ..MapSettings::default()
        };
        Environment::open(SKY, settings).unwrap().cube
    }

    fn white(side: usize) -> CubeMap {
        CubeMap::new(side, vec![[1.0; 3]; 6 * side * side]).unwrap()
    }

    fn cut(cube: &CubeMap, lights: usize, seed: u64) -> Vec<Region> {
        decompose(cube, &DecompositionSettings { lights, seed })
    }

    /// Sum over texels of luminance times squared distance to their light.
    fn cost(cube: &CubeMap, regions: &[Region]) -> f64 {
        let sites: Vec<DVec3> = regions.iter().map(|r| r.towards).collect();
        let texels = texels(cube);
        texels
            .iter()
            .map(|t| t.cost(sites[t.nearest(&sites)]))
            .sum()
    }

    #[test]
    fn regions_are_the_whole_map() {
        for (cube, lights) in [(sky(16), 16), (sky(32), 32), (white(8), 64), (sky(1), 32)] {
            let regions = cut(&cube, lights, 1);
            assert!(regions.len() <= lights && regions.len() >= lights.min(6));
            let energies: Vec<_> = regions.iter().map(|r| r.energy).collect();
            assert_eq!(sum(&energies), cube.total());
            let angle: f64 = regions.iter().map(|r| r.angle).sum();
            assert!((angle / (4.0 * PI) - 1.0).abs() < 1e-12, "{angle}");
            let sorted = energies
                .windows(2)
                .all(|p| luminance(p[0]) >= luminance(p[1]));
            assert!(sorted);
        }
    }

    #[test]
    fn seeds_move_regions_and_nothing_else_does() {
        let cube = sky(16);
        assert_eq!(cut(&cube, 16, 1), cut(&cube, 16, 1));
        assert_ne!(cut(&cube, 16, 1), cut(&cube, 16, 2));
    }

    /// Relaxed sites cost less than those it began with, and more sites less still.
    #[test]
    fn relaxation_brings_lights_nearer_to_the_light() {
        let cube = sky(32);
        let settings = DecompositionSettings {
            lights: 32,
            seed: 1,
        };
        let texels = texels(&cube);
        let first = first_sites(&texels, &settings);
        let before: f64 = texels
            .iter()
            .map(|t| t.cost(first[t.nearest(&first)]))
            .sum();
        let [few, many] = [32, 64].map(|n| cost(&cube, &cut(&cube, n, 1)));
        assert!(
            few < 0.7 * before && many < 0.7 * few,
            "{before} {few} {many}"
        );
    }

    /// Regions of a white map are about equal, and as spread as they are large; the
    /// sun's is much less spread than its region is.
    #[test]
    fn spread_is_the_solid_angle_of_even_light() {
        for region in cut(&white(32), 32, 1) {
            let ratio = region.spread / region.angle;
            assert!((0.85..1.5).contains(&ratio), "{region:?}");
            let share = region.angle / (4.0 * PI / 32.0);
            assert!((0.4..1.8).contains(&share), "{region:?}");
        }
        let sun = DVec3::new(0.478, 0.669, 0.569).normalize();
        let regions = cut(&sky(64), 32, 1);
        let of_sun = regions.iter().find(|r| r.towards.dot(sun) > 0.99).unwrap();
        assert!(of_sun.spread < 0.35 * of_sun.angle, "{of_sun:?}");
    }
}
