//! Edges and wedges for people.

use gnomon_pipeline::geometry::wedge::{Construction, Wedge};
use gnomon_pipeline::measure::visibility_sum::SilhouetteEdge;
use gnomon_pipeline::world::scene::Scene;

use super::run::Shown;
use crate::output::tables::Table;

/// How a wedge is built, in a word.
pub(super) fn construction(of: Construction) -> &'static str {
    match of {
        Construction::Exact => "exact",
        Construction::Tight => "tight",
        Construction::BoundingSphere => "sphere",
    }
}

/// All edges with their numbers.
pub(super) fn edges(scene: &Scene, light: usize, edges: &[SilhouetteEdge]) -> String {
    let title = format!(
        "{}: {} silhouette edges from the centre of light {light}",
        scene.name,
        edges.len()
    );
    let mut table = Table::new(&title, &["edge", "caster", "vertices", "from", "to"]);
    for (number, edge) in edges.iter().enumerate() {
        let [from, to] = edge.ends.map(|e| point(e.to_array()));
        table.rows.push(vec![
            number.to_string(),
            scene.objects[edge.object].name.clone(),
            format!("{} {}", edge.vertices[0], edge.vertices[1]),
            from,
            to,
        ]);
    }
    table.to_text()
}

/// One wedge.
pub(super) fn wedge(shown: &Shown<'_>, written: &[String]) -> String {
    let [from, to] = shown.edge.ends.map(|e| point(e.to_array()));
    let mut text = format!(
        "{}, light {}, edge {} of {}: {from} to {to}\n",
        shown.scene.name, shown.light, shown.number, shown.scene.objects[shown.edge.object].name,
    );
    if shown.wedges.is_empty() {
        text += "no wedge: the edge is behind the light, in its plane, or without length\n";
    }
    for (i, wedge) in shown.wedges.iter().enumerate() {
        text += &format!("wedge {i}: {}\n", describe(wedge));
    }
    let t = shown.map.totals();
    let [width, height] = shown.map.size;
    text += &format!(
        "of {width}x{height} pixels it adds at {}, up to {:.6}, and takes at {}, up to {:.6}\n",
        t.adding, t.most_added, t.taking, t.most_taken
    );
    for path in written {
        text += &format!("wrote {path}\n");
    }
    text
}

/// How it was built, and its parts.
fn describe(wedge: &Wedge) -> String {
    let mesh = wedge.volume.mesh();
    let halves = match wedge.halves() {
        Some(h) => format!(
            "outer half {} triangles, inner half {}",
            h.outer.triangles.len(),
            h.inner.triangles.len()
        ),
        None => "no halves: nothing to split by".to_owned(),
    };
    format!(
        "{}, {} planes, {} triangles; {halves}",
        construction(wedge.construction),
        wedge.volume.planes().len(),
        mesh.triangles.len()
    )
}

fn point([x, y, z]: [f64; 3]) -> String {
    format!("{x:.4} {y:.4} {z:.4}")
}
