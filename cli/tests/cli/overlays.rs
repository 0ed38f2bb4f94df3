//! Every overlay with every technique, at sizes that are no multiple of a block.

use crate::common::Folder;

/// The techniques that there are.
fn techniques(folder: &Folder) -> Vec<String> {
    let document = folder.gnomon("techniques --json").json();
    let list = document["techniques"].as_array().unwrap();
    let name = |t: &serde_json::Value| t["name"].as_str().unwrap().to_owned();
    list.iter().map(name).collect()
}

/// The overlays that there are, as the command line names them, but for those that a
/// scene or a technique may not have.
fn overlays(folder: &Folder) -> Vec<String> {
    let message = folder.gnomon("render demo --overlay none").stderr();
    let (_, list) = message.split_once("[possible values: ").unwrap();
    let (list, _) = list.split_once(']').unwrap();
    let all = list.split(", ").map(str::to_owned);
    all.filter(|o| !["wedges", "env-lights", "carries"].contains(&o.as_str()))
        .collect()
}

#[test]
fn every_technique_has_every_overlay_at_odd_sizes() {
    let folder = Folder::new("overlays-all");
    let overlays = overlays(&folder);
    assert!(overlays.len() >= 5, "{overlays:?}");
    for technique in techniques(&folder) {
        for size in ["1x1", "7x5", "65x33", "96x72"] {
            let render =
                format!("render parallel-plates --technique {technique} --size {size} --out a.png");
            let all = overlays.join(",");
            folder.gnomon(&format!("{render} --overlay {all}")).fine();
            for overlay in &overlays {
                let picture = image::open(folder.path(&format!("a-{overlay}.png"))).unwrap();
                assert!(picture.width() >= 280, "{technique} {size} {overlay}");
            }
            let wedges = folder.gnomon(&format!("{render} --overlay wedges"));
            wedges.fine_or_refused("builds no penumbra wedges");
            let carries = folder.gnomon(&format!("{render} --overlay carries"));
            carries.fine_or_refused("adds no coverage up in 8-bit channels");
        }
    }
}

#[test]
fn lights_of_an_environment_are_drawn_at_odd_sizes() {
    let folder = Folder::new("overlays-environment");
    for size in ["1x1", "7x5"] {
        folder
            .gnomon(&format!(
                "render cylinder --size {size} --env sky --lights 2 --technique shadow-map \
                 --overlay env-lights,traffic,overdraw --out a.png"
            ))
            .fine();
    }
}

/// Light views are larger than the picture here.
#[test]
fn light_views_larger_than_the_picture_are_left_out() {
    let folder = Folder::new("overlays-light-view");
    for technique in ["shadow-map", "convolution-soft-shadows"] {
        folder
            .gnomon(&format!(
                "render peer-a --technique {technique} --size 160x120 \
                 --overlay traffic,overdraw --out a.png"
            ))
            .fine();
    }
}
