//! What there is to choose from.

use clap::ValueEnum;

use super::orbit::Pose;
use crate::overlay::OverlayKind;

/// What the scene and the registry have; nothing of it changes.
#[derive(Clone, Debug)]
pub(super) struct Facts {
    /// The scene's name.
    pub(super) scene: String,
    /// Lights of the scene.
    pub(super) lights: usize,
    /// Whether a map lights the scene.
    pub(super) has_environment: bool,
    /// Where the eye is at first.
    pub(super) home: Pose,
    /// The size that was asked for; as large as the terminal where there is none.
    pub(super) size: Option<[u32; 2]>,
    /// The techniques.
    pub(super) techniques: Vec<TechniqueFacts>,
}

/// A technique that may be chosen.
#[derive(Clone, Debug)]
pub(super) struct TechniqueFacts {
    /// Its name.
    pub(super) name: &'static str,
    /// Whether it takes each of the lights.
    pub(super) takes: Vec<bool>,
    /// Whether it builds wedges.
    pub(super) has_wedges: bool,
    /// Whether it adds coverage up in 8-bit channels.
    pub(super) has_carries: bool,
}

impl TechniqueFacts {
    /// Whether it takes what shines: one light, or all.
    pub(super) fn takes(&self, light: Option<usize>) -> bool {
        match light {
            Some(one) => self.takes.get(one) == Some(&true),
            None => self.takes.iter().all(|t| *t),
        }
    }
}

impl Facts {
    /// The next technique that takes `light`, `by` places from `from`; itself where there is
    /// no other.
    pub(super) fn technique_after(&self, from: usize, by: i32, light: Option<usize>) -> usize {
        let count = self.techniques.len();
        let place = |k: usize| (from as i64 + k as i64 * i64::from(by)).rem_euclid(count as i64);
        let others = (1..count).map(|k| place(k) as usize);
        let mut fit = others.filter(|t| self.techniques[*t].takes(light));
        fit.next().unwrap_or(from)
    }

    /// The overlays of a technique's frame, in order.
    pub(super) fn overlays(&self, technique: usize) -> Vec<OverlayKind> {
        let of = &self.techniques[technique];
        let has = |kind: &&OverlayKind| match kind {
            OverlayKind::Wedges => of.has_wedges,
            OverlayKind::Carries => of.has_carries,
            OverlayKind::EnvLights => self.has_environment,
            _ => true,
        };
        let all = OverlayKind::value_variants().iter();
        all.filter(has).copied().collect()
    }

    /// The next overlay, or none behind the last.
    pub(super) fn overlay_after(
        &self,
        from: Option<OverlayKind>,
        by: i32,
        technique: usize,
    ) -> Option<OverlayKind> {
        let all = self.overlays(technique);
        let at = from.and_then(|kind| all.iter().position(|k| *k == kind));
        let place = at.map_or(0, |k| k as i64 + 1) + i64::from(by);
        match place.rem_euclid(all.len() as i64 + 1) {
            0 => None,
            k => all.get(k as usize - 1).copied(),
        }
    }
}
