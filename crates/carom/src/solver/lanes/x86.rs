//! Lanes of x86-64: four at a time with SSE2, eight with AVX2 and AVX-512.
//!
//! Nobody outside [`lanes`](super) can name these lanes. They come into kernels through [`run`] alone, which
//! [`Machine`](super::Machine) calls with an instruction set that it has found on this machine. This is the reason for which every
//! `unsafe` block here may use its instructions.

#![allow(
    unsafe_code,
    reason = "instructions that not every machine has, and loads and stores of several numbers"
)]

mod rows;

use super::{InstructionSet, Kernel, Lanes, Line, Portable, SharedRows, Source, WRITABLE};
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// What comes from memory at a time, bytes.
const CACHE_LINE: usize = 64;

/// Runs a kernel with the instructions of `set`.
///
/// # Safety
/// The machine has them.
pub(super) unsafe fn run<K: Kernel>(set: InstructionSet, kernel: K) -> K::Output {
    match set {
        InstructionSet::Portable => kernel.run::<Portable<4>>(),
        InstructionSet::Sse2 => kernel.run::<Sse2>(),
        // SAFETY: the caller has found these instructions on this machine.
        InstructionSet::Avx2 => unsafe { with_avx2(kernel) },
        // SAFETY: the same.
        InstructionSet::Avx512 => unsafe { with_avx512(kernel) },
    }
}

/// All of the kernel is compiled into this function, and with its instructions.
#[target_feature(enable = "avx2")]
fn with_avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Avx2>()
}

/// AVX-512 as it is for eight lanes: twice the registers, and masks.
#[target_feature(enable = "avx512f,avx512vl")]
fn with_avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Avx512>()
}

/// Four lanes.
#[derive(Clone, Copy)]
struct Sse2(__m128);

/// Eight lanes.
#[derive(Clone, Copy)]
struct Avx2(__m256);

/// Eight lanes, chosen from by masks.
#[derive(Clone, Copy)]
struct Avx512(__m256);

/// `$method` of the operator `$trait`, one instruction.
macro_rules! operator {
    ($lanes:ident, $trait:ident, $method:ident, $instruction:ident) => {
        impl $trait for $lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: these lanes are only where their instructions are.
                Self(unsafe { $instruction(self.0, other.0) })
            }
        }
    };
}

/// Lanes from the instructions of one width: four operators; to fill, load and store; sign, root, maximum and minimum; and the
/// functions that choose, and exchange rows for columns.
macro_rules! lanes {
    (
        $lanes:ident, $width:literal,
        [$add:ident, $sub:ident, $mul:ident, $div:ident],
        [$fill:ident, $load:ident, $store:ident],
        [$xor:ident, $sqrt:ident, $max:ident, $min:ident],
        [$choose:ident, $nonzero:ident, $gather:ident, $scatter:ident]
    ) => {
        operator!($lanes, Add, add, $add);
        operator!($lanes, Sub, sub, $sub);
        operator!($lanes, Mul, mul, $mul);
        operator!($lanes, Div, div, $div);

        impl Neg for $lanes {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                // SAFETY: these lanes are only where their instructions are; so in all that follows.
                Self(unsafe { $xor(self.0, $fill(-0.0)) })
            }
        }

        impl Lanes for $lanes {
            const WIDTH: usize = $width;

            #[inline(always)]
            fn splat(value: f32) -> Self {
                // SAFETY: see `neg`.
                Self(unsafe { $fill(value) })
            }

            #[inline(always)]
            fn load(line: &Line, part: usize) -> Self {
                let numbers = &line.0[part * $width..(part + 1) * $width];
                // SAFETY: see `neg`; as many numbers as it loads.
                Self(unsafe { $load(numbers.as_ptr()) })
            }

            #[inline(always)]
            fn store(self, line: &mut Line, part: usize) {
                let numbers = &mut line.0[part * $width..(part + 1) * $width];
                // SAFETY: see `neg`; as many numbers as it stores.
                unsafe { $store(numbers.as_mut_ptr(), self.0) }
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: see `neg`.
                Self(unsafe { $sqrt(self.0) })
            }

            // The instruction, too, gives the second one where neither is greater; so does that of `min`.
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                // SAFETY: see `neg`.
                Self(unsafe { $max(self.0, other.0) })
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                // SAFETY: see `neg`.
                Self(unsafe { $min(self.0, other.0) })
            }

            #[inline(always)]
            fn select_greater(left: Self, right: Self, [yes, no]: [Self; 2]) -> Self {
                // SAFETY: see `neg`.
                Self(unsafe { $choose([left.0, right.0], [yes.0, no.0]) })
            }

            #[inline(always)]
            fn bring_near(lines: &[Line]) {
                for line in lines.iter().step_by(CACHE_LINE / size_of::<Line>()) {
                    // SAFETY: every x86-64 has it, and it does not even fault.
                    unsafe { _mm_prefetch::<_MM_HINT_T0>((&raw const *line).cast()) }
                }
            }

            #[inline(always)]
            fn gather(rows: impl Source, indices: &[u32]) -> [Self; 8] {
                // SAFETY: see `neg`.
                let [s, t, u, v, w, x, y, z] = unsafe { rows::$gather(rows, indices) };
                [Self(s), Self(t), Self(u), Self(v), Self(w), Self(x), Self(y), Self(z)]
            }

            #[inline(always)]
            fn scatter([s, t, u, v, w, x, y, z]: [Self; 8], rows: SharedRows<'_>, indices: &[u32]) {
                let columns = [s.0, t.0, u.0, v.0, w.0, x.0, y.0, z.0];
                // SAFETY: see `neg`.
                unsafe { rows::$scatter(columns, rows, (indices, $nonzero(columns[WRITABLE]))) }
            }
        }
    };
}

