//! Proof that every freedom of a system meets an inertia, for systems with other joints than balls.
//!
//! The articulated-body algorithm is run once in f64, at the default parameters and in a general position. D = Hᵀ I H of a joint with the columns
//! H, I the articulated inertia, has in its decomposition L d Lᵀ what is left of the inertia of each freedom when those further out, and those
//! before it in the joint, move as they like. Where that is rounding beside the inertia of the composite body, the freedom meets none: two
//! hinges of a list have one axis, a body without moments turns about its own centre of gravity, and so on.

use super::kinematics::{
    IDENTITY, Matrix, Vector, apply, cross, placed, plus, product, rotation, sum, times, transpose,
    values,
};
use super::regularity::{ROUNDING, general_angles};
use crate::model::{FreedomKind, Joint, Reference, System};

/// Matrix of wrenches and motions, linear components first.
type Spatial = [[f64; 6]; 6];

/// A velocity: how it moves the origin, and how it turns.
type Column = [f64; 6];

/// What meets no inertia.
#[derive(Clone, Debug, PartialEq)]
pub struct Idle {
    /// Index in its system.
    pub element: usize,
    /// The freedom by its name; none for a ball joint or the reference joint.
    pub freedom: Option<String>,
    /// What is left of its inertia, as a share of that of the composite body.
    pub left: f64,
    /// Whether it is the reference joint.
    pub reference: bool,
}

/// The first freedom that meets no inertia, from the leaves inwards.
pub fn idle(system: &System, planar: bool, parameters: &[f64]) -> Option<Idle> {
    let frames = general_position(system, planar, parameters);
    let elements = &system.elements;
    let mut articulated: Vec<Spatial> = Vec::with_capacity(elements.len());
    for (element, (a, _)) in elements.iter().zip(&frames) {
        let mass = element.mass.value(parameters);
        let c = cross(apply(a, values(&element.cg, parameters)));
        let moments = values(&element.inertia, parameters);
        let axes = product(a, &rotation(values(&element.axes, parameters)));
        let principal = [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { moments[i] } else { 0.0 }));
        let own = product(&product(&axes, &principal), &transpose(&axes));
        let about_origin = plus(&own, &times(&product(&c, &c), -mass));
        articulated.push(blocks(
            &times(&IDENTITY, mass),
            &times(&c, mass),
            &about_origin,
        ));
    }
    let mut composite = articulated.clone();
    for (k, element) in elements.iter().enumerate().rev() {
        let carrier = element.parent.map(|p| frames[p].1);
        let columns = columns(system, k, &frames, planar, parameters);
        let moved: Vec<Column> = columns.iter().map(|h| times6(&articulated[k], h)).collect();
        let mut d: Vec<Vec<f64>> = (columns.iter())
            .map(|row| moved.iter().map(|m| dot(row, m)).collect())
            .collect();
        for j in 0..columns.len() {
            let whole = dot(&columns[j], &times6(&composite[k], &columns[j]));
            let pivot = d[j][j];
            if pivot.is_nan() || pivot <= ROUNDING * whole {
                let freedom = element.joint.freedoms().get(j);
                return Some(Idle {
                    element: k,
                    freedom: freedom.map(|f| f.name.clone()),
                    left: (pivot / whole).max(0.0),
                    reference: false,
                });
            }
            let row = d[j].clone();
            for later in d.iter_mut().skip(j + 1) {
                let factor = later[j] / pivot;
                for (entry, over) in later.iter_mut().zip(&row) {
                    *entry -= factor * over;
                }
            }
        }
        let left = eliminated(&articulated[k], &columns);
        if let (Some(parent), Some(x)) = (element.parent, carrier) {
            let u = sum(frames[k].1, x.map(|x| -x));
            let turns = element.joint.turns_with_carrier();
            add(&mut articulated[parent], &transported(&left, u, turns));
            let rigid = composite[k];
            add(&mut composite[parent], &transported(&rigid, u, turns));
        } else if system.reference == Reference::Free {
            let directions: &[usize] = if planar { &[0, 2] } else { &[0, 1, 2] };
            let unit = |i: &usize| std::array::from_fn(|j| f64::from(*i == j));
            let columns: Vec<Column> = directions.iter().map(unit).collect();
            let mut rest = left;
            for column in &columns {
                let whole = dot(column, &times6(&composite[k], column));
                let pivot = dot(column, &times6(&rest, column));
                if pivot <= ROUNDING * whole {
                    return Some(Idle {
                        element: k,
                        freedom: None,
                        left: (pivot / whole).max(0.0),
                        reference: true,
                    });
                }
                rest = eliminated(&rest, std::slice::from_ref(column));
            }
        }
    }
    None
}

