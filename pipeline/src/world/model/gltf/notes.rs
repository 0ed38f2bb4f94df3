//! What of a file is not drawn as it says, each told once.

use super::schema::{Material, Root};
use crate::world::tally::Tally;
use crate::world::warning::SceneWarning;

/// What was met.
#[derive(Default)]
pub(super) struct Notes {
    /// Nodes whose mesh bends with bones.
    pub(super) skins: Tally,
    /// Primitives that have other shapes to blend with.
    pub(super) morphs: Tally,
    /// Points and lines.
    pub(super) lines: Tally,
    /// Vertex colours.
    pub(super) colours: Tally,
    /// Triangles that lack a corner.
    pub(super) cut: Tally,
    /// Triangles without corners of their own.
    pub(super) degenerate: Tally,
    /// Cameras that are not drawn from.
    pub(super) cameras: Tally,
    /// Spot lights, drawn as points.
    pub(super) spots: Tally,
    /// Lights that are brighter nearby.
    pub(super) falloff: Tally,
    /// Channels of an animation that move no node.
    pub(super) channels: Tally,
    /// Texture coordinates that cannot be used.
    pub(super) coordinates: Tally,
    /// Pictures that cannot be used.
    pub(super) missing_maps: Tally,
    /// Base colours outside 0..=1.
    pub(super) limited: Tally,
}

impl Notes {
    /// All that was met, and what the file has besides.
    pub(super) fn warnings(&self, root: &Root, supported: &[&str]) -> Vec<SceneWarning> {
        let [maps, glow, glass] = materials(root);
        let all = [
            self.degenerate.warning(
                "degenerate-faces",
                "faces whose corners repeat so that they cover nothing were left out",
            ),
            (self.cut).warning("skipped-faces", "triangles that lack a corner were skipped"),
            self.lines.warning(
                "ignored-lines",
                "points and lines were ignored; only triangles are drawn",
            ),
            self.skins.warning(
                "ignored-skins",
                "meshes with skins are drawn as they were bound, not as their bones stand",
            ),
            self.morphs.warning(
                "ignored-morphs",
                "morph targets were ignored; meshes have their own shape",
            ),
            animations(root).warning(
                "ignored-animations",
                "animations after the first were ignored; that one is played",
            ),
            self.channels.warning(
                "ignored-channels",
                "channels of an animation that move no node, such as weights of morph targets, were ignored",
            ),
            self.colours.warning(
                "ignored-colours",
                "colours of vertices were ignored; base colours are used",
            ),
            maps.warning(
                "ignored-maps",
                "textures of other things than base colours were ignored",
            ),
            self.coordinates.warning(
                "bad-coordinates",
                "texture coordinates cannot be used and are 0",
            ),
            self.missing_maps.warning(
                "missing-maps",
                "pictures of base colours cannot be used; their factors alone are",
            ),
            glow.warning("ignored-emission", "surfaces that shine light nothing"),
            glass.warning(
                "ignored-transparency",
                "materials that let light through were drawn opaque",
            ),
            self.limited
                .warning("limited-colours", "base colours were limited to 0..=1"),
            self.cameras.warning(
                "ignored-cameras",
                "cameras were ignored; the first one in perspective is used",
            ),
            self.spots
                .warning("spot-lights", "spot lights shine to all sides, as points do"),
            self.falloff.warning(
                "light-units",
                "lights shine everywhere as they do at the middle of the model, the brightest with 1",
            ),
            extensions(root, supported)
                .warning("ignored-extensions", "extensions were ignored"),
        ];
        all.into_iter().flatten().collect()
    }
}

fn animations(root: &Root) -> Tally {
    let mut tally = Tally::default();
    let others = root.animations.len().saturating_sub(1);
    tally.add_many(others, || "animations[1]".to_owned());
    tally
}

/// Materials with textures, with emission, and with transparency.
fn materials(root: &Root) -> [Tally; 3] {
    let mut tallies: [Tally; 3] = Default::default();
    for (number, material) in root.materials.iter().enumerate() {
        let name = || match &material.name {
            Some(name) => format!("'{name}'"),
            None => format!("materials[{number}]"),
        };
        let glows = material.emissive_factor.is_some_and(|e| e != [0.0; 3]);
        let glass = !matches!(material.alpha_mode.as_deref(), None | Some("OPAQUE"));
        for (tally, met) in tallies.iter_mut().zip([has_maps(material), glows, glass]) {
            tally.add_many(usize::from(met), name);
        }
    }
    tallies
}

fn has_maps(material: &Material) -> bool {
    let pbr = &material.pbr_metallic_roughness;
    let textures = [
        &pbr.metallic_roughness_texture,
        &material.normal_texture,
        &material.emissive_texture,
    ];
    textures.into_iter().any(Option::is_some)
}

fn extensions(root: &Root, supported: &[&str]) -> Tally {
    let mut tally = Tally::default();
    for name in &root.extensions_used {
        if !supported.contains(&name.as_str()) {
            tally.add(|| format!("'{name}'"));
        }
    }
    tally
}
