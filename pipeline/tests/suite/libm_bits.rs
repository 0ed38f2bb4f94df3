//! The functions of `libm` have the bits that they had: pictures and truth rest on them,
//! and no other version may slip in that rounds otherwise.

use sha2::{Digest, Sha256};

type Function = fn(f64) -> f64;

/// By name, with the first 64 bits of the digest of their values.
const FUNCTIONS: [(&str, Function, u64); 16] = [
    ("acos", libm::acos, 0xaf5c_b83f_8f32_c9ec),
    ("asin", libm::asin, 0x60ca_a2d7_e842_b176),
    ("atan", libm::atan, 0x8671_b315_61e6_fcc5),
    ("cbrt", libm::cbrt, 0x0f3a_b564_1aaa_1919),
    ("cos", libm::cos, 0x2aa3_10db_e079_aef6),
    ("exp", libm::exp, 0x1c07_126a_01a2_5d50),
    ("exp2", libm::exp2, 0x890e_1588_24da_307d),
    ("expm1", libm::expm1, 0x8c48_a0ef_5ae0_6bb7),
    ("log", libm::log, 0xa513_2911_0bb4_7f0c),
    ("log10", libm::log10, 0x1260_ec66_03c4_69e9),
    ("log1p", libm::log1p, 0x7a65_36ba_6ba1_db32),
    ("log2", libm::log2, 0xecc5_84d6_0177_36b1),
    ("sin", libm::sin, 0x7a93_9176_0aa1_3363),
    ("tan", libm::tan, 0xd23f_3fb7_279c_fc86),
    ("atan2", |x| libm::atan2(x, 0.7), 0xdca6_3bbf_8e05_f32b),
    ("pow", |x| libm::pow(x.abs(), 1.7), 0x99dd_d2fc_fcb3_e7b6),
];

/// Arguments of every size and sign, the same everywhere.
fn arguments() -> impl Iterator<Item = f64> {
    let mut state = 1u64;
    (0..20_000).map(move |i| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let share = (state >> 11) as f64 / (1u64 << 53) as f64;
        (2.0 * share - 1.0) * [1.0, 0.01, 8.0, 300.0][i % 4]
    })
}

#[test]
fn functions_of_libm_have_the_bits_that_they_had() {
    let mut wrong = Vec::new();
    for (name, function, digest) in FUNCTIONS {
        let mut all = Sha256::new();
        for x in arguments() {
            let value = function(x);
            // NaN of any bits is one.
            let bits = if value.is_nan() {
                u64::MAX
            } else {
                value.to_bits()
            };
            all.update(bits.to_le_bytes());
        }
        let found = u64::from_be_bytes(all.finalize()[..8].try_into().unwrap());
        if found != digest {
            wrong.push(format!("{name}: {found:#018x}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
