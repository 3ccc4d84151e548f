//! The derivatives of the inverse dynamics in the frames of links: of the generalised forces τ(q, v, v̇) that a motion
//! needs, with respect to the positions and the velocities of the joints. \[Singh, Russell, Wensing 2022, in classical
//! accelerations\]
//!
//! A joint k at p_k has the column (t z, s z), and z is fixed in its link and in the carrier. The points p outboard of
//! it, with π = p − p_k and the velocity and acceleration π', π'' that they have relative to the axes of link k, move
//! by δp = t z × π + s z for a unit of its coordinate. Let ψ = ω × z and χ = Γ z, the first and second rates of z. Then
//! the acceleration of p changes by d²(δp)/dt² with the coordinate and by 2 d(δp)/dt with its rate. All sums over
//! outboard mass follow from
//!
//! | of link k, about p_k | |
//! |---|---|
//! | m, h, Σ | the composite body; J = tr Σ · 1 − Σ |
//! | P = Σ 2 m π',  B = Σ 2 m π' πᵀ | twice the momentum and its spread, relative to the link |
//! | f, n | the wrench that the motion relative to the link needs |
//!
//! No velocity of p_k occurs, because the dynamics are the same in all frames that move uniformly. The body δ has the
//! change of the composite body: mass 0, δh and δΣ. For a vector w, K(w) = Σ m π × (w × δp) = −t z × Σw + s h × (w ×
//! z). A joint passes three wrenches to the root. Their powers per velocity of a carrier i are entries of a matrix:
//!
//! | wrench | entry |
//! |---|---|
//! | (δh,  t J z + s h × z) | S_ik |
//! | (2ω × δh + t z × P,  K(2ω) + t (tr B − B) z) | ∂τ_i/∂v_k |
//! | the wrench that δ needs in the motion of k, plus t z × (f, n) + s (0, z × f) + t (ψ × P, (tr B − B) ψ) | ∂τ_i/∂q_k |
//!
//! The first of them, (e, c) when it has come to the carrier i, and g = Σ 2 m (ṗ − ṗ_i) × δp give the entries of row k.
//! On the way from a link to its carrier, by r, g increases by (2ω × r) × e, with ω of the carrier. a is the
//! acceleration of p_i minus the field; z, t, s, ω, ψ and χ are those of i.
//!
//! | | |
//! |---|---|
//! | ∂τ_k/∂v_i | t (2ψ · c + z · g) + 2 s ψ · e |
//! | ∂τ_k/∂q_i | t (χ · c + ψ · g − (z × a) · e) + s χ · e |
//!
//! A joint with the rate u and the acceleration u̇ changes what is outboard, seen from its carrier: P by 2 u δh, B by
//! 2 u Σ m δp πᵀ, and (f, n) by u̇ (δh, t J z + s h × z) + u (w × δh, K(w)) with w = 2ω − u t z.
//!
//! A free base turns about absolute axes e, and its v and v̇ are components in absolute axes. For a change of its
//! orientation the wrench that it passes is that of a hinge with z = e and ψ = ω × e. A change of ω alone changes the
//! acceleration of p by e × (ω × π) + ω × (e × π) + 2 e × π'. Moving the base changes nothing.

use super::body::Body;
use super::forces;
use super::frames::{Choice, Framed, natural_axes};
use super::mass_matrix;
use super::motion::{Given, LinkMotion};
use super::search::{self, Aim};
use super::tree::{LinkJoint, Tree};
use super::turn::through;
use super::wrench::Written;
use crate::dynamics::augmented_body::rotated;
use crate::dynamics::spatial::{Spatial, Wrench};
use crate::expression::Expr;
use crate::expression::vector::{Mat3, Sym3, Vec3};
use crate::force::AppliedForces;
use crate::motion::ball::Orientation;

/// A square matrix by rows and columns of v.
pub type Square<'g> = Vec<Vec<Expr<'g>>>;

/// A system in the frames of its links, for derivatives.
pub struct InLinks<'g> {
    tree: Tree<'g>,
    framed: Framed<'g>,
    choice: Choice,
    /// The field, in absolute axes; for a free base only.
    field: Vec3<'g>,
    /// Length of v.
    size: usize,
    names: Vec<String>,
}

/// The joint of a link, in its axes.
#[derive(Clone, Copy)]
struct Column<'g> {
    turn: f64,
    slide: Expr<'g>,
    /// u
    rate: Expr<'g>,
    /// u̇
    acceleration: Expr<'g>,
}

