//! Checks that the mass matrix is neither structurally singular nor singular up to rounding.
//!
//! S is singular if a system can move without kinetic energy. As masses are positive, no centre of gravity moves then,
//! and each element turns only about axes about which it has no moment of inertia; these axes span N. It matters which
//! moments are zero, not how large the others are. From the leaves to the root, in a general attitude, with the centre
//! of gravity c and the positions u_c of the outboard joints, in absolute axes:
//!
//! ```text
//! Ω = { ω ∈ N : ω × (u_c − c) ∈ V_c for each child }     turns without energy, −ω × c being the velocity of the joint
//! V = { −ω × c : ω ∈ Ω }                                 what the joint may do without energy
//! ```
//!
//! S is singular in every attitude exactly if some ω of Ω is parallel to c, so that the joint rests, or if V of a free
//! reference joint contains more than 0. In the plane, the only turn is about y.
//!
//! Rounding can make a regular matrix singular. So the elimination of FORMALISM is run once at the default parameters,
//! with the cross-product matrix û:
//!
//! ```text
//! J' = A I Aᵀ + m(c²1 − ccᵀ) − Σ û_c K_c û_c        what turning about the joint meets
//! H  = m ĉ + Σ û_c K_c                               moment by acceleration of the joint
//! K  = m 1 + ΣK_c − Hᵀ J'⁻¹ H                        what the joint's acceleration meets
//! ```
//!
//! No J', nor K of a free reference joint, may have an eigenvalue that is rounding compared with its terms.

use super::Resolver;
use super::kinematics::{
    IDENTITY, Matrix, Vector, apply, cross, plus, product, rotation, sum, times, transpose, values,
};
use super::mobility::{Idle, idle, inertia, is_redundant};
use crate::description::load::Loaded;
use crate::description::place::At;
use crate::diagnostic::quoted;
use crate::model::{Dimension, Element, Model, Reference, System};

/// Inertia smaller than this part of the largest is lost: a product of a dozen rotations has an error of some 50
/// ε ≈ 1e-14, which leaves one digit.
pub const ROUNDING: f64 = 1e-13;

/// Square of a sine that counts as rounding, as an inertia is quadratic in the distance from its axis.
const PARALLEL: f64 = 1e-14;

/// An element that can move without inertia.
#[derive(Clone, Debug, PartialEq)]
pub struct Singular {
    /// Index of the element in its system.
    pub element: usize,
    /// The motion without inertia.
    motion: Motion,
}

#[derive(Clone, Debug, PartialEq)]
enum Motion {
    /// A freedom of a joint, a ball joint, or the reference joint.
    Idle(Idle),
    /// The element turns about this axis of its frame; if the reference joint is free, about its centre of gravity.
    Turn { axis: Vector, free: bool },
    /// The element turns about this axis of its frame with an inertia that is rounding compared with another.
    Slight {
        axis: Vector,
        inertia: f64,
        beside: f64,
    },
    /// The reference joint moves with an inertia that is rounding compared with another.
    SlightReference { inertia: f64, beside: f64 },
}

/// Reports elements that can move without inertia.
pub(super) fn check_regularity(resolver: &Resolver<'_>, loaded: &Loaded) {
    for system in &resolver.systems {
        if let Some(singular) = singular(system, resolver.planar, &resolver.defaults) {
            let name = &system.elements[singular.element].name;
            let redundant = match &singular.motion {
                Motion::Idle(idle) => {
                    is_redundant(system, idle, resolver.planar, &resolver.defaults)
                }
                _ => false,
            };
            let (message, help) = explain(resolver, &system.name, name, singular.motion, redundant);
            let at = place(loaded, &system.name, name);
            resolver.problems.add(at.problem(message, help));
        }
    }
}

