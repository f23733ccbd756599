//! Storage of bodies.
//!
//! ```text
//! BodyId ──► slot   cold: description, mass, colliders, what the user reads (BodyState)
//!              │
//!              └──► row   warm: RigidState, Constants, Influence, clock; one row for each body that can move
//!                   row 0 = the world: infinite mass, at rest; every fixed body's row
//! ```
//!
//! ```text
//! bodies/state.rs        what users name bodies by, and read of them
//! bodies/record.rs       what the table keeps of a body and of its colliders
//! bodies/description.rs  what bodies were made from
//! bodies/forces.rs       what users push bodies with
//! ```
//!
//! Slots are stable and named by ids; rows are dense, so a step walks them in order. An id carries the generation of
//! its slot, hence an id of a removed body never names another one.

mod description;
mod forces;
mod record;
mod state;

use crate::body::{Body, Collider, Motion};
use crate::error::Invalid;
use crate::filter::Filter;
use crate::flight::{Constants, Influence, RigidState};
use crate::impacts::time_of_impact::is_exact;
use crate::ledger::Stock;
use crate::ledger::journal::Journal;
use crate::mass::BodyMass;
use crate::math::{DQuat, DVec3, Pose, Vec3};
use crate::room::Room;
use crate::shape::Shape;
use crate::step::motion::Plan;
use description::Description;
use forces::Forces;
pub(crate) use record::{Activity, ColliderRow, Outline, Record};
use smallvec::SmallVec;
pub use state::{BodyId, BodyState};

/// The row of everything that does not move.
pub(crate) const WORLD_ROW: usize = 0;

/// Whose collider it is: the body's slot and row, and its number there.
struct Owner {
    slot: u32,
    row: usize,
    number: u32,
}

struct Slot {
    generation: u32,
    record: Option<Record>,
}

/// All bodies of a world.
pub(crate) struct Bodies {
    slots: Vec<Slot>,
    free_slots: Vec<u32>,
    /// Warm rows; row 0 is the world.
    pub states: Vec<RigidState>,
    pub constants: Vec<Constants>,
    pub influences: Vec<Influence>,
    /// Time within the present step up to which each row has been advanced, s.
    pub clocks: Vec<f64>,
    /// How far (m, rad) the body's path has led so far, at least; grows for ever.
    pub ways: Vec<(f64, f64)>,
    /// Reach of the body's smallest collider, m: what is small against it is small for the body.
    pub grains: Vec<f64>,
    /// Bounds of its speeds (m/s, rad/s) on its present path.
    pub paces: Vec<(f64, f64)>,
    /// Counts its paths.
    pub courses: Vec<u32>,
    /// Whether it sleeps.
    sleeps: Vec<bool>,
    /// Forces of contacts that persist on a body's present path.
    pub plans: Vec<Option<Plan>>,
    /// What is noted for the ledger, if there is one.
    pub journal: Option<Box<Journal>>,
    /// What the user pushes bodies with during the next step.
    pub forces: Forces,
    /// The slot of each row.
    pub slot_of_row: Vec<u32>,
    colliders: Vec<Option<ColliderRow>>,
    /// Of each collider, last known.
    outlines: Vec<Outline>,
    free_colliders: Vec<u32>,
}

impl Bodies {
    pub fn new() -> Self {
        Self {
            slots: Vec::new(),
            free_slots: Vec::new(),
            states: vec![RigidState::REST],
            constants: vec![Constants::WORLD],
            influences: vec![Influence::default()],
            clocks: vec![0.0],
            ways: vec![(0.0, 0.0)],
            grains: vec![f64::INFINITY],
            paces: vec![(0.0, 0.0)],
            courses: vec![0],
            sleeps: vec![false],
            plans: vec![None],
            journal: None,
            forces: Forces::default(),
            slot_of_row: vec![u32::MAX],
            colliders: Vec::new(),
            outlines: Vec::new(),
            free_colliders: Vec::new(),
        }
    }

