//! Writes the f64 truth of a scene as a PPM picture: what hard shadows should
//! look like, without any rasteriser. Pixels near an edge, which a rasteriser
//! may see differently, can be tinted.
//!
//! `cargo run --release -p gnomon-pipeline --example hard_truth -- SCENE OUT.ppm [WIDTH HEIGHT [tint]]`
//! with SCENE a built-in name, a `.toml` or an `.obj`.

use std::error::Error;

use gnomon_pipeline::truth::oracle::hard::{EdgeTolerance, HardTruth, PixelTruth};
use gnomon_pipeline::world::scene::{self, Scene};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, out, rest @ ..] = &arguments[..] else {
        return Err("usage: hard_truth SCENE OUT.ppm [WIDTH HEIGHT [tint]]".into());
    };
    let scene = scene::open(name)?;
    let (width, height) = match rest {
        [w, h, ..] => (w.parse()?, h.parse()?),
        _ => (640, 480),
    };
    let tint = rest.len() > 2;
    // Light reaching each pixel, summed over the lights.
    let truths: Vec<HardTruth> = (0..scene.lights.len())
        .map(|light| HardTruth::of_scene(&scene, light, [width, height], EdgeTolerance::HALF_PIXEL))
        .collect();
    let mut ppm = format!("P6\n{width} {height}\n255\n").into_bytes();
    for i in 0..(width * height) as usize {
        let pixels: Vec<&PixelTruth> = truths.iter().map(|t| &t.pixels[i]).collect();
        let at = [i as u32 % width, i as u32 / width].map(|k| f64::from(k) + 0.5);
        let mut colour = shade(&scene, &pixels, at, f64::from(width), f64::from(height));
        if tint && pixels.iter().any(|p| !p.interior) {
            colour[0] = 1.0;
        }
        ppm.extend(colour.map(|c| (libm::sqrt(c.clamp(0.0, 1.0)) * 255.0) as u8));
    }
    Ok(std::fs::write(out, ppm)?)
}

/// Lambert shading with the flat normal, ambient everywhere.
fn shade(scene: &Scene, pixels: &[&PixelTruth], [x, y]: [f64; 2], w: f64, h: f64) -> [f64; 3] {
    let Some(hit) = pixels[0].centre.hit else {
        return scene.background.map(f64::from);
    };
    let object = &scene.objects[hit.object as usize];
    let [a, b, c] = object.mesh.corners(hit.triangle as usize);
    let rays = scene.camera.eye_rays(w as u32, h as u32);
    let direction = rays.direction(x, y);
    let point = rays.origin + direction * hit.depth;
    let normal = (b - a).cross(c - a).normalize();
    let mut light_in = scene.ambient.map(f64::from);
    for (light, pixel) in scene.lights.iter().zip(pixels) {
        let towards = light.hard().towards_from(point).normalize();
        let lambert = normal.dot(towards).max(0.0) * f64::from(u8::from(pixel.is_lit()));
        for (sum, colour) in light_in.iter_mut().zip(light.colour) {
            *sum += f64::from(colour) * lambert;
        }
    }
    let albedo = object.material.albedo.map(f64::from);
    std::array::from_fn(|k| albedo[k] * light_in[k])
}
