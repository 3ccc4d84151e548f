//! Chooses constant axes of an element in which its equations need fewer operations than in the axes of its
//! description: A R with a constant R.
//!
//! With quaternions, R costs no product of matrices, because A(q) R(r) = A(q ∘ r). Renaming and reversing axes costs
//! nothing, so 24 equivalent rotations r exist. The search takes the r with the fewest nonzero components, and scales
//! it such that its largest component is 1. The scale factor is absorbed where the rotation matrix doubles its
//! products.

use super::Body;
use crate::expression::graph::sum;
use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Graph, Symbol};
use crate::model::Element;
use crate::motion::ball::Orientation;
use crate::motion::kinematics::constant_rotation;
use crate::motion::numbers::{number, rotation_of_scaled_quaternion, vector};
use std::array::from_fn;

/// The constants of an element alone, without its children, if its geometry is known in numbers.
pub(super) struct Own<'g> {
    /// m \[kg\]
    pub mass: Expr<'g>,
    /// g, the centre of gravity from the origin, in the local frame \[m\].
    pub center: [f64; 3],
    /// Principal moments about the centre of gravity \[kg m²\].
    pub principal: Vec3<'g>,
    /// The principal axes, in the local frame.
    pub principal_axes: [[f64; 3]; 3],
}

impl<'g> Own<'g> {
    /// The constants, if centre of gravity and principal axes are numbers. Mass and moments may be parameters.
    pub fn of(graph: &'g Graph, element: &Element, origin: Vec3<'g>) -> Option<Self> {
        let axes = constant_rotation(graph, &element.axes);
        let mut principal_axes = [[0.0; 3]; 3];
        for (i, axis) in principal_axes.iter_mut().enumerate() {
            *axis = values(axes.column(i))?.map(|c| cleaned(c, 1.0));
        }
        Some(Own {
            mass: number(graph, &element.mass),
            center: values(vector(graph, &element.cg) - origin)?,
            principal: vector(graph, &element.inertia),
            principal_axes,
        })
    }

