//! Against quadrature that is exact for polynomials: the basis is orthonormal, lobes
//! are what they integrate to, and turned coefficients are those of turned functions.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

use super::*;
use crate::world::shape::on_circle;

/// Directions and weights that integrate polynomials up to degree 20: Gauss and
/// Legendre's 11 nodes in z, 24 directions round it.
fn quadrature() -> Vec<(DVec3, f64)> {
    let mut out = Vec::new();
    for (z, weight) in gauss(11) {
        let across = (1.0 - z * z).sqrt();
        for k in 0..24 {
            let (cos, sin) = on_circle(2.0 * PI * (f64::from(k) + 0.3) / 24.0);
            let d = DVec3::new(across * cos, across * sin, z);
            out.push((d, weight * 2.0 * PI / 24.0));
        }
    }
    out
}

/// Roots of the Legendre polynomial of degree `n` by Newton's steps, and their weights.
fn gauss(n: usize) -> Vec<(f64, f64)> {
    let value = |z: f64| {
        let (mut before, mut now) = (1.0, z);
        for k in 1..n {
            let next = ((2 * k + 1) as f64 * z * now - k as f64 * before) / (k + 1) as f64;
            (before, now) = (now, next);
        }
        (now, n as f64 * (z * now - before) / (z * z - 1.0))
    };
    let root = |k: usize| {
        let mut z = on_circle(PI * (k as f64 + 0.75) / (n as f64 + 0.5)).0;
        for _ in 0..60 {
            let (p, slope) = value(z);
            z -= p / slope;
        }
        let slope = value(z).1;
        (z, 2.0 / ((1.0 - z * z) * slope * slope))
    };
    (0..n).map(root).collect()
}

/// Coefficients of a function by quadrature.
fn projected(bands: usize, f: impl Fn(DVec3) -> f64) -> Vec<f64> {
    let basis = Basis::new(bands);
    let mut out = vec![0.0; terms(bands)];
    for (d, weight) in quadrature() {
        let scaled = f(d) * weight;
        out.iter_mut()
            .zip(basis.at(d))
            .for_each(|(c, y)| *c += scaled * y);
    }
    out
}

/// Rodrigues' formula.
fn about(axis: DVec3, angle: f64) -> DMat3 {
    let (axis, (cos, sin)) = (axis.normalize(), on_circle(angle));
    let turned = |v: DVec3| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
    DMat3::from_cols(turned(DVec3::X), turned(DVec3::Y), turned(DVec3::Z))
}

fn turns() -> Vec<DMat3> {
    vec![
        DMat3::IDENTITY,
        about(DVec3::Z, 0.7),
        about(DVec3::X, PI / 2.0),
        about(DVec3::Y, -2.1),
        about(DVec3::new(1.0, -2.0, 0.5), 1.3),
        about(DVec3::new(-0.3, 0.2, 0.9), 3.0),
    ]
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values
        .into_iter()
        .fold(0.0, |most, v| f64::max(most, v.abs()))
}

#[test]
fn the_basis_is_orthonormal() {
    let basis = Basis::new(MOST_BANDS);
    for i in 0..terms(MOST_BANDS) {
        let row = projected(MOST_BANDS, |d| basis.at(d)[i]);
        let off = row.iter().enumerate();
        let off = largest(off.map(|(j, v)| v - if i == j { 1.0 } else { 0.0 }));
        assert!(off < 1e-13, "{i}: {off:e}");
    }
}

#[test]
fn the_first_band_is_y_z_x() {
    let d = DVec3::new(0.48, -0.6, 0.64);
    let c = (3.0 / (4.0 * PI)).sqrt();
    let expected = [d.y, d.z, d.x].map(|v| v * c);
    let found = &Basis::new(2).at(d)[1..4];
    assert!(largest(found.iter().zip(expected).map(|(a, b)| a - b)) < 1e-15);
}

