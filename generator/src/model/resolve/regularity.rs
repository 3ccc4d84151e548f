//! Proof that the system matrix is not structurally singular.
//!
//! The elimination of FORMALISM (leaves to root) is run once at the default parameters in a general attitude. With
//! û the cross-product matrix, c the centre of gravity and u_c the joints outboard, absolute axes,
//!
//! ```text
//! J' = A I Aᵀ + m(c²1 − ccᵀ) − Σ û_c K_c û_c        what turning about the joint meets
//! H  = m ĉ + Σ û_c K_c                               moment by acceleration of the joint
//! K  = m 1 + ΣK_c − Hᵀ J'⁻¹ H                        what the joint's acceleration meets
//! ```
//!
//! S is singular in every attitude exactly where some J', or K of a free reference joint, is. In the plane the only
//! turn is about y, and K acts within the plane.

use super::Resolver;
use super::kinematics::{
    IDENTITY, Matrix, Vector, apply, cross, plus, product, rotation, times, transpose, values,
};
use crate::description::load::Loaded;
use crate::description::place::At;
use crate::diagnostic::quoted;
use crate::model::{Dimension, Model, Reference, System};

/// Inertia smaller than this part of the largest is rounding: a product of a dozen rotations carries some 50 ε ≈ 1e-14.
const ROUNDING: f64 = 1e-13;

impl Resolver<'_> {
    /// Reports the elements that can move without inertia.
    pub fn check_regularity(&self, loaded: &Loaded) {
        for system in &self.systems {
            if let Some((element, free)) = singular(system, self.planar, &self.defaults) {
                let name = &system.elements[element].name;
                let at = place(loaded, &system.name, name);
                let (message, help) = if free {
                    (
                        format!(
                            "the system {} can turn about a point without any inertia",
                            quoted(&system.name)
                        ),
                        "a free reference joint needs moments of inertia that are not all zero: give `inertia` a positive value",
                    )
                } else if self.planar {
                    (
                        format!(
                            "element {} can turn about its joint without any inertia",
                            quoted(name)
                        ),
                        "give it a positive `inertia`, or a `cg` away from the joint",
                    )
                } else {
                    (
                        format!(
                            "element {} can turn about an axis through its joint without any inertia",
                            quoted(name)
                        ),
                        "all its mass and what it carries lies on a line through the joint: give positive moments of inertia",
                    )
                };
                self.problems.add(at.problem(message, help));
            }
        }
    }
}

impl Model {
    /// True where the system matrix is not structurally singular; of a model that was read it is not.
    pub fn is_regular(&self) -> bool {
        let defaults: Vec<f64> = self.parameters.iter().map(|p| p.default).collect();
        let planar = self.dimension == Dimension::Plane;
        let mut systems = self.systems.iter();
        systems.all(|system| singular(system, planar, &defaults).is_none())
    }
}

/// The inertia of an element as written.
fn place<'w>(loaded: &'w Loaded, system: &str, element: &str) -> At<'w> {
    let mut found = loaded.files[loaded.files.len() - 1].source.at();
    for file in &loaded.files {
        let list = file.source.at().key("systems");
        for (s, written) in file.contents.systems.iter().flatten().enumerate() {
            for (e, one) in written.elements.iter().flatten().enumerate() {
                if written.name == system && one.name == element {
                    found = list.item(s).key("elements").item(e).key("inertia");
                }
            }
        }
    }
    found
}