    /// The inertia about the centre of gravity in constant axes of the local frame.
    pub fn inertia(&self, axes: [[f64; 3]; 3]) -> [[Expr<'g>; 3]; 3] {
        let graph = self.mass.graph();
        // First index: principal axis; second index: axis.
        let cosines = self.principal_axes.map(|p| Frame::new(axes).components(p));
        from_fn(|i| {
            from_fn(|j| {
                let terms = (0..3)
                    .map(|k| graph.constant(cosines[k][i] * cosines[k][j]) * self.principal.0[k]);
                sum(graph, terms)
            })
        })
    }
}

/// The components, if all are numbers.
pub(super) fn values(vector: Vec3<'_>) -> Option<[f64; 3]> {
    let [x, y, z] = vector.0.map(|component| component.as_constant());
    Some([x?, y?, z?])
}

/// The value, or 0 if it is only rounding relative to a scale.
pub(super) fn cleaned(value: f64, scale: f64) -> f64 {
    if value.abs() <= 16.0 * f64::EPSILON * scale {
        0.0
    } else {
        value
    }
}

/// The number, or 0 if it is only rounding relative to another number.
pub(super) fn clean<'g>(value: Expr<'g>, scale: Expr<'g>) -> Expr<'g> {
    match (value.as_constant(), scale.as_constant()) {
        (Some(v), Some(s)) => value.graph().constant(cleaned(v, s)),
        _ => value,
    }
}

/// Orthonormal right-handed axes, as rows. The first is along `first`. The second is in the plane of `first` and
/// `towards`; without `towards`, it is chosen such that one of its components is 0.
pub(super) fn along(first: [f64; 3], towards: Option<[f64; 3]>) -> [[f64; 3]; 3] {
    let unit = |v: [f64; 3]| {
        let norm = v.iter().map(|c| c * c).sum::<f64>().sqrt();
        v.map(|c| c / norm)
    };
    let x = unit(first);
    let towards = towards.unwrap_or_else(|| {
        // perpendicular to the coordinate axis along which `first` is smallest
        let least = (0..3)
            .min_by(|&i, &j| x[i].abs().total_cmp(&x[j].abs()))
            .unwrap_or(0);
        cross(from_fn(|i| f64::from(u8::from(i == least))), x)
    });
    let z = unit(cross(x, towards));
    let clean = |v: [f64; 3]| v.map(|c| cleaned(c, 1.0));
    [x, cross(z, x), z].map(clean)
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let [[ax, ay, az], [bx, by, bz]] = [a, b];
    [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
}

/// Constant axes in the local frame.
pub(super) struct Frame {
    axes: [[f64; 3]; 3],
}

impl Frame {
    /// A frame of these axes, which are orthonormal and right-handed.
    pub fn new(axes: [[f64; 3]; 3]) -> Self {
        Frame { axes }
    }

    /// The components in these axes of a vector given in the local frame.
    pub fn components(&self, v: [f64; 3]) -> [f64; 3] {
        let size = v.iter().fold(0.0f64, |m, c| m.max(c.abs()));
        self.axes
            .map(|axis| cleaned(axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2], size))
    }

    /// The axes times `length`, in absolute axes, as columns.
    pub fn turned<'g>(&self, body: &Body<'g, '_>, length: f64) -> Mat3<'g> {
        let graph = body.graph;
        let identity = self.axes == [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        if identity && length == 1.0 {
            return body.motion.rotation;
        }
        if body.layout.orientation != Orientation::Quaternion {
            return Mat3::from_columns(self.axes.map(|axis| {
                let axis = axis.map(|c| graph.constant(length * c));
                body.motion.rotation.times(Vec3(axis))
            }));
        }
        let range = body.layout.element_coordinates(body.id);
        let q = |i: usize| graph.symbol(Symbol::Coordinate((range.start + i) as u32));
        let [w, x, y, z] = [q(0), q(1), q(2), q(3)];
        let (order, r) = self.cheapest();
        let largest = r
            .iter()
            .fold(0.0f64, |m, c| if c.abs() > m.abs() { *c } else { m });
        let r = r.map(|c| c / largest);
        let norm = r.iter().map(|c| c * c).sum::<f64>();
        let [rw, rx, ry, rz] = r.map(|c| graph.constant(c));
        let product = [
            w * rw - x * rx - y * ry - z * rz,
            w * rx + x * rw + y * rz - z * ry,
            w * ry - x * rz + y * rw + z * rx,
            w * rz + x * ry - y * rx + z * rw,
        ];
        let turned = rotation_of_scaled_quaternion(graph, product, length, norm);
        Mat3::from_columns(order.map(|(column, negative)| {
            let axis = turned.column(column);
            if negative { -axis } else { axis }
        }))
    }

    /// The cheapest of the 24 equivalent rotations: for each axis the column that it becomes and its sign, and the unit
    /// quaternion of these columns.
    fn cheapest(&self) -> (Order, [f64; 4]) {
        let mut best: Option<(usize, Order, [f64; 4])> = None;
        for order in orders() {
            let mut columns = [[0.0; 3]; 3];
            for (axis, (column, negative)) in self.axes.iter().zip(order) {
                columns[column] = axis.map(|c| if negative { -c } else { c });
            }
            let r = quaternion(columns);
            let count = r.iter().filter(|c| **c != 0.0).count();
            if best.as_ref().is_none_or(|(least, ..)| count < *least) {
                best = Some((count, order, r));
            }
        }
        best.map_or(
            ([(0, false), (1, false), (2, false)], [1.0, 0.0, 0.0, 0.0]),
            |(_, order, r)| (order, r),
        )
    }
}

/// For each axis, the column that it becomes, and true if its sign changes.
type Order = [(usize, bool); 3];

/// The 24 rotations of a cube.
fn orders() -> impl Iterator<Item = Order> {
    let permutations = [
        ([0, 1, 2], false),
        ([1, 2, 0], false),
        ([2, 0, 1], false),
        ([0, 2, 1], true),
        ([2, 1, 0], true),
        ([1, 0, 2], true),
    ];
    permutations.into_iter().flat_map(|(columns, odd)| {
        let signs = (0..8u8).map(|bits| [0, 1, 2].map(|i| bits >> i & 1 == 1));
        let proper = move |signs: &[bool; 3]| !signs.iter().fold(odd, |odd, s| odd ^ s);
        signs
            .filter(proper)
            .map(move |signs| from_fn(|i| (columns[i], signs[i])))
    })
}

/// The unit quaternion (w, x, y, z) of a rotation given by its columns.
fn quaternion(columns: [[f64; 3]; 3]) -> [f64; 4] {
    let a = |i: usize, j: usize| columns[j][i];
    let (xx, yy, zz) = (a(0, 0), a(1, 1), a(2, 2));
    // Four times the squares of the components; the largest is at least 1.
    let squares = [
        1.0 + xx + yy + zz,
        1.0 + xx - yy - zz,
        1.0 - xx + yy - zz,
        1.0 - xx - yy + zz,
    ];
    let (wx, wy, wz) = (a(2, 1) - a(1, 2), a(0, 2) - a(2, 0), a(1, 0) - a(0, 1));
    let (xy, xz, yz) = (a(0, 1) + a(1, 0), a(0, 2) + a(2, 0), a(1, 2) + a(2, 1));
    let largest = (0..4)
        .max_by(|&i, &j| squares[i].total_cmp(&squares[j]).then(j.cmp(&i)))
        .unwrap_or(0);
    let row = match largest {
        0 => [squares[0], wx, wy, wz],
        1 => [wx, squares[1], xy, xz],
        2 => [wy, xy, squares[2], yz],
        _ => [wz, xz, yz, squares[3]],
    };
    let size = 2.0 * squares[largest].sqrt();
    row.map(|c| cleaned(c / size, 1.0))
}