    /// Adds a body; one whose description is of no use goes into quarantine, with the reason.
    pub fn add(&mut self, description: Body) -> (BodyId, Result<(), Invalid>) {
        let checked = description.check().and_then(|()| BodyMass::of(&description));
        let (mass, activity, verdict) = match checked {
            Ok(mass) => (mass, Activity::Awake, Ok(())),
            Err(error) => (BodyMass::INFINITE, Activity::Quarantined, Err(error)),
        };
        let index = self.free_slots.pop().unwrap_or_else(|| {
            self.slots.put(Slot { generation: 0, record: None });
            (self.slots.len() - 1) as u32
        });
        let rotation = description.rotation.as_dquat().normalize();
        let center = Pose::new(description.position + rotation * mass.center, rotation);
        let takes_part = activity == Activity::Awake;
        let row = if takes_part && description.motion != Motion::Fixed {
            self.push_row(index, &description, &mass, center)
        } else {
            WORLD_ROW
        };
        let colliders = if takes_part {
            let place = |collider: &Collider| {
                Pose::new(collider.pose.position - mass.center, collider.pose.rotation.normalize())
            };
            let colliders = description.colliders.iter().enumerate();
            colliders
                .map(|(number, collider)| {
                    let owner = Owner { slot: index, row, number: number as u32 };
                    self.push_collider(owner, collider, place(collider))
                })
                .collect()
        } else {
            SmallVec::new()
        };
        let fixed_pose = (row == WORLD_ROW).then(|| Box::new(center));
        let state = BodyState {
            position: description.position,
            rotation: description.rotation,
            linear_velocity: if row == WORLD_ROW { Vec3::ZERO } else { description.linear_velocity },
            angular_velocity: if row == WORLD_ROW { Vec3::ZERO } else { description.angular_velocity },
            asleep: false,
        };
        let slot = &mut self.slots[index as usize];
        let description = Description::new(description, takes_part);
        slot.record = Some(Record { description, mass, state, row, activity, colliders, fixed_pose });
        (BodyId { index, generation: slot.generation }, verdict)
    }

    fn push_row(&mut self, slot: u32, description: &Body, mass: &BodyMass, center: Pose) -> usize {
        let spin = description.angular_velocity.as_dvec3();
        let mut constants = Constants::new(mass, center.rotation, spin);
        if description.motion == Motion::Dynamic {
            constants.linear_damping = description.linear_damping;
            constants.angular_damping = description.angular_damping;
            constants.gravity_factor = description.gravity_factor;
        }
        self.states.put(RigidState {
            position: center.position,
            rotation: center.rotation,
            velocity: description.linear_velocity.as_dvec3(),
            angular_momentum: constants.inertia(center.rotation) * spin,
        });
        self.touch();
        self.constants.put(constants);
        self.influences.put(Influence::default());
        self.clocks.put(0.0);
        self.ways.put((0.0, 0.0));
        let reach =
            |collider: &Collider| collider.shape.reach(collider.pose.inverse_transform_point(mass.center));
        self.grains.put(description.colliders.iter().map(reach).fold(f64::INFINITY, f64::min));
        self.paces.put((0.0, 0.0));
        self.courses.put(0);
        self.sleeps.put(false);
        self.plans.put(None);
        self.slot_of_row.put(slot);
        self.states.len() - 1
    }

    fn push_collider(&mut self, owner: Owner, collider: &Collider, local: Pose) -> u32 {
        let reach = collider.shape.reach(local.inverse_transform_point(DVec3::ZERO));
        let spin_reach = match collider.shape {
            Shape::Sphere { .. } => local.position.length(),
            Shape::Plane => 0.0,
            _ => reach,
        };
        let entry = ColliderRow {
            slot: owner.slot,
            row: owner.row,
            index: owner.number,
            shape: collider.shape.clone(),
            local,
            reach,
            spin_reach,
            material: collider.material,
            filter: Some(&collider.filter).filter(|it| **it != Filter::default()).cloned().map(Box::new),
            sensor: collider.sensor,
        };
        let outline =
            Outline { row: owner.row as u32, is_exact: is_exact(&collider.shape), reach, spin_reach };
        if let Some(key) = self.free_colliders.pop() {
            (self.colliders[key as usize], self.outlines[key as usize]) = (Some(entry), outline);
            key
        } else {
            self.colliders.put(Some(entry));
            self.outlines.put(outline);
            (self.colliders.len() - 1) as u32
        }
    }