/// Lambert's lobe is known: π, 2π/3, π/4, 0, -π/24, 0, π/64 (Ramamoorthi and Hanrahan
/// 2001); the half space has 2π, π, 0, -π/4.
#[test]
fn lobes_are_the_known_ones() {
    let known = [
        PI,
        2.0 * PI / 3.0,
        PI / 4.0,
        0.0,
        -PI / 24.0,
        0.0,
        PI / 64.0,
    ];
    let found = cosine_power(1.0, 7);
    assert!(
        largest(found.iter().zip(known).map(|(a, b)| a - b)) < 1e-14,
        "{found:?}"
    );
    let half = cosine_power(0.0, 4);
    let known = [2.0 * PI, PI, 0.0, -PI / 4.0];
    assert!(
        largest(half.iter().zip(known).map(|(a, b)| a - b)) < 1e-14,
        "{half:?}"
    );
    // A band of a whole power is a polynomial, and shaders are linear in between.
    let axis = DVec3::new(0.6, 0.0, 0.8);
    let even = |d: DVec3| d.dot(axis) * d.dot(axis); // twice its clamped half, even bands
    let both = projected(3, even);
    let clamped = about_axis(&Basis::new(3), axis, &cosine_power(2.0, 3));
    let bands = [0, 4, 5, 6, 7, 8];
    assert!(largest(bands.map(|i| both[i] - 2.0 * clamped[i])) < 1e-14);
    let [a, b, c] = [20.0, 20.25, 21.0].map(|n| phong_lobe(n, 4));
    assert!(largest((0..4).map(|l| 0.75 * a[l] + 0.25 * c[l] - b[l])) < 1e-15);
    assert_eq!(phong_lobe(f32::MAX, 4), phong_lobe(4096.0, 4));
}

fn is_orthogonal(rotation: &Rotation, bands: usize) -> f64 {
    let size = terms(bands);
    let unit = |i: usize| -> Vec<f64> {
        let at = |k| f64::from(u8::from(k == i));
        (0..size).map(at).collect()
    };
    let columns: Vec<Vec<f64>> = (0..size).map(|i| rotation.apply(&unit(i))).collect();
    let pairs = (0..size).flat_map(|i| (0..size).map(move |j| (i, j)));
    largest(pairs.map(|(i, j)| dot(&columns[i], &columns[j]) - f64::from(u8::from(i == j))))
}

#[test]
fn rotations_are_orthogonal_and_turn_functions() {
    let f: Vec<f64> = (0..36)
        .map(|k| libm::sin(f64::from(k) * 1.7 + 0.4))
        .collect();
    let basis = Basis::new(6);
    for turn in turns() {
        let rotation = Rotation::new(&turn, 6);
        let off = is_orthogonal(&rotation, 6);
        assert!(off < 1e-12, "{off:e}");
        let back = turn.transpose();
        let again = projected(6, |d| dot(&f, &basis.at(back * d)));
        let off = largest(rotation.apply(&f).iter().zip(&again).map(|(a, b)| a - b));
        assert!(off < 1e-12, "{turn}: {off:e}");
    }
    // The measures see what is no rotation, and one that turns the other way.
    let skew = DMat3::from_diagonal(DVec3::new(1.0, 1.0 + 1e-5, 1.0));
    assert!(is_orthogonal(&Rotation::new(&skew, 6), 6) > 1e-6);
    let (turn, other) = (turns()[4], turns()[4].transpose());
    let again = projected(6, |d| dot(&f, &basis.at(other.transpose() * d)));
    let wrong = Rotation::new(&turn, 6).apply(&f);
    assert!(largest(wrong.iter().zip(&again).map(|(a, b)| a - b)) > 0.1);
}

#[test]
fn turns_after_each_other_are_one() {
    let [a, b] = [turns()[4], turns()[5]];
    let f: Vec<f64> = (0..25).map(|k| libm::cos(f64::from(k) * 0.9)).collect();
    let [once, one, other] = [b * a, a, b].map(|t| Rotation::new(&t, 5));
    let after = other.apply(&one.apply(&f));
    assert!(largest(once.apply(&f).iter().zip(&after).map(|(a, b)| a - b)) < 1e-13);
}

/// The matrix of light gives the product's coefficients, also of turned light.
#[test]
fn products_are_those_of_functions() {
    let basis = Basis::new(4);
    let light = |d: DVec3| 1.0 + d.x + 0.5 * d.y * d.z;
    let other = |d: DVec3| 0.3 - d.z + d.x * d.y;
    let mut matrix = Product::dark(4);
    for (d, weight) in quadrature() {
        matrix.add(light(d) * weight, &basis.at(d));
    }
    let expected = projected(4, |d| light(d) * other(d));
    let found = matrix.times(&projected(4, other));
    // Products of degree four have a band that is left out, and nothing else is lost.
    let off = |a: &[f64], b: &[f64]| largest(a.iter().zip(b).map(|(a, b)| a - b));
    assert!(off(&found, &expected) < 1e-13);
    let turn = turns()[4];
    let back = turn.transpose();
    let turned = matrix.turned(&Rotation::new(&turn, 4));
    let expected = projected(4, |d| light(back * d) * other(d));
    let found = turned.times(&projected(4, other));
    assert!(off(&found, &expected) < 1e-12);
    assert!(off(&matrix.times(&projected(4, other)), &expected) > 0.1);
    let row: f64 = dot(turned.row(3), &projected(4, other));
    assert!((row - found[3]).abs() < 1e-15);
}
