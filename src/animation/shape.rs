//! Shapes of size 1: their corners, normals and triangles.

use crate::pose::Vec3;
use crate::scene::length;
use std::f64::consts::{PI, TAU};

/// Number of circles of latitude and of longitude on a sphere.
const AROUND: (usize, usize) = (16, 24);

/// Number of sides of a rod.
const SIDES: usize = 10;

/// A shape that many nodes have.
#[derive(Clone, Copy, PartialEq)]
pub enum Shape {
    /// A sphere of radius 1, or a cube with rounded edges: the degree of its equation.
    Sphere(u32),
    /// A rod of radius 1 along z, from 0 to 1.
    Rod,
}

impl Shape {
    /// Positions, normals and triangles.
    pub fn triangles(self) -> (Vec<Vec3>, Vec<Vec3>, Vec<u32>) {
        match self {
            Shape::Sphere(degree) => sphere(degree),
            Shape::Rod => rod(),
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Shape::Sphere(2) => "ellipsoid",
            Shape::Sphere(_) => "rounded box",
            Shape::Rod => "rod",
        }
    }
}

/// Positions, normals and triangles of Σ |x_i|ⁿ = 1, a sphere if n is 2.
pub fn sphere(degree: u32) -> (Vec<Vec3>, Vec<Vec3>, Vec<u32>) {
    let (rings, sides) = AROUND;
    let n = f64::from(degree);
    let power = |x: f64, to: f64| libm::pow(x.abs(), to).copysign(x);
    let (mut places, mut normals) = (Vec::new(), Vec::new());
    for i in 0..=rings {
        let (sine, cosine) = libm::sincos(PI * i as f64 / rings as f64);
        for j in 0..=sides {
            let (y, x) = libm::sincos(TAU * j as f64 / sides as f64);
            let on_sphere = [sine * x, sine * y, cosine];
            if degree == 2 {
                places.push(on_sphere);
                normals.push(on_sphere);
                continue;
            }
            let place = on_sphere.map(|x| power(x, 2.0 / n));
            let normal = place.map(|x| power(x, n - 1.0));
            places.push(place);
            normals.push(normal.map(|x| x / length(normal)));
        }
    }
    let mut indices = Vec::new();
    let at = |i: usize, j: usize| (i * (sides + 1) + j) as u32;
    for i in 0..rings {
        for j in 0..sides {
            indices.extend([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            indices.extend([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    (places, normals, indices)
}

/// Positions, normals and triangles of a rod, without its ends.
pub fn rod() -> (Vec<Vec3>, Vec<Vec3>, Vec<u32>) {
    let (mut places, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for j in 0..=SIDES {
        let (y, x) = libm::sincos(TAU * j as f64 / SIDES as f64);
        for z in [0.0, 1.0] {
            places.push([x, y, z]);
            normals.push([x, y, 0.0]);
        }
    }
    for j in 0..SIDES as u32 {
        let first = 2 * j;
        indices.extend([first, first + 2, first + 3, first, first + 3, first + 1]);
    }
    (places, normals, indices)
}