    /// Removes a body with its colliders; returns what it was. The body of the last row, if it is another one, gets its row.
    pub fn remove(&mut self, id: BodyId) -> Option<Record> {
        self.get(id)?;
        let slot = &mut self.slots[id.index()];
        slot.generation += 1;
        let record = slot.record.take()?;
        self.free_slots.push(id.index);
        self.drop_colliders(&record.colliders);
        self.drop_row(record.row);
        Some(record)
    }

    fn drop_colliders(&mut self, keys: &[u32]) {
        for &key in keys {
            self.colliders[key as usize] = None;
            self.free_colliders.push(key);
        }
    }

    fn drop_row(&mut self, row: usize) {
        if row == WORLD_ROW {
            return;
        }
        self.states.swap_remove(row);
        self.constants.swap_remove(row);
        self.influences.swap_remove(row);
        self.clocks.swap_remove(row);
        self.ways.swap_remove(row);
        self.grains.swap_remove(row);
        self.paces.swap_remove(row);
        self.courses.swap_remove(row);
        self.sleeps.swap_remove(row);
        self.plans.swap_remove(row);
        if let Some(journal) = &mut self.journal {
            journal.swap_remove(row);
        }
        self.forces.swap_remove(row, self.states.len());
        self.slot_of_row.swap_remove(row);
        let Some(&moved) = self.slot_of_row.get(row) else { return };
        if let Some(record) = &mut self.slots[moved as usize].record {
            record.row = row;
            for &key in &record.colliders {
                if let Some(collider) = &mut self.colliders[key as usize] {
                    collider.row = row;
                    self.outlines[key as usize].row = row as u32;
                }
            }
        }
    }

    /// Takes a body out of the simulation where it was last seen whole; returns the keys of its colliders.
    pub fn quarantine(&mut self, slot: u32) -> SmallVec<[u32; 4]> {
        // Its colliders are part of what it was made from.
        self.record(slot).and_then(|record| record.description(|key| self.collider(key)));
        let Some(record) = self.slots[slot as usize].record.as_mut() else { return SmallVec::new() };
        record.activity = Activity::Quarantined;
        record.state.linear_velocity = Vec3::ZERO;
        record.state.angular_velocity = Vec3::ZERO;
        let colliders = std::mem::take(&mut record.colliders);
        let row = std::mem::replace(&mut record.row, WORLD_ROW);
        self.drop_colliders(&colliders);
        self.drop_row(row);
        colliders
    }

    pub fn get(&self, id: BodyId) -> Option<&Record> {
        let slot = self.slots.get(id.index())?;
        slot.record.as_ref().filter(|_| slot.generation == id.generation)
    }

    pub fn get_mut(&mut self, id: BodyId) -> Option<&mut Record> {
        let slot = self.slots.get_mut(id.index())?;
        slot.record.as_mut().filter(|_| slot.generation == id.generation)
    }

    /// What a body was made from.
    pub fn description(&self, id: BodyId) -> Option<&Body> {
        self.get(id)?.description(|key| self.collider(key))
    }

    /// The id of the body in a slot, if there is one.
    pub fn id_of(&self, slot: u32) -> Option<BodyId> {
        let entry = self.slots.get(slot as usize)?;
        entry.record.as_ref().map(|_| BodyId { index: slot, generation: entry.generation })
    }

    pub fn record(&self, slot: u32) -> Option<&Record> {
        self.slots.get(slot as usize)?.record.as_ref()
    }

    pub fn iter(&self) -> impl Iterator<Item = (BodyId, &Record)> {
        self.slots.iter().enumerate().filter_map(|(index, slot)| {
            let id = BodyId { index: index as u32, generation: slot.generation };
            slot.record.as_ref().map(|record| (id, record))
        })
    }

    /// Somebody changes bodies between steps: a ledger has to look at them again.
    pub fn touch(&mut self) {
        if let Some(journal) = &mut self.journal {
            journal.forget();
        }
    }

    /// Rows of bodies that can move: all but the world's.
    pub fn rows(&self) -> std::ops::Range<usize> {
        1..self.states.len()
    }

    #[inline]
    pub fn collider(&self, key: u32) -> Option<&ColliderRow> {
        self.colliders.get(key as usize)?.as_ref()
    }

