//! Checks that every freedom of a system has an inertia, for systems with joints other than ball joints.
//!
//! The articulated-body algorithm is run once in f64, at the default parameters and in a general position. For a joint
//! with the columns H and the articulated inertia I, D = Hᵀ I H. Its decomposition L d Lᵀ has in d the inertia of each
//! freedom that remains if all freedoms further out, and those before it in the same joint, move freely. If d is
//! rounding compared with the inertia of the composite body, the freedom has no inertia: two hinges of a list have the
//! same axis, a body without moments of inertia turns about its own centre of gravity, and so on.

use super::kinematics::{
    IDENTITY, Matrix, Vector, apply, cross, plus, product, rotation, sum, times, transpose, values,
};
use super::regularity::{ROUNDING, general_angles};
use crate::model::Joint;
use crate::model::joint::{axes_of_rotation, directions};
use crate::model::placement::{self, Column, placed};
use crate::model::{Element, Number, Reference, System};

/// Matrix from motions to wrenches, linear components first.
type Spatial = [[f64; 6]; 6];

/// A freedom without inertia.
#[derive(Clone, Debug, PartialEq)]
pub struct Idle {
    /// Index of the element in its system.
    pub element: usize,
    /// Name of the freedom; `None` for a ball joint or the reference joint.
    pub freedom: Option<String>,
    /// The remaining inertia, as a share of that of the composite body.
    pub left: f64,
    /// True for the reference joint.
    pub reference: bool,
}

/// True if a freedom moves its element like other freedoms of the same joint, in every position. Then no mass or
/// inertia helps.
pub fn is_redundant(system: &System, idle: &Idle, planar: bool, parameters: &[f64]) -> bool {
    let mut heavy = system.clone();
    for element in &mut heavy.elements {
        element.mass = Number::Constant(1.0);
        element.inertia = std::array::from_fn(|_| Number::Constant(1.0));
    }
    let still = self::idle(&heavy, planar, parameters);
    still.is_some_and(|still| still.element == idle.element && still.freedom == idle.freedom)
}

/// The first freedom without inertia, from the leaves to the root.
pub fn idle(system: &System, planar: bool, parameters: &[f64]) -> Option<Idle> {
    let frames = general_position(system, planar, parameters);
    let elements = &system.elements;
    let mut articulated: Vec<Spatial> = (elements.iter().zip(&frames))
        .map(|(element, (a, _))| {
            let (mass, c, about_origin) = inertia(element, a, parameters);
            blocks(&times(&IDENTITY, mass), &times(&c, mass), &about_origin)
        })
        .collect();
    if system.is_coupled() {
        return idle_of_matrix(system, &frames, &articulated, planar, parameters);
    }
    let mut composite = articulated.clone();
    for (k, element) in elements.iter().enumerate().rev() {
        let carrier = element.parent.map(|p| frames[p].1);
        let columns = columns(system, k, &frames, planar, parameters);
        let armatures: Vec<f64> = armatures(system, k, parameters);
        let moved: Vec<Column> = columns.iter().map(|h| times6(&articulated[k], h)).collect();
        let mut d: Vec<Vec<f64>> = (columns.iter())
            .map(|row| moved.iter().map(|m| dot(row, m)).collect())
            .collect();
        for (j, armature) in armatures.iter().enumerate() {
            d[j][j] += armature;
        }
        for j in 0..columns.len() {
            let armature = armatures.get(j).copied().unwrap_or(0.0);
            let whole = dot(&columns[j], &times6(&composite[k], &columns[j])) + armature;
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
        let left = eliminated(&articulated[k], &columns, &armatures);
        if let (Some(parent), Some(x)) = (element.parent, carrier) {
            let u = sum(frames[k].1, x.map(|x| -x));
            let turns = element.joint.turns_with_carrier();
            add(&mut articulated[parent], &transported(&left, u, turns));
            let rigid = composite[k];
            add(&mut composite[parent], &transported(&rigid, u, turns));
        } else if system.reference == Reference::Free {
            let directions = directions(planar);
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
                rest = eliminated(&rest, std::slice::from_ref(column), &[]);
            }
        }
    }
    None
}

/// The mass of an element with the axes `a`, the cross-product matrix of its centre of gravity, and its inertia about
/// its joint.
pub(super) fn inertia(element: &Element, a: &Matrix, parameters: &[f64]) -> (f64, Matrix, Matrix) {
    let mass = element.mass.value(parameters);
    let c = cross(apply(a, values(&element.cg, parameters)));
    let moments = values(&element.inertia, parameters);
    let axes = product(a, &rotation(values(&element.axes, parameters)));
    let principal = [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { moments[i] } else { 0.0 }));
    let own = product(&product(&axes, &principal), &transpose(&axes));
    let about_origin = plus(&own, &times(&product(&c, &c), -mass));
    (mass, c, about_origin)
}

/// Rotor inertia (armature) of each freedom of an element.
fn armatures(system: &System, k: usize, parameters: &[f64]) -> Vec<f64> {
    let freedoms = system.elements[k].joint.freedoms().iter();
    freedoms.map(|f| f.armature.value(parameters)).collect()
}

