//! Rows to columns and back: four rows with SSE2, eight with AVX.
//!
//! The rows of a bundle can be read, no other thread writes to them, and those that are writable no other thread reads: this is what
//! [`Source`] and [`SharedRows`] stand for.

use super::super::{Row, SharedRows, Source};
use std::arch::x86_64::*;

/// Columns of four rows.
#[inline(always)]
pub(super) unsafe fn gather_four(rows: impl Source, indices: &[u32]) -> [__m128; 8] {
    let indices = &indices[..4];
    let [a, b] = [rows.at(indices[0]), rows.at(indices[1])];
    let [c, d] = [rows.at(indices[2]), rows.at(indices[3])];
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
    rows: SharedRows<'_>,
    (indices, writable): (&[u32], u32),
) {
    let indices = &indices[..4];
    // SAFETY: every x86-64 has SSE2.
    unsafe {
        let (first, second) = (transposed([s, t, u, v]), transposed([w, x, y, z]));
        for lane in 0..4 {
            if writable >> lane & 1 == 1 {
                write(rows.at_mut(indices[lane]), first[lane], second[lane]);
            }
        }
    }
}

/// Columns of eight rows, where there is AVX.
#[inline(always)]
pub(super) unsafe fn gather_eight(rows: impl Source, indices: &[u32]) -> [__m256; 8] {
    let indices = &indices[..8];
    // Two rows to a register, one in each half, so that nothing has to change halves.
    let [a, e] = [rows.at(indices[0]), rows.at(indices[4])];
    let [b, f] = [rows.at(indices[1]), rows.at(indices[5])];
    let [c, g] = [rows.at(indices[2]), rows.at(indices[6])];
    let [d, h] = [rows.at(indices[3]), rows.at(indices[7])];
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
    rows: SharedRows<'_>,
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
                write(rows.at_mut(indices[lane]), first, second);
            }
        }
        for lane in 0..4 {
            if writable >> (lane + 4) & 1 == 1 {
                let (first, second) =
                    (_mm256_extractf128_ps::<1>(first[lane]), _mm256_extractf128_ps::<1>(second[lane]));
                write(rows.at_mut(indices[lane + 4]), first, second);
            }
        }
    }
}

/// Numbers `at` to `at + 3` of a row that can be read.
#[inline(always)]
unsafe fn half(row: *const Row, at: usize) -> __m128 {
    debug_assert!(at <= 4);
    // SAFETY: every x86-64 has SSE2; four numbers of the eight that a row is.
    unsafe { _mm_loadu_ps(row.cast::<f32>().add(at)) }
}

/// Such numbers of a row in the lower half, and of another in the upper one, where there is AVX.
#[inline(always)]
unsafe fn halves(low: *const Row, high: *const Row, at: usize) -> __m256 {
    // SAFETY: the caller has AVX, and rows that can be read.
    unsafe { _mm256_insertf128_ps::<1>(_mm256_castps128_ps256(half(low, at)), half(high, at)) }
}

/// Writes both halves of a row that nobody else has.
#[inline(always)]
unsafe fn write(row: *mut Row, first: __m128, second: __m128) {
    let row = row.cast::<f32>();
    // SAFETY: every x86-64 has SSE2; a row is two times four numbers.
    unsafe {
        _mm_storeu_ps(row, first);
        _mm_storeu_ps(row.add(4), second);
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
