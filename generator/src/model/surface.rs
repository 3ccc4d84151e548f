//! Surfaces: ellipsoids and planes on bodies, which meet in contacts, and shapes that are only drawn.

use super::body::{Attachment, Body};
use super::number::Number;
use super::part::{Fresh, Part};
use super::rule::{Rule, Ruled};
use crate::description::mesh::Solid;
use serde::Serialize;

/// A plane that an ellipsoid meets.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plane {
    /// A point of the plane.
    pub at: Attachment,
    /// Unit normal in the local frame of the plane's body, pointing to the side where the ellipsoid belongs.
    pub normal: [Number; 3],
    /// In space: a unit vector along the plane, in the local frame of its body. A second one is normal × tangent.
    pub tangent: [Number; 3],
    /// The edges of the plane; `None` for a plane without end.
    pub extent: Option<Extent>,
}

/// An ellipsoid that an ellipsoid meets.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ellipsoid {
    /// The centre of the ellipsoid.
    pub center: Attachment,
    /// Semi-axes along the ellipsoid's own axes \[m\], positive. In the plane the first and third (x, z) are used.
    pub semi_axes: [Number; 3],
    /// Bryant angles of the ellipsoid's axes relative to the body's frame \[rad\]. In the plane only the second is
    /// used.
    pub axes: [Number; 3],
}

/// A shape that is drawn, but takes part in no contact.
#[derive(Clone, Debug, PartialEq)]
pub enum Shown {
    /// An ellipsoid, and its degree n of Σ |x_i/a_i|ⁿ = 1.
    Round(Ellipsoid, u32),
    /// A plane.
    Plane(Plane),
    /// A mesh of triangles.
    Mesh(Mesh),
}

/// What a mesh is made of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Triangles {
    /// A file by its path as written: relative to the file that names it, or `package://…` as in URDF.
    File(String),
    /// A shape about the origin, whose length along each axis is 1.
    Solid(Solid),
}

/// Triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The body that the mesh moves with.
    pub on: Body,
    /// What it is made of.
    pub of: Triangles,
    /// The file that names it.
    pub source: String,
    /// The line in that file.
    pub line: usize,
    /// The origin of the mesh in the body's frame \[m\].
    pub at: [f64; 3],
    /// Bryant angles of the axes of the mesh relative to the body's frame \[rad\].
    pub angles: [f64; 3],
    /// Factors on the coordinates of the mesh, one for each axis.
    pub scale: [f64; 3],
}

/// The finite extent of a plane.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Extent {
    /// Distances from the point of the plane to its edges, along the tangent and, in space, along normal × tangent
    /// \[m\].
    pub half_lengths: Vec<Number>,
    /// The way in which the force ends at the edges.
    pub rule: EdgeRule,
}

/// The way in which the force of a contact ends at the edge of a plane.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum EdgeRule {
    /// The full force acts while the deepest point projects inside the edges, and none outside.
    Cut,
    /// The force fades to 0 over this width inside the edge \[m\].
    Fade(Number),
}

/// An ellipsoid of a body.
#[derive(Clone, Copy, Debug)]
pub struct Round<'a> {
    /// The centre of the ellipsoid.
    pub center: &'a Attachment,
    /// The semi-axes \[m\].
    pub semi_axes: &'a [Number; 3],
    /// Bryant angles of the ellipsoid's axes relative to the body's frame \[rad\].
    pub axes: &'a [Number; 3],
    /// n of Σ |x_i/a_i|ⁿ = 1
    pub degree: u32,
}

impl Ellipsoid {
    /// The ellipsoid as a part of a picture.
    pub fn round(&self) -> Round<'_> {
        Round {
            center: &self.center,
            semi_axes: &self.semi_axes,
            axes: &self.axes,
            degree: 2,
        }
    }
}

impl Shown {
    /// The body that the shape moves with.
    pub(crate) fn body_mut(&mut self) -> &mut Body {
        match self {
            Shown::Round(ellipsoid, _) => &mut ellipsoid.center.on,
            Shown::Plane(plane) => &mut plane.at.on,
            Shown::Mesh(mesh) => &mut mesh.on,
        }
    }

    /// The shape with its numbers replaced by their values at these parameters.
    pub(crate) fn fixed(mut self, parameters: &[f64]) -> Self {
        let mut numbers: Vec<&mut Number> = Vec::new();
        match &mut self {
            Shown::Round(ellipsoid, _) => {
                let Ellipsoid {
                    center,
                    semi_axes,
                    axes,
                } = ellipsoid;
                numbers.extend(center.at.iter_mut().chain(semi_axes).chain(axes));
            }
            Shown::Plane(plane) => {
                let Plane {
                    at,
                    normal,
                    tangent,
                    extent,
                } = plane;
                numbers.extend(at.at.iter_mut().chain(normal).chain(tangent));
                if let Some(Extent { half_lengths, rule }) = extent {
                    numbers.extend(half_lengths);
                    // the way in which a force fades cannot be seen
                    *rule = EdgeRule::Cut;
                }
            }
            Shown::Mesh(_) => {}
        }
        for number in numbers {
            *number = Number::Constant(number.value(parameters));
        }
        self
    }
}

/// The edges of a plane, as a part that may be left out.
impl Part for Option<Extent> {
    fn is_in(&self) -> bool {
        self.is_some()
    }
    fn leave_out(&mut self) {
        *self = None;
    }
    fn put_in(&mut self, _: &mut Fresh<'_>) {}
    fn numbers(&mut self) -> Vec<Ruled<'_>> {
        let Some(Extent { half_lengths, rule }) = self else {
            return Vec::new();
        };
        let one = half_lengths.len() == 1;
        let lengths = half_lengths.iter_mut().enumerate();
        let mut numbers: Vec<Ruled<'_>> = lengths
            .map(|(index, length)| match one {
                true => Ruled::itself(Rule::Positive, length),
                false => Ruled::item(index, Rule::Positive, length),
            })
            .collect();
        match rule {
            EdgeRule::Cut => {}
            EdgeRule::Fade(width) => {
                numbers.push(Ruled::beside("edge.width", Rule::Positive, width));
            }
        }
        numbers
    }
}
