//! Counters as a list of numbers, field after field.

use gnomon_raster::{
    ClientTraffic, Counters, EventCounters, FragmentCounters, PrimitiveCounters, TileCounters,
    Traffic,
};

/// The numbers of `counters`.
pub(crate) fn list(counters: &Counters) -> Vec<u64> {
    let (mut all, mut copy) = (Vec::new(), *counters);
    visit(&mut copy, &mut |n| all.push(*n));
    all
}

/// Counters of a list.
pub(crate) fn from_list(numbers: &[u64]) -> Result<Counters, String> {
    let mut counters = Counters::default();
    fill(numbers, |f| visit(&mut counters, f))?;
    Ok(counters)
}

/// The numbers of clears.
pub(crate) fn clear_list(clear: &ClientTraffic) -> Vec<u64> {
    let (mut all, mut copy) = (Vec::new(), *clear);
    visit_clients(&mut copy, &mut |n| all.push(*n));
    all
}

/// Clears of a list.
pub(crate) fn clear_from_list(numbers: &[u64]) -> Result<ClientTraffic, String> {
    let mut clear = ClientTraffic::default();
    fill(numbers, |f| visit_clients(&mut clear, f))?;
    Ok(clear)
}

fn fill(numbers: &[u64], visit: impl FnOnce(&mut dyn FnMut(&mut u64))) -> Result<(), String> {
    let (mut given, mut wanted) = (numbers.iter(), 0);
    visit(&mut |n| {
        *n = given.next().copied().unwrap_or(0);
        wanted += 1;
    });
    match numbers.len() == wanted {
        true => Ok(()),
        false => Err(format!(
            "{} counters where {wanted} are wanted",
            numbers.len()
        )),
    }
}

type Visitor<'a> = &'a mut dyn FnMut(&mut u64);

/// Visits all fields of a struct in the order given. It is taken apart without `..`: a
/// field that is left out does not compile.
macro_rules! visit_fields {
    ($of:expr, $f:expr, $type:ident { $($field:ident),+ $(,)? }) => {
        let $type { $($field),+ } = $of;
        [$($field),+].into_iter().for_each(&mut *$f);
    };
}

fn visit(counters: &mut Counters, f: Visitor<'_>) {
    visit_fields!(
        &mut counters.primitives,
        f,
        PrimitiveCounters {
            vertex_shader_invocations,
            input,
            non_finite,
            frustum_culled,
            clipped,
            degenerate,
            face_culled,
            rasterized,
            steep_depth_planes,
        }
    );
    visit_fields!(
        &mut counters.fragments,
        f,
        FragmentCounters {
            generated,
            hiz_killed,
            bounds_failed,
            stencil_failed,
            depth_failed,
            discarded,
            written,
        }
    );
    f(&mut counters.fragment_shader_invocations);
    counters.shader_counts.iter_mut().for_each(&mut *f);
    visit_fields!(
        &mut counters.tiles,
        f,
        TileCounters {
            tested,
            culled,
            accepted
        }
    );
    visit_events(&mut counters.events, f);
    visit_clients(&mut counters.traffic, f);
}

fn visit_events(events: &mut EventCounters, f: Visitor<'_>) {
    let EventCounters {
        silent_z_writes,
        silent_stencil_writes,
        silent_color_writes,
        blend_saturated,
        source_clamped,
        nan_canonicalised,
        depth_clamped,
    } = events;
    f(silent_z_writes);
    f(silent_stencil_writes);
    let lists = [silent_color_writes, blend_saturated, source_clamped];
    lists.into_iter().flatten().for_each(&mut *f);
    f(nan_canonicalised);
    f(depth_clamped);
}

fn visit_clients(clients: &mut ClientTraffic, f: Visitor<'_>) {
    let ClientTraffic {
        z,
        stencil,
        hiz,
        color,
        tex,
        tex_fetches,
        vertex,
        index,
        packed_depth_stencil,
    } = clients;
    let single = [z, stencil, hiz, vertex, index, packed_depth_stencil];
    let all = single.into_iter().chain(color).chain(tex);
    all.for_each(|traffic| visit_traffic(traffic, f));
    tex_fetches.iter_mut().for_each(f);
}

fn visit_traffic(traffic: &mut Traffic, f: Visitor<'_>) {
    visit_fields!(
        traffic,
        f,
        Traffic {
            read_accesses,
            read_bytes,
            write_accesses,
            write_bytes
        }
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_counter_has_its_place() {
        let mut counters = Counters::default();
        let mut next = 0;
        visit(&mut counters, &mut |n| {
            next += 1;
            *n = next;
        });
        let all = list(&counters);
        assert_eq!(all, (1..=next).collect::<Vec<_>>());
        // 8 bytes each; what raster keeps to itself is as many more accesses.
        assert_eq!(all.len(), 9 + 7 + 1 + 4 + 3 + 16 + 80);
        assert_eq!(from_list(&all), Ok(counters));
        let short = from_list(&all[1..]).unwrap_err();
        assert_eq!(short, "119 counters where 120 are wanted");
        let clear = clear_list(&counters.traffic);
        assert_eq!(clear_from_list(&clear), Ok(counters.traffic));
    }
}
