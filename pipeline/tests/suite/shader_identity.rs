//! Every stage of every technique says which shader it is, and the table of shaders makes
//! the same frame again from that alone.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use gnomon_pipeline::technique::{Frame, Params, Technique};
use gnomon_pipeline::techniques::{self, find};
use gnomon_pipeline::world::environment::FitSettings;
use gnomon_pipeline::world::light::{Light, LightShape};
use gnomon_pipeline::world::scene::environment::EnvironmentRequest;
use gnomon_pipeline::world::scene::{Object, Scene, SceneSource, SurfaceTexture, builtin};
use gnomon_raster::shader::{ShaderIdentity, ShaderTable};
use gnomon_raster::{Gpu, GpuConfig, Recording, RenderPipeline, SubmitReport};

use crate::textures::{lay, picture};

const SIZE: [u32; 2] = [40, 30];

/// Scenes with lights of all kinds.
fn scenes() -> Vec<(&'static str, Scene)> {
    let creature = builtin::build("creature").unwrap();
    let lit_by = |shape: LightShape| {
        let mut scene = creature.clone();
        scene.lights = vec![Light {
            shape,
            ..scene.lights[0].clone()
        }];
        scene
    };
    let centre = DVec3::new(2.0, 4.0, 2.0);
    let sun = LightShape::Directional { towards: centre };
    let disc = LightShape::Disc {
        centre,
        normal: DVec3::Y,
        radius: 0.5,
    };
    let sphere = LightShape::Sphere {
        centre,
        radius: 0.5,
    };
    let mut request = EnvironmentRequest::new("sky");
    request.settings.side = 32;
    request.fit = FitSettings {
        lights: 2,
        ..FitSettings::default()
    };
    let sky = SceneSource::open("cylinder").unwrap();
    let sky = sky.with_environment(Some(request)).at(0.0).unwrap();
    let mut painted = creature.clone();
    painted.objects.iter_mut().for_each(paint);
    let mut painted_sky = sky.clone();
    painted_sky.objects.iter_mut().for_each(paint);
    vec![
        ("textures", painted),
        ("sky with textures", painted_sky),
        ("rectangle", creature.clone()),
        ("sphere", lit_by(sphere)),
        ("disc", lit_by(disc)),
        ("sun", lit_by(sun)),
        ("sky", sky),
        (
            "eye in shadow",
            builtin::build("adversarial-eye-in-shadow").unwrap(),
        ),
    ]
}

/// A picture on all of an object, glossy or not.
fn paint(object: &mut Object) {
    let picture = picture(2, &[[255, 0, 0], [0, 255, 0]]);
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    lay(object, SurfaceTexture::repeated(picture), &[corners]);
}

/// Settings that keep frames small.
fn small(technique: &dyn Technique) -> Vec<String> {
    let wanted = [
        ("map-size", "64"),
        ("samples", "4"),
        ("maps", "4"),
        ("texture-size", "8"),
    ];
    let has = |key: &str| technique.params().iter().any(|p| p.name == key);
    let wanted = wanted.iter().filter(|(key, _)| has(key));
    wanted
        .map(|(key, value)| format!("{key}={value}"))
        .collect()
}

/// Whether a word can be set: neither a placeholder nor a size that only takes time.
fn is_settable(word: &str) -> bool {
    let large = word.parse::<u32>().is_ok_and(|n| n > 64);
    !large && !word.contains(|c: char| c.is_uppercase() || c == ' ')
}

/// The defaults, and each word that a parameter takes, one at a time.
fn settings(technique: &dyn Technique) -> Vec<Vec<String>> {
    let base = small(technique);
    let mut all = vec![base.clone()];
    for info in technique.params() {
        let words = info.domain.words().iter();
        for value in words.filter(|v| is_settable(v)) {
            let mut set = base.clone();
            set.retain(|s| !s.starts_with(&format!("{}=", info.name)));
            set.push(format!("{}={value}", info.name));
            all.push(set);
        }
    }
    // What only shows in a combination.
    let more: &[&[&str]] = match technique.name() {
        "mixed-lights" => &[
            &[
                "brightest=1",
                "first=pcss:map-size=64",
                "rest=pcf:map-size=64",
            ],
            &["brightest=1", "rest=penumbra-wedges"],
        ],
        "soft-shadow-volumes" | "soft-shadow-volumes-optimised" => {
            &[&["light-image=fire", "light-frame=0.5"]]
        }
        "convolution-soft-shadows" => &[&["filter=sat", "m=8"], &["filter=sat-u32", "m=2"]],
        _ => &[],
    };
    all.extend(more.iter().map(|set| {
        let mut whole = base.clone();
        whole.extend(set.iter().map(|s| (*s).to_owned()));
        whole
    }));
    all
}