/// Rotation and origin of every element where nothing is special.
fn general_position(system: &System, planar: bool, parameters: &[f64]) -> Vec<(Matrix, Vector)> {
    let mut frames: Vec<(Matrix, Vector)> = Vec::new();
    for (k, element) in system.elements.iter().enumerate() {
        let (a, x) = match element.parent {
            None => (IDENTITY, [0.0; 3]),
            Some(parent) => {
                let (a, x) = frames[parent];
                (a, sum(x, apply(&a, values(&element.at, parameters))))
            }
        };
        frames.push(match &element.joint {
            Joint::Ball => (rotation(general_angles(k, planar)), x),
            Joint::Freedoms(freedoms) => {
                let q = general_coordinates(k, freedoms.len());
                placed((a, x), freedoms, &q, parameters)
            }
        });
    }
    frames
}

/// Coordinates without any relation to each other.
fn general_coordinates(k: usize, count: usize) -> Vec<f64> {
    let step = 0.569_840_290_998_053;
    (0..count)
        .map(|j| ((k + 1) as f64 * step + j as f64 * 0.754_877_666_246_693).fract() + 0.2)
        .collect()
}

/// The columns of a joint at the origin of its element.
fn columns(
    system: &System,
    k: usize,
    frames: &[(Matrix, Vector)],
    planar: bool,
    parameters: &[f64],
) -> Vec<Column> {
    let element = &system.elements[k];
    let Joint::Freedoms(freedoms) = &element.joint else {
        let axes: &[usize] = if planar { &[1] } else { &[0, 1, 2] };
        let unit = |i: &usize| std::array::from_fn(|j| f64::from(i + 3 == j));
        return axes.iter().map(unit).collect();
    };
    let (a, x) = match element.parent {
        None => (IDENTITY, [0.0; 3]),
        Some(parent) => {
            let (a, x) = frames[parent];
            (a, sum(x, apply(&a, values(&element.at, parameters))))
        }
    };
    let q = general_coordinates(k, freedoms.len());
    let end = frames[k].1;
    let mut columns = Vec::new();
    for (j, freedom) in freedoms.iter().enumerate() {
        let (turned, _) = placed((a, x), &freedoms[..j], &q, parameters);
        let (_, center) = placed((a, x), &freedoms[..=j], &q, parameters);
        let e = apply(&turned, values(&freedom.axis, parameters));
        let arm = sum(end, center.map(|c| -c));
        let across = apply(&cross(e), arm);
        let (slide, axis) = match &freedom.kind {
            FreedomKind::Hinge => (across, e),
            FreedomKind::Slider => (e, [0.0; 3]),
            FreedomKind::Screw(advance) => {
                let advance = advance.value(parameters);
                (sum(across, e.map(|e| advance * e)), e)
            }
        };
        columns.push([slide[0], slide[1], slide[2], axis[0], axis[1], axis[2]]);
    }
    columns
}

/// [[K, Bᵀ], [B, J]]
fn blocks(k: &Matrix, b: &Matrix, j: &Matrix) -> Spatial {
    std::array::from_fn(|row| {
        std::array::from_fn(|column| match (row < 3, column < 3) {
            (true, true) => k[row][column],
            (true, false) => b[column - 3][row],
            (false, true) => b[row - 3][column],
            (false, false) => j[row - 3][column - 3],
        })
    })
}

fn times6(m: &Spatial, v: &Column) -> Column {
    m.map(|row| dot(&row, v))
}

fn dot(a: &Column, b: &Column) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(to: &mut Spatial, other: &Spatial) {
    for (row, more) in to.iter_mut().zip(other) {
        for (entry, more) in row.iter_mut().zip(more) {
            *entry += more;
        }
    }
}

/// What is left of an inertia when these velocities are free, one by one.
fn eliminated(inertia: &Spatial, columns: &[Column]) -> Spatial {
    let mut left = *inertia;
    for column in columns {
        let u = times6(&left, column);
        let d = dot(column, &u);
        for (i, row) in left.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry -= u[i] * u[j] / d;
            }
        }
    }
    left
}

/// Xᵀ I X with X = [[1, −û], [0, 1]], or [[1, −û], [0, 0]] where the element does not turn with its carrier.
fn transported(inertia: &Spatial, u: Vector, turns: bool) -> Spatial {
    let across = cross(u);
    let x: Spatial = std::array::from_fn(|i| {
        std::array::from_fn(|j| match (i < 3, j < 3) {
            (true, false) => -across[i][j - 3],
            (false, false) if !turns => 0.0,
            _ => f64::from(i == j),
        })
    });
    let half: Spatial = std::array::from_fn(|i| {
        std::array::from_fn(|j| (0..6).map(|k| inertia[i][k] * x[k][j]).sum())
    });
    std::array::from_fn(|i| std::array::from_fn(|j| (0..6).map(|k| x[k][i] * half[k][j]).sum()))
}