/// What is outboard of a joint, about its origin and in its axes.
#[derive(Clone, Copy)]
struct Outboard<'g> {
    body: Body<'g>,
    /// P
    momentum: Vec3<'g>,
    /// B
    spread: Mat3<'g>,
    /// f, n
    needed: Wrench<'g>,
}

/// What a joint passes towards the root.
#[derive(Clone, Copy)]
struct Carried<'g> {
    /// The column of S.
    inertia: Wrench<'g>,
    /// g
    spin: Vec3<'g>,
    by_velocity: Wrench<'g>,
    by_position: Wrench<'g>,
}

/// The results of a system, by rows and columns of v; other systems have zeros.
pub struct Found<'g> {
    /// S
    pub matrix: Square<'g>,
    /// τ
    pub forces: Vec<Expr<'g>>,
    /// ∂τ/∂q
    pub by_position: Square<'g>,
    /// ∂τ/∂v
    pub by_velocity: Square<'g>,
}

/// All ways of writing a system in link frames that are worth a comparison; none if link frames cannot be used.
pub fn ways<'g>(spatial: &Spatial<'g, '_>, applied: &AppliedForces<'g>) -> Vec<InLinks<'g>> {
    let tree = Tree::of(spatial, Some(applied));
    let Some(tree) = tree.filter(|tree| is_possible(spatial, tree)) else {
        return Vec::new();
    };
    let aims = [Aim::Matrices, Aim::Factorization, Aim::Elimination];
    let mut choices: Vec<Choice> = Vec::new();
    for aim in aims {
        let mut choice = search::choice(&tree, aim);
        choice.base = [0.0; 3];
        if !choices.contains(&choice) {
            choices.push(choice);
        }
    }
    let ways = choices.into_iter();
    ways.filter_map(|choice| InLinks::of(spatial, applied, choice))
        .collect()
}

/// A free base.
pub struct FreeBase<'g> {
    /// The first row of its translation.
    pub translation: usize,
    /// The first row of its rotation.
    pub rotation: usize,
    omega: Vec3<'g>,
    field: Vec3<'g>,
}

impl<'g> FreeBase<'g> {
    /// True for the columns of its rotation.
    pub fn turns(&self, column: usize) -> bool {
        (self.rotation..self.rotation + 3).contains(&column)
    }

