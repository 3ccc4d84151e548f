//! The accelerations by the articulated-body algorithm. A reference motion replaces the velocity terms: the
//! accelerations are those for v̇ = 0 plus a remainder Δ, and only Δ is multiplied by articulated inertias.
//! \[Featherstone 2008, ch. 7\]
//!
//! For the accelerations of its element, the bodies outboard of a joint need the wrench
//!
//! f = K Δa + Bᵀ Δα + f₀,   n = B Δa + J Δα + n₀
//!
//! K and J are symmetric. Of a body alone K = m 1 and B = ŵ, where û is the matrix of u ×.
//!
//! | leaves to root, with the columns H = (s, e) of a joint and the generalised forces Q on its coordinates | |
//! |---|---|
//! | U = (K s + Bᵀ e,   B s + J e),   D = Hᵀ U = L d Lᵀ | y = L⁻¹ Uᵀ,   z = d⁻¹ y |
//! | (K, B, J) ← (K, B, J) − Σ z yᵀ | K and J stay exactly symmetric: six entries each |
//! | r = Q − Hᵀ (f₀, n₀) | (f₀, n₀) ← (f₀, n₀) + Σ (d⁻¹ L⁻¹ r) y |
//! | moved by u to the carrier: B' = B + û K,   J' = J − B û + û B'ᵀ,   n₀' = n₀ + u × f₀ | through a ball joint, with B = J = n₀ = 0 |
//! | root to leaves: Δa' = Δa_p + Δα_p × u,   v̇ = L⁻ᵀ (d⁻¹ L⁻¹ r − zᵀ (Δa', Δα_p)) | on a ball joint, with Δα_p = 0 |

use super::{Column, Spatial, Wrench};
use crate::dynamics::factorization::Ldl;
use crate::expression::vector::{Mat3, Sym3, Vec3};
use crate::expression::{Expr, Symbol};
use crate::force::AppliedForces;
use crate::model::Dimension;
use crate::motion::kinematics::reference_acceleration;
use crate::motion::numbers::inverse_rates;

/// The articulated inertia and bias of the bodies outboard of a joint, about the origin of its element.
#[derive(Clone, Copy)]
struct Articulated<'g> {
    /// K \[kg\]
    mass: Sym3<'g>,
    /// B \[kg m\]
    coupling: Mat3<'g>,
    /// J \[kg m²\]
    inertia: Sym3<'g>,
    /// (f₀, n₀)
    bias: Wrench<'g>,
}

/// The quantities of an element that the pass outwards needs.
struct Eliminated<'g> {
    factors: Ldl<'g>,
    /// z: its force parts, then its moment parts.
    forces: Vec<Vec3<'g>>,
    moments: Vec<Vec3<'g>>,
    /// d⁻¹ L⁻¹ r
    bias: Vec<Expr<'g>>,
}

/// The pass from the leaves to the root. Returns for each joint the articulated inertia that is left after its
/// elimination, and the quantities that the pass outwards needs.
fn inwards<'g>(
    spatial: &Spatial<'g, '_>,
    applied: &AppliedForces<'g>,
    biases: &[Vec3<'g>],
) -> (Vec<Articulated<'g>>, Vec<Option<Eliminated<'g>>>) {
    let (graph, system) = (spatial.graph, spatial.system);
    let elements = &spatial.of_system().elements;
    let mut outboard: Vec<Articulated<'g>> = (spatial.bodies().iter().enumerate())
        .map(|(k, body)| {
            graph.section(format!(
                "element {}: forces of velocity and load",
                spatial.label(k)
            ));
            let load = &applied.wrenches.elements[system][k];
            let needed = spatial.inertia(k, body, biases[k]);
            let zero = graph.constant(0.0);
            let [x, y, z] = body.first_moment.0;
            let mut mass = Sym3::zero(graph);
            mass.diagonal = [body.mass; 3];
            Articulated {
                mass,
                coupling: Mat3([[zero, -z, y], [z, zero, -x], [-y, x, zero]]),
                inertia: body.inertia,
                bias: Wrench {
                    force: needed.force - load.force,
                    moment: needed.moment - load.moment,
                },
            }
        })
        .collect();

    let mut eliminated: Vec<Option<Eliminated<'g>>> = elements.iter().map(|_| None).collect();
    for k in (0..elements.len()).rev() {
        let label = spatial.label(k);
        graph.section(format!("element {label}: elimination"));
        let columns = elimination_columns(spatial, k);
        // the laws of a ball joint act as moments
        let mut acting = applied.wrenches.on_freedoms[system][k].clone();
        acting.resize(columns.columns.len(), graph.constant(0.0));
        let (done, rest) = outboard[k].eliminate(spatial, &columns.columns, acting);
        eliminated[k] = Some(done);
        outboard[k] = rest;
        if let Some(parent) = elements[k].parent {
            graph.section(format!(
                "element {}: what {label} passes on",
                spatial.label(parent)
            ));
            let motion = spatial.motion_of(k);
            let passed = rest.moved(motion.offset, motion.turns_with_carrier);
            outboard[parent] = outboard[parent].plus(passed);
        }
    }
    (outboard, eliminated)
}