/// The first element without inertia from the leaves down, and whether it is the reference joint that moves without.
pub fn singular(system: &System, planar: bool, parameters: &[f64]) -> Option<(usize, bool)> {
    let n = system.elements.len();
    let attitudes: Vec<Matrix> = (0..n)
        .map(|k| rotation(general_angles(k, planar)))
        .collect();
    let mut stiff = vec![[[0.0; 3]; 3]; n]; // K
    let mut moment = vec![[[0.0; 3]; 3]; n]; // Σ û_c K_c
    let mut turning = vec![[[0.0; 3]; 3]; n]; // −Σ û_c K_c û_c
    let mut scale = vec![0.0; n];
    for k in (0..n).rev() {
        let element = &system.elements[k];
        let a = &attitudes[k];
        let mass = element.mass.value(parameters);
        let c = cross(apply(a, values(&element.cg, parameters)));
        let moments = values(&element.inertia, parameters);
        let axes = product(a, &rotation(values(&element.axes, parameters)));
        let principal = [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { moments[i] } else { 0.0 }));
        let own = plus(
            &product(&product(&axes, &principal), &transpose(&axes)),
            &times(&product(&c, &c), -mass),
        );
        let j = plus(&own, &turning[k]);
        let h = plus(&times(&c, mass), &moment[k]);
        scale[k] += trace(&own);
        let inverse = inverse(&j, planar, ROUNDING * scale[k]);
        let Some(inverse) = inverse else {
            return Some((k, false));
        };
        let taken = product(&product(&transpose(&h), &inverse), &h);
        let rigid = plus(&stiff[k], &times(&IDENTITY, mass));
        stiff[k] = plus(&rigid, &times(&taken, -1.0));
        match element.parent {
            Some(parent) => {
                let u = cross(apply(&attitudes[parent], values(&element.at, parameters)));
                let uk = product(&u, &stiff[k]);
                let uku = times(&product(&uk, &u), -1.0);
                moment[parent] = plus(&moment[parent], &uk);
                turning[parent] = plus(&turning[parent], &uku);
                stiff[parent] = plus(&stiff[parent], &stiff[k]);
                scale[parent] += trace(&uku).abs();
            }
            None if system.reference == Reference::Free => {
                let total = trace(&rigid);
                if smallest(&stiff[k], planar) <= ROUNDING * total {
                    return Some((k, true));
                }
            }
            None => {}
        }
    }
    None
}

/// Angles without any relation to each other: multiples of irrational numbers.
fn general_angles(k: usize, planar: bool) -> Vector {
    let angle = |step: f64| ((k + 1) as f64 * step).fract() * 2.0 + 0.2;
    if planar {
        [0.0, angle(0.618_033_988_749_895), 0.0]
    } else {
        [
            angle(0.754_877_666_246_693),
            angle(0.569_840_290_998_053),
            angle(0.618_033_988_749_895),
        ]
    }
}

fn trace(a: &Matrix) -> f64 {
    a[0][0] + a[1][1] + a[2][2]
}

/// The inverse of J' on the turns there are; `None` where an eigenvalue is not above `limit`.
fn inverse(j: &Matrix, planar: bool, limit: f64) -> Option<Matrix> {
    let mut inverse = [[0.0; 3]; 3];
    if planar {
        if j[1][1].is_nan() || j[1][1] <= limit {
            return None;
        }
        inverse[1][1] = 1.0 / j[1][1];
        return Some(inverse);
    }
    let (eigenvalues, vectors) = eigen(j);
    for (value, v) in eigenvalues.into_iter().zip(vectors) {
        if value.is_nan() || value <= limit {
            return None;
        }
        for r in 0..3 {
            for s in 0..3 {
                inverse[r][s] += v[r] * v[s] / value;
            }
        }
    }
    Some(inverse)
}

/// The smallest eigenvalue, within the plane where there is one.
fn smallest(k: &Matrix, planar: bool) -> f64 {
    let mut k = *k;
    if planar {
        k[1] = [0.0, f64::MAX.sqrt(), 0.0];
        k[0][1] = 0.0;
        k[2][1] = 0.0;
    }
    let (values, _) = eigen(&k);
    values.into_iter().fold(f64::INFINITY, f64::min)
}

/// Eigenvalues and eigenvectors of a symmetric matrix by Jacobi's rotations.
fn eigen(a: &Matrix) -> (Vector, [Vector; 3]) {
    let mut a = *a;
    let mut v = IDENTITY; // rows are the eigenvectors
    for _ in 0..16 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let angle = 0.5 * (2.0 * a[p][q]).atan2(a[q][q] - a[p][p]);
            let (s, c) = angle.sin_cos();
            let mut turn = IDENTITY;
            turn[p][p] = c;
            turn[q][q] = c;
            turn[p][q] = -s;
            turn[q][p] = s;
            a = product(&product(&turn, &a), &transpose(&turn));
            a[p][q] = 0.0;
            a[q][p] = 0.0;
            v = product(&turn, &v);
        }
    }
    ([a[0][0], a[1][1], a[2][2]], v)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvalues_of_a_rotated_diagonal_are_its_entries() {
        let r = rotation([0.4, -1.1, 2.0]);
        let diagonal = [[1.0, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 0.25]];
        let a = product(&product(&r, &diagonal), &transpose(&r));
        let (mut found, vectors) = eigen(&a);
        for (value, v) in found.iter().zip(vectors) {
            let av = apply(&a, v);
            for i in 0..3 {
                assert!((av[i] - value * v[i]).abs() < 1e-14);
            }
        }
        found.sort_by(f64::total_cmp);
        for (value, expected) in found.iter().zip([0.25, 1.0, 5.0]) {
            assert!((value - expected).abs() < 1e-14, "{found:?}");
        }
    }
}
