//! Placements of parts by instances.

use glam::{DAffine3, DMat3, DQuat, DVec3};

/// A map from a part's coordinates to the scene's: scaled by `scale` (above 0), then rotated, then moved.
///
/// ```
/// use glam::{DQuat, DVec3};
/// use gridel_host::scene::Placement;
///
/// let placement = Placement {
///     rotation: DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
///     translation: DVec3::new(0.0, 0.0, 5.0),
///     scale: 2.0,
/// };
/// assert_eq!(placement.point(DVec3::X), DVec3::new(0.0, 2.0, 5.0));
/// assert_eq!(placement.direction(DVec3::X), DVec3::Y);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// A quaternion of length 1.
    pub rotation: DQuat,
    pub translation: DVec3,
    pub scale: f64,
}

impl Placement {
    /// Leaves everything in its place.
    pub const IDENTITY: Self = Self {
        rotation: DQuat::IDENTITY,
        translation: DVec3::ZERO,
        scale: 1.0,
    };

    /// Largest difference of a matrix's entries from those of a rotation, relative to the scale.
    const TOLERANCE: f64 = 1e-6;

    /// Maps a point of the part to the scene.
    pub fn point(&self, point: DVec3) -> DVec3 {
        self.matrix() * point + self.translation
    }

    /// Returns a direction of the part in the scene; its length stays.
    pub fn direction(&self, direction: DVec3) -> DVec3 {
        self.turn() * direction
    }

    /// Returns the rotation times the scale.
    pub fn matrix(&self) -> DMat3 {
        self.turn() * self.scale
    }

    /// The map as an affine transform.
    pub(crate) fn affine(&self) -> DAffine3 {
        DAffine3 {
            matrix3: self.matrix(),
            translation: self.translation,
        }
    }

    /// The rotation, whose quarter turns are exact.
    fn turn(&self) -> DMat3 {
        /// A few roundings of an `f64`.
        const ROUNDED: f64 = 4.0 * f64::EPSILON;
        let exact = |entry: f64| {
            let whole = entry.round();
            if (entry - whole).abs() <= ROUNDED {
                whole
            } else {
                entry
            }
        };
        let turn = DMat3::from_quat(self.rotation);
        DMat3::from_cols_array(&turn.to_cols_array().map(exact))
    }

    /// Returns the placement that applies `self` first and `outer` then.
    ///
    /// ```
    /// use glam::DVec3;
    /// use gridel_host::scene::Placement;
    ///
    /// let moved = Placement { translation: DVec3::X, ..Placement::IDENTITY };
    /// let scaled = Placement { scale: 3.0, ..Placement::IDENTITY };
    /// assert_eq!(moved.within(&scaled).point(DVec3::ZERO), DVec3::X * 3.0);
    /// ```
    #[must_use]
    pub fn within(&self, outer: &Self) -> Self {
        Self {
            rotation: (outer.rotation * self.rotation).normalize(),
            translation: outer.point(self.translation),
            scale: outer.scale * self.scale,
        }
    }

    /// Returns whether all numbers are finite, the scale is above 0 and the rotation has length 1.
    pub fn is_valid(&self) -> bool {
        let scaled = self.scale.is_finite() && self.scale > 0.0;
        self.translation.is_finite() && scaled && self.rotation.is_normalized()
    }

    /// Reads a matrix and a translation. `None` unless the matrix is a rotation times a scale above 0, within 1e-6 of
    /// the scale. A mirror is rejected, too.
    ///
    /// ```
    /// use glam::{DAffine3, DMat3, DVec3};
    /// use gridel_host::scene::Placement;
    ///
    /// let even = DMat3::from_diagonal(DVec3::splat(2.0));
    /// assert_eq!(Placement::from_affine(even, DVec3::ZERO).map(|it| it.scale), Some(2.0));
    /// let uneven = DMat3::from_diagonal(DVec3::new(2.0, 2.0, 3.0));
    /// assert_eq!(Placement::from_affine(uneven, DVec3::ZERO), None);
    /// ```
    pub fn from_affine(matrix: DMat3, translation: DVec3) -> Option<Self> {
        Self::near(matrix, translation, Self::TOLERANCE)
    }

    /// Returns the placement nearest to a matrix whose entries are off by at most `tolerance` of the scale.
    pub(super) fn near(matrix: DMat3, translation: DVec3, tolerance: f64) -> Option<Self> {
        let (rotation, scale) = rotation_and_scale(matrix, tolerance)?;
        let placement = Self {
            rotation,
            translation,
            // Rotations that were rounded stay rotations.
            scale: match (scale - 1.0).abs() <= tolerance {
                true => 1.0,
                false => scale,
            },
        };
        (translation.is_finite() && placement.is_valid()).then_some(placement)
    }
}

/// Returns the rotation and the scale that are nearest to a matrix. `None` if one of its entries is off by more than
/// `tolerance` of the scale, or it mirrors.
pub(super) fn rotation_and_scale(matrix: DMat3, tolerance: f64) -> Option<(DQuat, f64)> {
    let entries = matrix.to_cols_array();
    let size = entries.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
    if !size.is_normal() || entries.iter().any(|it| !it.is_finite()) {
        return None;
    }
    // At size 1 the determinant can neither overflow nor vanish.
    let unit = DMat3::from_cols(
        matrix.x_axis / size,
        matrix.y_axis / size,
        matrix.z_axis / size,
    );
    let determinant = unit.determinant();
    // A rotation has an entry of at least 1 / sqrt(3), so the determinant of its multiple is at least 1.
    if determinant < 0.5 {
        return None;
    }
    let root = libm::cbrt(determinant);
    let scaled = unit * (1.0 / root);
    let turn = nearest_rotation(scaled);
    let near = turn.abs_diff_eq(scaled, tolerance);
    near.then(|| (DQuat::from_mat3(&turn).normalize(), size * root))
}

/// The rotation nearest to a matrix with a positive determinant near 1: the orthogonal factor of its polar
/// decomposition, by Newton's iteration (N. Higham, *SIAM Journal on Scientific and Statistical
/// Computing* 7, 1986).
fn nearest_rotation(matrix: DMat3) -> DMat3 {
    // Errors are squared in each step: 1e-3 needs three.
    (0..4).fold(matrix, |turn, _| (turn + turn.inverse().transpose()) * 0.5)
}

#[cfg(test)]
pub(super) mod tests;
