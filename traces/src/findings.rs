//! What is remarkable about a frame, in words, each sentence computed from its counters.

use crate::report::{ClientBytes, DrawRow, FrameReport, PassRow};

/// A sentence and what it is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// A stable name.
    pub code: &'static str,
    /// For people, with full numbers.
    pub text: String,
}

/// All findings that hold of a frame whose picture has `size` pixels.
#[must_use]
pub fn findings(frame: &FrameReport, size: [u32; 2]) -> Vec<Finding> {
    [
        largest_client(frame),
        largest_pass(frame),
        few_draws(frame),
        overdraw(frame, size),
        hiz(frame),
        unwritten(frame),
        idle_draws(frame),
        silent_writes(frame),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn finding(code: &'static str, text: String) -> Option<Finding> {
    Some(Finding { code, text })
}

/// `part` of `whole` in per cent with a digit behind the point; exact in integers.
fn percent(part: u64, whole: u64) -> String {
    let tenths = (u128::from(part) * 2000 / u128::from(whole.max(1))).div_ceil(2);
    format!("{}.{} %", tenths / 10, tenths % 10)
}

fn largest_client(frame: &FrameReport) -> Option<Finding> {
    let clients = frame.clients();
    let largest = clients.iter().max_by_key(|c| c.total())?;
    let (bytes, all) = (largest.total(), frame.bytes());
    if bytes == 0 {
        return None;
    }
    let ClientBytes {
        client,
        read,
        write,
    } = largest;
    finding(
        "largest-client",
        format!(
            "{client} moves most: {bytes} of {all} logical bytes ({}), {read} read and {write} written.",
            percent(bytes, all)
        ),
    )
}

fn largest_pass(frame: &FrameReport) -> Option<Finding> {
    let largest = frame.passes.iter().max_by_key(|p| p.bytes())?;
    if frame.passes.len() < 2 {
        return None;
    }
    let (bytes, all) = (largest.bytes(), frame.bytes());
    finding(
        "largest-pass",
        format!(
            "Of {} passes, “{}” moves most: {bytes} logical bytes ({}).",
            frame.passes.len(),
            largest.label,
            percent(bytes, all)
        ),
    )
}

/// The fewest draws that make half of the bytes.
fn few_draws(frame: &FrameReport) -> Option<Finding> {
    let mut draws: Vec<&DrawRow> = frame.draws.iter().collect();
    draws.sort_by_key(|d| std::cmp::Reverse(d.bytes()));
    let all: u64 = draws.iter().map(|d| d.bytes()).sum();
    let first = draws.first().filter(|d| d.bytes() > 0)?;
    let (mut count, mut sum) = (0, 0);
    while sum * 2 < all {
        sum += draws[count].bytes();
        count += 1;
    }
    finding(
        "few-draws",
        format!(
            "{count} of {} draws move half of what draws move ({sum} of {all} bytes); first among them draw {} of “{}”, “{}”: {} bytes.",
            draws.len(),
            first.draw,
            first.pass_label,
            first.label,
            first.bytes()
        ),
    )
}

fn overdraw(frame: &FrameReport, size: [u32; 2]) -> Option<Finding> {
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    let generated = frame.totals().fragments.generated;
    let hundredths = u128::from(generated) * 100 / u128::from(pixels.max(1));
    finding(
        "overdraw",
        format!(
            "{generated} fragments were generated for {pixels} pixels: {}.{:02} each.",
            hundredths / 100,
            hundredths % 100
        ),
    )
}

fn hiz(frame: &FrameReport) -> Option<Finding> {
    let f = frame.totals().fragments;
    let off = frame.draws.iter().filter(|d| d.hiz_disabled.is_some());
    let (killed, off) = (f.hiz_killed, off.count());
    finding(
        "hiz",
        format!(
            "Zmin/zmax of blocks ended {killed} of {} fragments ({}) before any of their depths was read; they were not used by {off} of {} draws.",
            f.generated,
            percent(killed, f.generated),
            frame.draws.len()
        ),
    )
}

fn unwritten(frame: &FrameReport) -> Option<Finding> {
    let f = frame.totals().fragments;
    let ends = [
        ("zmin/zmax", f.hiz_killed),
        ("depth bounds", f.bounds_failed),
        ("the stencil test", f.stencil_failed),
        ("the depth test", f.depth_failed),
        ("discarding shaders", f.discarded),
    ];
    let lost = f.generated - f.written;
    let (by, most) = ends.into_iter().max_by_key(|(_, n)| *n)?;
    if lost == 0 {
        return None;
    }
    finding(
        "unwritten",
        format!(
            "{lost} of {} fragments ({}) were not written; most of them, {most}, ended by {by}.",
            f.generated,
            percent(lost, f.generated)
        ),
    )
}

/// Draws that leave nothing behind.
fn idle_draws(frame: &FrameReport) -> Option<Finding> {
    let is_idle = |d: &&DrawRow| d.counters.fragments.written == 0 && writes(&d.clients) == 0;
    let idle: Vec<&DrawRow> = frame.draws.iter().filter(is_idle).collect();
    let first = idle.first()?;
    let bytes: u64 = idle.iter().map(|d| d.bytes()).sum();
    finding(
        "idle-draws",
        format!(
            "{} of {} draws wrote nothing, and moved {bytes} bytes; the first is draw {} of “{}”, “{}”.",
            idle.len(),
            frame.draws.len(),
            first.draw,
            first.pass_label,
            first.label
        ),
    )
}

fn writes(clients: &[ClientBytes]) -> u64 {
    clients.iter().map(|c| c.write).sum()
}

fn silent_writes(frame: &FrameReport) -> Option<Finding> {
    let e = frame.totals().events;
    let color: u64 = e.silent_color_writes.iter().sum();
    let all = e.silent_z_writes + e.silent_stencil_writes + color;
    if all == 0 {
        return None;
    }
    let worst = |p: &&PassRow| {
        let e = p.counters.events;
        e.silent_z_writes + e.silent_stencil_writes + e.silent_color_writes.iter().sum::<u64>()
    };
    let pass = frame.passes.iter().max_by_key(worst)?;
    finding(
        "silent-writes",
        format!(
            "{all} writes stored what was there: {} of depth, {} of stencil, {color} of colour; most of them in “{}”.",
            e.silent_z_writes, e.silent_stencil_writes, pass.label
        ),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_exact() {
        let shown = [(1, 3), (2, 3), (1, 1), (0, 5), (1, 2000)].map(|(p, w)| percent(p, w));
        assert_eq!(shown, ["33.3 %", "66.7 %", "100.0 %", "0.0 %", "0.1 %"]);
        assert_eq!(percent(u64::MAX, u64::MAX), "100.0 %");
    }

    fn draw(label: &str, bytes: u64, written: u64) -> DrawRow {
        let mut counters = gnomon_raster::Counters::default();
        counters.fragments.generated = 10;
        counters.fragments.depth_failed = 10 - written;
        counters.fragments.written = written;
        DrawRow {
            pass: 0,
            pass_label: "main".to_owned(),
            draw: 0,
            label: label.to_owned(),
            counters,
            clients: vec![ClientBytes {
                client: "z".to_owned(),
                read: bytes,
                write: written,
            }],
            hiz_disabled: None,
        }
    }

    fn frame() -> FrameReport {
        let draws = vec![draw("a", 100, 5), draw("b", 10, 0), draw("c", 30, 10)];
        let mut counters = gnomon_raster::Counters::default();
        draws.iter().for_each(|d| counters.add(&d.counters));
        let pass = PassRow {
            label: "main".to_owned(),
            counters,
            clients: draws.iter().flat_map(|d| d.clients.clone()).collect(),
        };
        FrameReport {
            passes: vec![pass],
            draws,
        }
    }

    /// Every number of a sentence is the frame's.
    #[test]
    fn sentences_have_the_frames_numbers() {
        let found = findings(&frame(), [4, 4]);
        let text = |code: &str| {
            let of_code = found.iter().find(|f| f.code == code);
            of_code.map_or("", |f| f.text.as_str())
        };
        assert!(
            text("largest-client")
                .contains("155 of 155 logical bytes (100.0 %), 140 read and 15 written")
        );
        assert!(
            text("few-draws")
                .starts_with("1 of 3 draws move half of what draws move (105 of 155 bytes)")
        );
        assert!(text("overdraw").contains("30 fragments were generated for 16 pixels: 1.87 each"));
        assert!(text("unwritten").contains("15 of 30 fragments (50.0 %) were not written; most of them, 15, ended by the depth test"));
        assert!(text("idle-draws").contains("1 of 3 draws wrote nothing, and moved 10 bytes"));
        assert_eq!(text("largest-pass"), "", "one pass is no largest");
        assert_eq!(text("silent-writes"), "");
    }
}
