//! The support function of an ellipsoid of even degree n, Σ |x_i/a_i|ⁿ = 1: how far it reaches in a direction. It is
//! the dual norm.
//!
//! In the direction n, with s_i = a_i n_i and m = n/(n − 1): h = (Σ |s_i|^m)^(1/m). The furthest point has x_i = a_i
//! ∂h/∂s_i with ∂h/∂s_i = sign(s_i) (|s_i|/h)^(m−1). For degree 2, h = √(Σ s_i²). For a high degree the body is nearly
//! a box, and h nearly Σ |s_i|.

use crate::Real;

/// The smallest part of the largest |s_i| that counts: a smaller s_i is replaced by it. A root of it is far less than
/// rounding, and its derivative is finite.
const SMALLEST: f64 = 1e-200;

/// \[h, ∂h/∂s_x, ∂h/∂s_y, ∂h/∂s_z\] of s = (`x`, `y`, `z`) \[m\], not all 0, with the exponent `power` = m, 1 < m ≤ 2.
#[inline(always)]
pub fn support<T: Real>(x: T, y: T, z: T, power: T) -> [T; 4] {
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    // relative to the largest one, so that no power overflows or underflows
    let largest = x.abs().max(y.abs()).max(z.abs());
    let smallest = T::from_f64(SMALLEST);
    let (mut rest, mut sum) = ([zero; 3], zero);
    // no closures: the compiler cannot be told to inline them, and each operation on wide registers would become a call
    for (rest, s) in rest.iter_mut().zip([x, y, z]) {
        let part = (s.abs() / largest).max(smallest);
        *rest = part.powf(power - one);
        sum += part * *rest;
    }
    // h/largest, and its power m − 1
    let reach = sum.powf(one / power);
    let scale = reach / sum;
    for (rest, s) in rest.iter_mut().zip([x, y, z]) {
        let size = *rest * scale;
        *rest = T::select(s.lt(zero), -size, size);
    }
    let [dx, dy, dz] = rest;
    [largest * reach, dx, dy, dz]
}
