//! Whose a contact is, and what touches in it.

use crate::bodies::Bodies;
use crate::collide::{ContactPoint, Manifold};
use crate::solver::bundle::POINTS;
use crate::solver::graph::ContactId;
use crate::step::pairs::Pair;

/// The pair that a contact belongs to, and what touches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Owner {
    /// The pair's index.
    pub pair: u32,
    /// Whether its bodies have no other contact with each other.
    pub is_alone: bool,
    pub touched: Touched,
    /// The pair's next contact, if it has several.
    pub next: ContactId,
}

impl Owner {
    /// Of a contact that is no more.
    pub const NOBODY: Owner =
        Owner { pair: u32::MAX, is_alone: false, touched: Touched::NOTHING, next: ContactId::NONE };

    /// The owner of the contacts of a pair, of which it has so many.
    pub fn of(bodies: &Bodies, pair: &Pair, index: usize, contacts: usize) -> Self {
        let is_single = |slot: u32| bodies.record(slot).is_some_and(|record| record.colliders.len() == 1);
        let is_alone = contacts == 1 && pair.slots(bodies).into_iter().all(is_single);
        Self { pair: index as u32, is_alone, ..Self::NOBODY }
    }
}

/// What a contact is like.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Manner {
    /// Whether it would bounce if it were struck faster, and whether it has static friction.
    pub bounces: bool,
    pub rubs: bool,
}

/// What touches at each point of a contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touched {
    count: u8,
    /// Their features.
    features: [Features; POINTS],
}

/// Names the features of two surfaces that touch at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Features(u32);

impl Features {
    /// A good hash of both keys, as it is kept for each point of each contact: that two points of a pair share one by chance happens once in
    /// 2³² times, and then the impulse of one point goes to another one of the same contact.
    pub fn of(point: &ContactPoint) -> Self {
        let [a, b] = [point.feature_a, point.feature_b].map(|feature| u64::from(feature.key()));
        Self(((a << 32 | b).wrapping_mul(SPREAD) >> 32) as u32)
    }
}

/// 2⁶⁴ divided by the golden ratio, odd: Fibonacci hashing (Knuth, The Art of Computer Programming 3, section 6.4).
const SPREAD: u64 = 0x9e37_79b9_7f4a_7c15;

impl Touched {
    pub const NOTHING: Touched = Touched { count: 0, features: [Features(0); POINTS] };

    pub fn of(manifold: &Manifold) -> Self {
        let mut touched = Self { count: manifold.points().len() as u8, ..Self::NOTHING };
        for (entry, point) in touched.features.iter_mut().zip(manifold.points()) {
            *entry = Features::of(point);
        }
        touched
    }

    /// How many points there are.
    pub fn count(&self) -> usize {
        self.count.into()
    }

    /// The features that touch at each.
    pub fn features(&self) -> &[Features] {
        &self.features[..self.count()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Feature;

    #[test]
    fn pairs_of_features_have_names_of_their_own() {
        let kinds = [Feature::Vertex, Feature::Edge, Feature::Face];
        // Of boxes and hulls, and of triangles far on in a large mesh.
        let numbers = || (0..12).chain(1_000_000..1_000_012);
        let features = || numbers().flat_map(move |number| kinds.map(|kind| kind(number)));
        let mut names: Vec<u32> = features()
            .flat_map(|feature_a| features().map(move |feature_b| (feature_a, feature_b)))
            .map(|(feature_a, feature_b)| {
                Features::of(&ContactPoint { feature_a, feature_b, ..ContactPoint::NONE }).0
            })
            .collect();
        let count = names.len();
        assert_eq!(count, 72 * 72);
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count, "names that are shared");
    }
}
