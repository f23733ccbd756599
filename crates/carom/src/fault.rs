//! Faults on purpose, to see that the audit finds them. No build has any unless it is asked for.
//!
//! `RUSTFLAGS='--cfg carom_fault="restitution"' cargo run -- check SCENE` plants one of those below. With
//! `--cfg carom_fault="any"` the environment variable `CAROM_FAULT` names it when the program runs, so that one build
//! serves for all. Each seam is one call on the engine's own path; without these flags it returns its argument.

use crate::math::DVec3;

#[cfg(not(carom_fault = "any"))]
const fn is_chosen(_: &str) -> bool {
    false
}

#[cfg(carom_fault = "any")]
fn is_chosen(fault: &str) -> bool {
    static CHOSEN: std::sync::OnceLock<String> = std::sync::OnceLock::new();
    CHOSEN.get_or_init(|| std::env::var("CAROM_FAULT").unwrap_or_default()) == fault
}

macro_rules! is_planted {
    ($fault:literal) => {
        cfg!(carom_fault = $fault) || is_chosen($fault)
    };
}

/// `restitution`: C_r is off by 1 %.
pub(crate) fn restitution(restitution: f64) -> f64 {
    if is_planted!("restitution") { 0.99 * restitution } else { restitution }
}

/// `friction`: what slides is braked by 1 % more than the cone allows.
pub(crate) fn friction(coefficient: f64) -> f64 {
    if is_planted!("friction") { 1.01 * coefficient } else { coefficient }
}

/// `lever_arm`: an impulse turns bodies the wrong way.
pub(crate) fn lever_arm(arm: DVec3) -> DVec3 {
    if is_planted!("lever_arm") { -arm } else { arm }
}

/// `lost_impulse`: every other body does not get its impulse.
pub(crate) fn lost_impulse(row: usize, impulse: DVec3) -> DVec3 {
    if is_planted!("lost_impulse") && row.is_multiple_of(2) { DVec3::ZERO } else { impulse }
}

/// `normal`: an impulse is off its line by a hundredth of itself.
pub(crate) fn normal(impulse: DVec3) -> DVec3 {
    if is_planted!("normal") {
        impulse + 0.01 * impulse.length() * DVec3::new(0.6, 0.0, 0.8)
    } else {
        impulse
    }
}

/// `lost_collision`: every other pair of bodies does not see each other coming.
pub(crate) fn lost_collision(slots: (u32, u32)) -> bool {
    is_planted!("lost_collision") && (slots.0 + slots.1) % 2 == 1
}

/// `gravity`: what flies falls 1 % too fast.
pub(crate) fn gravity(acceleration: DVec3) -> DVec3 {
    if is_planted!("gravity") { 1.01 * acceleration } else { acceleration }
}

/// `spin`: a thousandth of the angular momentum is lost in each flight.
pub(crate) fn spin(angular_momentum: DVec3) -> DVec3 {
    if is_planted!("spin") { 0.999 * angular_momentum } else { angular_momentum }
}
