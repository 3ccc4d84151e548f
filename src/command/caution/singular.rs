//! Finds positions in which two freedoms of a joint move its element in the same way.
//!
//! A joint with several freedoms and no mass between them is singular if its columns H (see
//! `bryant_generator::joint`) are linearly dependent, that is if the Gram determinant det Ĥᵀ Ĥ is 0, where Ĥ are the
//! columns scaled to length 1. Near such a position rates become extreme and steps short. The columns depend only on
//! the coordinates between the first and the last freedom. The smallest determinant within the stops is
//! searched from many start values. This proves nothing, but the joints of two or three hinges and sliders that users
//! write have few minima.

use bryant_generator::law::ForceKind;
use bryant_generator::model::{Active, ElementId, Model};
use bryant_generator::model::{Freedom, Joint};
use std::f64::consts::{PI, TAU};

type Vector = [f64; 3];

/// Singular angles this far beyond a stop are still reported \[rad\].
const NEAR: f64 = 10.0 * PI / 180.0;
/// The range of a slider without stops, and the length that makes translations and rotations comparable \[m\].
const LENGTH: f64 = 1.0;
/// A smaller determinant counts as 0: the position is within 1e-6 of a singular one.
const ZERO: f64 = 1e-12;
/// A larger determinant does not count as 0; at a twentieth of a turn from a singular position it is much larger.
const SOUND: f64 = 1e-6;
/// A smaller determinant is within 2° of a singular position.
const CLOSE: f64 = 1e-3;
/// Number of start values of the search, for each coordinate.
const PLACES: usize = 200;

/// A joint with several freedoms.
struct Several {
    /// The element that it carries.
    name: String,
    freedoms: Vec<One>,
}

/// A freedom, at given values of the parameters.
struct One {
    name: String,
    axis: Vector,
    zero: f64,
    turns: bool,
    /// Displacement per unit of the coordinate \[m\], if the freedom translates.
    advance: Option<f64>,
    /// The range between the stops.
    stops: [f64; 2],
    /// Inertia of its rotor relative to that of the element.
    rotor: f64,
}

/// The warnings, each for a joint that can come to a singular position or close to one, with a remedy.
pub fn cautions(model: &Model) -> Vec<String> {
    let defaults: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
    let joints = joints(model, &defaults);
    joints
        .iter()
        .filter_map(|(joint, _)| joint.caution())
        .collect()
}

/// How near a joint is to a singular position.
#[derive(Clone, Copy)]
pub enum Near {
    /// At it, up to rounding.
    In,
    /// Within a few degrees.
    CloseTo,
}

/// A message about a joint that is near a singular position at a state, and a remedy. `state` returns the value of a
/// coordinate by its name; where it has none, that at the start of a run with these parameters is used.
pub fn at(
    model: &Model,
    parameters: &[f64],
    state: impl Fn(&str) -> Option<f64>,
    near: Near,
) -> Option<[String; 2]> {
    let (least, word) = match near {
        Near::In => (ZERO, "in"),
        Near::CloseTo => (CLOSE, "in, or close to,"),
    };
    let joints = joints(model, parameters);
    let found = joints.iter().find_map(|(joint, start)| {
        let names = joint.freedoms.iter().zip(start);
        let q = names.map(|(one, start)| {
            let name = format!("{}.{}", joint.name, one.name);
            state(&name).unwrap_or(*start)
        });
        let q: Vec<f64> = q.collect();
        (joint.determinant(&q) < least).then_some((joint, q))
    });
    found.map(|(joint, q)| {
        let named = joint.freedoms.iter().zip(&q);
        let shown: Vec<String> = named
            .map(|(one, q)| format!("{} = {}", one.name, one.shown(*q)))
            .collect();
        let position = format!(
            "the joint of \"{}\" is {word} a singular position ({}): there {} move the element alike, and the mass matrix is singular",
            joint.name,
            shown.join(", "),
            joint.alike(&q).join(" and ")
        );
        let remedy = "start elsewhere, let stops end the motion before, or turn the axes of the joint; what turns freely about all axes has a ball joint";
        [position, remedy.to_owned()]
    })
}