lanes!(
    Sse2,
    4,
    [_mm_add_ps, _mm_sub_ps, _mm_mul_ps, _mm_div_ps],
    [_mm_set1_ps, _mm_loadu_ps, _mm_storeu_ps],
    [_mm_xor_ps, _mm_sqrt_ps, _mm_max_ps, _mm_min_ps],
    [choose_of_four, nonzero_of_four, gather_four, scatter_four]
);
lanes!(
    Avx2,
    8,
    [_mm256_add_ps, _mm256_sub_ps, _mm256_mul_ps, _mm256_div_ps],
    [_mm256_set1_ps, _mm256_loadu_ps, _mm256_storeu_ps],
    [_mm256_xor_ps, _mm256_sqrt_ps, _mm256_max_ps, _mm256_min_ps],
    [choose_of_eight, nonzero_of_eight, gather_eight, scatter_eight]
);
lanes!(
    Avx512,
    8,
    [_mm256_add_ps, _mm256_sub_ps, _mm256_mul_ps, _mm256_div_ps],
    [_mm256_set1_ps, _mm256_loadu_ps, _mm256_storeu_ps],
    [_mm256_xor_ps, _mm256_sqrt_ps, _mm256_max_ps, _mm256_min_ps],
    [choose_by_mask, nonzero_by_mask, gather_eight, scatter_eight]
);

/// The first of `choices` where `left > right`, else the second.
#[inline(always)]
unsafe fn choose_of_four([left, right]: [__m128; 2], [yes, no]: [__m128; 2]) -> __m128 {
    // SAFETY: every x86-64 has SSE2.
    unsafe {
        let greater = _mm_cmpgt_ps(left, right);
        _mm_or_ps(_mm_and_ps(greater, yes), _mm_andnot_ps(greater, no))
    }
}

/// A bit for each number that is not zero.
#[inline(always)]
unsafe fn nonzero_of_four(numbers: __m128) -> u32 {
    // SAFETY: every x86-64 has SSE2.
    unsafe { _mm_movemask_ps(_mm_cmpneq_ps(numbers, _mm_setzero_ps())) as u32 }
}

/// As [`choose_of_four`], where there is AVX.
#[inline(always)]
unsafe fn choose_of_eight([left, right]: [__m256; 2], [yes, no]: [__m256; 2]) -> __m256 {
    // SAFETY: the caller has AVX.
    unsafe { _mm256_blendv_ps(no, yes, _mm256_cmp_ps::<_CMP_GT_OQ>(left, right)) }
}

/// As [`nonzero_of_four`], where there is AVX.
#[inline(always)]
unsafe fn nonzero_of_eight(numbers: __m256) -> u32 {
    // SAFETY: the caller has AVX.
    unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_NEQ_UQ>(numbers, _mm256_setzero_ps())) as u32 }
}

/// As [`choose_of_four`], where there is AVX-512F with VL.
#[inline(always)]
unsafe fn choose_by_mask([left, right]: [__m256; 2], [yes, no]: [__m256; 2]) -> __m256 {
    // SAFETY: the caller has AVX-512F with VL.
    unsafe { _mm256_mask_blend_ps(_mm256_cmp_ps_mask::<_CMP_GT_OQ>(left, right), no, yes) }
}

/// As [`nonzero_of_four`], where there is AVX-512F with VL.
#[inline(always)]
unsafe fn nonzero_by_mask(numbers: __m256) -> u32 {
    // SAFETY: the caller has AVX-512F with VL.
    unsafe { u32::from(_mm256_cmp_ps_mask::<_CMP_NEQ_UQ>(numbers, _mm256_setzero_ps())) }
}