    /// Adds the change of v̇ with a turn of the base to its columns of ∂v̇/∂q, from ∂v̇/∂v and S⁻¹: a turn of the base
    /// with the velocities and the forces r on the base turned as well turns the accelerations minus the field, and
    /// those of the joints stay.
    pub fn turn(
        &self,
        by_position: &mut Square<'g>,
        by_velocity: &Square<'g>,
        inverse: &Square<'g>,
        [accelerations, forces]: [&[Expr<'g>]; 2],
    ) {
        let three = |of: &[Expr<'g>], first: usize| Vec3([0, 1, 2].map(|i| of[first + i]));
        let [x, r] = [self.translation, self.rotation];
        for (i, row) in by_position.iter_mut().enumerate() {
            let turned = three(&by_velocity[i], r).cross(self.omega)
                + three(&inverse[i], x).cross(three(forces, x))
                + three(&inverse[i], r).cross(three(forces, r));
            for (entry, value) in row[r..r + 3].iter_mut().zip(turned.0) {
                *entry = *entry + value;
            }
        }
        let turned = [
            (x, three(accelerations, x) - self.field),
            (r, three(accelerations, r)),
        ];
        for (first, a) in turned {
            for j in 0..3 {
                // e_j × a
                let (k, l) = ((j + 1) % 3, (j + 2) % 3);
                let [above, below] = [first + l, first + k];
                by_position[above][r + j] = by_position[above][r + j] + a.0[k];
                by_position[below][r + j] = by_position[below][r + j] - a.0[l];
            }
        }
    }
}

/// True if every joint is an axis that turns with its carrier, except for the ball of a free base.
fn is_possible(spatial: &Spatial<'_, '_>, tree: &Tree<'_>) -> bool {
    let of = |(k, link): (usize, &super::tree::Link<'_>)| match link.joint {
        LinkJoint::Ball { .. } => {
            k == 0 && tree.free && spatial.layout.orientation == Orientation::Quaternion
        }
        LinkJoint::Axis { absolute, .. } => !absolute,
    };
    tree.links.iter().enumerate().all(of)
}

impl<'g> InLinks<'g> {
    /// The system in chosen frames; `None` if link frames cannot be used.
    pub fn of(
        spatial: &Spatial<'g, '_>,
        applied: &AppliedForces<'g>,
        choice: Choice,
    ) -> Option<Self> {
        let tree = Tree::of(spatial, Some(applied)).filter(|tree| is_possible(spatial, tree))?;
        let links = tree.links.iter();
        Some(InLinks {
            framed: Framed::of(&tree, &natural_axes(&tree), &choice),
            names: links.map(|link| spatial.label(link.element)).collect(),
            tree,
            choice,
            field: applied.wrenches.fields[spatial.system],
            size: spatial.layout.velocities.len(),
        })
    }

    fn written(&self) -> Written<'g, '_> {
        Written {
            tree: &self.tree,
            framed: &self.framed,
            choice: &self.choice,
        }
    }

    /// True if the ground does not turn, so that τ at v̇ = 0 is a quadratic form of v plus the forces against a field.
    pub fn rests(&self) -> bool {
        let ground = &self.tree.ground;
        ground.omega.is_zero() && ground.alpha.is_zero()
    }

    /// The free base, if there is one.
    pub fn base(&self) -> Option<FreeBase<'g>> {
        let translation = self.tree.base?;
        Some(FreeBase {
            translation,
            rotation: self.tree.links[0].row,
            omega: match self.tree.links[0].joint {
                LinkJoint::Ball { omega, .. } => omega,
                LinkJoint::Axis { .. } => return None,
            },
            field: self.field,
        })
    }

    /// −(bias forces): what the field that all bodies feel does, by row; the inertia against a given acceleration of
    /// the reference joint included.
    pub fn of_field(&self) -> Vec<Expr<'g>> {
        let graph = self.tree.graph;
        let ground = &self.tree.ground;
        let field = match self.tree.free {
            true => self.field,
            false => -ground.axes.times(ground.acceleration),
        };
        let written = self.written();
        let mut sums = vec![graph.constant(0.0); self.size];
        for (row, force) in forces::of_field(&written, &mass_matrix::composites(&written), field) {
            sums[row] = sums[row] + force;
        }
        sums
    }

    /// τ, its derivatives, and S, at these v̇.
    pub fn at(&self, accelerations: &[Expr<'g>]) -> Found<'g> {
        let graph = self.tree.graph;
        let zero = graph.constant(0.0);
        let square = || vec![vec![zero; self.size]; self.size];
        let given = Given {
            accelerations,
            field: self.field,
        };
        for name in &self.names {
            graph.section(format!("element {name}: motion for derivatives"));
        }
        let motions = given.motion(&self.tree, &self.framed, &self.choice);
        let mut pass = Pass {
            written: self.written(),
            columns: self.columns(accelerations),
            accelerations,
            found: Found {
                matrix: square(),
                forces: vec![zero; self.size],
                by_position: square(),
                by_velocity: square(),
            },
            motions,
        };
        let outboard = pass.outboard(&self.names);
        for (k, of) in outboard.iter().enumerate() {
            graph.section(format!("∂τ[·, {}]", self.names[k]));
            match pass.columns[k] {
                Some(column) => pass.joint(k, &column, of),
                None => pass.of_base(of),
            }
        }
        pass.found
    }

    /// The joint of each link; `None` for a base.
    fn columns(&self, accelerations: &[Expr<'g>]) -> Vec<Option<Column<'g>>> {
        let links = self.tree.links.iter().zip(&self.framed.links);
        let column = |link: &super::tree::Link<'g>, sign: f64| match link.joint {
            LinkJoint::Ball { .. } => None,
            LinkJoint::Axis {
                turn,
                slide,
                rate,
                ratio,
                ..
            } => Some(Column {
                turn,
                slide: (1.0 / self.choice.unit) * slide,
                rate: sign * rate,
                acceleration: sign * (ratio * accelerations[link.row]),
            }),
        };
        links
            .map(|(link, frame)| column(link, frame.sign))
            .collect()
    }
}

/// z × v
fn about_z<'g>(v: Vec3<'g>) -> Vec3<'g> {
    let [x, y, _] = v.0;
    Vec3([-y, x, x.graph().constant(0.0)])
}

/// w × z
fn with_z<'g>(w: Vec3<'g>) -> Vec3<'g> {
    -about_z(w)
}