/// The joints with several freedoms, and the coordinates of each at the start, for these values of the
/// parameters.
fn joints(model: &Model, parameters: &[f64]) -> Vec<(Several, Vec<f64>)> {
    let mut all = Vec::new();
    for (s, system) in model.systems.iter().enumerate() {
        for (e, element) in system.elements.iter().enumerate() {
            let Joint::Freedoms(freedoms) = &element.joint else {
                continue;
            };
            if freedoms.len() < 2 || freedoms.iter().any(|freedom| !freedom.is_own()) {
                continue;
            }
            let id = ElementId {
                system: s,
                element: e,
            };
            let mass = element.mass.value(parameters);
            let of = |(index, freedom): (usize, &Freedom)| One {
                name: freedom.name.clone(),
                axis: freedom.axis.each_ref().map(|a| a.value(parameters)),
                zero: freedom.zero.value(parameters),
                turns: freedom.kind.turns(),
                advance: freedom.kind.advance().map(|a| a.value(parameters)),
                stops: stops(model, id, index, parameters),
                rotor: {
                    let length = if freedom.kind.turns() { LENGTH } else { 1.0 };
                    freedom.armature.value(parameters) / (mass * length * length)
                },
            };
            let joint = Several {
                name: format!("{}/{}", system.name, element.name),
                freedoms: freedoms.iter().enumerate().map(of).collect(),
            };
            let start = freedoms
                .iter()
                .map(|freedom| freedom.position.value(parameters));
            all.push((joint, start.collect()));
        }
    }
    all
}

/// The range of a freedom between stops that act at all times.
fn stops(model: &Model, joint: ElementId, index: usize, defaults: &[f64]) -> [f64; 2] {
    let mut ends = [f64::NEG_INFINITY, f64::INFINITY];
    for force in &model.forces {
        let ForceKind::Freedom(on) = ForceKind::of(force) else {
            continue;
        };
        if (on.child, on.freedom) != (joint, index) || force.active != Active::default() {
            continue;
        }
        if let Some(stop) = &on.law.stop {
            let value = |end: &Option<_>, open: f64| {
                let end: &Option<bryant_generator::model::Number> = end;
                end.as_ref().map_or(open, |end| end.value(defaults))
            };
            ends[0] = ends[0].max(value(&stop.from, f64::NEG_INFINITY));
            ends[1] = ends[1].min(value(&stop.to, f64::INFINITY));
        }
    }
    ends
}

impl Several {
    fn caution(&self) -> Option<String> {
        if let Some(found) = self.nearly_alike() {
            return Some(found);
        }
        let inner = self.freedoms.len() - 1;
        let ranges: Vec<[f64; 2]> = self.freedoms[..inner].iter().map(One::range).collect();
        let found = self.smallest(&ranges)?;
        let relevant: Vec<usize> = (1..inner)
            .filter(|&index| self.depends_on(&found, index))
            .collect();
        // a joint that is singular everywhere is refused with the model, so this one has relevant coordinates
        let (first, others) = relevant.split_first()?;
        let mut places = vec![found[*first]];
        if others.is_empty() {
            places = self.all_places(&found, *first, ranges[*first]);
        }
        let one = &self.freedoms[*first];
        let listed: Vec<String> = places.iter().map(|place| one.shown(*place)).collect();
        let mut place = format!("{} = {}", one.name, listed.join(" or "));
        for index in others {
            let one = &self.freedoms[*index];
            place.push_str(&format!(" and {} = {}", one.name, one.shown(found[*index])));
        }
        let reaches = |place: f64, one: &One| (one.stops[0]..=one.stops[1]).contains(&place);
        let reached = places.iter().any(|place| reaches(*place, one))
            && others
                .iter()
                .all(|index| reaches(found[*index], &self.freedoms[*index]));
        let alike = self.alike(&found).join(" and ");
        let how = match reached {
            true => "is singular at",
            false => "comes within 10° of",
        };
        let what = match reached {
            true => String::new(),
            false => ", where it is singular".to_owned(),
        };
        Some(format!(
            "the joint of \"{}\" {how} {place}{what}: there {alike} move the element alike, and near it steps become very small\n  \
             help: let stops end the motion before, or turn the axes of the joint so that this position is out of reach; what turns freely \
             about all axes has a ball joint",
            self.name
        ))
    }

    /// The warning about two successive freedoms with nearly the same axis, which are alike at all positions.
    /// (Equal axes are refused with the model.)
    fn nearly_alike(&self) -> Option<String> {
        self.freedoms.windows(2).find_map(|pair| {
            let [one, other] = pair else { return None };
            let pure = |one: &One| one.turns != one.advance.is_some() && one.rotor == 0.0;
            let across = cross(one.axis, other.axis);
            let squared: f64 = across.iter().map(|c| c * c).sum();
            let alike = one.turns == other.turns && pure(one) && pure(other) && squared < CLOSE;
            let angle = libm::asin(squared.sqrt()).to_degrees();
            let angle = match angle < 0.1 {
                true => format!("{angle:.0e}"),
                false => format!("{angle:.1}"),
            };
            alike.then(|| {
                format!(
                    "the axes of {} and {} of \"{}\" are only {angle}° apart: both move the element nearly alike, and rounding errors grow by the inverse of this angle\n  \
                     help: remove one of them, or turn its axis",
                    one.name, other.name, self.name
                )
            })
        })
    }

