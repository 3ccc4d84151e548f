//! The augmented body of each element, for trees of ball joints: the masses outboard of it act as points on its joints.
//! \[Wittenburg 1977\]
//!
//! M_k = Σ m_i,   b_k = m_k g_k + Σ_c M_c s_c,   J_k = I_k + m_k (g²·1 − g gᵀ) + Σ_c M_c (s_c²·1 − s_c s_cᵀ)
//!
//! The first sum is over element k and all elements outboard of it; the others are over its children c. M is mass, b
//! first moment, and J inertia about the joint. All three are constant in the frame of the element, in every motion.
//! The equations use w = A b and A J Aᵀ in absolute axes.

use crate::expression::vector::{Mat3, Sym3, Vec3};
use crate::expression::{Expr, Graph};
use crate::model::{Dimension, Element, ElementId, Model};
use crate::motion::Motion;
use crate::motion::kinematics::{children, constant_rotation, identifier, path};
use crate::motion::numbers::{number, vector};

/// One augmented body.
pub struct AugmentedBody<'g> {
    /// M, the mass of the element and of all elements outboard of it \[kg\].
    pub mass: Expr<'g>,
    /// w = A b, the first moment about the joint, in absolute axes \[kg m\].
    pub first_moment: Vec3<'g>,
    /// A J Aᵀ, the inertia about the joint, in absolute axes \[kg m²\].
    pub inertia: Sym3<'g>,
    /// Whether ω × Jω is included.
    pub gyroscopic: bool,
}

/// The element whose gyroscopic moment ω × Jω is left out of the equations, to measure the cost of that moment. Such
/// equations describe no real body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Omitted(pub ElementId);

impl Omitted {
    /// Leaves out the gyroscopic moment of this element.
    pub fn omit(self, trees: &mut [AugmentedTree<'_>]) {
        let Omitted(id) = self;
        trees[id.system].bodies[id.element].gyroscopic = false;
    }
}

impl<'g> AugmentedBody<'g> {
    /// The body with these M, b and J, in absolute axes.
    pub fn turned(
        graph: &'g Graph,
        rotation: &Mat3<'g>,
        (mass, first_moment, inertia): (Expr<'g>, Vec3<'g>, Sym3<'g>),
        name: &str,
    ) -> Self {
        AugmentedBody {
            mass,
            first_moment: rotation.times(first_moment).named(&format!("w_{name}")),
            inertia: rotated(graph, rotation, &inertia).named(&format!("inertia_{name}")),
            gyroscopic: true,
        }
    }

    /// The gyroscopic moment ω × Jω. A body with equal moments about all axes has none; then no node is made.
    pub fn gyroscopic_moment(&self, graph: &'g Graph, omega: Vec3<'g>) -> Vec3<'g> {
        if !self.gyroscopic || is_spherical(&self.inertia) {
            Vec3::zero(graph)
        } else {
            omega.cross(self.inertia.times(omega))
        }
    }
}

/// The augmented bodies of one tree.
pub struct AugmentedTree<'g> {
    /// The body of each element.
    pub bodies: Vec<AugmentedBody<'g>>,
    /// Children of each element.
    pub children: Vec<Vec<usize>>,
}

impl<'g> AugmentedTree<'g> {
    /// The augmented bodies of a system in motion.
    pub fn of(graph: &'g Graph, model: &Model, system: usize, motion: &Motion<'g>) -> Self {
        let elements = &model.systems[system].elements;
        let children = children(elements);
        graph.section("augmented bodies");
        let carried = match model.systems[system].has_balls_alone() {
            true => children.clone(),
            // ball joints only: a body on any other joint cannot be lumped as a point mass
            false => vec![Vec::new(); elements.len()],
        };
        let constants = constants(graph, model.dimension, elements, &carried);
        let bodies = constants
            .into_iter()
            .enumerate()
            .map(|(k, (mass, first_moment, inertia))| {
                let id = ElementId { system, element: k };
                let rotation = &motion.element(id).rotation;
                let name = identifier(model, id);
                graph.section(format!("element {}: augmented body", path(model, id)));
                AugmentedBody::turned(graph, rotation, (mass, first_moment, inertia), &name)
            })
            .collect();
        AugmentedTree { bodies, children }
    }
}

