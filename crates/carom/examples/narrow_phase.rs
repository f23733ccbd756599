//! How long the narrow phase takes for pairs with a convex hull: nanoseconds per call, apart, touching and overlapping.
//!
//! `cargo run --release -p carom --example narrow_phase [part of a pair's name]`

use carom::Shape;
use carom::collide::{manifolds, separation, separation_along};
use carom::math::{DVec3, Pose, rotation_from_vector};
use std::time::Instant;

/// Numbers from −1 to 1, the same ones every time (Marsaglia 2003).
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

fn blob(corners: u32) -> Shape {
    let mut number = numbers(7);
    let mut point = || DVec3::new(number(), number(), number()).normalize() * 0.5;
    Shape::hull(&(0..corners).map(|_| point()).collect::<Vec<_>>()).expect("a round hull")
}

fn block() -> Shape {
    let side = |corner: u32, bit: u32| f64::from(corner >> bit & 1) - 0.5;
    let corner = |k: u32| DVec3::new(side(k, 0), side(k, 1), side(k, 2));
    Shape::hull(&(0..8).map(corner).collect::<Vec<_>>()).expect("a cube")
}

/// 256 pairs of poses at which the gap along the line of the centres is about `gap` (m).
fn poses(a: &Shape, b: &Shape, gap: f64, spin: f64) -> Vec<(Pose, Pose)> {
    let mut number = numbers(11);
    let mut vector = || DVec3::new(number(), number(), number());
    (0..256)
        .map(|_| {
            let pose_a = Pose::new(vector() * 0.1, rotation_from_vector(vector() * spin));
            let way = if spin < 0.1 { DVec3::Y } else { vector().normalize_or(DVec3::Y) };
            let mut pose_b = Pose::new(pose_a.position + way * 2.0, rotation_from_vector(vector() * spin));
            for _ in 0..20 {
                pose_b.position -= way * (separation(a, &pose_a, b, &pose_b) - gap);
            }
            (pose_a, pose_b)
        })
        .collect()
}

fn nanoseconds(mut call: impl FnMut() -> f64) -> f64 {
    let mut least = f64::INFINITY;
    for _ in 0..7 {
        let start = Instant::now();
        let mut rounds = 0;
        let mut sum = 0.0;
        while start.elapsed().as_millis() < 20 {
            sum += call();
            rounds += 1;
        }
        assert!(sum.is_finite());
        least = least.min(start.elapsed().as_secs_f64() * 1e9 / f64::from(rounds) / 256.0);
    }
    least
}

fn main() {
    let pairs = [
        ("cube hull, cube hull (level)", block(), block(), 0.001),
        ("cube hull, cube hull", block(), block(), 3.0),
        ("cube hull, cuboid", block(), Shape::cuboid(1.0, 1.0, 1.0), 3.0),
        ("hull 16, hull 16", blob(16), blob(16), 3.0),
        ("hull 24, cuboid", blob(24), Shape::cuboid(1.0, 1.0, 1.0), 3.0),
        ("hull 24, hull 24", blob(24), blob(24), 3.0),
        ("hull 200, hull 200", blob(200), blob(200), 3.0),
        ("hull 16, ball", blob(16), Shape::sphere(0.3), 3.0),
        ("hull 16, capsule", blob(16), Shape::capsule(0.6, 0.2), 3.0),
        ("hull 16, plane", blob(16), Shape::plane(), 0.001),
    ];
    let gaps = [0.5, 0.01, 1e-7, -1e-7, -0.01, -0.2];
    print!("{:<34}", "ns per call, gap (m):");
    gaps.iter().for_each(|gap| print!("{gap:>9}"));
    println!();
    let wanted = std::env::args().nth(1).unwrap_or_default();
    for (name, a, b, spin) in pairs.iter().filter(|pair| pair.0.contains(&wanted)) {
        let all: Vec<_> = gaps.iter().map(|&gap| poses(a, b, gap, *spin)).collect();
        print!("{:<34}", format!("{name}: gap"));
        for poses in &all {
            let time = nanoseconds(|| poses.iter().map(|(p, q)| separation(a, p, b, q)).sum());
            print!("{time:>9.0}");
        }
        print!("\n{:<34}", "    along a known normal");
        for poses in &all {
            let normals: Vec<DVec3> =
                poses.iter().map(|(p, q)| (q.position - p.position).normalize_or(DVec3::Y)).collect();
            let along = |((p, q), &normal)| separation_along((a, p), (b, q), normal).max(-1e9);
            let time = nanoseconds(|| poses.iter().map(|(p, q)| (p, q)).zip(&normals).map(along).sum());
            print!("{time:>9.0}");
        }
        print!("\n{:<34}", "    contacts");
        let mut out = Vec::new();
        for poses in &all {
            let time = nanoseconds(|| {
                for (p, q) in poses {
                    manifolds((a, p), (b, q), 1e-4, &mut out);
                }
                let count = out.len() as f64;
                out.clear();
                count
            });
            print!("{time:>9.0}");
        }
        println!();
    }
}
