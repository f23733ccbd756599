//! What falls onto seams.

use super::*;

/// Where the mover is after some time, having been dropped from half a metre with that velocity.
fn dropped(floor: Floor, mover: &Mover, place: [f64; 2], restitution: f64) -> (DVec3, DVec3, f64, usize) {
    let frame = Frame::level();
    let mut world = world_over(frame);
    floor.lay(&mut world, frame, coat(0.0, restitution));
    let mut body = coated(mover.body(frame, place, (0.0, 0.5)), coat(0.0, restitution));
    body.linear_velocity = Vec3::new(2.0, 0.0, 0.7);
    let first = body.rotation;
    let id = world.add(body);
    let mut hits = 0;
    for _ in 0..80 {
        hits += world.step(STEP).impacts().iter().filter(|hit| hit.round == 0).count().min(1);
    }
    (world[id].position(), velocity(&world[id]), turned(&world[id], first), hits)
}

#[test]
fn it_bounces_as_on_a_plane() {
    // The fall takes 0.32 s: at 2 m/s along x and 0.7 along z these touch down beside a seam, on one, and on a corner.
    let fall = (2.0 * 0.5 / G).sqrt();
    let corner = [0.13 + 0.7, 0.31];
    let places = [
        [0.0, 0.0],
        [corner[0] - 2.0 * fall, 0.0],
        [corner[0] - 2.0 * fall + 1e-4, 0.0],
        [corner[0] - 2.0 * fall, corner[1] - 0.7 * fall],
        [corner[0] - 2.0 * fall - 1e-6, corner[1] - 0.7 * fall - 1e-5],
    ];
    let mut worst: f64 = 0.0;
    for mover in movers() {
        for (place, restitution) in places.into_iter().flat_map(|place| [(place, 0.0), (place, 1.0)]) {
            let truth = dropped(Floor::Slab, &mover, place, restitution);
            assert!(truth.3 >= 1);
            for floor in FLOORS {
                let found = dropped(floor, &mover, place, restitution);
                let case = format!("{} with C_r {restitution} from {place:?} onto {floor:?}", mover.name);
                let (off, change) = ((found.0 - truth.0).length(), (found.1 - truth.1).length());
                worst = worst.max(off).max(change).max(found.2);
                assert!(
                    off < 1e-3 && change < 1e-3 && found.2 < 1e-3,
                    "{case}: {off} m, {change} m/s, turned by {}",
                    found.2
                );
            }
        }
    }
    println!("worst: {worst}");
}
