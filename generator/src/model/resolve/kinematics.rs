//! Rotations and positions in f64, for checks of a model.
//!
//! A = Rx(φ₁) Ry(φ₂) Rz(φ₃); in the plane φ₁ = φ₃ = 0 and Ry(φ) maps (x, z) to (x cos φ + z sin φ, −x sin φ + z cos φ).

use crate::model::Joint;
use crate::model::placement::placed;
pub(crate) use crate::model::placement::{cross, plus, sum, times, values};
use crate::model::{Attachment, Body, System, Vehicle};

pub use crate::rotation::{IDENTITY, Matrix, Vector, apply, product, transpose};

pub fn rotation([a, b, c]: Vector) -> Matrix {
    let x = [
        [1.0, 0.0, 0.0],
        [0.0, libm::cos(a), -libm::sin(a)],
        [0.0, libm::sin(a), libm::cos(a)],
    ];
    let y = [
        [libm::cos(b), 0.0, libm::sin(b)],
        [0.0, 1.0, 0.0],
        [-libm::sin(b), 0.0, libm::cos(b)],
    ];
    let z = [
        [libm::cos(c), -libm::sin(c), 0.0],
        [libm::sin(c), libm::cos(c), 0.0],
        [0.0, 0.0, 1.0],
    ];
    product(&product(&x, &y), &z)
}

pub fn distance(a: Vector, b: Vector) -> f64 {
    (0..3)
        .map(|i| (a[i] - b[i]) * (a[i] - b[i]))
        .sum::<f64>()
        .sqrt()
}

/// Rotation and origin of every element of a system at the start. `reference` is the rotation of the body that carries
/// the root.
pub fn start(system: &System, reference: Matrix, parameters: &[f64]) -> Vec<(Matrix, Vector)> {
    let mut frames: Vec<(Matrix, Vector)> = Vec::with_capacity(system.elements.len());
    for element in &system.elements {
        let (carrier, origin) = match element.parent {
            None => (reference, values(&system.position, parameters)),
            Some(parent) => {
                let (a, x) = frames[parent];
                (a, sum(x, apply(&a, values(&element.at, parameters))))
            }
        };
        frames.push(match &element.joint {
            Joint::Ball => (rotation(values(&element.angles, parameters)), origin),
            Joint::Freedoms(freedoms) => {
                let q: Vec<f64> = (freedoms.iter())
                    .map(|f| f.position.value(parameters))
                    .collect();
                placed((carrier, origin), freedoms, &q, parameters)
            }
        });
    }
    frames
}

/// Rotation and origin of a vehicle at the start.
pub fn vehicle_start(vehicle: &Vehicle, parameters: &[f64]) -> (Matrix, Vector) {
    (
        rotation(values(&vehicle.angles_at_start, parameters)),
        values(&vehicle.position, parameters),
    )
}

/// The position of an attachment at the start, given the frames of the elements of all systems, and the vehicles.
pub fn place(
    attachment: &Attachment,
    frames: &[Vec<(Matrix, Vector)>],
    vehicles: &[Vehicle],
    parameters: &[f64],
) -> Vector {
    let local = values(&attachment.at, parameters);
    match attachment.on {
        Body::Frame => local,
        Body::Element(id) => {
            let (a, x) = frames[id.system][id.element];
            sum(x, apply(&a, local))
        }
        Body::Vehicle(index) => {
            let (a, x) = vehicle_start(&vehicles[index], parameters);
            sum(x, apply(&a, local))
        }
    }
}