/// v̇ of the system, by row.
pub fn accelerations<'g>(
    spatial: &Spatial<'g, '_>,
    applied: &AppliedForces<'g>,
) -> Vec<(usize, Expr<'g>)> {
    let mut accelerations = Vec::new();
    let (graph, system) = (spatial.graph, spatial.system);
    let elements = &spatial.of_system().elements;
    let free = spatial.layout.reference_velocities(system);
    // all accelerations are relative to a frame in which the common field vanishes
    let field = applied.wrenches.fields[system];
    let given = match free {
        Some(_) => Vec3::zero(graph),
        None => reference_acceleration(graph, spatial.of_system(), spatial.motion) - field,
    };
    let biases = spatial.origin_biases(given);
    let (outboard, eliminated) = inwards(spatial, applied, &biases);

    graph.section(format!(
        "system {}: reference joint",
        spatial.of_system().name
    ));
    let mut moved = vec![Vec3::zero(graph); elements.len()];
    let mut turned = moved.clone();
    let root = match &free {
        Some(_) => outboard[0].floating(spatial),
        None => Vec3::zero(graph),
    };
    if let Some(rows) = free {
        for (row, &direction) in rows.zip(spatial.layout.directions) {
            accelerations.push((row, root.0[direction] + field.0[direction]));
        }
    }
    for (k, element) in elements.iter().enumerate() {
        graph.section(format!("element {}: accelerations", spatial.label(k)));
        let motion = spatial.motion_of(k);
        let none = Vec3::zero(graph);
        let (a, alpha) = match element.parent {
            None => (root, none),
            Some(p) => {
                let a = moved[p] + turned[p].cross(motion.offset);
                (
                    a,
                    if motion.turns_with_carrier {
                        turned[p]
                    } else {
                        none
                    },
                )
            }
        };
        let Some(done) = &eliminated[k] else { continue };
        let rates = done.rates(a, alpha);
        let columns = elimination_columns(spatial, k);
        (moved[k], turned[k]) = (a, alpha);
        for (column, &rate) in columns.columns.iter().zip(&rates) {
            moved[k] = moved[k] + rate * column.slide;
            turned[k] = turned[k] + rate * column.axis;
        }
        let rates = match columns.own {
            true => rates,
            false => {
                let second = spatial.layout.element_coordinates(spatial.id(k)).start + 1;
                let cosine = graph.symbol(Symbol::Coordinate(second as u32)).cos();
                inverse_rates(motion.axes[1], motion.axes[2], cosine, turned[k]).to_vec()
            }
        };
        accelerations.extend(spatial.rows(k).zip(rates));
    }
    accelerations
}

/// The columns that are eliminated together.
struct Columns<'g> {
    columns: Vec<Column<'g>>,
    /// True if the columns belong to the entries of v. For Bryant angles the columns are the absolute axes instead.
    own: bool,
}

fn elimination_columns<'g>(spatial: &Spatial<'g, '_>, k: usize) -> Columns<'g> {
    if !spatial.has_bryant_angles(k) || spatial.model.dimension == Dimension::Plane {
        return Columns {
            columns: spatial.columns(k),
            own: true,
        };
    }
    let graph = spatial.graph;
    let unit = |i: usize| Vec3([0, 1, 2].map(|j| graph.constant(f64::from(i == j))));
    let first = spatial.rows(k).start;
    let column = |i| Column {
        row: first + i,
        slide: Vec3::zero(graph),
        axis: unit(i),
        armature: graph.constant(0.0),
    };
    Columns {
        columns: (0..3).map(column).collect(),
        own: false,
    }
}

