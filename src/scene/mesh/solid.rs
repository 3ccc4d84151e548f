//! Boxes, spheres and cylinders as triangles, about the origin and of length 1 along each axis.

use super::Triangles;
use crate::pose::Vec3;
use bryant_generator::description::mesh::Solid;
use std::f64::consts::PI;

/// Corners of a circle; half as many from pole to pole of a sphere.
pub const AROUND: usize = 24;

/// The triangles of a shape.
pub fn triangles(solid: Solid) -> Triangles {
    match solid {
        Solid::Box => cuboid(),
        // a ring at the poles is a point
        Solid::Sphere => turned(
            &(0..=AROUND / 2)
                .map(|i| 2.0 * PI * i as f64 / AROUND as f64)
                .map(|angle| [0.5 * libm::sin(angle), -0.5 * libm::cos(angle)])
                .collect::<Vec<_>>(),
        ),
        Solid::Cylinder => turned(&[[0.0, -0.5], [0.5, -0.5], [0.5, 0.5], [0.0, 0.5]]),
    }
}

fn cuboid() -> Triangles {
    let place = |n: usize| -> Vec3 {
        std::array::from_fn(|axis| if n >> axis & 1 == 0 { -0.5 } else { 0.5 })
    };
    // each side by its corners, around it as seen from outside
    let sides = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    Triangles {
        places: (0..8).map(place).collect(),
        corners: sides.into_iter().flat_map(halves).collect(),
    }
}

/// What a line of points (distance from z, z), upwards on the outside, goes over as it turns about z.
fn turned(line: &[[f64; 2]]) -> Triangles {
    let mut triangles = Triangles::default();
    for [from_axis, z] in line {
        for i in 0..AROUND {
            let angle = 2.0 * PI * i as f64 / AROUND as f64;
            let [x, y] = [libm::cos(angle), libm::sin(angle)].map(|unit| from_axis * unit);
            triangles.places.push([x, y, *z]);
        }
    }
    for ring in 0..line.len() - 1 {
        for i in 0..AROUND {
            let corner = |up: usize, on: usize| ((ring + up) * AROUND + (i + on) % AROUND) as u32;
            let [a, b, c, d] = [corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)];
            // at the axis two corners are one place
            if line[ring][0] > 1e-9 {
                triangles.corners.push([a, b, c]);
            }
            if line[ring + 1][0] > 1e-9 {
                triangles.corners.push([a, c, d]);
            }
        }
    }
    triangles
}
