//! Seeded random cases: the same numbers on every machine.

mod case;
mod draw;
mod geometry;
mod look_up;
mod misuse;
mod state;
mod texture;

pub use case::{case_of, random_case};
pub use geometry::{Screen, grid_triangulation};
pub use misuse::misuse;
pub use texture::{sampler as random_sampler, texture as random_texture};

/// PCG-XSH-RR, 64 bits of state, 32 of output.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
    /// What it says first, last number first.
    given: Vec<u32>,
}

impl Random {
    /// A generator of its own for each seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut r = Self {
            state: seed.wrapping_mul(0x9e37_79b9_7f4a_7c15),
            given: Vec::new(),
        };
        r.next();
        r.next();
        r
    }

    /// Numbers of these bytes, so that whoever chooses bytes chooses the case; when they
    /// are used up, those of seed 0.
    #[must_use]
    pub fn of_bytes(bytes: &[u8]) -> Self {
        let words = bytes.chunks_exact(4).rev();
        Self {
            given: words
                .map(|w| u32::from_le_bytes([w[0], w[1], w[2], w[3]]))
                .collect(),
            ..Self::new(0)
        }
    }

    /// 32 random bits.
    #[allow(
        clippy::should_implement_trait,
        reason = "an endless generator is no iterator here"
    )]
    pub fn next(&mut self) -> u32 {
        if let Some(word) = self.given.pop() {
            return word;
        }
        let s = self.state;
        self.state = s
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((((s >> 18) ^ s) >> 27) as u32).rotate_right((s >> 59) as u32)
    }

    /// 0..n.
    pub fn below(&mut self, n: u32) -> u32 {
        ((u64::from(self.next()) * u64::from(n)) >> 32) as u32
    }

    /// lo..=hi.
    pub fn between(&mut self, lo: i32, hi: i32) -> i32 {
        lo + self.below((hi - lo + 1) as u32) as i32
    }

    /// True once in n times.
    pub fn one_in(&mut self, n: u32) -> bool {
        self.below(n) == 0
    }

    /// lo..hi in 2²⁴ steps.
    pub fn float(&mut self, lo: f32, hi: f32) -> f32 {
        lo + (hi - lo) * ((self.next() >> 8) as f32 / 16_777_216.0)
    }

    /// One of the list.
    pub fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len() as u32) as usize]
    }

    /// A clone of one of the list.
    pub fn pick_ref<T: Clone>(&mut self, list: &[T]) -> T {
        list[self.below(list.len() as u32) as usize].clone()
    }

    /// An array of what `f` gives.
    pub fn array<T, const N: usize>(&mut self, mut f: impl FnMut(&mut Self) -> T) -> [T; N] {
        std::array::from_fn(|_| f(self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_hold_and_seeds_differ() {
        let mut r = Random::new(1);
        for _ in 0..1000 {
            assert!((-3..=4).contains(&r.between(-3, 4)));
            assert!((0.5..2.0).contains(&r.float(0.5, 2.0)));
        }
        assert_ne!(Random::new(2).next(), Random::new(3).next());
        assert_eq!(
            Random::new(7).array::<_, 3>(Random::next),
            Random::new(7).array::<_, 3>(Random::next)
        );
    }

    #[test]
    fn bytes_are_the_first_numbers() {
        let mut r = Random::of_bytes(&[1, 0, 0, 0, 0, 1, 0, 0, 9]);
        assert_eq!([r.next(), r.next()], [1, 256]);
        assert_eq!(r.next(), Random::new(0).next());
    }
}
