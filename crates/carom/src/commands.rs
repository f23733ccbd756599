//! What a user does to a body between steps.

use crate::bodies::{Activity, BodyId, WORLD_ROW};
use crate::error::Invalid;
use crate::impacts::strike::push;
use crate::math::{DQuat, DVec3};
use crate::world::World;

/// Commands to one body. Each wakes it; values that are not finite are refused and change nothing.
pub struct BodyMut<'world> {
    world: &'world mut World,
    id: BodyId,
}

impl<'world> BodyMut<'world> {
    pub(crate) fn new(world: &'world mut World, id: BodyId) -> Self {
        world.bodies.touch();
        Self { world, id }
    }

    /// The body's row, awake; the world's row if nothing can move it.
    fn wake_row(&mut self) -> usize {
        let row = self.world.bodies.get(self.id).map_or(WORLD_ROW, |record| record.row);
        self.world.bodies.wake(row);
        row
    }

    fn finite(field: &str, value: DVec3) -> Result<DVec3, Invalid> {
        if value.is_finite() {
            return Ok(value);
        }
        Err(Invalid::new(field, value, "three finite numbers"))
    }

    /// Pushes at the centre of mass during the whole next step (N). Adds to other forces.
    ///
    /// # Errors
    /// If the force is not finite.
    pub fn add_force(&mut self, force: DVec3) -> Result<(), Invalid> {
        let force = Self::finite("force", force)?;
        let row = self.wake_row();
        self.world.bodies.forces.add(row, (force, DVec3::ZERO));
        Ok(())
    }

    /// Pushes at a point of the world (m) during the whole next step (N).
    ///
    /// # Errors
    /// If force or point is not finite.
    pub fn add_force_at(&mut self, force: DVec3, point: DVec3) -> Result<(), Invalid> {
        let (force, point) = (Self::finite("force", force)?, Self::finite("point", point)?);
        let row = self.wake_row();
        let arm = point - self.world.bodies.states[row].position;
        self.world.bodies.forces.add(row, (force, arm.cross(force)));
        Ok(())
    }

    /// Turns about the centre of mass during the whole next step (N·m, world axes).
    ///
    /// # Errors
    /// If the torque is not finite.
    pub fn add_torque(&mut self, torque: DVec3) -> Result<(), Invalid> {
        let torque = Self::finite("torque", torque)?;
        let row = self.wake_row();
        self.world.bodies.forces.add(row, (DVec3::ZERO, torque));
        Ok(())
    }

    /// Strikes at a point of the world (m), now (N·s).
    ///
    /// # Errors
    /// If impulse or point is not finite.
    pub fn apply_impulse_at(&mut self, impulse: DVec3, point: DVec3) -> Result<(), Invalid> {
        let (impulse, point) = (Self::finite("impulse", impulse)?, Self::finite("point", point)?);
        let row = self.wake_row();
        let arm = point - self.world.bodies.states[row].position;
        push(&mut self.world.bodies, row, arm, impulse);
        self.publish(row);
        Ok(())
    }

    /// Strikes at the centre of mass, now (N·s).
    ///
    /// # Errors
    /// If the impulse is not finite.
    pub fn apply_impulse(&mut self, impulse: DVec3) -> Result<(), Invalid> {
        let impulse = Self::finite("impulse", impulse)?;
        let row = self.wake_row();
        self.apply_impulse_at(impulse, self.world.bodies.states[row].position)
    }

    /// Changes the angular momentum, now (N·m·s, world axes).
    ///
    /// # Errors
    /// If the impulse is not finite.
    pub fn apply_angular_impulse(&mut self, impulse: DVec3) -> Result<(), Invalid> {
        let impulse = Self::finite("impulse", impulse)?;
        let row = self.wake_row();
        if self.world.bodies.constants[row].is_movable() {
            self.world.bodies.states[row].angular_momentum += impulse;
        }
        self.publish(row);
        Ok(())
    }

    /// Sets the velocity of the centre of mass (m/s). Fixed bodies stay where they are.
    ///
    /// # Errors
    /// If the velocity is not finite.
    pub fn set_linear_velocity(&mut self, velocity: DVec3) -> Result<(), Invalid> {
        let velocity = Self::finite("linear_velocity", velocity)?;
        let row = self.wake_row();
        if row != WORLD_ROW {
            self.world.bodies.states[row].velocity = velocity;
        }
        self.publish(row);
        Ok(())
    }

    /// Sets the angular velocity (rad/s). Fixed bodies stay as they are.
    ///
    /// # Errors
    /// If the velocity is not finite.
    pub fn set_angular_velocity(&mut self, velocity: DVec3) -> Result<(), Invalid> {
        let velocity = Self::finite("angular_velocity", velocity)?;
        let row = self.wake_row();
        if row != WORLD_ROW {
            self.world.bodies.spin(row, velocity);
        }
        self.publish(row);
        Ok(())
    }

    /// Puts the body's origin elsewhere (m), at once and through whatever is between; its velocities stay.
    ///
    /// # Errors
    /// If position or rotation is not finite, or the rotation has no length.
    pub fn teleport(&mut self, position: DVec3, rotation: DQuat) -> Result<(), Invalid> {
        let position = Self::finite("position", position)?;
        if !rotation.is_finite() || rotation.length_squared() < 1e-12 {
            return Err(Invalid::new("rotation", rotation, "a unit quaternion [x, y, z, w]"));
        }
        let row = self.wake_row();
        let (id, world) = (self.id, &mut *self.world);
        world.bodies.place(id.index() as u32, position, rotation.normalize());
        let keys = world.bodies.get(id).map_or_else(Default::default, |record| record.colliders.clone());
        world.forget_colliders(&keys, row);
        world.enlist(id);
        self.publish(row);
        Ok(())
    }

    /// Wakes the body.
    pub fn wake(&mut self) {
        self.wake_row();
    }

    /// Stops the body and lets it stand, without gravity, until something touches it or a command wakes it.
    pub fn put_to_sleep(&mut self) {
        let row = self.wake_row();
        if self.world.bodies.put_to_sleep(row) {
            self.publish(row);
        }
    }

    /// Sets what you have stored with the body.
    pub fn set_user_data(&mut self, user_data: u64) {
        if let Some(record) = self.world.bodies.get_mut(self.id) {
            record.description.set_user_data(user_data);
        }
    }

    /// Whether the body takes part in the simulation.
    pub fn is_active(&self) -> bool {
        self.world.bodies.get(self.id).is_some_and(|record| record.activity != Activity::Quarantined)
    }

    fn publish(&mut self, row: usize) {
        if row != WORLD_ROW {
            self.world.bodies.publish(row);
        }
    }
}
