//! Origins far from a scene whose coordinates in units have more digits than a number.

use glam::DVec3;

/// The distance from which an origin's last digit is coarser than a hit's bound: 16 times the width of a scene.
pub(super) const FAR: f64 = (1_u64 << 20) as f64;

/// `a + b`, rounded, and what that lacks to the sum.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// Returns the point of a line that is nearest to the lattice's middle along the line's largest component. Also returns
/// how far along that component the point is from the origin. The arguments are the two points whose difference is the
/// origin, in scene units, and a direction. `None` where the difference is exact, so that the core itself loses
/// nothing.
pub(super) fn carry(
    [to, from]: [DVec3; 2],
    unit: f64,
    direction: DVec3,
) -> Option<([f64; 3], f64)> {
    let apart = [0, 1, 2].map(|k| two_sum(to[k], -from[k]));
    if apart.iter().all(|&(_, low)| low == 0.0) {
        return None;
    }
    // A unit is a power of two.
    let apart = apart.map(|(high, low)| (high / unit, low / unit));
    let major = direction.abs().max_position();
    let steps = -apart[major].0 / direction[major];
    let place = [0, 1, 2].map(|k| {
        let (high, low) = apart[k];
        let rise = steps * direction[k];
        let rise_low = steps.mul_add(direction[k], -rise);
        let (sum, sum_low) = two_sum(high, rise);
        sum + (sum_low + (rise_low + low))
    });
    Some((place, steps * direction[major].abs()))
}
