//! What surfaces are made of, and what two of them make together.

/// How two values become one. Where both colliders name a rule, the earlier one here goes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Combine {
    /// Half the sum.
    Average,
    /// The smaller.
    Minimum,
    /// The larger.
    Maximum,
    /// The product.
    Multiply,
}

impl Combine {
    fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Combine::Average => 0.5 * (a + b),
            Combine::Minimum => a.min(b),
            Combine::Maximum => a.max(b),
            Combine::Multiply => a * b,
        }
    }

    /// The rule of a pair: a side without one takes no part; if neither has one, `default` holds.
    fn of_pair(a: Option<Combine>, b: Option<Combine>, default: Combine) -> Combine {
        match (a, b) {
            (Some(a), Some(b)) => a.min(b),
            (Some(one), None) | (None, Some(one)) => one,
            (None, None) => default,
        }
    }
}

/// Friction and restitution of one surface. All coefficients are without dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Coulomb's coefficient while the surfaces stick; 0 or more.
    pub static_friction: f64,
    /// Coulomb's coefficient while they slide; 0 or more.
    pub dynamic_friction: f64,
    /// Parting speed over closing speed of an impact, C_r in the lecture: 0 (none) to 1 (all of it).
    pub restitution: f64,
    /// How friction combines with the other surface's; `None` leaves it to the other.
    pub friction_combine: Option<Combine>,
    /// How restitution combines with the other surface's; `None` leaves it to the other.
    pub restitution_combine: Option<Combine>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            static_friction: 0.6,
            dynamic_friction: 0.6,
            restitution: 0.0,
            friction_combine: None,
            restitution_combine: None,
        }
    }
}

/// What two materials make together: the coefficients that a contact between them uses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Coulomb's coefficient while the contact sticks.
    pub static_friction: f64,
    /// Coulomb's coefficient while it slides.
    pub dynamic_friction: f64,
    /// C_r: parting speed over closing speed.
    pub restitution: f64,
}

impl Surface {
    /// Combines two materials. Without a rule on either side friction is averaged and restitution is the larger.
    ///
    /// ```
    /// use carom::{Combine, Material, Surface};
    /// let rubber = Material { restitution: 0.9, ..Material::default() };
    /// let felt = Material { restitution: 0.1, restitution_combine: Some(Combine::Multiply), ..rubber };
    /// assert_eq!(Surface::between(&rubber, &rubber).restitution, 0.9);
    /// assert!((Surface::between(&rubber, &felt).restitution - 0.09).abs() < 1e-15);
    /// ```
    pub fn between(a: &Material, b: &Material) -> Self {
        let friction = Combine::of_pair(a.friction_combine, b.friction_combine, Combine::Average);
        let restitution = Combine::of_pair(a.restitution_combine, b.restitution_combine, Combine::Maximum);
        Self {
            static_friction: friction.apply(a.static_friction, b.static_friction),
            dynamic_friction: friction.apply(a.dynamic_friction, b.dynamic_friction),
            restitution: restitution.apply(a.restitution, b.restitution),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn average_goes_before_minimum_before_maximum_before_multiply() {
        let rule = |a, b| Combine::of_pair(a, b, Combine::Maximum);
        let order = [Combine::Average, Combine::Minimum, Combine::Maximum, Combine::Multiply];
        for (i, &first) in order.iter().enumerate() {
            for &second in &order[i..] {
                assert_eq!(rule(Some(first), Some(second)), first);
                assert_eq!(rule(Some(second), Some(first)), first);
            }
            assert_eq!(rule(Some(first), None), first);
            assert_eq!(rule(None, Some(first)), first);
        }
        assert_eq!(rule(None, None), Combine::Maximum);
    }
}