/// The first freedom without inertia in a system whose freedoms follow others, from the last velocity to the first.
/// Uses S = Σ JᵀIJ, where J is the motion of each body per velocity.
fn idle_of_matrix(
    system: &System,
    frames: &[(Matrix, Vector)],
    inertias: &[Spatial],
    planar: bool,
    parameters: &[f64],
) -> Option<Idle> {
    let rows = velocities(system, planar);
    let mut s = mass_matrix(system, &rows, frames, inertias, planar, parameters);
    let whole: Vec<f64> = (0..rows.len()).map(|i| s[i][i]).collect();
    for i in (0..rows.len()).rev() {
        let pivot = s[i][i];
        if pivot.is_nan() || pivot <= ROUNDING * whole[i] {
            let (element, freedom) = match rows[i] {
                None => (0, None),
                Some((k, j)) => (k, system.elements[k].joint.freedoms().get(j)),
            };
            return Some(Idle {
                element,
                freedom: freedom.map(|f| f.name.clone()),
                left: (pivot / whole[i]).max(0.0),
                reference: rows[i].is_none(),
            });
        }
        let last = s[i].clone();
        for j in 0..i {
            let factor = last[j] / pivot;
            for (entry, over) in s[j].iter_mut().zip(&last[..i]) {
                *entry -= factor * over;
            }
        }
    }
    None
}

/// The element and freedom of a velocity; `None` for the reference joint.
type Row = Option<(usize, usize)>;

/// The directions in which the reference joint moves.
fn reference_directions(system: &System, planar: bool) -> &'static [usize] {
    match system.reference {
        Reference::Free => directions(planar),
        _ => &[],
    }
}

/// The velocities of a system; those of the reference joint come first.
fn velocities(system: &System, planar: bool) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    rows.extend(reference_directions(system, planar).iter().map(|_| None));
    for (k, element) in system.elements.iter().enumerate() {
        match &element.joint {
            Joint::Ball => {
                let axes = axes_of_rotation(planar).len();
                rows.extend((0..axes).map(|j| Some((k, j))));
            }
            Joint::Freedoms(freedoms) => {
                let own = freedoms.iter().enumerate().filter(|(_, f)| f.is_own());
                rows.extend(own.map(|(j, _)| Some((k, j))));
            }
        }
    }
    rows
}

/// The mass matrix S = Σ JᵀIJ.
fn mass_matrix(
    system: &System,
    rows: &[Row],
    frames: &[(Matrix, Vector)],
    inertias: &[Spatial],
    planar: bool,
    parameters: &[f64],
) -> Vec<Vec<f64>> {
    let row = |k, j| rows.iter().position(|row| *row == Some((k, j)));
    let mut s = vec![vec![0.0; rows.len()]; rows.len()];
    let mut motions: Vec<Vec<Column>> = Vec::new();
    for (k, element) in system.elements.iter().enumerate() {
        let mut motion: Vec<Column> = match element.parent {
            None => {
                let mut motion = vec![[0.0; 6]; rows.len()];
                let directions = reference_directions(system, planar);
                for (column, &direction) in motion.iter_mut().zip(directions) {
                    column[direction] = 1.0;
                }
                motion
            }
            Some(parent) => {
                let u = sum(frames[k].1, frames[parent].1.map(|x| -x));
                let turns = element.joint.turns_with_carrier();
                let carried = motions[parent].iter().map(|&[x, y, z, a, b, c]| {
                    let v = sum([x, y, z], apply(&cross([a, b, c]), u));
                    let omega = if turns { [a, b, c] } else { [0.0; 3] };
                    [v[0], v[1], v[2], omega[0], omega[1], omega[2]]
                });
                carried.collect()
            }
        };
        let own = columns(system, k, frames, planar, parameters);
        let armatures = armatures(system, k, parameters);
        for (j, column) in own.iter().enumerate() {
            let freedom = element.joint.freedoms().get(j);
            let (at, ratio) = match freedom.and_then(|f| f.follows.as_ref()) {
                None => (row(k, j), 1.0),
                Some(f) => (row(f.element, f.freedom), f.ratio.value(parameters)),
            };
            let Some(at) = at else { continue };
            for (to, from) in motion[at].iter_mut().zip(column) {
                *to += ratio * from;
            }
            s[at][at] += ratio * ratio * armatures.get(j).copied().unwrap_or(0.0);
        }
        for i in 0..rows.len() {
            let needed = times6(&inertias[k], &motion[i]);
            for j in 0..rows.len() {
                s[i][j] += dot(&motion[j], &needed);
            }
        }
        motions.push(motion);
    }
    s
}

/// Rotation and origin of every element in a general position, without symmetries.
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

/// Coordinates without any relation to one another.
fn general_coordinates(k: usize, count: usize) -> Vec<f64> {
    let step = 0.569_840_290_998_053;
    (0..count)
        .map(|j| ((k + 1) as f64 * step + j as f64 * 0.754_877_666_246_693).fract() + 0.2)
        .collect()
}

/// The columns of a joint: the motion per velocity, at the origin of its element.
fn columns(
    system: &System,
    k: usize,
    frames: &[(Matrix, Vector)],
    planar: bool,
    parameters: &[f64],
) -> Vec<Column> {
    let element = &system.elements[k];
    let Joint::Freedoms(freedoms) = &element.joint else {
        let axes = axes_of_rotation(planar);
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
    placement::columns((a, x), freedoms, &q, frames[k].1, parameters)
}

/// The matrix [[K, Bᵀ], [B, J]].
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

/// The inertia that remains if the velocities in `columns` are free; they are eliminated one by one.
fn eliminated(inertia: &Spatial, columns: &[Column], armatures: &[f64]) -> Spatial {
    let mut left = *inertia;
    for (j, column) in columns.iter().enumerate() {
        let u = times6(&left, column);
        let d = dot(column, &u) + armatures.get(j).copied().unwrap_or(0.0);
        for (i, row) in left.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry -= u[i] * u[j] / d;
            }
        }
    }
    left
}

/// Xᵀ I X with X = [[1, −û], [0, 1]]; X = [[1, −û], [0, 0]] if the element does not turn with its carrier.
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
