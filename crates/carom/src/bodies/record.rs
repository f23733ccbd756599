//! What the table keeps of a body and of its colliders.

use super::BodyState;
use super::description::Description;
use crate::filter::Filter;
use crate::mass::BodyMass;
use crate::material::Material;
use crate::math::Pose;
use crate::shape::Shape;
use smallvec::SmallVec;

/// Whether a body takes part in the simulation, and if not, why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Activity {
    /// It does take part.
    Awake,
    /// Put to sleep; a touch or a command wakes it.
    Asleep,
    /// Its description or its state is of no use.
    Quarantined,
}

/// A body as the table keeps it.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    pub description: Description,
    pub mass: BodyMass,
    pub state: BodyState,
    pub row: usize,
    pub activity: Activity,
    /// Keys of its colliders.
    pub colliders: SmallVec<[u32; 4]>,
    /// Pose of the centre of mass where it does not follow from a row.
    pub fixed_pose: Option<Box<Pose>>,
}

/// A collider as the phases of a step use it.
#[derive(Clone, Debug)]
pub(crate) struct ColliderRow {
    /// Slot and row of its body.
    pub slot: u32,
    pub row: usize,
    /// Which of the body's colliders it is.
    pub index: u32,
    pub shape: Shape,
    /// Where it sits relative to the body's centre of mass.
    pub local: Pose,
    /// Farthest point from the centre of mass, m.
    pub reach: f64,
    /// The same, but of what moves when the body turns: 0 for a ball around the centre of mass.
    pub spin_reach: f64,
    pub material: Material,
    /// Whom it touches, unless it is in no group and touches everything, as most are.
    pub filter: Option<Box<Filter>>,
    pub sensor: bool,
}

impl ColliderRow {
    /// Whether its filter and another one's accept each other.
    #[inline]
    pub fn allows(&self, other: &ColliderRow) -> bool {
        if self.filter.is_none() && other.filter.is_none() {
            return true;
        }
        let open = Filter::default();
        let [one, other] = [self, other].map(|it| it.filter.as_deref().unwrap_or(&open));
        one.allows(other)
    }
}

/// Of a collider what pairs ask, and whoever looks for what is near: its body's row, and how far it reaches (m), as in its
/// [`ColliderRow`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outline {
    pub row: u32,
    /// Whether our own kernels tell how far it is from others, and not parry's iterations.
    pub is_exact: bool,
    pub reach: f64,
    pub spin_reach: f64,
}