    /// H, one column for each freedom: the velocity of the element's origin divided by `LENGTH`, and its
    /// angular velocity.
    fn columns(&self, q: &[f64]) -> Vec<[f64; 6]> {
        let mut rotation = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut slid = [0.0; 3];
        let mut found: Vec<(Vector, Vector, Option<Vector>)> = Vec::new();
        for (index, one) in self.freedoms.iter().enumerate() {
            let position = q.get(index).copied().unwrap_or(0.0) + one.zero;
            let axis = times(&rotation, one.axis);
            let slide = axis.map(|a| a * one.advance.unwrap_or(0.0));
            slid = std::array::from_fn(|i| slid[i] + slide[i] * position);
            if one.turns {
                rotation = turned(&rotation, axis, position);
                found.push((slide, axis, Some(slid)));
            } else {
                found.push((slide, [0.0; 3], None));
            }
        }
        let column = |(slide, axis, center): (Vector, Vector, Option<Vector>)| {
            let lever = center.map_or([0.0; 3], |c| std::array::from_fn(|i| slid[i] - c[i]));
            let moved = cross(axis, lever);
            let mut column = [0.0; 6];
            for i in 0..3 {
                column[i] = (slide[i] + moved[i]) / LENGTH;
                column[i + 3] = axis[i];
            }
            let length = column.iter().map(|c| c * c).sum::<f64>().sqrt();
            column.map(|c| c / length)
        };
        found.into_iter().map(column).collect()
    }

    /// Ĥᵀ Ĥ, with the rotors' inertia on the diagonal.
    fn gram(&self, q: &[f64]) -> Vec<Vec<f64>> {
        let columns = self.columns(q);
        let dot = |a: &[f64; 6], b: &[f64; 6]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let row = |(i, a): (usize, &[f64; 6])| -> Vec<f64> {
            let entry = |(j, b): (usize, &[f64; 6])| match i == j {
                true => dot(a, b) + self.freedoms[j].rotor,
                false => dot(a, b),
            };
            columns.iter().enumerate().map(entry).collect()
        };
        columns.iter().enumerate().map(row).collect()
    }

    fn determinant(&self, q: &[f64]) -> f64 {
        pivots(self.gram(q)).into_iter().product()
    }

    /// A position within these ranges with determinant 0; `None` if none is found.
    fn smallest(&self, ranges: &[[f64; 2]]) -> Option<Vec<f64>> {
        let dimensions = ranges.len();
        let place = |index: usize| -> Vec<f64> {
            let coordinate = |(base, range): (u32, &[f64; 2])| {
                range[0] + (range[1] - range[0]) * halton(index, base)
            };
            [2, 3, 5, 7, 11]
                .into_iter()
                .zip(ranges)
                .map(coordinate)
                .collect()
        };
        let mut places: Vec<(f64, Vec<f64>)> = (1..=PLACES * dimensions)
            .map(place)
            .map(|q| (self.determinant(&q), q))
            .collect();
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        if places.last().is_none_or(|(largest, _)| *largest < SOUND) {
            return None;
        }
        let refined = places
            .into_iter()
            .take(8)
            .map(|(value, q)| self.descended(value, q, ranges));
        let best = refined.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (best.0 < ZERO).then_some(best.1)
    }

    /// Descends along one coordinate after the other; the step is halved when no step improves.
    fn descended(&self, value: f64, q: Vec<f64>, ranges: &[[f64; 2]]) -> (f64, Vec<f64>) {
        let (mut value, mut q) = (value, q);
        let mut step = 0.1;
        while step > 1e-9 && value > 0.0 {
            let mut better = false;
            for index in 0..q.len() {
                for way in [step, -step] {
                    let mut moved = q.clone();
                    moved[index] = (q[index] + way).clamp(ranges[index][0], ranges[index][1]);
                    let there = self.determinant(&moved);
                    if there < value {
                        (value, q, better) = (there, moved, true);
                    }
                }
            }
            if !better {
                step *= 0.5;
            }
        }
        (value, q)
    }

    /// True if a change of this coordinate leaves the singular position.
    fn depends_on(&self, q: &[f64], index: usize) -> bool {
        [0.3, -0.3].into_iter().any(|by| {
            let mut moved = q.to_vec();
            moved[index] += by;
            self.determinant(&moved) > SOUND
        })
    }

