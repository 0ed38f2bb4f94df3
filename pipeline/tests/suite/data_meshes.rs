//! The meshes of the shared data folder against the table in its README:
//! vertices, faces, closedness, and the defects of those that are not closed.
//! Passes with a note where the folder is absent.

use std::collections::BTreeSet;
use std::path::PathBuf;

use gnomon_pipeline::geometry::caster::Caster;
use gnomon_pipeline::geometry::winding::volume_solid_angle;
use gnomon_pipeline::world::adjacency::EdgeAdjacency;
use gnomon_pipeline::world::light::HardLight;
use gnomon_pipeline::world::mesh::Shading;
use gnomon_pipeline::world::obj;

/// `$GNOMON_DATA`, or `shared/data` beside the workspace.
fn data_folder() -> Option<PathBuf> {
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let folder = std::env::var_os("GNOMON_DATA").map_or_else(beside, PathBuf::from);
    folder.join("README.md").exists().then_some(folder)
}

/// A row of the table.
struct Row {
    file: String,
    vertices: usize,
    faces: usize,
    /// Boundary, over-shared, flipped; zeros for closed meshes.
    defects: [usize; 3],
}

fn numbers(text: &str) -> Vec<usize> {
    text.replace(',', "")
        .split(|c: char| !c.is_ascii_digit())
        .filter_map(|n| n.parse().ok())
        .collect()
}

fn row(line: &str) -> Option<Row> {
    let cells: Vec<&str> = line.split('|').map(str::trim).collect();
    let file = cells.get(1)?.strip_prefix('`')?.strip_suffix('`')?;
    let [vertices, faces] = numbers(cells.get(3)?)[..] else {
        return None;
    };
    let defects = match cells.get(4)?.split_once("open") {
        Some((_, open)) => numbers(open).try_into().ok()?,
        None => [0; 3],
    };
    file.ends_with(".obj").then(|| Row {
        file: file.to_owned(),
        vertices,
        faces,
        defects,
    })
}

#[test]
fn meshes_are_as_their_table_says() {
    let Some(folder) = data_folder() else {
        eprintln!("no data folder: nothing compared");
        return;
    };
    let table = std::fs::read_to_string(folder.join("README.md")).unwrap();
    let rows: Vec<Row> = table.lines().filter_map(row).collect();
    assert!(
        rows.len() >= 30,
        "only {} rows of the table understood",
        rows.len()
    );
    assert!(
        rows.iter().any(|r| r.defects != [0; 3]),
        "no negative control"
    );
    for expected in rows {
        check(&folder.join("meshes"), &expected);
    }
}

/// Vertices that a file lists, and points that they are: equal coordinates are one.
fn vertices(text: &str) -> [usize; 2] {
    let lines = text.lines().filter_map(|l| l.strip_prefix("v "));
    let coordinate = |word: &str| (word.parse::<f64>().unwrap() + 0.0).to_bits();
    let point = |l: &str| -> Vec<u64> { l.split_whitespace().take(3).map(coordinate).collect() };
    let all: Vec<Vec<u64>> = lines.map(point).collect();
    let distinct: BTreeSet<&Vec<u64>> = all.iter().collect();
    [all.len(), distinct.len()]
}

fn check(folder: &std::path::Path, expected: &Row) {
    let file = &expected.file;
    let read = obj::load(&folder.join(file)).unwrap();
    let mesh = &read.shape.into_mesh(Shading::Smooth).unwrap();
    let [lines, points] = vertices(&std::fs::read_to_string(folder.join(file)).unwrap());
    assert_eq!(lines, expected.vertices, "{file}");
    assert_eq!(mesh.positions().len(), points, "{file}");
    assert_eq!(mesh.triangles().len(), expected.faces, "{file}");
    let report = EdgeAdjacency::new(mesh.triangles()).closedness(mesh);
    // The table counts edges of more than two faces; those with as many faces either way
    // are no defect. Where points have become one, there is less boundary than it has.
    let [boundary, shared, flipped] = expected.defects;
    let (found, listed) = ([report.boundary, report.flipped], [boundary, flipped]);
    let fewer = lines > points && report.boundary < boundary;
    assert!(found == listed || fewer, "{file}: {report}, not {listed:?}");
    assert!(report.over_shared <= shared, "{file}: {report}");
    let left = [report.boundary, report.over_shared, report.flipped];
    assert_eq!(report.is_closed(), left == [0; 3], "{file}: {report}");
    if report.is_closed() {
        assert!(mesh.signed_volume() > 0.0, "{file}");
    }
    for warning in &read.warnings {
        eprintln!(
            "{file}: {} x{}: {}",
            warning.code, warning.count, warning.message
        );
    }
}

/// Scanned and open meshes alike: a volume winds a whole number of times round
/// any point, so no count leaks out of it.
#[test]
fn volumes_of_real_meshes_are_closed() {
    let Some(folder) = data_folder() else {
        eprintln!("no data folder: nothing checked");
        return;
    };
    for file in [
        "bunny.obj",
        "armadillo_10k.obj",
        "teapot_classic_open.obj",
        "suzanne.obj",
        "skeleton_full.obj",
    ] {
        let read = obj::load(&folder.join("meshes").join(file)).unwrap();
        let mesh = read.shape.into_mesh(Shading::Flat).unwrap();
        let (low, high) = mesh.bounds().unwrap();
        let (centre, size) = ((low + high) / 2.0, high - low);
        let light = HardLight::Point(centre + size * glam::DVec3::new(0.8, 1.7, 0.6));
        let volume = Caster::new(&mesh).volume(&mesh, light);
        let below = centre - size * glam::DVec3::new(0.81, 1.73, 0.59);
        let counts = [below, centre + size * 0.9].map(|p| volume_solid_angle(&volume, p));
        for count in counts {
            assert!((count - count.round()).abs() < 1e-6, "{file}: {count}");
        }
        assert!(
            counts[0] > 0.5 && counts[1].abs() < 0.5,
            "{file}: {counts:?}"
        );
    }
}
