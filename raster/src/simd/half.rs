//! Conversion instructions between halves and floats, where a level has them. They
//! round once, ties to even, whatever the machine's mode, so that their bits are those
//! of the arithmetic in [`crate::format`]; but NaN, which keep a payload of their own.

use core::arch::x86_64::{
    __m128i, __m256, __m256i, __m512, _MM_FROUND_NO_EXC, _MM_FROUND_TO_NEAREST_INT,
    _mm256_cvtph_ps, _mm256_cvtps_ph, _mm512_cvtph_ps, _mm512_cvtps_ph,
};

use fearless_simd::{Avx2, Avx512, Simd as _, SimdInto as _, f32x8, f32x16, u16x8, u16x16};

fearless_simd::kernel!(
    #[inline(always)]
    fn narrow_avx2(avx2: Avx2, v: __m256) -> __m128i {
        _mm256_cvtps_ph::<_MM_FROUND_TO_NEAREST_INT>(v)
    }
);

fearless_simd::kernel!(
    #[inline(always)]
    fn widen_avx2(avx2: Avx2, h: __m128i) -> __m256 {
        _mm256_cvtph_ps(h)
    }
);

fearless_simd::kernel!(
    #[inline(always)]
    fn narrow_avx512(avx512: Avx512, v: __m512) -> __m256i {
        _mm512_cvtps_ph::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(v)
    }
);

fearless_simd::kernel!(
    #[inline(always)]
    fn widen_avx512(avx512: Avx512, h: __m256i) -> __m512 {
        _mm512_cvtph_ps(h)
    }
);

#[inline(always)]
pub(super) fn half_from_float_avx2(l: Avx2, v: f32x16<Avx2>) -> u16x16<Avx2> {
    let (lo, hi) = l.split_f32x16(v);
    let lo: u16x8<Avx2> = narrow_avx2(l, lo.into()).simd_into(l);
    let hi: u16x8<Avx2> = narrow_avx2(l, hi.into()).simd_into(l);
    l.combine_u16x8(lo, hi)
}

#[inline(always)]
pub(super) fn float_from_half_avx2(l: Avx2, h: u16x16<Avx2>) -> f32x16<Avx2> {
    let (lo, hi) = l.split_u16x16(h);
    let lo: f32x8<Avx2> = widen_avx2(l, lo.into()).simd_into(l);
    let hi: f32x8<Avx2> = widen_avx2(l, hi.into()).simd_into(l);
    l.combine_f32x8(lo, hi)
}

#[inline(always)]
pub(super) fn half_from_float_avx512(l: Avx512, v: f32x16<Avx512>) -> u16x16<Avx512> {
    narrow_avx512(l, v.into()).simd_into(l)
}

#[inline(always)]
pub(super) fn float_from_half_avx512(l: Avx512, h: u16x16<Avx512>) -> f32x16<Avx512> {
    widen_avx512(l, h.into()).simd_into(l)
}
