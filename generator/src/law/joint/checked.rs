//! What a joint has beside springs, dampers and friction about its rotations: stops, locks, drives, flexion and torsion.

use crate::model::{FieldComponent, JointTorque, Number};

/// The ends of a relative rotation: N(δ) = max(0, stiffness δ + damping min(δ/fade, 1) δ̇) back, at depth δ > 0 beyond.
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// Smallest angle that is free \[rad\].
    pub from: Option<Number>,
    /// Largest \[rad\].
    pub to: Option<Number>,
    /// \[N m/rad\]
    pub stiffness: Number,
    /// \[N m s/rad\]; none is 0.
    pub damping: Option<Number>,
    /// Depth up to which damping grows from 0 to its whole \[rad\]; without one it is there at once.
    pub damping_angle: Option<Number>,
}

/// Holds the relative angle that there was when a switch began to act.
#[derive(Clone, Debug, PartialEq)]
pub struct Lock {
    /// Index into [`Model::switches`](crate::model::Model::switches).
    pub by: usize,
    /// \[N m/rad\]
    pub stiffness: Number,
    /// \[N m s/rad\]; none is 0.
    pub damping: Option<Number>,
}

/// Drives the coordinate to one that is given: N = stiffness (c(t) − θ) + damping (ċ(t) − θ̇), kept within ± limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// c, constant or a curve of time \[rad\].
    pub to: FieldComponent,
    /// \[N m/rad\]
    pub stiffness: Number,
    /// \[N m s/rad\]; none is 0.
    pub damping: Option<Number>,
    /// Largest torque \[N m\]; none is infinite.
    pub limit: Option<Number>,
}

impl Bending {
    /// Whether something in it has a direction that is not determined at a flexion of 180°.
    pub fn directs(&self) -> bool {
        let JointTorque { elastic, stop, .. } = &self.flexion;
        elastic.is_some() || stop.is_some() || self.torsion != JointTorque::default()
    }
}

/// Flexion and torsion of a ball joint, in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Bending {
    /// Which local axis is the long one, of both bodies.
    pub axis: usize,
    /// The law of the angle between the long axes; without neutral angle and lock, and with a stop at one end.
    pub flexion: JointTorque,
    /// The law of the turn about them.
    pub torsion: JointTorque,
}