impl<'g> Articulated<'g> {
    fn eliminate(
        self,
        spatial: &Spatial<'g, '_>,
        columns: &[Column<'g>],
        acting: Vec<Expr<'g>>,
    ) -> (Eliminated<'g>, Articulated<'g>) {
        let needed: Vec<Wrench<'g>> = columns
            .iter()
            .map(|Column { slide, axis, .. }| Wrench {
                force: self.mass.times(*slide) + self.coupling.transposed_times(*axis),
                moment: self.coupling.times(*slide) + self.inertia.times(*axis),
            })
            .collect();
        let mut matrix: Vec<Vec<Expr<'g>>> = (columns.iter().enumerate())
            .map(|(i, row)| needed[..=i].iter().map(|n| row.power(n)).collect())
            .collect();
        for (i, column) in columns.iter().enumerate() {
            matrix[i][i] = matrix[i][i] + column.armature;
        }
        let factors = Ldl::of(spatial.graph, matrix);
        let forces = factors.forward(needed.iter().map(|n| n.force).collect());
        let moments = factors.forward(needed.iter().map(|n| n.moment).collect());
        let rest = (columns.iter().zip(acting))
            .map(|(column, acting)| acting - column.power(&self.bias))
            .collect();
        let right = factors.forward(rest);
        let bias = factors.scale(&right);
        let eliminated = Eliminated {
            forces: factors.scale(&forces),
            moments: factors.scale(&moments),
            bias,
            factors,
        };
        let mut left = self;
        for (j, (force, moment)) in forces.iter().zip(&moments).enumerate() {
            let (z, t) = (eliminated.forces[j], eliminated.moments[j]);
            left.mass = left.mass - Sym3::from_fn(|a, b| z.0[a] * force.0[b]);
            left.inertia = left.inertia - Sym3::from_fn(|a, b| t.0[a] * moment.0[b]);
            for (row, t) in left.coupling.0.iter_mut().zip(t.0) {
                for (entry, force) in row.iter_mut().zip(force.0) {
                    *entry = *entry - t * force;
                }
            }
            let bias = eliminated.bias[j];
            left.bias.force = left.bias.force + bias * *force;
            left.bias.moment = left.bias.moment + bias * *moment;
        }
        (eliminated, left)
    }

    /// The same articulated inertia, moved to the carrier, whose origin is at −u. `turns_with_carrier` is false for a
    /// ball joint.
    fn moved(self, u: Vec3<'g>, turns_with_carrier: bool) -> Self {
        let graph = u.0[0].graph();
        let none = Vec3::zero(graph);
        let (coupling, inertia, moment) = match turns_with_carrier {
            true => (self.coupling, self.inertia, self.bias.moment),
            false => (Mat3([none.0; 3]), Sym3::zero(graph), none),
        };
        // û K and û B'ᵀ are cross products of u with the columns of K and with the rows of B'
        let across = Mat3::from_columns([0, 1, 2].map(|j| {
            let column = [0, 1, 2].map(|i| self.mass.entry(i, j));
            u.cross(Vec3(column))
        }));
        let moved = Mat3([0, 1, 2].map(|i| [0, 1, 2].map(|j| coupling.0[i][j] + across.0[i][j])));
        // the rows of −B û are u × b for the rows b of B; the columns of û B'ᵀ are u × b' for the rows b' of B'
        let left = coupling.0.map(|row| u.cross(Vec3(row)));
        let right = moved.0.map(|row| u.cross(Vec3(row)));
        Articulated {
            mass: self.mass,
            coupling: moved,
            inertia: inertia + Sym3::from_fn(|i, j| left[i].0[j] + right[j].0[i]),
            bias: Wrench {
                force: self.bias.force,
                moment: moment + u.cross(self.bias.force),
            },
        }
    }

    fn plus(self, other: Self) -> Self {
        Articulated {
            mass: self.mass + other.mass,
            coupling: Mat3(
                [0, 1, 2]
                    .map(|i| [0, 1, 2].map(|j| self.coupling.0[i][j] + other.coupling.0[i][j])),
            ),
            inertia: self.inertia + other.inertia,
            bias: self.bias.plus(other.bias),
        }
    }

    /// Δa of the origin of a free base, from f = 0.
    fn floating(&self, spatial: &Spatial<'g, '_>) -> Vec3<'g> {
        let directions = spatial.layout.directions;
        let matrix = (directions.iter().enumerate())
            .map(|(i, &row)| {
                directions[..=i]
                    .iter()
                    .map(|&c| self.mass.entry(row, c))
                    .collect()
            })
            .collect();
        let right = directions.iter().map(|&d| -self.bias.force.0[d]).collect();
        let mut acceleration = Vec3::zero(spatial.graph);
        let solution = Ldl::of(spatial.graph, matrix).solve(right);
        for (&direction, a) in directions.iter().zip(solution) {
            acceleration.0[direction] = a;
        }
        acceleration
    }
}

impl<'g> Eliminated<'g> {
    /// v̇ of a joint, given the Δa' and Δα' that its element has if the joint is at rest.
    fn rates(&self, a: Vec3<'g>, alpha: Vec3<'g>) -> Vec<Expr<'g>> {
        let rest = (self.bias.iter().zip(&self.forces).zip(&self.moments))
            .map(|((bias, force), moment)| *bias - (force.dot(a) + moment.dot(alpha)))
            .collect();
        self.factors.backward(rest)
    }
}
