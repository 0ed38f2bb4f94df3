//! The functions of [`crate::math`] on one `f32`: the same bits as a lane's.

macro_rules! twins {
    ($($name:ident($($arg:ident),*);)*) => { $(
        #[doc = concat!("[`crate::math::", stringify!($name), "`] of one `f32` each.")]
        #[must_use]
        pub fn $name($($arg: f32),*) -> f32 {
            super::$name($($arg),*)
        }
    )* };
}

twins! {
    sin(x);
    cos(x);
    tan(x);
    asin(x);
    acos(x);
    atan(x);
    atan2(y, x);
    exp(x);
    exp2(x);
    ln(x);
    log2(x);
    pow(x, y);
    rsqrt(x);
    saturate(x);
    mix(a, b, t);
    smoothstep(from, to, x);
}

macro_rules! vector_twins {
    ($($name:ident($($arg:ident: $n:literal),*) -> $out:ty;)*) => { $(
        #[doc = concat!("[`crate::math::", stringify!($name), "`] of `f32` components.")]
        #[must_use]
        pub fn $name($($arg: [f32; $n]),*) -> $out {
            super::$name($($arg),*)
        }
    )* };
}

vector_twins! {
    dot2(a: 2, b: 2) -> f32;
    dot3(a: 3, b: 3) -> f32;
    dot4(a: 4, b: 4) -> f32;
    length(a: 3) -> f32;
    cross(a: 3, b: 3) -> [f32; 3];
    normalize(a: 3) -> [f32; 3];
    reflect(i: 3, n: 3) -> [f32; 3];
}
