//! The scenes that can be asked for, and what becomes of them at other sizes.

use super::{Scene, Size, gas, packed, piles, pyramids, terrain};

/// A scene that can be asked for by name.
pub struct Entry {
    /// What the command line calls it.
    pub name: &'static str,
    /// One line for people.
    pub about: &'static str,
    /// Writes it down.
    pub build: fn(Size) -> Scene,
    /// What another count of bodies does to it.
    pub growth: Growth,
}

/// What another count of bodies does to a scene, and so how many of its steps are a fair measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Growth {
    /// It knows no count.
    None,
    /// Its bodies do the same from the first step to the last, whatever their count.
    Steady,
    /// They fall, land and come to rest, and with more bodies the highest falls farther.
    Falling,
}

impl Entry {
    /// How many steps show as much with `count` bodies as the scene's own steps do with its own count.
    ///
    /// Where bodies do the same all the time, that is as many. Where they fall, steps grow as the time of the highest
    /// body's fall does, with the square root of its height: falling, landing and resting then keep their shares of the run.
    pub fn steps_with(&self, count: usize) -> usize {
        let own = (self.build)(Size::default());
        if self.growth != Growth::Falling {
            return own.steps;
        }
        let other = (self.build)(Size { count: Some(count), base: None });
        (own.steps as f64 * (other.height() / own.height()).sqrt()).round() as usize
    }
}

/// All scenes, in the order in which they run.
pub const SCENES: &[Entry] = &[
    Entry {
        name: "pyramid",
        about: "a wall of unit boxes, 40 in the lowest course",
        build: pyramids::one,
        growth: Growth::None,
    },
    Entry {
        name: "many_pyramids",
        about: "196 such walls, 10 in the lowest course",
        build: pyramids::many,
        growth: Growth::None,
    },
    Entry {
        name: "pile_boxes",
        about: "4,000 boxes dropped into a pit",
        build: piles::boxes,
        growth: Growth::Falling,
    },
    Entry {
        name: "pile_mixed",
        about: "4,000 spheres, capsules, boxes and hulls in a pit",
        build: piles::mixed,
        growth: Growth::Falling,
    },
    Entry {
        name: "pile_spheres",
        about: "8,000 spheres dropped into a pit",
        build: piles::spheres,
        growth: Growth::Falling,
    },
    Entry {
        name: "packed_boxes",
        about: "4,000 boxes that rest in a pit from the start",
        build: packed::boxes,
        growth: Growth::Steady,
    },
    Entry {
        name: "mesh_terrain",
        about: "2,000 of four kinds on hills of 32,768 triangles",
        build: terrain::hills,
        growth: Growth::Falling,
    },
    Entry {
        name: "elastic_gas",
        about: "2,000 spheres that lose nothing, without gravity",
        build: gas::elastic,
        growth: Growth::Steady,
    },
];

/// The scenes that run where none is asked for.
pub const DEFAULT_SCENES: [&str; 3] = ["pyramid", "pile_boxes", "pile_mixed"];

/// The same where cost against size is asked for: every step of it costs about the same, so few of them do.
pub const SIZES_SCENES: [&str; 1] = ["packed_boxes"];

/// The scene of that name.
pub fn find(name: &str) -> Option<&'static Entry> {
    SCENES.iter().find(|entry| entry.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scenes_have_the_counts_they_promise() {
        let counts = [820, 10_780, 4000, 4000, 8000, 4000, 2000, 2000];
        for (entry, count) in SCENES.iter().zip(counts) {
            assert_eq!((entry.build)(Size::default()).dynamic_count(), count, "{}", entry.name);
        }
        for entry in SCENES.iter().filter(|entry| entry.growth != Growth::None) {
            for count in [1, 30, 2000] {
                let scene = (entry.build)(Size { count: Some(count), base: None });
                assert_eq!(scene.dynamic_count(), count, "{}", entry.name);
            }
        }
        let small = (find("pyramid").unwrap().build)(Size { count: None, base: Some(4) });
        assert_eq!(small.dynamic_count(), 10);
    }

    /// Nobody starts out of bounds, and nobody far inside another: at most the corners of neighbours meet.
    #[test]
    fn the_scenes_start_in_bounds_and_almost_without_overlap() {
        for entry in SCENES {
            for count in [30, 500] {
                let scene = (entry.build)(Size { count: Some(count), base: Some(5) });
                let start = crate::quality::Poses::of_scene(&scene);
                let judge = crate::quality::Judge::new(&scene);
                let overlap = judge.overlap(&start);
                assert!(overlap.max < 0.2, "{} of {count}: {overlap:?}", entry.name);
                assert!(overlap.pairs * 20 < scene.bodies.len(), "{} of {count}: {overlap:?}", entry.name);
                assert_eq!(judge.escaped(&start), 0, "{} of {count}", entry.name);
            }
        }
    }

    /// Eight times the boxes fall from twice the height, but for what whole columns and layers round away.
    #[test]
    fn steps_grow_with_the_time_of_the_fall() {
        let (pile, packed) = (find("pile_boxes").unwrap(), find("packed_boxes").unwrap());
        assert_eq!([100, 4000, 100_000].map(|count| pile.steps_with(count)), [326, 600, 1022]);
        let ratio = pile.steps_with(32_000) as f64 / pile.steps_with(4000) as f64;
        assert!((ratio - 2.0_f64.sqrt()).abs() < 0.05, "{ratio}");
        assert_eq!(packed.steps_with(100), packed.steps_with(100_000));
    }
}
