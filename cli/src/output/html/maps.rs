//! The picture with its maps: each once, chosen by radio buttons, which need no script;
//! the values for the pointer stand beside them as pictures of numbers.

use std::fmt::Write;

use gnomon_traces::maps::{MapKind, Maps};

use super::{base64, escape};
use crate::draw::heat_scale::{place, scale_labels, scale_top};
use crate::draw::{Picture, heat};
use crate::output::png;

const NAMES: [(MapKind, &str, &str); 4] = [
    (
        MapKind::Overdraw,
        "overdraw",
        "fragments generated at each pixel",
    ),
    (
        MapKind::StencilOperations,
        "stencil operations",
        "reads and writes of the stencil at each pixel",
    ),
    (
        MapKind::HizKills,
        "HiZ kills",
        "fragments that zmin/zmax of their block ended, at each pixel",
    ),
    (
        MapKind::Bytes,
        "bytes",
        "logical bytes of depth, stencil and colour at each pixel; entries of zmin/zmax, textures and vertices have no pixel",
    ),
];

/// The figure of section `number`; `pixels` have a history, others the `command`.
pub(crate) fn figure(
    number: usize,
    picture: Vec<u8>,
    maps: &Maps,
    pixels: &[[u32; 2]],
    command: &str,
) -> String {
    let [width, height] = maps.size;
    let (mut inputs, mut images, mut legends) = (String::new(), String::new(), String::new());
    inputs += &input(number, 0, "picture", true);
    images += &image("m0", "the picture", &picture, "");
    legends += "<p class=\"m0\">What the frame leaves behind.</p>\n";
    for (i, (kind, name, what)) in NAMES.into_iter().enumerate() {
        let class = format!("m{}", i + 1);
        let values = maps.of(kind);
        let top = scale_top(values.iter().map(|v| u64::from(*v)));
        let numbers = png::encode(&numbers(maps.size, values));
        let data = format!(
            " data-name=\"{name}\" data-values=\"data:image/png;base64,{}\"",
            base64(&numbers)
        );
        inputs += &input(number, i + 1, name, false);
        images += &image(
            &class,
            name,
            &png::encode(&colored(maps.size, values, top)),
            &data,
        );
        legends += &legend(&class, what, values, top);
    }
    let marks: String = pixels.iter().map(|p| mark(number, *p, maps.size)).collect();
    let elsewhere = match maps.elsewhere {
        0 => String::new(),
        n => format!("<p>Left out: {n} fragments of passes that draw to other images.</p>\n"),
    };
    format!(
        "<div class=\"maps\" data-size=\"{width},{height}\" data-section=\"{number}\" data-command=\"{}\">\n{inputs}\
         <div class=\"stage\">{images}{marks}</div>\n<div class=\"legends\">\n{legends}{elsewhere}</div>\n\
         <p class=\"value\" role=\"status\"></p>\n</div>\n",
        escape(command)
    )
}

fn input(section: usize, i: usize, name: &str, checked: bool) -> String {
    let checked = if checked { " checked" } else { "" };
    format!(
        "<input type=\"radio\" name=\"map{section}\" class=\"pick m{i}\" id=\"s{section}m{i}\"{checked}><label for=\"s{section}m{i}\">{name}</label>\n"
    )
}

fn image(class: &str, alt: &str, png: &[u8], data: &str) -> String {
    format!(
        "<img class=\"{class}\" alt=\"{}\" src=\"data:image/png;base64,{}\"{data}>",
        escape(alt),
        base64(png)
    )
}

/// A place that leads to the pixel's history.
fn mark(section: usize, [x, y]: [u32; 2], [width, height]: [u32; 2]) -> String {
    let at = |v: u32, of: u32| 100.0 * (f64::from(v) + 0.5) / f64::from(of);
    format!(
        "<a class=\"mark\" href=\"#s{section}p{x}-{y}\" title=\"history of pixel {x}, {y}\" style=\"left:{:.4}%;top:{:.4}%\"></a>",
        at(x, width),
        at(y, height)
    )
}

fn legend(class: &str, what: &str, values: &[u32], top: u64) -> String {
    let max = values.iter().copied().max().unwrap_or(0);
    let sum: u64 = values.iter().map(|v| u64::from(*v)).sum();
    let mut ticks = String::new();
    for (at, label) in scale_labels(top, u64::from(max), |n| n.to_string()) {
        let _ = write!(
            ticks,
            "<span style=\"left:{:.2}%\">{}</span>",
            at * 100.0,
            escape(&label)
        );
    }
    let stops: Vec<String> = (0..=12).map(|i| css(heat(i as f32 / 12.0))).collect();
    format!(
        "<div class=\"{class}\"><p>{}: {sum} in all, {max} at most.</p><div class=\"ramp\" style=\"background:linear-gradient(90deg,{})\"></div><div class=\"ticks\">{ticks}</div></div>\n",
        capital(what),
        stops.join(",")
    )
}

fn css([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

fn colored(size: [u32; 2], values: &[u32], top: u64) -> Picture {
    let color = |v: &u32| {
        let [r, g, b] = heat(place(u64::from(*v), top));
        [r, g, b, 255]
    };
    Picture {
        size,
        pixels: values.iter().map(color).collect(),
    }
}

/// Numbers as colours, blue lowest: 24 bits, the largest one standing for all above.
fn numbers(size: [u32; 2], values: &[u32]) -> Picture {
    let color = |v: &u32| {
        let [b, g, r, _] = v.min(&0xff_ffff).to_le_bytes();
        [r, g, b, 255]
    };
    Picture {
        size,
        pixels: values.iter().map(color).collect(),
    }
}
