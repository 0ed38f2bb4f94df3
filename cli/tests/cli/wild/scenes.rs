//! Scene files.

use super::{fixture, folder_of, render};

#[test]
fn arrays_have_the_length_that_they_should_have() {
    let folder = folder_of("arrays", &["four-numbers.toml"]);
    folder.gnomon("render four-numbers.toml").refused(&[
        "four-numbers.toml:6:",
        "4",
        "array of 3 numbers",
    ]);
    let text = std::fs::read_to_string(fixture("four-numbers.toml")).unwrap();
    let valid = text.replace("0.5, 0.0, 9.0]", "0.5, 0.0]");
    for (from, to, place) in [
        ("size = [160, 120]", "size = [160, 120, 7]", "2:"),
        ("size = [160, 120]", "size = [160]", "2:"),
        ("name = \"w\"", "ambient = [0.1, 0.1, 0.1, 1.0]", "1:"),
        ("name = \"w\"", "background = [0.1, 0.1]", "1:"),
        ("eye = [0.6, 3.1, 5.4]", "eye = [0.6, 3.1, [5.4]]", "5:"),
        ("eye = [0.6, 3.1, 5.4]", "eye = \"here\"", "5:"),
        ("fov = 42.0", "up = [0, 1, 0, 0]", "7:"),
        (
            "centre = [1.6, 4.2, 1.1]",
            "centre = [1.6, 4.2, 1.1, 0]",
            "9:",
        ),
        ("size = [1.4,0.5,1.0]", "size = [1.4,0.5,1.0,1.0]", "14:"),
        ("translate=[0,1.2,0]", "translate=[0,1.2,0,0]", "15:"),
        ("translate=[0,1.2,0]", "scale=[1,2,3,4]", "15:"),
        ("translate=[0,1.2,0]", "motion.spin=[1,2]", "15:"),
        ("translate=[0,1.2,0]", "material.albedo=[1,2,1e300]", "15:"),
        ("translate=[0,1.2,0]", "rotate=[0,nan,0]", "15:"),
    ] {
        assert!(valid.contains(from), "{from}");
        folder.write("s.toml", &valid.replace(from, to));
        folder
            .gnomon("render s.toml")
            .refused(&[&format!("s.toml:{place}")]);
    }
    folder.write("s.toml", &format!("\u{feff}{valid}"));
    render(&folder, "s.toml");
    std::fs::write(folder.path("s.toml"), b"name = \"\xff\"").unwrap();
    folder
        .gnomon("render s.toml")
        .refused(&["s.toml", "not UTF-8", "byte 8"]);
}
