//! Penumbra wedges, outlined.

use std::collections::BTreeMap;

use glam::{DMat4, DVec4};
use gnomon_pipeline::geometry::wedge::{Construction, WedgeMesh};
use gnomon_pipeline::technique::WedgeKind;

use super::Source;
use crate::draw::{Canvas, Legend, Picture, Projection, Stroke, Swatch, heat};

const WEDGE: [u8; 3] = [255, 170, 60];
const APEX: [u8; 3] = [90, 190, 255];
/// Faces that lean from one another by less have no edge between them.
const FLAT: f64 = 1e-6;

pub(super) fn draw(source: &Source<'_>) -> Picture {
    let picture = source.picture();
    let mut canvas = Canvas::dimmed(&picture, 0.6);
    let projection = Projection::new(&source.scene.camera, picture.size);
    let meshes = source.wedges.map_or(&[][..], |w| &w.meshes);
    // Many wedges overlap; each then says less.
    let opacity = (8.0 / meshes.len().max(1) as f32).clamp(0.06, 0.7);
    for mesh in meshes {
        for face in &mesh.triangles {
            let corners = face.map(|i| narrow(mesh.vertices[i as usize]));
            canvas.fill(&projection.polygon(&corners), WEDGE, opacity * 0.15);
        }
        for edge in outline(mesh) {
            let ends = edge.map(|i| mesh.vertices[i as usize]);
            let is_apex = ends.iter().all(|v| v.w != 0.0);
            let stroke = Stroke {
                colour: if is_apex { APEX } else { WEDGE },
                opacity: if is_apex { 0.9 } else { opacity },
                width: if is_apex { 1.6 } else { 1.0 },
            };
            if let Some(seen) = projection.segment(ends.map(narrow)) {
                canvas.line(&seen.map(|p| p.at), false, stroke);
            }
        }
    }
    make_legend(source, meshes).below(canvas, heat)
}

fn make_legend(source: &Source<'_>, meshes: &[WedgeMesh]) -> Legend {
    let kind = source.wedges.map(|w| w.kind);
    let faces: usize = meshes.iter().map(|m| m.triangles.len()).sum();
    let (finite, note) = match kind {
        Some(WedgeKind::Linked) => (
            "edges that they start from, and where their planes meet",
            "neighbours share side planes; light falls off from front to back plane",
        ),
        Some(WedgeKind::Single(Construction::Exact)) => (
            "edges that they start from",
            "whoever is in a wedge sees its edge cut the light, and nobody else",
        ),
        _ => (
            "edges that they start from",
            "whoever sees an edge cut the light is in its wedge, and others are",
        ),
    };
    let name = kind.map_or("none", WedgeKind::name);
    Legend {
        title: format!("Penumbra wedges ({name}): {}", meshes.len()),
        swatches: vec![
            Swatch::new(WEDGE, format!("sides, to infinity: {faces} triangles")),
            Swatch::new(APEX, finite.to_owned()),
        ],
        notes: vec![note.to_owned()],
        ..Legend::default()
    }
}

fn narrow(v: DVec4) -> [f32; 4] {
    v.to_array().map(|c| c as f32)
}

/// Edges between faces that are not in one plane, each once; those at infinity are
/// left out.
fn outline(mesh: &WedgeMesh) -> Vec<[u32; 2]> {
    let mut beside: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    for &[a, b, c] in &mesh.triangles {
        for [from, to, other] in [[a, b, c], [b, c, a], [c, a, b]] {
            let key = [from.min(to), from.max(to)];
            beside.entry(key).or_default().push(other);
        }
    }
    let vertex = |i: u32| mesh.vertices[i as usize];
    let finite = |[a, b]: [u32; 2]| vertex(a).w != 0.0 || vertex(b).w != 0.0;
    let sharp = |(ends, others): &(&[u32; 2], &Vec<u32>)| match others[..] {
        [c, d] => !coplanar([vertex(ends[0]), vertex(ends[1]), vertex(c), vertex(d)]),
        _ => true,
    };
    let all = beside.iter().filter(sharp);
    all.map(|(ends, _)| *ends).filter(|e| finite(*e)).collect()
}

/// Whether four homogeneous points lie in one plane.
fn coplanar(points: [DVec4; 4]) -> bool {
    let [a, b, c, d] = points.map(DVec4::normalize_or_zero);
    DMat4::from_cols(a, b, c, d).determinant().abs() < FLAT
}

#[cfg(test)]
mod tests {
    use gnomon_pipeline::technique::Params;
    use gnomon_pipeline::techniques::find;
    use gnomon_pipeline::world::scene::builtin;

    use super::*;

    /// An edge parallel to a side of a square light: four planes, so two rays leave
    /// each of its ends, whatever triangles they are drawn with.
    #[test]
    fn outlines_have_the_edge_and_its_rays() {
        let scene = builtin::build("parallel-plates").unwrap();
        let technique = find("soft-shadow-volumes").unwrap();
        let params = Params::defaults(technique);
        let wedges = technique.wedges(&scene, &params);
        let wedges = wedges.unwrap().unwrap().meshes;
        assert_eq!(wedges.len(), 4);
        for mesh in &wedges {
            let edges = outline(mesh);
            let apexes = edges
                .iter()
                .filter(|e| e.iter().all(|i| mesh.vertices[*i as usize].w != 0.0));
            assert_eq!(apexes.count(), 1);
            assert_eq!(edges.len(), 1 + 2 * 2, "{edges:?}");
            assert!(edges.len() < 3 * mesh.triangles.len() / 2);
        }
    }
}
