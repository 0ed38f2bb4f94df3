//! The sum for people.

use gnomon_pipeline::measure::visibility_sum::SeenLight;

use super::run::View;
use crate::output::tables::Table;

/// What the surface is, the summands, their sum and the truth.
pub(super) fn text(view: &View) -> String {
    let [x, y] = view.pixel;
    let [width, height] = view.size;
    let p = view.receiver.point;
    let mut text = format!(
        "{}, {width}x{height}, pixel {x} {y}: {}, triangle {}, at {:.6} {:.6} {:.6}\n\
         light {}: {}\n\n",
        view.scene.name,
        view.object(view.hit.object as usize),
        view.hit.triangle,
        p.x,
        p.y,
        p.z,
        view.light,
        kind(view.seen.as_ref()),
    );
    match &view.seen {
        Some(seen) => text += &summands(view, seen),
        None => text += "the surface is in the light's plane, or inside it: nothing is added up\n",
    }
    text += &format!("exact {:.9}\n", view.exact);
    if view.free != view.exact {
        text += &format!(
            "without the surface's own plane, which hides a part of the light {:.9}\n",
            view.free
        );
    }
    text
}

fn kind(seen: Option<&SeenLight>) -> &'static str {
    match seen {
        Some(seen) if seen.is_square => "a square in its own coordinates, -1 to 1",
        Some(_) => "a disc in its own coordinates, of radius 1",
        None => "not seen",
    }
}

fn summands(view: &View, seen: &SeenLight) -> String {
    let head = ["edge", "caster", "from", "to", "side", "adds"];
    let mut table = Table::new("Edges that cut the light", &head);
    for edge in &seen.edges {
        let [from, to] = edge.on_light.map(|p| format!("{:+.4} {:+.4}", p.x, p.y));
        let side = if edge.inside { "umbra" } else { "lit" };
        table.rows.push(vec![
            edge.number.to_string(),
            view.object(edge.object).to_owned(),
            from,
            to,
            side.to_owned(),
            format!("{:+.9}", edge.contribution()),
        ]);
    }
    let mut text = match seen.edges.is_empty() {
        true => format!("none of {} silhouette edges cuts the light\n", view.edges),
        false => table.to_text(),
    };
    text += &format!(
        "\n1 - {} (layers before the light's centre) + {} edges of {} = {:.9}\n",
        seen.centre_hidden,
        seen.edges.len(),
        view.edges,
        seen.sum(),
    );
    if seen.saturation() != 0.0 {
        text += &format!("clamped by {:+.9}\n", -seen.saturation());
    }
    text
}
