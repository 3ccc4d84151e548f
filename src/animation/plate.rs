//! Planes as plates.

use crate::pose::{Vec3, cross, dot};
use crate::scene::{Plane, from_to, length};

/// The thickness of a plate \[m\], or this share of its shorter edge where that is less.
const THICKNESS: [f64; 2] = [0.01, 0.05];

/// A plane with a thickness, so that it is seen from its side, too. What meets it meets its outer face.
pub struct Plate {
    /// Local frame \[m\].
    pub places: Vec<Vec3>,
    /// Of each corner.
    pub normals: Vec<Vec3>,
    /// Of triangles.
    pub corners: Vec<u32>,
}

impl Plate {
    /// That of a plane.
    pub fn of(plane: &Plane) -> Self {
        let [a, b, .., d] = plane.corners;
        let edges = [from_to(a, b), from_to(a, d)];
        let shorter = length(edges[0]).min(length(edges[1]));
        let thickness = THICKNESS[0].min(THICKNESS[1] * shorter);
        let below = plane.corners.map(|corner| -> Vec3 {
            std::array::from_fn(|i| corner[i] - thickness * plane.normal[i])
        });
        let mut plate = Plate {
            places: Vec::new(),
            normals: Vec::new(),
            corners: Vec::new(),
        };
        plate.side(plane.corners, plane.normal);
        plate.side(below, plane.normal.map(|x| -x));
        let middle: Vec3 = std::array::from_fn(|i| 0.5 * (a[i] + plane.corners[2][i]));
        for k in 0..4 {
            let ends = [k, (k + 1) % 4];
            let [from, to] = ends.map(|end| plane.corners[end]);
            let outwards: Vec3 = std::array::from_fn(|i| 0.5 * (from[i] + to[i]) - middle[i]);
            let size = length(outwards).max(f64::MIN_POSITIVE);
            let [low, high] = ends.map(|end| below[end]);
            plate.side([from, to, high, low], outwards.map(|x| x / size));
        }
        plate
    }

    /// Adds a side, counter-clockwise as seen from where its normal leads.
    fn side(&mut self, [a, b, c, d]: [Vec3; 4], normal: Vec3) {
        let first = self.places.len() as u32;
        let turns = dot(cross(from_to(a, b), from_to(a, c)), normal) > 0.0;
        self.places.extend([a, b, c, d]);
        self.normals.extend([normal; 4]);
        let halves = match turns {
            true => [0, 1, 2, 0, 2, 3],
            false => [0, 2, 1, 0, 3, 2],
        };
        self.corners.extend(halves.map(|corner| first + corner));
    }
}