/// The problem and a remedy, in words. `redundant` is true if a freedom does the same as others of its joint.
fn explain(
    resolver: &Resolver<'_>,
    system: &str,
    element: &str,
    motion: Motion,
    redundant: bool,
) -> (String, String) {
    let (system, element) = (quoted(system), quoted(element));
    let planar = resolver.planar;
    let about = |axis: Vector| match planar {
        true => String::new(),
        false => format!(" the axis {} of its frame", shown(axis)),
    };
    match motion {
        Motion::Turn { axis, free: true } => (
            format!(
                "the system {system} can move without any inertia: its root {element} turns about{} its centre of gravity",
                match planar {
                    true => String::new(),
                    false => format!("{} through", about(axis)),
                }
            ),
            "where the reference joint is free the root needs moments of inertia that are not zero: give `inertia` a positive value".into(),
        ),
        Motion::Turn { free: false, .. } if planar => (
            format!("element {element} can turn about its joint without any inertia"),
            "give it a positive `inertia`, or a `cg` away from the joint".into(),
        ),
        Motion::Turn { axis, free: false } => (
            format!(
                "element {element} can turn about{} through its joint without any inertia",
                about(axis)
            ),
            "all its mass and what it carries lies on that axis: give positive moments of inertia".into(),
        ),
        Motion::Idle(idle) => explain_idle(&system, &element, idle, redundant),
        Motion::Slight {
            axis,
            inertia,
            beside,
        } => (
            format!(
                "element {element} can turn about{} its joint with an inertia of {inertia:.1e} kg*m^2 beside {beside:.1e} kg*m^2, so little that rounding hides it",
                match planar {
                    true => String::new(),
                    false => format!("{} through", about(axis)),
                }
            ),
            "a part of less than 1e-13 is lost in double precision: give it a larger `inertia`, or leave the element out".into(),
        ),
        Motion::SlightReference { inertia, beside } => (
            format!(
                "the reference joint of the system {system} can move with an inertia of {inertia:.1e} kg beside {beside:.1e} kg, so little that rounding hides it"
            ),
            "a part of less than 1e-13 is lost in double precision: make a heavier element the root, or give this one more `mass` or `inertia`".into(),
        ),
    }
}

/// The problem and a remedy for a freedom without inertia. `system` and `element` are in quotation marks.
fn explain_idle(system: &str, element: &str, idle: Idle, redundant: bool) -> (String, String) {
    let which = match (idle.freedom, idle.reference) {
        (Some(freedom), _) => format!("the freedom {} of element {element}", quoted(&freedom)),
        (None, true) => format!("the reference joint of the system {system}"),
        (None, false) => format!("element {element} on its joint"),
    };
    let left = match idle.left {
        0.0 => "nothing of it is left".to_owned(),
        left => format!("a share of {left:.0e} of it is left"),
    };
    (
        format!("{which} can move without any inertia: {left} when what it carries, and what is before it in the joint, move freely"),
        match idle.reference {
            false if redundant => "the other freedoms of this joint move the element in all ways that this one does, whatever its mass: remove one of them, or give it another axis".into(),
            true => "the root moves in its own joint as the reference joint does: write `reference: fixed`, or another `joint` of the root".into(),
            false => "give what it carries mass or moments of inertia there, or remove a freedom whose axis another one has".into(),
        },
    )
}

impl Model {
    /// True if the mass matrix is not structurally singular, which holds for every model that was read.
    pub fn is_regular(&self) -> bool {
        let defaults: Vec<f64> = self.parameters.iter().map(|p| p.default).collect();
        let planar = self.dimension == Dimension::Plane;
        let mut systems = self.systems.iter();
        systems.all(|system| singular(system, planar, &defaults).is_none())
    }
}

/// The place where the inertia of an element is written.
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

/// A direction as people write it: with three digits, and a largest component of 1.
fn shown(axis: Vector) -> String {
    let largest = axis
        .iter()
        .fold(0.0f64, |m, a| if a.abs() > m.abs() + 1e-9 { *a } else { m });
    let digits = axis.map(|a| {
        let rounded = format!("{:.3}", a / largest);
        let trimmed = rounded.trim_end_matches('0').trim_end_matches('.');
        (if trimmed == "-0" { "0" } else { trimmed }).to_owned()
    });
    format!("[{}]", digits.join(", "))
}

