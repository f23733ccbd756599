//! What it ran on, and what this process has used. Linux only, as far as memory and the processor's name go.

use rustix::time::{ClockId, clock_gettime};
use serde::{Deserialize, Serialize};
use std::fs::read_to_string;

/// What it ran on.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Machine {
    /// The processor's name, or nothing where it is not known.
    pub processor: String,
    /// How many threads can run at once.
    pub threads: usize,
    /// Instruction sets that this program was compiled for, beyond its target's least.
    pub compiled_for: String,
}

impl Machine {
    /// This one.
    pub fn this() -> Self {
        let information = read_to_string("/proc/cpuinfo").unwrap_or_default();
        let named = information.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
        let wide = [("AVX2", cfg!(target_feature = "avx2")), ("AVX-512", cfg!(target_feature = "avx512f"))];
        let wide: Vec<&str> = wide.iter().filter(|(_, there)| *there).map(|(name, _)| *name).collect();
        Self {
            processor: named.map_or_else(String::new, |(_, name)| name.trim().to_string()),
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            compiled_for: if wide.is_empty() { "the plain target".to_string() } else { wide.join(", ") },
        }
    }
}

/// CPU time of all threads of this process so far, s.
pub fn cpu_time() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// The most memory that this process has had resident so far, MiB; 0 where the system does not tell.
pub fn peak_memory() -> f64 {
    let status = read_to_string("/proc/self/status").unwrap_or_default();
    status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:")?.split_whitespace().next()?.parse::<f64>().ok())
        .map_or(0.0, |kibibytes| kibibytes / 1024.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_goes_on_and_memory_is_used() {
        let before = cpu_time();
        let mut sum = 0_u64;
        while cpu_time() == before {
            sum = std::hint::black_box(sum.wrapping_add(1));
        }
        assert!(cpu_time() > before);
        if cfg!(target_os = "linux") {
            assert!(peak_memory() > 0.5);
        }
    }
}
