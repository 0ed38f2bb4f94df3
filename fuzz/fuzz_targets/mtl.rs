//! Materials of Wavefront OBJ, of any bytes, beside a model that names them.
#![no_main]

use libfuzzer_sys::fuzz_target;

const MODEL: &[u8] = b"mtllib f.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n";

fuzz_target!(|data: &[u8]| {
    gnomon_fuzz::file("f.mtl", data);
    gnomon_fuzz::model("named.obj", MODEL);
});
