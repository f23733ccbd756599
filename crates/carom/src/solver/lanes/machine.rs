//! Which instructions kernels run with.

use super::Lanes;
#[cfg(not(target_arch = "x86_64"))]
use super::Portable;

/// Instructions that the solver computes with, from the narrowest to the widest. All give the same bits.
///
/// ```
/// use carom::{InstructionSet, Settings, World};
///
/// let settings = Settings { instruction_set: InstructionSet::Portable, ..Settings::default() };
/// let world = World::with_settings(settings);
/// assert_eq!(world.settings().instruction_set, InstructionSet::Portable);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum InstructionSet {
    /// What the compiler makes of plain Rust, on any machine.
    Portable,
    /// Four numbers at a time; every x86-64 has it.
    Sse2,
    /// Eight numbers at a time.
    Avx2,
    /// Eight numbers at a time, in twice as many registers.
    Avx512,
}

impl InstructionSet {
    /// All of them, from the narrowest to the widest.
    pub const ALL: [InstructionSet; 4] = [Self::Portable, Self::Sse2, Self::Avx2, Self::Avx512];

    /// Whether this machine has it.
    pub fn is_available(self) -> bool {
        match self {
            Self::Portable => true,
            #[cfg(target_arch = "x86_64")]
            Self::Sse2 => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => std::arch::is_x86_feature_detected!("avx2"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                std::arch::is_x86_feature_detected!("avx512f")
                    && std::arch::is_x86_feature_detected!("avx512vl")
            }
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }

    /// The widest that this machine has, up to this one.
    #[must_use]
    pub fn or_narrower(self) -> Self {
        let has = |set: &Self| *set <= self && set.is_available();
        Self::ALL.into_iter().rfind(has).unwrap_or(Self::Portable)
    }
}

impl Default for InstructionSet {
    /// The widest that this machine has.
    fn default() -> Self {
        Self::Avx512.or_narrower()
    }
}

/// Work that is done in lanes. The whole of it is compiled for each instruction set: `run` and all that it calls with lanes has to be
/// `#[inline(always)]` and no closure, since only what ends up inside of one function has that function's instructions.
pub(crate) trait Kernel {
    /// What comes of it.
    type Output;

    /// Does it with one kind of lanes.
    fn run<L: Lanes>(self) -> Self::Output;
}

/// An instruction set that this machine has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Machine(InstructionSet);

impl Default for Machine {
    fn default() -> Self {
        Self::new(InstructionSet::default())
    }
}

impl Machine {
    /// With `wanted`, or the widest below it that there is.
    pub fn new(wanted: InstructionSet) -> Self {
        Self(wanted.or_narrower())
    }

    /// Does the work.
    #[cfg(target_arch = "x86_64")]
    #[allow(unsafe_code, reason = "the one way into instructions that not every machine has")]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        // SAFETY: a machine is made by `new` alone, which has asked for the instruction set.
        unsafe { super::x86::run(self.0, kernel) }
    }

    /// Does the work.
    #[cfg(not(target_arch = "x86_64"))]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        kernel.run::<Portable<4>>()
    }
}
