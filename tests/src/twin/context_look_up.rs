//! The same look-ups by a closure that sees one fragment.

use gnomon_raster::shader::FragmentContext;

use super::look_up::{
    Coordinate, LookUp, LookUpKind, MAX_LOOK_UPS, Origin, Values, at, halves, integer,
};

/// Values of all look-ups, in order.
pub(super) fn look_up_all(list: &[LookUp], f: &FragmentContext<'_>) -> Values {
    let mut values = [[0.0; 4]; MAX_LOOK_UPS];
    for (k, look_up) in list.iter().enumerate() {
        if f.texture_size(look_up.slot, 0) != [0; 3] {
            values[k] = look(look_up, &list[..k], f, &values);
        }
    }
    values
}

/// `before` are the look-ups that gave `values`.
fn look(l: &LookUp, before: &[LookUp], f: &FragmentContext<'_>, values: &Values) -> [f32; 4] {
    match &l.kind {
        // A neighbour's look-ups have to be made again for it.
        LookUpKind::Sample(c) if matches!(c.of, Origin::LookUp(_)) => {
            let component =
                |k: usize| move |g: &FragmentContext<'_>| at(c, g, &look_up_all(before, g))[k];
            let dx = [0, 1, 2].map(|k| f.ddx(component(k)));
            let dy = [0, 1, 2].map(|k| f.ddy(component(k)));
            f.sample_grad(l.slot, at(c, f, values), dx, dy)
        }
        LookUpKind::Sample(c) => f.sample(l.slot, |g| at(c, g, &Values::default())),
        LookUpKind::Gradients(c, [dx, dy]) => {
            let all = |c: &Coordinate| at(c, f, values);
            f.sample_grad(l.slot, all(c), all(dx), all(dy))
        }
        LookUpKind::Level(c, level) => {
            f.sample_level(l.slot, at(c, f, values), at(level, f, values)[0])
        }
        LookUpKind::Fetch(t) => f.fetch_texel(l.slot, integer(t, f), t.mip),
        LookUpKind::Bits(t) => halves(f.fetch_texel_bits(l.slot, integer(t, f), t.mip)),
        LookUpKind::Stencil(t) => halves(f.fetch_stencil(l.slot, integer(t, f), t.mip)),
    }
}
