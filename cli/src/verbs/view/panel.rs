//! What a pixel holds.

use super::studio::Drawn;

/// Lines about a pixel of a frame.
pub(super) fn lines(drawn: &Drawn, [x, y]: [u32; 2]) -> Vec<String> {
    let done = &drawn.done;
    let mut lines = vec![format!("pixel {x}, {y}")];
    let at = y as usize * done.size[0] as usize + x as usize;
    if x >= done.size[0] || y >= done.size[1] {
        return lines;
    }
    let [r, g, b, _] = done.srgb[at];
    let linear = done.color[at].map(|c| c.to_string());
    lines.push(format!("color      #{r:02x}{g:02x}{b:02x}  {r} {g} {b}"));
    lines.push(format!("  linear   {}", linear[0]));
    lines.push(format!("           {}", linear[1]));
    lines.push(format!("           {}", linear[2]));
    lines.push(format!("depth      {}", done.depth[at]));
    lines.push(match done.visibility[at] {
        v if v.is_nan() => "visibility - (no surface)".to_owned(),
        v => format!("visibility {v}"),
    });
    lines.push(format!("stencil    {}", done.stencil[at]));
    lines
}
