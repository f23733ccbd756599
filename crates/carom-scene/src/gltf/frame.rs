//! Transforms of nodes, composed in double precision.
//!
//! A node maps its coordinates to outer ones by `x ↦ A x + t`. Rigid bodies know no scale, so `A` is split into a
//! rotation and a rest, `A = R·S`. Where `S` is diagonal, its entries are the scale (signs included), and shapes
//! take it; where it is not, the node is sheared: only points can follow that.

use super::json::At;
use crate::SceneError;
use carom::limits;
use carom::math::{DMat3, DQuat, DVec3, Pose};

/// Off-diagonal part of `S`, against the length of its column, up to which a rotation is taken as it is written.
const SAME: f64 = 1e-6;
/// Cosine of the angle between two axes up to which they count as perpendicular: what single precision and a
/// scale of a hundred to one leave of a right angle.
const SHEAR: f64 = 1e-4;

/// `x ↦ linear·x + position`, with the rotation of `linear`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub linear: DMat3,
    pub position: DVec3,
    pub rotation: DQuat,
}

impl Frame {
    pub const IDENTITY: Frame =
        Frame { linear: DMat3::IDENTITY, position: DVec3::ZERO, rotation: DQuat::IDENTITY };

    /// Reads the transform of a node relative to its parent.
    pub fn read(node: &At) -> Result<Frame, SceneError> {
        if let Some(matrix) = node.get("matrix")? {
            for key in ["translation", "rotation", "scale"] {
                if let Some(part) = node.get(key)? {
                    return Err(part.error("no such key beside a matrix"));
                }
            }
            return Frame::from_matrix(&matrix);
        }
        let position = match node.get("translation")? {
            Some(at) => at.vector(limits::POSITION, " m")?,
            None => DVec3::ZERO,
        };
        let rotation = node.get("rotation")?.map_or(Ok(DQuat::IDENTITY), |at| at.rotation())?;
        let scale = node.get("scale")?.map_or(Ok(DVec3::ONE), |at| at.vector(f64::MAX, ""))?;
        Ok(Frame { linear: DMat3::from_quat(rotation) * DMat3::from_diagonal(scale), position, rotation })
    }

    fn from_matrix(matrix: &At) -> Result<Frame, SceneError> {
        let entries: [At; 16] = matrix.several()?;
        let mut m = [0.0; 16];
        for (number, at) in m.iter_mut().zip(&entries) {
            *number = at.number()?;
        }
        for (i, last) in [(3, 0.0), (7, 0.0), (11, 0.0), (15, 1.0)] {
            if (m[i] - last).abs() > 1e-6 {
                return Err(
                    entries[i].error(format!("{last} in the last row of a matrix (listed by columns)"))
                );
            }
        }
        for at in &entries[12..15] {
            at.within(-limits::POSITION..=limits::POSITION, " m")?;
        }
        let linear = DMat3::from_cols_array(&[m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]]);
        let rotation = rotation_of(&linear, DQuat::IDENTITY);
        Ok(Frame { linear, position: DVec3::new(m[12], m[13], m[14]), rotation })
    }

    /// The frame of a child, whose frame relative to this one is `local`.
    pub fn child(&self, local: &Frame) -> Frame {
        let linear = self.linear * local.linear;
        let rotation = rotation_of(&linear, (self.rotation * local.rotation).normalize());
        Frame { linear, position: self.linear * local.position + self.position, rotation }
    }

    /// Place and orientation.
    pub fn pose(&self) -> Pose {
        Pose::new(self.position, self.rotation)
    }

    /// The rest `S` that the rotation leaves of the linear part.
    pub fn stretch(&self) -> DMat3 {
        DMat3::from_quat(self.rotation).transpose() * self.linear
    }

    /// The scale along the node's axes, signs included; nothing where the node is sheared.
    pub fn scale(&self) -> Option<DVec3> {
        let stretch = self.stretch();
        is_diagonal(&stretch, SHEAR).then(|| diagonal(&stretch))
    }
}

fn diagonal(m: &DMat3) -> DVec3 {
    DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z)
}

fn is_diagonal(m: &DMat3, tolerance: f64) -> bool {
    let rest = *m - DMat3::from_diagonal(diagonal(m));
    (0..3).all(|i| rest.col(i).length() <= tolerance * m.col(i).length())
}

