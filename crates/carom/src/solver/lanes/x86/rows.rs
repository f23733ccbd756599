//! Rows to columns and back: four rows with SSE2, eight with AVX.

use super::super::Row;
use std::arch::x86_64::*;

/// Columns of four rows.
#[inline(always)]
pub(super) unsafe fn gather_four(rows: &[Row], indices: &[u32]) -> [__m128; 8] {
    let indices = &indices[..4];
    let [a, b] = [&rows[indices[0] as usize], &rows[indices[1] as usize]];
    let [c, d] = [&rows[indices[2] as usize], &rows[indices[3] as usize]];
    // SAFETY: every x86-64 has SSE2.
    unsafe {
        let [s, t, u, v] = transposed([half(a, 0), half(b, 0), half(c, 0), half(d, 0)]);
        let [w, x, y, z] = transposed([half(a, 4), half(b, 4), half(c, 4), half(d, 4)]);
        [s, t, u, v, w, x, y, z]
    }
}

/// Writes columns into those of four rows whose bits are set in `writable`.
#[inline(always)]
pub(super) unsafe fn scatter_four(
    [s, t, u, v, w, x, y, z]: [__m128; 8],
    rows: &mut [Row],
    (indices, writable): (&[u32], u32),
) {
    let indices = &indices[..4];
    // SAFETY: every x86-64 has SSE2.
    unsafe {
        let (first, second) = (transposed([s, t, u, v]), transposed([w, x, y, z]));
        for lane in 0..4 {
            if writable >> lane & 1 == 1 {
                write(&mut rows[indices[lane] as usize], first[lane], second[lane]);
            }
        }
    }
}

/// Columns of eight rows, where there is AVX.
#[inline(always)]
pub(super) unsafe fn gather_eight(rows: &[Row], indices: &[u32]) -> [__m256; 8] {
    let indices = &indices[..8];
    // Two rows to a register, one in each half, so that nothing has to change halves.
    let [a, e] = [&rows[indices[0] as usize], &rows[indices[4] as usize]];
    let [b, f] = [&rows[indices[1] as usize], &rows[indices[5] as usize]];
    let [c, g] = [&rows[indices[2] as usize], &rows[indices[6] as usize]];
    let [d, h] = [&rows[indices[3] as usize], &rows[indices[7] as usize]];
    // SAFETY: the caller has AVX.
    unsafe {
        let first = [halves(a, e, 0), halves(b, f, 0), halves(c, g, 0), halves(d, h, 0)];
        let second = [halves(a, e, 4), halves(b, f, 4), halves(c, g, 4), halves(d, h, 4)];
        let ([s, t, u, v], [w, x, y, z]) = (transposed_halves(first), transposed_halves(second));
        [s, t, u, v, w, x, y, z]
    }
}

/// Writes columns into those of eight rows whose bits are set in `writable`, where there is AVX.
#[inline(always)]
pub(super) unsafe fn scatter_eight(
    [s, t, u, v, w, x, y, z]: [__m256; 8],
    rows: &mut [Row],
    (indices, writable): (&[u32], u32),
) {
    let indices = &indices[..8];
    // SAFETY: the caller has AVX.
    unsafe {
        let (first, second) = (transposed_halves([s, t, u, v]), transposed_halves([w, x, y, z]));
        for lane in 0..4 {
            if writable >> lane & 1 == 1 {
                let (first, second) =
                    (_mm256_castps256_ps128(first[lane]), _mm256_castps256_ps128(second[lane]));
                write(&mut rows[indices[lane] as usize], first, second);
            }
        }
        for lane in 0..4 {
            if writable >> (lane + 4) & 1 == 1 {
                let (first, second) =
                    (_mm256_extractf128_ps::<1>(first[lane]), _mm256_extractf128_ps::<1>(second[lane]));
                write(&mut rows[indices[lane + 4] as usize], first, second);
            }
        }
    }
}

/// Numbers `at` to `at + 3` of a row.
#[inline(always)]
unsafe fn half(row: &Row, at: usize) -> __m128 {
    let numbers = &row.0[at..at + 4];
    // SAFETY: every x86-64 has SSE2; four numbers.
    unsafe { _mm_loadu_ps(numbers.as_ptr()) }
}

/// Such numbers of a row in the lower half, and of another in the upper one, where there is AVX.
#[inline(always)]
unsafe fn halves(low: &Row, high: &Row, at: usize) -> __m256 {
    // SAFETY: the caller has AVX.
    unsafe { _mm256_insertf128_ps::<1>(_mm256_castps128_ps256(half(low, at)), half(high, at)) }
}

/// Writes both halves of a row.
#[inline(always)]
unsafe fn write(row: &mut Row, first: __m128, second: __m128) {
    let (low, high) = row.0.split_at_mut(4);
    // SAFETY: every x86-64 has SSE2; a row has two times four numbers.
    unsafe {
        _mm_storeu_ps(low.as_mut_ptr(), first);
        _mm_storeu_ps(high.as_mut_ptr(), second);
    }
}

/// Columns of four rows of four, or the other way round.
#[inline(always)]
unsafe fn transposed([a, b, c, d]: [__m128; 4]) -> [__m128; 4] {
    // SAFETY: every x86-64 has SSE2.
    unsafe {
        let (ab_low, ab_high) = (_mm_unpacklo_ps(a, b), _mm_unpackhi_ps(a, b));
        let (cd_low, cd_high) = (_mm_unpacklo_ps(c, d), _mm_unpackhi_ps(c, d));
        [
            _mm_movelh_ps(ab_low, cd_low),
            _mm_movehl_ps(cd_low, ab_low),
            _mm_movelh_ps(ab_high, cd_high),
            _mm_movehl_ps(cd_high, ab_high),
        ]
    }
}

/// Twice [`transposed`], in the lower and in the upper halves, where there is AVX.
#[inline(always)]
unsafe fn transposed_halves([a, b, c, d]: [__m256; 4]) -> [__m256; 4] {
    // SAFETY: the caller has AVX.
    unsafe {
        let (ab_low, ab_high) = (_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
        let (cd_low, cd_high) = (_mm256_unpacklo_ps(c, d), _mm256_unpackhi_ps(c, d));
        [
            _mm256_shuffle_ps::<0b01_00_01_00>(ab_low, cd_low),
            _mm256_shuffle_ps::<0b11_10_11_10>(ab_low, cd_low),
            _mm256_shuffle_ps::<0b01_00_01_00>(ab_high, cd_high),
            _mm256_shuffle_ps::<0b11_10_11_10>(ab_high, cd_high),
        ]
    }
}
