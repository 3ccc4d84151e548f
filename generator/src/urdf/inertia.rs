//! Inertia of links: which no body can have, and the nearest that a body can.

use crate::rotation::{Matrix, Vector, add, dot, principal, scale, subtract, turned};

/// The relative excess of a principal moment over the sum of the others that counts as rounding.
pub const ROUNDING: f64 = 1e-9;

/// Inertia of a link, in the axes of the root link.
pub struct Part {
    pub link: usize,
    pub mass: f64,
    pub center: Vector,
    /// Inertia tensor about the centre of mass.
    pub tensor: Matrix,
}

/// The reason why no body can have this inertia, if there is one.
pub fn wrong_with(part: &Part) -> Option<String> {
    match part.mass <= 0.0 {
        true => Some("has no mass".to_owned()),
        false => wrong_tensor(&part.tensor),
    }
}

/// The reason why no body can have this tensor, if there is one.
pub fn wrong_tensor(tensor: &Matrix) -> Option<String> {
    let (moments, _) = principal(tensor);
    let sum: f64 = moments.iter().sum();
    let largest = moments.iter().copied().fold(f64::MIN, f64::max);
    let smallest = moments.iter().copied().fold(f64::MAX, f64::min);
    let shown = moments.map(|m| format!("{m:.4e}")).join(", ");
    if smallest < -ROUNDING * largest.abs() {
        Some(format!("has a negative principal moment: {shown} kg·m²"))
    } else if 2.0 * largest > sum * (1.0 + ROUNDING) {
        Some(format!(
            "is that of no body: of its principal moments {shown} kg·m² one is above the sum of the other two"
        ))
    } else {
        None
    }
}

/// The tensor of a body that is nearest to a symmetric one in the Frobenius norm.
///
/// The set of tensors of bodies is convex and the same in all axes, so the nearest has the same principal axes. Its
/// moments are the point nearest to the given ones in the cone of (b + c, a + c, a + b) with a, b, c ≥ 0, the second
/// moments of mass.
pub fn nearest(tensor: &Matrix) -> Matrix {
    let (moments, axes) = principal(tensor);
    let sums = |[a, b, c]: Vector| [b + c, a + c, a + b];
    // The normal equations of each face: the columns of the cone have the products 2 with themselves and 1 with each
    // other.
    let [x, y, z] = sums(moments);
    let half = 0.5 * (moments[0] + moments[1] + moments[2]);
    let two = |p: f64, q: f64| ((2.0 * p - q) / 3.0, (2.0 * q - p) / 3.0);
    let ((xy, yx), (xz, zx), (yz, zy)) = (two(x, y), two(x, z), two(y, z));
    let faces = [
        moments.map(|m| half - m),
        [xy, yx, 0.0],
        [xz, 0.0, zx],
        [0.0, yz, zy],
        [0.5 * x, 0.0, 0.0],
        [0.0, 0.5 * y, 0.0],
        [0.0, 0.0, 0.5 * z],
        [0.0; 3],
    ];
    let far = |second: &Vector| {
        let d = subtract(sums(*second), moments);
        dot(d, d)
    };
    let inside = faces
        .iter()
        .filter(|second| second.iter().all(|&s| s >= 0.0));
    let found = inside.min_by(|a, b| far(a).total_cmp(&far(b)));
    let [p, q, r] = sums(found.copied().unwrap_or_default());
    turned(&axes, &[[p, 0.0, 0.0], [0.0, q, 0.0], [0.0, 0.0, r]])
}

/// The Frobenius norm of a tensor.
pub fn norm(tensor: &Matrix) -> f64 {
    let squares = tensor.iter().flatten().map(|t| t * t);
    squares.sum::<f64>().sqrt()
}

/// The inertia of all parts together (parallel axis theorem).
pub fn together(link: usize, parts: &[Part]) -> Part {
    let mass: f64 = parts.iter().map(|p| p.mass).sum();
    let moment = parts
        .iter()
        .fold([0.0; 3], |sum, p| add(sum, scale(p.center, p.mass)));
    let center = match mass > 0.0 {
        true => scale(moment, 1.0 / mass),
        false => [0.0; 3],
    };
    let mut tensor = [[0.0; 3]; 3];
    for part in parts {
        let d = subtract(part.center, center);
        for (i, row) in tensor.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let square = if i == j { dot(d, d) } else { 0.0 };
                *entry += part.tensor[i][j] + part.mass * (square - d[i] * d[j]);
            }
        }
    }
    Part {
        link,
        mass,
        center,
        tensor,
    }
}