/// The rotation in `linear`: `written`, the product of the rotations that the file states, wherever a scale along
/// the axes explains the rest. Else an axis-by-axis orthogonalisation (Gram and Schmidt), with the first axis
/// turned round if the map mirrors.
fn rotation_of(linear: &DMat3, written: DQuat) -> DQuat {
    if is_diagonal(&(DMat3::from_quat(written).transpose() * *linear), SAME) {
        return written;
    }
    let mirror = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
    let x = (linear.x_axis * mirror).try_normalize();
    let y = linear.y_axis.try_normalize();
    let z = linear.z_axis.try_normalize();
    let axes = match (x, y, z) {
        (Some(x), Some(y), _) => right_angled(x, y).map(|(x, y)| [x, y, x.cross(y)]),
        (Some(x), None, Some(z)) => right_angled(x, z).map(|(x, z)| [x, z.cross(x), z]),
        (None, Some(y), Some(z)) => right_angled(y, z).map(|(y, z)| [y.cross(z), y, z]),
        _ => None,
    };
    match axes {
        Some([x, y, z]) => DQuat::from_mat3(&DMat3::from_cols(x, y, z)).normalize(),
        None => written,
    }
}

/// Two unit vectors, the second made perpendicular to the first.
fn right_angled(first: DVec3, second: DVec3) -> Option<(DVec3, DVec3)> {
    (second - first * first.dot(second)).try_normalize().map(|second| (first, second))
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom::math::rotation_from_vector;

    fn frame(rotation: DQuat, scale: DVec3) -> Frame {
        Frame {
            linear: DMat3::from_quat(rotation) * DMat3::from_diagonal(scale),
            position: DVec3::new(1.0, 2.0, 3.0),
            rotation,
        }
    }

    #[test]
    fn uniform_scales_multiply_and_rotations_compose() {
        let (p, q) = (rotation_from_vector(DVec3::X), rotation_from_vector(DVec3::new(0.2, -1.0, 0.5)));
        let outer = frame(p, DVec3::splat(2.0));
        let inner = outer.child(&frame(q, DVec3::new(3.0, -4.0, 5.0)));
        assert!((inner.scale().unwrap() - DVec3::new(6.0, -8.0, 10.0)).length() < 1e-12);
        assert!(inner.rotation.angle_between(p * q) < 1e-7);
        let expected = p * (DVec3::new(1.0, 2.0, 3.0) * 2.0) + DVec3::new(1.0, 2.0, 3.0);
        assert!((inner.position - expected).length() < 1e-12);
    }

    #[test]
    fn a_quarter_turn_under_uneven_scale_swaps_it() {
        let outer = frame(DQuat::IDENTITY, DVec3::new(2.0, 3.0, 4.0));
        let quarter = DQuat::from_xyzw(0.0, 0.0, 0.5_f64.sqrt(), 0.5_f64.sqrt());
        let scale = outer.child(&frame(quarter, DVec3::ONE)).scale().unwrap();
        assert!((scale - DVec3::new(3.0, 2.0, 4.0)).length() < 1e-12, "{scale}");
    }

    #[test]
    fn an_eighth_turn_under_uneven_scale_shears() {
        let outer = frame(DQuat::IDENTITY, DVec3::new(2.0, 3.0, 4.0));
        let child = outer.child(&frame(rotation_from_vector(DVec3::Z * 0.785), DVec3::ONE));
        assert!(child.scale().is_none());
    }

    #[test]
    fn a_mirror_above_a_rotation_is_a_rotation_and_a_mirror() {
        let mirror = frame(DQuat::IDENTITY, DVec3::new(-1.0, 1.0, 1.0));
        let child = mirror.child(&frame(rotation_from_vector(DVec3::new(0.3, 0.4, 0.5)), DVec3::ONE));
        let scale = child.scale().unwrap();
        assert!((scale.abs() - DVec3::ONE).length() < 1e-12);
        assert!(scale.x * scale.y * scale.z < 0.0);
        let again = DMat3::from_quat(child.rotation) * child.stretch();
        assert!((again - child.linear).abs_diff_eq(DMat3::ZERO, 1e-12));
    }

    #[test]
    fn no_scale_at_all_keeps_the_rotation() {
        let q = rotation_from_vector(DVec3::Y);
        let flat = frame(DQuat::IDENTITY, DVec3::ZERO).child(&frame(q, DVec3::ONE));
        assert_eq!(flat.scale(), Some(DVec3::ZERO));
        assert!(flat.rotation.angle_between(q) < 1e-7);
    }
}
