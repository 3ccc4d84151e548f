//! Rotations as glTF has them.

use crate::pose::{Vec3, quaternion};
use crate::scene::{from_to, length};

/// (x, y, z, w)
pub type Quaternion = [f64; 4];

/// The rotation of a frame.
pub fn turn(rotation: [Vec3; 3]) -> Quaternion {
    let [w, x, y, z] = quaternion(rotation);
    [x, y, z, w]
}

fn unit(q: Quaternion) -> Quaternion {
    let size = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / size)
}

/// The rotation (x, y, z, w) of z into the direction from one point to another, and their distance.
pub fn along(from: Vec3, to: Vec3) -> (Quaternion, f64) {
    let d = from_to(from, to);
    let length = length(d);
    if length == 0.0 {
        return ([0.0, 0.0, 0.0, 1.0], 0.0);
    }
    let [x, y, z] = d.map(|x| x / length);
    // half way between z and the direction; a half turn about x if they are opposite
    match z < -1.0 + 1e-9 {
        true => ([1.0, 0.0, 0.0, 0.0], length),
        false => (unit([-y, x, 0.0, 1.0 + z]), length),
    }
}

/// Unit quaternions with the sign, q or −q, that is closer to the one before: players interpolate along the shorter
/// way.
pub fn continuous(turns: impl IntoIterator<Item = Quaternion>) -> Vec<Quaternion> {
    let mut all: Vec<Quaternion> = Vec::new();
    for turn in turns {
        let turn = unit(turn);
        let far = all.last().is_some_and(|before| {
            let product: f64 = before.iter().zip(turn).map(|(a, b)| a * b).sum();
            product < 0.0
        });
        all.push(if far { turn.map(|x| -x) } else { turn });
    }
    all
}