/// The first element, from the leaves to the root, that can move without inertia; otherwise the first whose inertia is
/// lost to rounding.
pub fn singular(system: &System, planar: bool, parameters: &[f64]) -> Option<Singular> {
    if !system.has_balls_alone() {
        return idle(system, planar, parameters).map(|idle| Singular {
            element: idle.element,
            motion: Motion::Idle(idle),
        });
    }
    let attitudes: Vec<Matrix> = (0..system.elements.len())
        .map(|k| rotation(general_angles(k, planar)))
        .collect();
    without_inertia(system, planar, parameters, &attitudes)
        .or_else(|| slight(system, planar, parameters, &attitudes))
}

/// Unit vectors along the principal axes about which an element has no moment of inertia, in absolute axes.
fn idle_axes(element: &Element, a: &Matrix, planar: bool, parameters: &[f64]) -> Vec<Vector> {
    let moments = values(&element.inertia, parameters);
    let columns = transpose(&product(a, &rotation(values(&element.axes, parameters))));
    let none = |i: &usize| moments[*i] <= f64::EPSILON * moments.iter().sum::<f64>();
    match planar {
        true if moments[1] <= 0.0 => vec![columns[1]],
        true => Vec::new(),
        false => (0..3).filter(none).map(|i| columns[i]).collect(),
    }
}

/// The first element that can turn without energy while its joint rests; or the root, if it can turn while its joint
/// moves freely.
fn without_inertia(
    system: &System,
    planar: bool,
    parameters: &[f64],
    attitudes: &[Matrix],
) -> Option<Singular> {
    let elements = &system.elements;
    // For each element, V: the directions in which its joint may move without energy.
    let mut idle: Vec<Vec<Vector>> = vec![Vec::new(); elements.len()];
    let mut children = vec![Vec::new(); elements.len()];
    for (k, element) in elements.iter().enumerate() {
        if let Some(parent) = element.parent {
            children[parent].push(k);
        }
    }
    let size = |v: Vector| v.iter().fold(0.0f64, |m, a| m.max(a.abs()));
    for (k, element) in elements.iter().enumerate().rev() {
        let a = &attitudes[k];
        let axes = idle_axes(element, a, planar, parameters);
        if axes.is_empty() {
            continue;
        }
        let turn = |axis: Vector, free: bool| Singular {
            element: k,
            motion: Motion::Turn {
                axis: apply(&transpose(a), axis),
                free,
            },
        };
        let center = apply(a, values(&element.cg, parameters));
        // Each condition on ω is a square in G: ωᵀ G ω = 0 if and only if ω ∈ Ω.
        let mut conditions = IDENTITY;
        for axis in &axes {
            conditions = plus(&conditions, &times(&square(*axis), -1.0));
        }
        let mut largest = size(center);
        for &c in &children[k] {
            let joint = apply(a, values(&elements[c].at, parameters));
            largest = largest.max(size(joint));
            let arm = sum(joint, center.map(|c| -c));
            if let Some(arm) = direction(arm, size(joint).max(size(center))) {
                let mut across = cross(arm);
                for free in &idle[c] {
                    // removes the directions in which the child's joint may move
                    let passed = product(&square(*free), &across);
                    across = plus(&across, &times(&passed, -1.0));
                }
                conditions = plus(&conditions, &product(&transpose(&across), &across));
            }
        }
        let turns = kernel(&conditions);
        let Some(center) = direction(center, largest) else {
            // the centre of gravity is at the joint, which rests in every turn
            match turns.first() {
                Some(&axis) => return Some(turn(axis, false)),
                None => continue,
            }
        };
        let resting = product(&transpose(&cross(center)), &cross(center));
        if let Some(&axis) = kernel(&plus(&conditions, &resting)).first() {
            return Some(turn(axis, false));
        }
        if let (None, Reference::Free, Some(&axis)) =
            (element.parent, &system.reference, turns.first())
        {
            return Some(turn(axis, true));
        }
        let mut moves = [[0.0; 3]; 3];
        for axis in turns {
            moves = plus(&moves, &square(apply(&cross(axis), center)));
        }
        let (sizes, directions) = eigen(&moves);
        let moved = sizes.into_iter().zip(directions);
        idle[k] = moved
            .filter(|(size, _)| *size > PARALLEL)
            .map(|(_, direction)| direction)
            .collect();
    }
    None
}