    /// All values of one coordinate in its range for which the position is singular.
    fn all_places(&self, q: &[f64], index: usize, [from, to]: [f64; 2]) -> Vec<f64> {
        const STEPS: usize = 720;
        let at = |value: f64| {
            let mut moved = q.to_vec();
            moved[index] = value;
            self.determinant(&moved)
        };
        let value = |step: usize| from + (to - from) * step as f64 / STEPS as f64;
        let mut places: Vec<f64> = Vec::new();
        for step in 0..=STEPS {
            let (before, after) = (value(step.saturating_sub(1)), value((step + 1).min(STEPS)));
            let here = at(value(step));
            if here > at(before) || here > at(after) {
                continue;
            }
            let mut only = q.to_vec();
            only[index] = value(step);
            let mut ranges: Vec<[f64; 2]> = q.iter().map(|q| [*q, *q]).collect();
            ranges[index] = [before, after];
            let (smallest, there) = self.descended(here, only, &ranges);
            let there = there[index];
            let is_new = |place: &f64| {
                let apart = (there - place).abs();
                let round = match self.freedoms[index].turns {
                    true => (TAU - apart).abs().min(apart),
                    false => apart,
                };
                round > 1e-4
            };
            if smallest < ZERO && places.iter().all(is_new) {
                places.push(there);
            }
        }
        places
    }

    /// The names of the freedoms that are linearly dependent in a singular position.
    fn alike(&self, q: &[f64]) -> Vec<String> {
        let gram = self.gram(q);
        let all = 0..self.freedoms.len();
        // a column is one of the dependent ones if the others are independent without it
        let needed = |without: &usize| {
            let keep: Vec<usize> = all.clone().filter(|i| i != without).collect();
            let row = |i: &usize| keep.iter().map(|j| gram[*i][*j]).collect();
            let rest: f64 = pivots(keep.iter().map(row).collect()).into_iter().product();
            rest > SOUND
        };
        let named = all.clone().filter(needed);
        named.map(|i| self.freedoms[i].name.clone()).collect()
    }
}

impl One {
    /// The range of the search: that between the stops and slightly more; without stops, half a turn or `LENGTH` to
    /// both sides.
    fn range(&self) -> [f64; 2] {
        let open = match self.turns {
            true => PI,
            false => LENGTH,
        };
        let beyond = if self.turns { NEAR } else { 0.0 };
        let [from, to] = self.stops;
        let from = if from.is_finite() {
            from - beyond
        } else {
            -open
        };
        let to = if to.is_finite() { to + beyond } else { open };
        [from.min(to), to.max(from)]
    }

    fn shown(&self, value: f64) -> String {
        // a rounded zero has no sign
        match self.turns {
            true => format!("{:.0}°", value.to_degrees() + 0.0).replace("-0°", "0°"),
            false => format!("{:.0} mm", 1e3 * value + 0.0).replace("-0 mm", "0 mm"),
        }
    }
}

/// The pivots of Gaussian elimination of a positive semi-definite matrix.
fn pivots(mut matrix: Vec<Vec<f64>>) -> Vec<f64> {
    let size = matrix.len();
    let mut pivots = Vec::with_capacity(size);
    for k in 0..size {
        let pivot = matrix[k][k].max(0.0);
        pivots.push(pivot);
        if pivot == 0.0 {
            return vec![0.0];
        }
        let row = matrix[k].clone();
        for below in &mut matrix[k + 1..] {
            let factor = below[k] / pivot;
            for (entry, above) in below[k + 1..].iter_mut().zip(&row[k + 1..]) {
                *entry -= factor * above;
            }
        }
    }
    pivots
}

/// Element `index` of the van der Corput sequence of this base, by reversing its digits; with different bases, points
/// fill a cube evenly (Halton 1960).
fn halton(mut index: usize, base: u32) -> f64 {
    let (mut result, mut unit) = (0.0, 1.0);
    let base = base as usize;
    while index > 0 {
        unit /= base as f64;
        result += unit * (index % base) as f64;
        index /= base;
    }
    result
}

fn times(matrix: &[Vector; 3], v: Vector) -> Vector {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

fn cross(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

/// `rotation`, followed by a rotation about `axis`, both in absolute axes (Rodrigues).
fn turned(rotation: &[Vector; 3], axis: Vector, angle: f64) -> [Vector; 3] {
    let (sine, cosine) = libm::sincos(angle);
    let columns: [Vector; 3] = std::array::from_fn(|j| {
        let column = [rotation[0][j], rotation[1][j], rotation[2][j]];
        let across = cross(axis, column);
        let along = axis[0] * column[0] + axis[1] * column[1] + axis[2] * column[2];
        std::array::from_fn(|i| {
            column[i] * cosine + across[i] * sine + axis[i] * along * (1.0 - cosine)
        })
    });
    std::array::from_fn(|i| [columns[0][i], columns[1][i], columns[2][i]])
}
