//! The triangles that the peers' coverage was measured with.
//!
//! The generator and the classes are those of the coverage script beside the
//! peers, so that seed and class name the same triangle in both.

/// state = state·6364136223846793005 + 1442695040888963407; output = (state >> 33) mod n.
#[derive(Clone, Debug)]
pub struct Lcg(u64);

impl Lcg {
    /// A generator of its own for each seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut g = Self(seed.wrapping_mul(2).wrapping_add(1));
        for _ in 0..4 {
            g.below(2);
        }
        g
    }

    /// 0..n.
    pub fn below(&mut self, n: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }

    /// lo..=hi.
    pub fn between(&mut self, lo: i64, hi: i64) -> i64 {
        lo + self.below((hi - lo + 1) as u64) as i64
    }

    /// A point with coordinates in lo..=hi, multiples of 1/unit.
    fn point(&mut self, lo: i64, hi: i64, unit: i64) -> [f64; 2] {
        let x = self.between(lo * unit, hi * unit) as f64 / unit as f64;
        [x, self.between(lo * unit, hi * unit) as f64 / unit as f64]
    }

    /// A point half-way between multiples of 2/unit.
    fn tie(&mut self, lo: i64, hi: i64, unit: i64) -> [f64; 2] {
        let x = (2 * self.between(lo, hi) + 1) as f64 / unit as f64;
        [x, (2 * self.between(lo, hi) + 1) as f64 / unit as f64]
    }

    /// A point at most `reach`/256 from another.
    fn near(&mut self, a: [f64; 2], reach: i64) -> [f64; 2] {
        let x = a[0] + self.between(-reach, reach) as f64 / 256.0;
        [x, a[1] + self.between(-reach, reach) as f64 / 256.0]
    }
}

/// Names of the classes.
pub const CLASSES: [&str; 11] = [
    "grid256",
    "fine",
    "sliver",
    "subpixel",
    "centres",
    "ties512",
    "shared",
    "guardband",
    "far",
    "degenerate",
    "ties32",
];

/// Side of the square target.
pub const TARGET: u32 = 64;

/// Corners in pixels.
pub type PixelTriangle = [[f64; 2]; 3];

/// The next triangle of a class, or the next two.
fn next(class: usize, g: &mut Lcg) -> Vec<PixelTriangle> {
    let mut three = |lo, hi, unit| {
        vec![[
            g.point(lo, hi, unit),
            g.point(lo, hi, unit),
            g.point(lo, hi, unit),
        ]]
    };
    match CLASSES[class] {
        "grid256" => three(1, 63, 256),
        "fine" => three(1, 63, 65536),
        "centres" => three(1, 63, 2),
        "guardband" => three(-30, 94, 256),
        "far" => three(-2000, 2000, 256),
        "sliver" => vec![sliver(g)],
        "degenerate" => vec![degenerate(g)],
        "ties512" => vec![[
            g.tie(512, 16000, 512),
            g.tie(512, 16000, 512),
            g.tie(512, 16000, 512),
        ]],
        "ties32" => vec![[
            g.tie(32, 1000, 32),
            g.tie(32, 1000, 32),
            g.tie(32, 1000, 32),
        ]],
        "subpixel" => {
            let a = g.point(2, 62, 256);
            vec![[a, g.near(a, 384), g.near(a, 384)]]
        }
        _ => {
            let [a, b, p, q] = [
                g.point(1, 63, 256),
                g.point(1, 63, 256),
                g.point(1, 63, 256),
                g.point(1, 63, 256),
            ];
            vec![[a, b, p], [b, a, q]]
        }
    }
}

fn sliver(g: &mut Lcg) -> PixelTriangle {
    let (a, b) = (g.point(1, 63, 256), g.point(1, 63, 256));
    let k = g.between(0, 256) as f64;
    let m =
        [0, 1].map(|i| ((a[i] * 256.0 * (256.0 - k) + b[i] * 256.0 * k) / 256.0).floor() / 256.0);
    [a, b, g.near(m, 96)]
}

fn degenerate(g: &mut Lcg) -> PixelTriangle {
    let a = g.point(8, 40, 256);
    let d = [g.between(-1024, 1024), g.between(-1024, 1024)].map(|v| v as f64 / 256.0);
    let (k, m) = (g.between(0, 4) as f64, g.between(-1, 5) as f64);
    [
        a,
        [a[0] + k * d[0], a[1] + k * d[1]],
        [a[0] + m * d[0], a[1] + m * d[1]],
    ]
}

/// Triangles of one class, at least `count` of them.
#[must_use]
pub fn triangles(class: usize, count: usize, seed: u64) -> Vec<PixelTriangle> {
    let mut g = Lcg::new(seed * 1000 + class as u64);
    let mut list = Vec::new();
    while list.len() < count {
        list.extend(next(class, &mut g));
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twin::covered_pixels;

    #[test]
    fn the_generator_gives_the_peers_numbers() {
        let mut g = Lcg::new(1000);
        let first: Vec<_> = (0..4).map(|_| g.below(1000)).collect();
        assert_eq!(first, [419, 271, 155, 258]);
    }

    /// Covered pixels, and the sum of covered (pixel number + 1) mod 1000003, of
    /// the first 40 triangles of each class with seed 1, as the coverage script's
    /// exact integer rule (8 bits, half-even, top-left) gives them.
    const PEERS: [(u64, u64); 11] = [
        (10931, 860_534),
        (15135, 223_362),
        (98, 214_446),
        (19, 33854),
        (11362, 254_567),
        (11971, 372_193),
        (13671, 472_109),
        (30587, 9760),
        (39737, 385_923),
        (0, 0),
        (9316, 156_349),
    ];

    #[test]
    fn the_twin_covers_what_the_peers_integer_rule_covers() {
        for (class, expected) in PEERS.into_iter().enumerate() {
            let (mut count, mut sum) = (0, 0);
            for t in triangles(class, 40, 1) {
                let snapped =
                    t.map(|p| p.map(|v| (256.0 * f64::from(v as f32)).round_ties_even() as i64));
                let pixels = covered_pixels(snapped, TARGET, TARGET);
                for (i, _) in pixels.iter().enumerate().filter(|(_, covered)| **covered) {
                    count += 1;
                    sum += i as u64 + 1;
                }
            }
            assert_eq!(
                (count, sum % 1_000_003),
                expected,
                "class {}",
                CLASSES[class]
            );
        }
    }
}