fn along_z(value: Expr<'_>) -> Vec3<'_> {
    let zero = value.graph().constant(0.0);
    Vec3([zero, zero, value])
}

/// (tr B − B) v
fn spread_of<'g>(spread: &Mat3<'g>, v: Vec3<'g>) -> Vec3<'g> {
    let b = spread.0;
    Vec3([0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        (b[j][j] + b[k][k]) * v.0[i] - b[i][j] * v.0[j] - b[i][k] * v.0[k]
    }))
}

fn plus<'g>(a: &Mat3<'g>, b: &Mat3<'g>) -> Mat3<'g> {
    Mat3([0, 1, 2].map(|i| [0, 1, 2].map(|j| a.0[i][j] + b.0[i][j])))
}

fn outer<'g>(a: Vec3<'g>, b: Vec3<'g>) -> Mat3<'g> {
    Mat3(a.0.map(|x| b.0.map(|y| x * y)))
}

impl<'g> Column<'g> {
    /// The power of a wrench on the link per rate of the joint.
    fn power(&self, wrench: &Wrench<'g>) -> Expr<'g> {
        self.slide * wrench.force.0[2] + self.turn * wrench.moment.0[2]
    }

    /// δh
    fn shift(&self, body: &Body<'g>) -> Vec3<'g> {
        self.turn * about_z(body.first) + along_z(self.slide * body.mass)
    }

    /// The body δ.
    fn change(&self, body: &Body<'g>) -> Body<'g> {
        let (t, s) = (self.turn, self.slide);
        let second = |i: usize, j: usize| body.second.entry(i, j);
        let [x, y, z] = body.first.0;
        Body {
            mass: s.graph().constant(0.0),
            first: self.shift(body),
            second: Sym3 {
                diagonal: [
                    -((2.0 * t) * second(0, 1)),
                    (2.0 * t) * second(0, 1),
                    2.0 * (s * z),
                ],
                off: [
                    t * second(0, 2) + s * y,
                    s * x - t * second(1, 2),
                    t * (second(0, 0) - second(1, 1)),
                ],
            },
            sizes: body.sizes,
        }
    }

    /// K(w)
    fn coriolis(&self, body: &Body<'g>, w: Vec3<'g>) -> Vec3<'g> {
        self.slide * body.first.cross(with_z(w)) - self.turn * about_z(body.second.times(w))
    }

    /// J t z + s h × z
    fn inertia(&self, body: &Body<'g>) -> Vec3<'g> {
        let second = |i: usize, j: usize| body.second.entry(i, j);
        let about = Vec3([-second(0, 2), -second(1, 2), second(0, 0) + second(1, 1)]);
        self.turn * about + self.slide * with_z(body.first)
    }

    /// What the link passes to its carrier, still about its own origin and in its own axes.
    fn passed(&self, outboard: &Outboard<'g>, omega: Vec3<'g>) -> Outboard<'g> {
        let body = &outboard.body;
        let (shift, twice) = (self.shift(body), 2.0 * self.rate);
        let between = 2.0 * omega - along_z(self.turn * self.rate);
        let rows = [0, 1, 2].map(|i| Vec3([0, 1, 2].map(|j| body.second.entry(i, j))));
        let (turned, slid) = (self.turn * twice, self.slide * twice);
        let spread = Mat3([
            (-(turned * rows[1])).0,
            (turned * rows[0]).0,
            (slid * body.first).0,
        ]);
        let moment =
            self.acceleration * self.inertia(body) + self.rate * self.coriolis(body, between);
        Outboard {
            body: *body,
            momentum: outboard.momentum + twice * shift,
            spread: plus(&outboard.spread, &spread),
            needed: outboard.needed.plus(Wrench {
                force: self.acceleration * shift + self.rate * between.cross(shift),
                moment,
            }),
        }
    }

    /// The wrenches of the joint itself.
    fn carried(&self, outboard: &Outboard<'g>, motion: &LinkMotion<'g>) -> Carried<'g> {
        let (t, s) = (self.turn, self.slide);
        let Outboard {
            body,
            momentum,
            spread,
            needed,
        } = outboard;
        let z = along_z(s.graph().constant(1.0));
        let twice = 2.0 * motion.omega;
        let psi = with_z(motion.omega);
        let (shift, b) = (self.shift(body), spread.0);
        let own = motion.inertia(&self.change(body), false);
        let moving = body.second.times(with_z(twice));
        let trace = b[0][0] + b[1][1];
        let row = Vec3([-b[2][0], -b[2][1], trace]);
        Carried {
            inertia: Wrench {
                force: shift,
                moment: self.inertia(body),
            },
            spin: t * (row + moving) + s * with_z(twice.cross(body.first) + *momentum),
            by_velocity: Wrench {
                force: twice.cross(shift) + t * about_z(*momentum),
                moment: self.coriolis(body, twice) + t * spread_of(spread, z),
            },
            by_position: Wrench {
                force: own.force + t * about_z(needed.force) + t * psi.cross(*momentum),
                moment: own.moment
                    + (t * about_z(needed.moment) + s * about_z(needed.force))
                    + t * spread_of(spread, psi),
            },
        }
    }
}

/// The pass over all links.
struct Pass<'g, 'a> {
    written: Written<'g, 'a>,
    accelerations: &'a [Expr<'g>],
    columns: Vec<Option<Column<'g>>>,
    motions: Vec<LinkMotion<'g>>,
    found: Found<'g>,
}