/// Whether the matrix is J·1.
fn is_spherical(inertia: &Sym3<'_>) -> bool {
    let [x, y, z] = inertia.diagonal.map(|moment| moment.id());
    x == y && y == z && inertia.off.iter().all(|product| product.is_zero())
}

/// M, b and J of every element, in its local frame.
pub fn constants<'g>(
    graph: &'g Graph,
    dimension: Dimension,
    elements: &[Element],
    children: &[Vec<usize>],
) -> Vec<(Expr<'g>, Vec3<'g>, Sym3<'g>)> {
    let zero = graph.constant(0.0);
    let mut bodies = vec![(zero, Vec3::zero(graph), Sym3::zero(graph)); elements.len()];
    for k in (0..elements.len()).rev() {
        let points: Vec<_> = children[k]
            .iter()
            .map(|&c| (bodies[c].0, vector(graph, &elements[c].at)))
            .collect();
        let origin = Vec3::zero(graph);
        bodies[k] = with_points(graph, dimension, &elements[k], origin, &points);
    }
    bodies
}

/// M, b and J of an element with additional point masses, about an origin in its local frame. The points are given from
/// that origin.
pub fn with_points<'g>(
    graph: &'g Graph,
    dimension: Dimension,
    element: &Element,
    origin: Vec3<'g>,
    points: &[(Expr<'g>, Vec3<'g>)],
) -> (Expr<'g>, Vec3<'g>, Sym3<'g>) {
    let m = number(graph, &element.mass);
    let g = vector(graph, &element.cg) - origin;
    let own = own_inertia(graph, dimension, element) + of_point(m, g);
    let mut body = (m, m * g, own);
    for &(outboard, s) in points {
        body = (
            body.0 + outboard,
            body.1 + outboard * s,
            body.2 + of_point(outboard, s),
        );
    }
    if dimension == Dimension::Plane {
        // In the plane there is only one moment.
        let moment = body.2.diagonal[1];
        body.2 = Sym3::zero(graph);
        body.2.diagonal[1] = moment;
    }
    body
}

/// The inertia of an element about its centre of gravity, in its local frame: B diag(I₁, I₂, I₃) Bᵀ.
pub fn own_inertia<'g>(graph: &'g Graph, dimension: Dimension, element: &Element) -> Sym3<'g> {
    let principal = vector(graph, &element.inertia).0;
    let diagonal = Sym3 {
        diagonal: principal,
        off: Sym3::zero(graph).off,
    };
    match dimension {
        Dimension::Plane => diagonal,
        Dimension::Space => congruent(&constant_rotation(graph, &element.axes), &diagonal),
    }
}

/// m (r²·1 − r rᵀ)
fn of_point<'g>(m: Expr<'g>, r: Vec3<'g>) -> Sym3<'g> {
    let squares = r.0.map(|a| a.squared());
    let mr = m * r;
    Sym3 {
        diagonal: [
            m * (squares[1] + squares[2]),
            m * (squares[0] + squares[2]),
            m * (squares[0] + squares[1]),
        ],
        off: [
            -(mr.0[1] * r.0[2]),
            -(mr.0[0] * r.0[2]),
            -(mr.0[0] * r.0[1]),
        ],
    }
}

/// A M Aᵀ
fn congruent<'g>(a: &Mat3<'g>, m: &Sym3<'g>) -> Sym3<'g> {
    let half = a.0.map(|row| m.times(Vec3(row)));
    Sym3::from_fn(|i, j| Vec3(a.0[i]).dot(half[j]))
}

