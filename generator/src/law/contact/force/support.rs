//! The reach of an ellipsoid in a direction, and its deepest point.
//!
//! Let n' be the direction n in the ellipsoid's axes, and a the semi-axes. Then h = √(Σ a_i² n'_i²), and the vector
//! from the deepest point to the centre is u = R (a_i² n'_i)/h = ∂h/∂n. It turns with n by K = ∂²h/∂n² = (A − u uᵀ)/h,
//! A = R diag(a²) Rᵀ. For a degree other than 2, h is the dual norm of the ellipsoid's equation:
//! `force::ellipsoid::support`.

use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Function, Graph};
use crate::law::contact::check::Contact;
use crate::model::Dimension;
use crate::motion::Motion;
use crate::motion::kinematics::constant_rotation;
use crate::motion::numbers::vector;

/// The support of an ellipsoid in one direction.
pub struct Support<'g> {
    /// h \[m\]
    pub reach: Expr<'g>,
    /// u, the vector from the deepest point to the centre, in absolute axes \[m\].
    pub deepest: Vec3<'g>,
    /// For a degree other than 2: the local components of the direction. One of them is 0 in the middle of a flat side,
    /// where the deepest point moves infinitely fast.
    pub flats: Vec<Expr<'g>>,
    /// Shape of an ellipsoid of degree 2; `None` for a sphere, and for other degrees, whose turning is not needed.
    shape: Option<Shape<'g>>,
}

struct Shape<'g> {
    semi_axes: [Expr<'g>; 3],
    body: Mat3<'g>,
    axes: Mat3<'g>,
}

impl<'g> Support<'g> {
    /// The support in a direction.
    pub fn of(
        graph: &'g Graph,
        dimension: Dimension,
        motion: &Motion<'g>,
        contact: &Contact,
        normal: Vec3<'g>,
    ) -> Self {
        let semi_axes = vector(graph, &contact.ellipsoid.semi_axes).0;
        let used: &[usize] = match dimension {
            Dimension::Plane => &[0, 2],
            Dimension::Space => &[0, 1, 2],
        };
        let round = used.iter().all(|&i| semi_axes[i].id() == semi_axes[0].id());
        if round && contact.degree == 2 {
            // a sphere reaches equally far in all directions
            return Support {
                reach: semi_axes[0],
                deepest: semi_axes[0] * normal,
                flats: Vec::new(),
                shape: None,
            };
        }
        let body = motion.body(contact.ellipsoid.center.on).rotation;
        let axes = constant_rotation(graph, &contact.ellipsoid.axes);
        let local = axes.transposed_times(body.transposed_times(normal));
        let stretched = Vec3(std::array::from_fn(|i| semi_axes[i] * local.0[i]));
        if contact.degree != 2 {
            let degree = f64::from(contact.degree);
            let [x, y, z] = stretched.0;
            let power = graph.constant(degree / (degree - 1.0));
            let results: [Expr<'g>; 4] = std::array::from_fn(|part| {
                graph.call(Function::Support(part as u8), &[x, y, z, power])
            });
            let point = Vec3(std::array::from_fn(|i| {
                // in the plane the deepest point has no component along y
                match used.contains(&i) {
                    true => semi_axes[i] * results[i + 1],
                    false => graph.constant(0.0),
                }
            }));
            return Support {
                reach: results[0],
                deepest: body.times(axes.times(point)),
                flats: used.iter().map(|&i| stretched.0[i]).collect(),
                shape: None,
            };
        }
        let reach = stretched.squared().sqrt();
        let twice_stretched = Vec3(std::array::from_fn(|i| semi_axes[i] * stretched.0[i]));
        Support {
            reach,
            deepest: reach.recip() * body.times(axes.times(twice_stretched)),
            flats: Vec::new(),
            shape: Some(Shape {
                semi_axes,
                body,
                axes,
            }),
        }
    }

    /// m = u × t − n × K t: if the ellipsoid turns about its centre at ω, with n and t held, the deepest point moves
    /// along t at −m·ω.
    pub fn turning(&self, normal: Vec3<'g>, tangent: Vec3<'g>) -> Vec3<'g> {
        let Some(shape) = &self.shape else {
            return Vec3::zero(self.reach.graph());
        };
        let local = shape
            .axes
            .transposed_times(shape.body.transposed_times(tangent));
        let twice_stretched = Vec3(std::array::from_fn(|i| {
            let a = shape.semi_axes[i];
            a * (a * local.0[i])
        }));
        let stretched = shape.body.times(shape.axes.times(twice_stretched));
        let along = self.deepest.dot(tangent) * self.deepest;
        let turned = self.reach.recip() * (stretched - along);
        self.deepest.cross(tangent) - normal.cross(turned)
    }
}