/// v vᵀ
fn square(v: Vector) -> Matrix {
    v.map(|a| v.map(|b| a * b))
}

/// The unit vector along v; `None` if the length of v is rounding compared with `scale`.
fn direction(v: Vector, scale: f64) -> Option<Vector> {
    // scaled first, so that the squares of very small and very large lengths neither underflow nor overflow
    let largest = v.iter().fold(0.0f64, |m, a| m.max(a.abs()));
    if largest <= ROUNDING * scale {
        return None;
    }
    let v = v.map(|a| a / largest);
    let length = v.iter().map(|a| a * a).sum::<f64>().sqrt();
    Some(v.map(|a| a / length))
}

/// Unit vectors that satisfy all conditions, given as a sum of squares, each of the size of 1.
fn kernel(conditions: &Matrix) -> Vec<Vector> {
    let (values, vectors) = eigen(conditions);
    let seen = values.into_iter().zip(vectors);
    seen.filter(|(value, _)| *value <= PARALLEL)
        .map(|(_, vector)| vector)
        .collect()
}

/// The first element, from the leaves to the root, whose inertia is rounding compared with that of others.
fn slight(
    system: &System,
    planar: bool,
    parameters: &[f64],
    attitudes: &[Matrix],
) -> Option<Singular> {
    let n = system.elements.len();
    let mut stiff = vec![[[0.0; 3]; 3]; n]; // K
    let mut moment = vec![[[0.0; 3]; 3]; n]; // Σ û_c K_c
    let mut turning = vec![[[0.0; 3]; 3]; n]; // −Σ û_c K_c û_c
    let mut scale = vec![0.0; n];
    for k in (0..n).rev() {
        let element = &system.elements[k];
        let a = &attitudes[k];
        let (mass, c, own) = inertia(element, a, parameters);
        let j = plus(&own, &turning[k]);
        let h = plus(&times(&c, mass), &moment[k]);
        scale[k] += trace(&own);
        // Hᵀ J'⁻¹ H as a sum of squares, one for each eigenvector: entries of J'⁻¹ may be so large that only products
        // with Hᵀ cancel them
        let mut taken = [[0.0; 3]; 3];
        for (inertia, axis) in turns(&j, planar) {
            if inertia.is_nan() || inertia <= ROUNDING * scale[k] {
                return Some(Singular {
                    element: k,
                    motion: Motion::Slight {
                        axis: apply(&transpose(a), axis),
                        inertia: inertia.max(0.0),
                        beside: scale[k],
                    },
                });
            }
            let moved = apply(&transpose(&h), axis);
            taken = plus(&taken, &times(&square(moved), 1.0 / inertia));
        }
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
                let (total, inertia) = (trace(&rigid), smallest(&stiff[k], planar));
                if inertia <= ROUNDING * total {
                    return Some(Singular {
                        element: k,
                        motion: Motion::SlightReference {
                            inertia: inertia.max(0.0),
                            beside: total,
                        },
                    });
                }
            }
            None => {}
        }
    }
    None
}

/// Angles without any relation to one another: multiples of irrational numbers.
pub fn general_angles(k: usize, planar: bool) -> Vector {
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

/// The inertias of the possible turns: eigenvalues of J', with their axes.
fn turns(j: &Matrix, planar: bool) -> Vec<(f64, Vector)> {
    if planar {
        return vec![(j[1][1], IDENTITY[1])];
    }
    let (eigenvalues, vectors) = eigen(j);
    eigenvalues.into_iter().zip(vectors).collect()
}

/// The smallest eigenvalue of K; in the plane, that of its part in the plane.
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
pub fn eigen(a: &Matrix) -> (Vector, [Vector; 3]) {
    let mut a = *a;
    let mut v = IDENTITY; // rows are the eigenvectors
    for _ in 0..16 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let angle = 0.5 * libm::atan2(2.0 * a[p][q], a[q][q] - a[p][p]);
            let (s, c) = libm::sincos(angle);
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
