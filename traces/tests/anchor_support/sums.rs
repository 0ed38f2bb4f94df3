//! Whether judged traffic adds up.

use gnomon_traces::profile::{Client, Levels, Traffic};

/// The first sum that differs from the totals: by draw, client, place and pixel, and what
/// became dirty against what was written back.
pub(crate) fn unequal_sum(traffic: &Traffic) -> Option<String> {
    let total = traffic.total();
    let mut rows = Levels::default();
    traffic.rows.iter().for_each(|r| rows.add(&r.total()));
    let mut cells = Levels::default();
    for client in Client::all() {
        let mut of_client = Levels::default();
        traffic.cells(client).iter().for_each(|l| of_client.add(l));
        if of_client != traffic.client(client) {
            return Some(format!("places of {client}"));
        }
        cells.add(&of_client);
    }
    let (pixels, mut all) = traffic.pixels().unwrap();
    pixels.iter().for_each(|l| all.add(l));
    for (sum, what) in [(rows, "draws"), (cells, "places"), (all, "pixels")] {
        if sum != total {
            return Some(what.to_owned());
        }
    }
    let wrong = traffic.caches.iter().find(|c| {
        let d = c.dirty;
        d.dirtied != d.written_back + d.flushed
    });
    wrong.map(|_| "dirty bytes".to_owned())
}
