//! The error of the state: the largest over all samples and entries, each relative to the extent of the motion of the
//! entry.
//!
//! | entry | its error | what it is relative to |
//! |---|---|---|
//! | position, angle | difference | the range that it goes through in the run |
//! | quaternion, as one entry | angle of the rotation between the two orientations (q and −q are equal) | the largest angle from the orientation at the start |
//! | velocity, angular velocity | difference | its largest magnitude |
//! | state of a force law | difference | its largest magnitude |
//!
//! The value of a position or an angle at the start is as arbitrary as the origin of the frame, so its errors are not
//! relative to its magnitude. The scale of an entry is at least a hundredth of the largest scale of its kind, because
//! some entries hardly move. If a kind does not move at all, its scale is 1 in SI units. The memory of force laws is
//! not compared: it jumps, and a jump that comes one rounding error earlier is not an error of the size of the jump.
//! The effects of memory show in the other entries.

/// Least scale of an entry, as a share of the largest scale of its kind.
const LEAST: f64 = 1e-2;

/// Compares the states of runs of a model with those of a reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Norm {
    entries: Vec<Entry>,
}

#[derive(Clone, Debug, PartialEq)]
struct Entry {
    name: String,
    kind: EntryKind,
    /// Index of the entry; for a quaternion, of the first of its four numbers.
    index: usize,
    /// The scale of its error.
    scale: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum EntryKind {
    Position,
    Angle,
    Orientation,
    Velocity,
    AngularVelocity,
    /// A continuous state of a force law, by its index; each is a kind of its own.
    Auxiliary(usize),
}

/// The names of the entries of a state.
#[derive(Clone, Copy, Debug)]
pub struct Names<'a> {
    /// Names of the coordinates q.
    pub coordinates: &'a [String],
    /// Names of the velocities v.
    pub velocities: &'a [String],
    /// Names of the states of force laws.
    pub auxiliaries: &'a [String],
}

/// The largest error, and the entry with this error.
#[derive(Clone, Debug, PartialEq)]
pub struct StateError {
    /// Relative error; infinite if a state is not finite.
    pub error: f64,
    /// Name of the entry.
    pub entry: String,
}

impl Norm {
    /// The norm for runs that are compared with a reference.
    pub fn of(names: Names<'_>, reference: &[Vec<f64>]) -> Norm {
        let component = |name: &str| name.rsplit('.').next().unwrap_or_default().to_owned();
        let mut entries = Vec::new();
        let mut add = |name: &str, kind, index| {
            entries.push(Entry {
                name: name.to_owned(),
                kind,
                index,
                scale: extent(kind, index, reference),
            });
        };
        for (index, name) in names.coordinates.iter().enumerate() {
            match component(name).as_str() {
                "qw" => add(name.trim_end_matches(".qw"), EntryKind::Orientation, index),
                "qx" | "qy" | "qz" => {}
                "x" | "y" | "z" => add(name, EntryKind::Position, index),
                _ => add(name, EntryKind::Angle, index),
            }
        }
        let first = names.coordinates.len();
        for (index, name) in names.velocities.iter().enumerate() {
            let kind = match component(name).as_str() {
                "vx" | "vy" | "vz" => EntryKind::Velocity,
                _ => EntryKind::AngularVelocity,
            };
            add(name, kind, first + index);
        }
        let first = first + names.velocities.len();
        for (index, name) in names.auxiliaries.iter().enumerate() {
            add(name, EntryKind::Auxiliary(index), first + index);
        }
        let largest = |kind: EntryKind| {
            let same = entries.iter().filter(|e| e.kind == kind);
            same.fold(0.0f64, |m, e| m.max(e.scale))
        };
        let scales: Vec<f64> = entries
            .iter()
            .map(|e| match largest(e.kind) {
                largest if largest > 0.0 => e.scale.max(LEAST * largest),
                _ => 1.0,
            })
            .collect();
        for (entry, scale) in entries.iter_mut().zip(scales) {
            entry.scale = scale;
        }
        Norm { entries }
    }

    /// The error of a run over the samples of the reference; infinite if the run has fewer samples.
    pub fn error(&self, reference: &[Vec<f64>], run: &[Vec<f64>]) -> StateError {
        let mut worst = StateError {
            error: 0.0,
            entry: String::new(),
        };
        if run.len() < reference.len() {
            worst.error = f64::INFINITY;
        }
        for (expected, found) in reference.iter().zip(run) {
            for entry in &self.entries {
                let error = entry.difference(expected, found) / entry.scale;
                let error = if error.is_nan() { f64::INFINITY } else { error };
                if error > worst.error {
                    worst = StateError {
                        error,
                        entry: entry.name.clone(),
                    };
                }
            }
        }
        worst
    }
}

impl Entry {
    fn difference(&self, a: &[f64], b: &[f64]) -> f64 {
        match self.kind {
            EntryKind::Orientation => angle_between(a, b, self.index),
            _ => match (a.get(self.index), b.get(self.index)) {
                (Some(a), Some(b)) => (a - b).abs(),
                _ => f64::NAN,
            },
        }
    }
}

/// The extent of the motion of an entry during a run.
fn extent(kind: EntryKind, index: usize, states: &[Vec<f64>]) -> f64 {
    let entry = || {
        states
            .iter()
            .map(|y| y.get(index).copied().unwrap_or(f64::NAN))
    };
    let fold = |pick: fn(f64, f64) -> f64, start| entry().fold(start, pick);
    match kind {
        EntryKind::Position | EntryKind::Angle => {
            let (low, high) = (
                fold(f64::min, f64::INFINITY),
                fold(f64::max, f64::NEG_INFINITY),
            );
            (high - low).max(0.0)
        }
        EntryKind::Orientation => match states.first() {
            Some(start) => {
                let angles = states.iter().map(|y| angle_between(start, y, index));
                angles.fold(0.0, f64::max)
            }
            None => 0.0,
        },
        EntryKind::Velocity | EntryKind::AngularVelocity | EntryKind::Auxiliary(_) => {
            entry().fold(0.0, |m, v| m.max(v.abs()))
        }
    }
}

/// Angle of the rotation between two unit quaternions (w, x, y, z), from 0 to π \[rad\]: 2 atan2(|vec a⁻¹b|, |scalar
/// a⁻¹b|).
fn angle_between(a: &[f64], b: &[f64], first: usize) -> f64 {
    let (Some(&[aw, ax, ay, az]), Some(&[bw, bx, by, bz])) =
        (a.get(first..first + 4), b.get(first..first + 4))
    else {
        return f64::NAN;
    };
    let scalar = aw * bw + ax * bx + ay * by + az * bz;
    let vector = [
        aw * bx - ax * bw - ay * bz + az * by,
        aw * by - ay * bw - az * bx + ax * bz,
        aw * bz - az * bw - ax * by + ay * bx,
    ];
    let length = vector.iter().map(|v| v * v).sum::<f64>().sqrt();
    2.0 * libm::atan2(length, scalar.abs())
}