    /// The outline of a collider that there is.
    #[inline]
    pub fn outline(&self, key: u32) -> &Outline {
        &self.outlines[key as usize]
    }

    /// How far (m, rad) the body's path has led by `time` within the step, at least: grows with time, and two times on the
    /// same path differ by no less than how far any point has moved.
    #[inline]
    pub fn way(&self, row: usize, time: f64) -> (f64, f64) {
        let (way, pace) = (self.ways[row], self.paces[row]);
        let flown = time - self.clocks[row];
        (way.0 + pace.0 * flown, way.1 + pace.1 * flown)
    }

    /// Where the centre of mass of a collider's body is now.
    #[inline]
    pub fn center_pose(&self, collider: &ColliderRow) -> Pose {
        if collider.row == WORLD_ROW {
            let fixed = self.record(collider.slot).and_then(|record| record.fixed_pose.as_deref());
            return fixed.copied().unwrap_or(Pose::IDENTITY);
        }
        let state = &self.states[collider.row];
        Pose::new(state.position, state.rotation)
    }

    /// Writes what the user reads from the row; returns its angular velocity, rad/s.
    pub fn publish(&mut self, row: usize) -> DVec3 {
        let state = self.states[row];
        let angular = self.constants[row].angular_velocity(&state);
        let slot = &mut self.slots[self.slot_of_row[row] as usize];
        let Some(record) = slot.record.as_mut() else { return angular };
        let center = record.mass.center;
        let offset = if center == DVec3::ZERO { center } else { state.rotation * center };
        record.state = BodyState {
            position: state.position - offset,
            rotation: state.rotation.as_quat(),
            linear_velocity: state.velocity.as_vec3(),
            angular_velocity: angular.as_vec3(),
            asleep: record.activity == Activity::Asleep,
        };
        angular
    }

    /// Gives the body of `row` another pose of its origin.
    pub fn place(&mut self, slot: u32, position: DVec3, rotation: DQuat) {
        let Some(record) = self.slots[slot as usize].record.as_mut() else { return };
        let center = Pose::new(position + rotation * record.mass.center, rotation);
        if let Some(fixed) = &mut record.fixed_pose {
            **fixed = center;
        }
        record.state.position = position;
        record.state.rotation = rotation.as_quat();
        let row = record.row;
        if row != WORLD_ROW {
            let spin = self.constants[row].angular_velocity(&self.states[row]);
            self.states[row].position = center.position;
            self.states[row].rotation = rotation;
            self.spin(row, spin);
        }
    }

    /// Gives a row another angular velocity (rad/s).
    pub fn spin(&mut self, row: usize, angular_velocity: DVec3) {
        let rotation = self.states[row].rotation;
        self.constants[row].drive(rotation, angular_velocity);
        self.states[row].angular_momentum = self.constants[row].inertia(rotation) * angular_velocity;
    }

    /// Wakes the body of a row; whether it was asleep.
    pub fn wake(&mut self, row: usize) -> bool {
        self.set_activity(row, Activity::Asleep, Activity::Awake)
    }

    /// Stops the body of a row and puts it to sleep; whether it was awake.
    pub fn put_to_sleep(&mut self, row: usize) -> bool {
        let slept = self.set_activity(row, Activity::Awake, Activity::Asleep);
        if slept {
            if let Some(mut journal) = self.journal.take() {
                journal.falls_asleep(row, &Stock::of_row(self, row, journal.gravity));
                self.journal = Some(journal);
            }
            self.states[row].velocity = DVec3::ZERO;
            self.spin(row, DVec3::ZERO);
        }
        slept
    }

    fn set_activity(&mut self, row: usize, from: Activity, to: Activity) -> bool {
        if row == WORLD_ROW || self.sleeps[row] != (from == Activity::Asleep) {
            return false;
        }
        let slot = self.slot_of_row.get(row).and_then(|&slot| self.slots.get_mut(slot as usize));
        let Some(record) = slot.and_then(|slot| slot.record.as_mut()) else { return false };
        let changes = record.activity == from;
        if changes {
            record.activity = to;
            record.state.asleep = to == Activity::Asleep;
            self.sleeps[row] = record.state.asleep;
        }
        changes
    }

    #[inline]
    pub fn is_asleep(&self, row: usize) -> bool {
        self.sleeps[row]
    }
}