/// What the stages of a pipeline are.
fn identities(p: &RenderPipeline, what: &str) -> (ShaderIdentity, Option<ShaderIdentity>) {
    let label = &p.label;
    let vertex = p.vertex.identity();
    let vertex = vertex.unwrap_or_else(|| panic!("{what}: vertex shader of '{label}' is nameless"));
    let fragment = p.fragment.as_ref().map(|f| {
        f.identity()
            .unwrap_or_else(|| panic!("{what}: fragment shader of '{label}' is nameless"))
    });
    (vertex, fragment)
}

/// The recording with every shader made again.
fn made_again(recording: &Recording, table: &ShaderTable, what: &str) -> Recording {
    let mut again = recording.clone();
    for draw in again.list.passes.iter_mut().flat_map(|p| &mut p.draws) {
        let old = &draw.pipeline;
        let (vertex, fragment) = identities(old, what);
        let new = RenderPipeline {
            vertex: table.vertex(&vertex).unwrap(),
            fragment: fragment.as_ref().map(|f| table.fragment(f).unwrap()),
            ..(**old).clone()
        };
        assert_eq!(identities(&new, what), (vertex, fragment));
        draw.pipeline = Arc::new(new);
    }
    again
}

/// All bytes that a recording leaves behind, and what it counts.
fn run(recording: &Recording) -> (Vec<Vec<u8>>, SubmitReport) {
    let mut gpu = Gpu::new(GpuConfig::default()).unwrap();
    gpu.load(recording).unwrap();
    let report = gpu.submit(&recording.list).unwrap();
    let mut images = Vec::new();
    for id in gpu.texture_ids() {
        let texture = gpu.texture(id).unwrap();
        let all = texture.descriptor().images();
        images.extend(all.map(|image| texture.read_packed(image).unwrap()));
    }
    (images, report)
}

fn assert_same(recording: &Recording, again: &Recording, what: &str) {
    let ((images, report), (same, counted)) = (run(recording), run(again));
    assert!(images == same, "{what}: textures differ");
    for (pass, other) in report.passes.iter().zip(&counted.passes) {
        assert_eq!(pass.draws, other.draws, "{what}: {}", pass.label);
    }
}

#[test]
fn every_stage_has_an_identity_that_makes_it_again() {
    let table = gnomon_shaders::table();
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let mut frames = 0;
    for (lights, scene) in scenes() {
        for technique in techniques::all() {
            for set in settings(*technique) {
                let what = format!("{lights}, {} {set:?}", technique.name());
                let params = Params::parse(*technique, &set).unwrap();
                // Not every technique takes every light.
                let Ok(Frame { recording, .. }) = technique.frame(&scene, SIZE, &params) else {
                    continue;
                };
                let again = made_again(&recording, &table, &what);
                for draw in recording.list.passes.iter().flat_map(|p| &p.draws) {
                    let (vertex, fragment) = identities(&draw.pipeline, &what);
                    for identity in [Some(vertex), fragment].into_iter().flatten() {
                        *seen.entry(identity.name).or_default() += 1;
                    }
                }
                // Setting by setting on one scene, the defaults on all.
                if lights == "rectangle" || set == small(*technique) {
                    assert_same(&recording, &again, &what);
                }
                frames += 1;
            }
        }
    }
    assert!(frames > 300, "{frames} frames");
    let names = table.vertex_shaders().chain(table.fragment_shaders());
    // Whoever wants several samples of a pixel resolves them, not the technique.
    let unused: Vec<_> = names
        .filter(|(name, _)| !seen.contains_key(*name) && *name != "box-resolve")
        .collect();
    assert!(unused.is_empty(), "no technique uses {unused:?}");
}

/// What a frame is made from is checked before anything is drawn.
#[test]
fn other_versions_and_other_bytes_are_refused() {
    let table = gnomon_shaders::table();
    let scene = builtin::build("cylinder").unwrap();
    let technique = find("soft-shadow-volumes").unwrap();
    let params = Params::defaults(technique);
    let recording = technique.frame(&scene, SIZE, &params).unwrap().recording;
    for draw in recording.list.passes.iter().flat_map(|p| &p.draws) {
        let (vertex, fragment) = identities(&draw.pipeline, "cylinder");
        let changed = |change: &dyn Fn(&mut ShaderIdentity)| {
            let mut vertex = vertex.clone();
            change(&mut vertex);
            let fragment = fragment.clone().map(|mut f| {
                change(&mut f);
                table.fragment(&f).is_err()
            });
            table.vertex(&vertex).is_err() && fragment != Some(false)
        };
        assert!(changed(&|i| i.name.push('x')));
        assert!(changed(&|i| i.version += 1));
        assert!(changed(&|i| i.uniforms.push(0)));
    }
}