/// A J Aᵀ of a constant J, in fewer operations than two matrix products. With the smallest eigenvalue λ of J, J − λ·1 =
/// d p pᵀ + e r rᵀ has at most rank two, so A J Aᵀ = λ·1 + d (A p)(A p)ᵀ + e (A r)(A r)ᵀ. An axisymmetric body has only
/// one of these terms, a spherical one none.
pub fn rotated<'g>(graph: &'g Graph, rotation: &Mat3<'g>, inertia: &Sym3<'g>) -> Sym3<'g> {
    if is_spherical(inertia) {
        return *inertia;
    }
    let Some(values) = numbers(inertia) else {
        return congruent(rotation, inertia);
    };
    let number = |value: f64| graph.constant(value);
    let smallest = smallest_eigenvalue(values);
    let terms: Vec<_> = terms_of_rank_two(values, smallest)
        .into_iter()
        .map(|(d, p)| (number(d), rotation.times(Vec3(p.map(number)))))
        .collect();
    let trace = values[0][0] + values[1][1] + values[2][2];
    sum_of_squares(number(smallest), &terms, number(trace))
}

/// The entries, if all are numbers.
fn numbers(matrix: &Sym3<'_>) -> Option<[[f64; 3]; 3]> {
    let mut values = [[0.0; 3]; 3];
    for (i, row) in values.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            *value = matrix.entry(i, j).as_constant()?;
        }
    }
    Some(values)
}

/// Writes the symmetric matrix `values` − `smallest`·1 as d p pᵀ + e r rᵀ. `smallest` is the smallest eigenvalue of
/// `values`, so the rank is at most two. Returns d and p, e and r. The largest component of each vector is 1, and the
/// second vector has a zero.
pub fn terms_of_rank_two(values: [[f64; 3]; 3], smallest: f64) -> Vec<(f64, [f64; 3])> {
    let mut rest = values;
    for (i, row) in rest.iter_mut().enumerate() {
        row[i] -= smallest;
    }
    let scale = values[0][0] + values[1][1] + values[2][2];
    let mut terms = Vec::new();
    for _ in 0..2 {
        let pivot = (0..3)
            .max_by(|&a, &b| rest[a][a].total_cmp(&rest[b][b]).then(b.cmp(&a)))
            .unwrap_or(0);
        let d = rest[pivot][pivot];
        // A remainder below rounding counts as 0: the matrix has no further term.
        if d <= 8.0 * f64::EPSILON * scale {
            break;
        }
        let p: [f64; 3] = std::array::from_fn(|i| {
            let ratio = rest[i][pivot] / d;
            if ratio.abs() <= 8.0 * f64::EPSILON {
                0.0
            } else {
                ratio
            }
        });
        for (i, row) in rest.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                // Set to exactly 0 in spite of rounding: this row and column are eliminated.
                *entry = if i == pivot || j == pivot {
                    0.0
                } else {
                    *entry - d * p[i] * p[j]
                };
            }
        }
        terms.push((d, p));
    }
    terms
}

/// λ·1 + Σ d p pᵀ. The third diagonal entry follows from the given trace.
pub fn sum_of_squares<'g>(
    isotropic: Expr<'g>,
    terms: &[(Expr<'g>, Vec3<'g>)],
    trace: Expr<'g>,
) -> Sym3<'g> {
    let mut sum = Sym3::zero(isotropic.graph());
    sum.diagonal = [isotropic; 3];
    for &(d, p) in terms {
        let scaled = d * p;
        sum = sum + Sym3::from_fn(|i, j| scaled.0[i] * p.0[j]);
    }
    if terms.iter().filter(|(_, p)| !p.0[2].is_zero()).count() > 1 {
        sum.diagonal[2] = trace - (sum.diagonal[0] + sum.diagonal[1]);
    }
    sum
}

/// The smallest eigenvalue of a symmetric matrix, by Jacobi rotations. They use square roots only, so every machine
/// gives the same bits.
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn smallest_eigenvalue(mut a: [[f64; 3]; 3]) -> f64 {
    for _ in 0..32 {
        let mut off = 0.0;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            off += a[p][q].abs();
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            let r = 3 - p - q;
            (a[p][p], a[q][q]) = (a[p][p] - t * a[p][q], a[q][q] + t * a[p][q]);
            (a[p][q], a[q][p]) = (0.0, 0.0);
            let (arp, arq) = (a[r][p], a[r][q]);
            (a[r][p], a[r][q]) = (c * arp - s * arq, s * arp + c * arq);
            (a[p][r], a[q][r]) = (a[r][p], a[r][q]);
        }
        if off == 0.0 {
            break;
        }
    }
    a[0][0].min(a[1][1]).min(a[2][2])
}