impl<'g> Pass<'g, '_> {
    /// What is outboard of each joint.
    fn outboard(&mut self, names: &[String]) -> Vec<Outboard<'g>> {
        let (graph, links) = (self.written.tree.graph, &self.written.tree.links);
        let none = Vec3::zero(graph);
        let composites = mass_matrix::composites(&self.written).into_iter();
        let still = |body| Outboard {
            body,
            momentum: none,
            spread: Mat3([none.0; 3]),
            needed: Wrench::none(graph),
        };
        let mut outboard: Vec<Outboard<'g>> = composites.map(still).collect();
        for (k, link) in links.iter().enumerate().rev() {
            graph.section(format!("element {}: outboard", names[k]));
            let (Some(column), Some(parent)) = (self.columns[k], link.parent) else {
                continue;
            };
            let passed = column.passed(&outboard[k], self.motions[k].omega);
            let (mut momentum, mut spread) = (passed.momentum, passed.spread);
            if let Some(along) = self.written.along(k) {
                spread = plus(&spread, &outer(momentum, along));
            }
            let frame = &self.written.framed.links[k];
            for turn in &frame.turns {
                (momentum, spread) = (turn.vector(momentum), turn.general(spread));
            }
            spread = plus(&spread, &outer(momentum, frame.place));
            let needed = self.written.on_parent(k, parent, passed.needed);
            let carrier = &mut outboard[parent];
            carrier.momentum = carrier.momentum + momentum;
            carrier.spread = plus(&carrier.spread, &spread);
            carrier.needed = carrier.needed.plus(needed.as_it_is());
        }
        outboard
    }

    /// Adds the row and the column of a joint.
    fn joint(&mut self, k: usize, column: &Column<'g>, outboard: &Outboard<'g>) {
        let link = &self.written.tree.links[k];
        let (row, share) = (link.row, self.written.share(k));
        let LinkJoint::Axis { armature, .. } = link.joint else {
            unreachable!("only an axis has a column")
        };
        let rotor = share.squared() * armature;
        let motion = self.motions[k];
        let whole = motion.inertia(&outboard.body, false).plus(outboard.needed);
        let force = share * column.power(&whole) + rotor * self.accelerations[row];
        self.found.forces[row] = self.found.forces[row] + force;
        let mut carried = column.carried(outboard, &motion);
        add(&mut self.found.matrix, (row, row), rotor);
        self.at_joint((row, share), k, &carried, true);
        let mut at = k;
        while let Some(parent) = self.written.tree.links[at].parent {
            carried = self.inwards(at, parent, &carried);
            match self.columns[parent] {
                Some(_) => self.at_joint((row, share), parent, &carried, false),
                None => self.at_base((row, share), &carried),
            }
            at = parent;
        }
    }

    /// What a joint passes on, at the carrier of link `k` in place of the link.
    fn inwards(&self, k: usize, parent: usize, carried: &Carried<'g>) -> Carried<'g> {
        let frame = &self.written.framed.links[k];
        let mut spin = carried.spin;
        if let (Some(along), Some(column)) = (self.written.along(k), &self.columns[k]) {
            let speed = (2.0 * self.motions[k].omega).cross(along)
                + along_z(column.slide * (2.0 * column.rate));
            spin = spin + speed.cross(carried.inertia.force);
        }
        let pass = |wrench| self.written.on_parent(k, parent, wrench).as_it_is();
        let inertia: Wrench<'g> = pass(carried.inertia);
        let speed = (2.0 * self.motions[parent].omega).cross(frame.place);
        Carried {
            inertia,
            spin: through(&frame.turns, spin) + speed.cross(inertia.force),
            by_velocity: pass(carried.by_velocity),
            by_position: pass(carried.by_position),
        }
    }

    /// Adds what a joint, with its row and its share of it, passes on, at the joint of link `i`.
    fn at_joint(
        &mut self,
        (row, share): (usize, Expr<'g>),
        i: usize,
        carried: &Carried<'g>,
        own: bool,
    ) {
        let Some(column) = &self.columns[i] else {
            return;
        };
        let (t, s) = (column.turn, column.slide);
        let motion = &self.motions[i];
        let other = self.written.tree.links[i].row;
        let share = share * self.written.share(i);
        let Wrench { force, moment } = carried.inertia;
        let twice = with_z(2.0 * motion.omega);
        let second = motion.gamma(along_z(s.graph().constant(1.0)));
        let by_velocity = t * (twice.dot(moment) + carried.spin.0[2]) + s * twice.dot(force);
        let by_position = t
            * (second.dot(moment) + with_z(motion.omega).dot(carried.spin)
                - about_z(motion.acceleration).dot(force))
            + s * second.dot(force);
        let found = &mut self.found;
        add(&mut found.by_velocity, (row, other), share * by_velocity);
        add(&mut found.by_position, (row, other), share * by_position);
        let inertia = share * column.power(&carried.inertia);
        add(&mut found.matrix, (row, other), inertia);
        if !own {
            let [by_velocity, by_position] =
                [&carried.by_velocity, &carried.by_position].map(|w| share * column.power(w));
            add(&mut found.matrix, (other, row), inertia);
            add(&mut found.by_velocity, (other, row), by_velocity);
            add(&mut found.by_position, (other, row), by_position);
        }
    }

    /// Adds what a joint passes on, at a free base.
    fn at_base(&mut self, (row, share): (usize, Expr<'g>), carried: &Carried<'g>) {
        let base = self.base();
        let absolute = |wrench| self.written.absolute(0, wrench);
        let inertia = absolute(carried.inertia);
        let spin = self.written.framed.links[0].axes.times(carried.spin);
        let by_velocity = spin + inertia.moment.cross(base.omega);
        let by_position = by_velocity.cross(base.omega)
            + inertia.moment.cross(base.alpha)
            + inertia.force.cross(base.acceleration);
        let columns = [absolute(carried.by_velocity), absolute(carried.by_position)];
        let found = &mut self.found;
        for i in 0..3 {
            let (x, turn) = (base.rows[0] + i, base.rows[1] + i);
            let scale = (1.0 / self.written.choice.unit) * share;
            for (of_row, value) in [
                (x, scale * inertia.force.0[i]),
                (turn, share * inertia.moment.0[i]),
            ] {
                add(&mut found.matrix, (row, of_row), value);
                add(&mut found.matrix, (of_row, row), value);
            }
            add(
                &mut found.by_velocity,
                (row, turn),
                share * by_velocity.0[i],
            );
            add(
                &mut found.by_position,
                (row, turn),
                share * by_position.0[i],
            );
            let matrices = [&mut found.by_velocity, &mut found.by_position];
            for (matrix, wrench) in matrices.into_iter().zip(&columns) {
                add(matrix, (x, row), scale * wrench.force.0[i]);
                add(matrix, (turn, row), share * wrench.moment.0[i]);
            }
        }
    }

    /// The motion of a free base, in absolute axes.
    fn base(&self) -> Base<'g> {
        let (tree, given) = (self.written.tree, self.accelerations);
        let link = &tree.links[0];
        let LinkJoint::Ball { omega, .. } = link.joint else {
            unreachable!("only a base is on a ball")
        };
        let first = tree.base.unwrap_or_default();
        Base {
            rows: [first, link.row],
            omega,
            alpha: Vec3([0, 1, 2].map(|i| given[link.row + i])),
            acceleration: self.written.framed.links[0]
                .axes
                .times(self.motions[0].acceleration),
        }
    }

    /// Adds the rows and the columns of a free base.
    fn of_base(&mut self, outboard: &Outboard<'g>) {
        let base = self.base();
        let graph = self.written.tree.graph;
        let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
        let axes = self.written.framed.links[0].axes;
        let needed = self.written.absolute(0, outboard.needed);
        let momentum = axes.times(outboard.momentum);
        let spread = axes.product(&outboard.spread).product(&axes.transposed());
        let inertia = rotated(graph, &axes, &outboard.body.inertia());
        let [x, y, z] = inertia.diagonal;
        let half = 0.5 * (x + y + z);
        let body = Body {
            mass: outboard.body.mass,
            first: axes.times(outboard.body.first),
            second: Sym3::from_fn(|i, j| match i == j {
                true => half - inertia.diagonal[i],
                false => -inertia.entry(i, j),
            }),
            sizes: [0.0; 2],
        };
        let motion = LinkMotion {
            omega: base.omega,
            alpha: base.alpha,
            acceleration: base.acceleration,
            reference: zero,
        };
        let whole = motion.inertia(&body, true).plus(needed);
        let unit = self.written.choice.unit;
        let scale = 1.0 / unit;
        let (omega, h) = (base.omega, body.first);
        let moving = body.second.times(omega);
        for j in 0..3 {
            let mut axis = Vec3([zero; 3]);
            axis.0[j] = one;
            let turns_with = omega.cross(axis);
            // ω × (h × e) is ω e · h less h e · ω
            let force =
                h.cross(omega).cross(axis) + omega.cross(axis.cross(h)) + axis.cross(momentum);
            let by_velocity = Wrench {
                force,
                moment: spread_of(&spread, axis) - omega.cross(body.second.times(axis))
                    + moving.cross(axis),
            };
            let own = motion.inertia(&turned_about(&body, axis), false);
            let by_position = Wrench {
                force: own.force + axis.cross(needed.force) + turns_with.cross(momentum),
                moment: own.moment + axis.cross(needed.moment) + spread_of(&spread, turns_with),
            };
            let column = Wrench {
                force: axis.cross(h),
                moment: inertia.times(axis),
            };
            let [x, turn] = base.rows;
            let found = &mut self.found;
            found.forces[x + j] = found.forces[x + j] + scale * whole.force.0[j];
            found.forces[turn + j] = found.forces[turn + j] + whole.moment.0[j];
            add(
                &mut found.matrix,
                (x + j, x + j),
                (scale * scale) * body.mass,
            );
            for i in 0..3 {
                let force = scale * column.force.0[i];
                add(&mut found.matrix, (x + i, turn + j), force);
                add(&mut found.matrix, (turn + j, x + i), force);
                add(&mut found.matrix, (turn + i, turn + j), column.moment.0[i]);
                let matrices = [&mut found.by_velocity, &mut found.by_position];
                for (matrix, wrench) in matrices.into_iter().zip([&by_velocity, &by_position]) {
                    add(matrix, (x + i, turn + j), scale * wrench.force.0[i]);
                    add(matrix, (turn + i, turn + j), wrench.moment.0[i]);
                }
            }
        }
    }
}

/// The motion of a free base, in absolute axes.
struct Base<'g> {
    /// The first rows of its translation and of its rotation.
    rows: [usize; 2],
    omega: Vec3<'g>,
    alpha: Vec3<'g>,
    /// The acceleration of its origin minus the field, in the unit of length.
    acceleration: Vec3<'g>,
}

/// The change of a body that turns about an axis through its origin: h → e × h, Σ → e × Σ − Σ × e.
fn turned_about<'g>(body: &Body<'g>, axis: Vec3<'g>) -> Body<'g> {
    let columns = [0, 1, 2].map(|j| Vec3([0, 1, 2].map(|i| body.second.entry(i, j))));
    let turned = columns.map(|column| axis.cross(column));
    Body {
        mass: axis.0[0].graph().constant(0.0),
        first: axis.cross(body.first),
        second: Sym3::from_fn(|i, j| turned[j].0[i] + turned[i].0[j]),
        sizes: body.sizes,
    }
}

fn add<'g>(matrix: &mut Square<'g>, (row, column): (usize, usize), value: Expr<'g>) {
    matrix[row][column] = matrix[row][column] + value;
}
