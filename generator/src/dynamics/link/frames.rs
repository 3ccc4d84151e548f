//! The frames of links, and the constants of the system in these frames.
//!
//! The frame of a link is fixed to the link, with its origin on the axis of its joint and z along this axis. Two
//! choices remain: the rotation about z and the place of the origin along z. The frame of a link on a ball is that of
//! its element, or the absolute frame.
//!
//! Bodies are regrouped, so a body on a hinge has only h_x, h_y and five entries of Σ.

use super::body::{Body, Numbers, cleaned, cleaned_numbers, in_axes, numbers};
use super::regrouping::{Constant, kept};
use super::tree::{LinkJoint, Tree};
use super::turn::Turn;
use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Graph};
pub use crate::rotation::Matrix;
use crate::rotation::{IDENTITY, cross, dot, product, transpose};

/// The choice of frames for the equations of a tree.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// The choice for each link.
    pub links: Vec<LinkChoice>,
    /// The origin of a free base, in its axes \[m\].
    pub base: [f64; 3],
    /// The unit of length \[m\].
    pub unit: f64,
}

/// The choice of the frame of one link.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkChoice {
    /// Angle of the frame about z \[rad\].
    pub turn: f64,
    /// Place of the origin along z \[m\].
    pub place: f64,
    /// True if the link is aligned: its frame keeps the axes of the inboard side of the joint; for a ball, the absolute
    /// axes.
    pub aligned: bool,
    /// The link's angular acceleration about z in the reference motion.
    pub reference: ReferenceTurn,
    /// True if the link's moment in the reference motion is written with J instead of Σ.
    pub by_inertia: bool,
    /// The order of the axes along which the bodies that the link carries are moved to its origin.
    pub order: [usize; 3],
    /// The child that keeps a component of the first moment of this link in the reference motion (`regrouping`), and
    /// the index of the component.
    pub keep: Option<(usize, usize)>,
    /// True if the pass inwards multiplies U by u/D; otherwise it multiplies G = U/D by u.
    pub scales_bias: bool,
    /// True if the pass outwards uses G; otherwise it uses U and then 1/D.
    pub scales_rate: bool,
}

impl LinkChoice {
    /// The whole choice as numbers: equal numbers mean equal choices.
    pub fn words(&self) -> [u64; 3] {
        let keep = self
            .keep
            .map_or(0, |(child, axis)| 1 + 4 * child as u64 + axis as u64);
        [
            self.turn.to_bits(),
            self.place.to_bits(),
            (keep << 16) + self.flags(),
        ]
    }

    /// The part of the choice that does not change the frame or the body for the reference motion, as a number.
    pub fn flags(&self) -> u64 {
        let flags = [
            self.aligned,
            self.by_inertia,
            self.scales_bias,
            self.scales_rate,
        ];
        let flags = flags.iter().fold(self.reference as u64, |word, flag| {
            2 * word + u64::from(*flag)
        });
        self.order
            .iter()
            .fold(flags, |word, axis| 4 * word + *axis as u64)
    }
}

/// The choice of α⁰_z of a link, its angular acceleration about z in the reference motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReferenceTurn {
    /// 0
    Zero,
    /// Its value for q̈ = 0, i.e. that of the carrier
    Rest,
    /// ω_x ω_y, so that Γ_xy is 0
    Product,
    /// −ω_x ω_y, so that Γ_yx is 0
    NegativeProduct,
}

impl Choice {
    /// The choice before any search.
    pub fn plain(links: usize) -> Self {
        let link = LinkChoice {
            turn: 0.0,
            place: 0.0,
            aligned: false,
            reference: ReferenceTurn::Zero,
            by_inertia: false,
            order: [0, 1, 2],
            keep: None,
            scales_bias: true,
            scales_rate: true,
        };
        Choice {
            links: vec![link; links],
            base: [0.0; 3],
            unit: 1.0,
        }
    }
}

/// A tree in the frames of its links.
pub struct Framed<'g> {
    /// Each link in its frame.
    pub links: Vec<FramedLink<'g>>,
    /// The constants from which each link was made.
    pub made_of: Vec<MadeOf<'g>>,
}

/// The numbers of a link in its frame, before the rotations of aligned links.
pub struct MadeOf<'g> {
    /// The constant properties.
    pub constant: Constant<'g>,
    /// The body for the reference motion.
    pub in_reference: Body<'g>,
    /// The constant part of the joint's angle \[rad\], including that of aligned parents: a number of right angles, and
    /// the remainder.
    pub offset: (u8, f64),
}

/// True if a link can be aligned, i.e. can keep the axes of the inboard side of its joint: a hinge whose children all
/// turn about its axis, or a ball whose children are all on balls.
pub fn can_align(tree: &Tree<'_>, natural: &[(Matrix, f64)], k: usize) -> bool {
    let mut children = tree
        .links
        .iter()
        .enumerate()
        .filter(|(_, l)| l.parent == Some(k));
    match &tree.links[k].joint {
        LinkJoint::Ball { .. } => {
            !(k == 0 && tree.free) && children.all(|(_, child)| child.joint.is_ball())
        }
        LinkJoint::Axis { turn, .. } => {
            *turn != 0.0
                && children.all(|(c, child)| {
                    let parallel = column(&natural[k].0, 2) == column(&natural[c].0, 2);
                    !child.joint.is_ball() && parallel
                })
        }
    }
}

/// One link in its frame. Lengths are in the unit of the choice.
pub struct FramedLink<'g> {
    /// The rotations from its axes to the parent's, in order.
    pub turns: Vec<Turn<'g>>,
    /// Its origin from the parent's origin, in the parent's axes.
    pub place: Vec3<'g>,
    /// Its body after regrouping.
    pub body: Body<'g>,
    /// The body for the reference motion: `body`, or `body` after a part of it is moved to or from another link
    /// (`regrouping`).
    pub in_reference: Body<'g>,
    /// True if the link is aligned: it keeps the axes of the inboard side of its joint.
    pub aligned: bool,
    /// The sign of z relative to the axis of the joint in the model.
    pub sign: f64,
    /// The rotation from its axes to absolute axes.
    pub axes: Mat3<'g>,
    /// The origin of the frame from that of the element, in the link's axes.
    pub origin: Vec3<'g>,
    /// R, the constant part of the rotation from the link's axes to the parent's.
    pub against: [[f64; 3]; 3],
}

/// The size below which an entry of a rotation counts as rounding.
const ROUNDING: f64 = 4e-15;

/// The axes of each link before the rotation about z is chosen, as columns, and the sign of z relative to the joint's
/// axis.
pub fn natural_axes(tree: &Tree<'_>) -> Vec<(Matrix, f64)> {
    let mut found: Vec<(Matrix, f64)> = Vec::new();
    for link in &tree.links {
        let LinkJoint::Axis { axis, .. } = &link.joint else {
            found.push((IDENTITY, 1.0));
            continue;
        };
        let carrier = link.parent.map_or(IDENTITY, |p| found[p].0);
        let is_along = |sign: f64| {
            let along = column(&carrier, 2);
            (0..3).all(|i| (axis[i] - sign * along[i]).abs() < ROUNDING)
        };
        // if the axis is opposite to z of the carrier, it is reversed
        let sign = if is_along(-1.0) { -1.0 } else { 1.0 };
        let parallel = is_along(sign);
        let axis = axis.map(|a| sign * a);
        let axes = match parallel {
            true => carrier,
            false => {
                // x is along an axis of the carrier that is perpendicular to the joint's axis, if there is one,
                // otherwise along any perpendicular direction
                let square = (0..3)
                    .map(|i| column(&carrier, i))
                    .find(|c| dot(*c, axis).abs() < ROUNDING);
                let x = square.unwrap_or_else(|| {
                    let smallest = (0..3).min_by(|&i, &j| axis[i].abs().total_cmp(&axis[j].abs()));
                    let mut unit = [0.0; 3];
                    unit[smallest.unwrap_or(0)] = 1.0;
                    cross(axis, unit)
                });
                // exactly perpendicular, and of length 1
                let along = dot(x, axis);
                let x = [0, 1, 2].map(|i| x[i] - along * axis[i]);
                let length = dot(x, x).sqrt();
                let x = x.map(|a| a / length);
                let y = cross(axis, x);
                transpose(&[x, y, axis])
            }
        };
        found.push((axes, sign));
    }
    found
}

impl<'g> Framed<'g> {
    /// The tree in the frames of a choice.
    pub fn of(tree: &Tree<'g>, natural: &[(Matrix, f64)], choice: &Choice) -> Self {
        Self::with(tree, natural, choice, Purpose::Equations)
    }

    /// The same for a trial, in which only operations are counted.
    pub fn in_trial(tree: &Tree<'g>, natural: &[(Matrix, f64)], choice: &Choice) -> Self {
        let axes = tree.needs_axes();
        Self::with(tree, natural, choice, Purpose::Trial { axes })
    }

    fn with(tree: &Tree<'g>, natural: &[(Matrix, f64)], choice: &Choice, purpose: Purpose) -> Self {
        let axes = (natural.iter().zip(&choice.links))
            .map(|((axes, _), link)| turned_axes(axes, link.turn))
            .collect();
        let mut framing = Framing {
            tree,
            natural,
            choice,
            purpose,
            axes,
            links: Vec::new(),
            constants: Vec::new(),
            aligning: Vec::new(),
            angles: Vec::new(),
            turned: Vec::new(),
        };
        for k in 0..tree.links.len() {
            framing.add(k);
        }
        let mut links = framing.links;
        let mut in_reference: Vec<Body<'g>> = framing.constants.iter().map(|c| c.body).collect();
        if choice.links.iter().any(|link| link.keep.is_some()) {
            in_reference = kept(tree, choice, &framing.constants);
            for ((link, body), turns) in links.iter_mut().zip(&in_reference).zip(&framing.aligning)
            {
                link.in_reference = body.turned(turns);
            }
        }
        let offsets = framing
            .angles
            .iter()
            .map(|(_, offset)| right_angles(*offset));
        let made_of = (framing.constants.into_iter().zip(in_reference).zip(offsets))
            .map(|((constant, in_reference), offset)| MadeOf {
                constant,
                in_reference,
                offset,
            })
            .collect();
        Framed { links, made_of }
    }
}

/// The purpose of the frames.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Purpose {
    /// The equations themselves.
    Equations,
    /// A count of operations: numbers are computed without a graph.
    Trial {
        /// True if any quantity is in absolute axes.
        axes: bool,
    },
}

/// Brings the links into their frames, from the root to the leaves.
struct Framing<'a, 'g> {
    tree: &'a Tree<'g>,
    natural: &'a [(Matrix, f64)],
    choice: &'a Choice,
    purpose: Purpose,
    /// The axes of each frame, as columns.
    axes: Vec<Matrix>,
    links: Vec<FramedLink<'g>>,
    constants: Vec<Constant<'g>>,
    /// For each link, the rotations by which aligned frames turn its body.
    aligning: Vec<Vec<Turn<'g>>>,
    /// For each link, the angle of its joint including those of aligned parents: variable and constant part.
    angles: Vec<(Expr<'g>, f64)>,
    /// By link, in the plane: the angle of the link and the angle of its axes in the absolute frame.
    turned: Vec<[Expr<'g>; 2]>,
}

/// The position and rotation of a link relative to its parent.
struct Placed<'g> {
    /// The rotations from its axes to the parent's, in order.
    turns: Vec<Turn<'g>>,
    /// Its origin from the parent's, in the parent's axes.
    place: Vec3<'g>,
    /// The angle of the joint about z, including those of aligned parents: variable and constant part.
    angle: (Expr<'g>, f64),
    /// In the plane: the angle of the link in the absolute frame.
    own_turned: Expr<'g>,
}

impl<'g> Framing<'_, 'g> {
    fn is_aligned(&self, k: usize) -> bool {
        self.choice.links[k].aligned
    }

    /// The axes of the carrier of a link, in absolute axes.
    fn carrier_axes(&self, k: usize) -> Mat3<'g> {
        let parent = self.tree.links[k].parent;
        parent.map_or(self.tree.ground.axes, |p| self.links[p].axes)
    }

    /// Brings link `k` into its frame; its parent must be in its frame already.
    fn add(&mut self, k: usize) {
        let (graph, link) = (self.tree.graph, &self.tree.links[k]);
        let constant = self.constant(k);
        let axes_turned = match link.parent {
            Some(p) => self.turned[p][1],
            None => self.tree.ground.angle,
        };
        let Placed {
            turns,
            place,
            angle,
            own_turned,
        } = match &link.joint {
            LinkJoint::Ball { .. } => self.on_ball(k, &constant),
            LinkJoint::Axis {
                turn,
                position,
                axis,
                absolute,
                ..
            } => self.on_axis(k, &constant, (*turn, *axis), *position, *absolute),
        };
        self.angles.push(angle);
        let is_aligned = self.is_aligned(k);
        self.turned.push(match is_aligned {
            true => [own_turned, axes_turned],
            false => [own_turned; 2],
        });
        let mut own_turns = Vec::new();
        if is_aligned {
            match &link.joint {
                LinkJoint::Ball { .. } => own_turns.push(Turn::Matrix(link.rotation)),
                LinkJoint::Axis { .. } => push_about(graph, &mut own_turns, 2, angle.0, angle.1),
            }
        }
        let body = constant.body.turned(&own_turns);
        let axes = match self.purpose {
            Purpose::Trial { axes: false } => link.rotation,
            _ => self.absolute_axes(k, &turns),
        };
        self.links.push(FramedLink {
            turns,
            place,
            body,
            in_reference: body,
            aligned: is_aligned,
            sign: self.natural[k].1,
            axes,
            origin: match &link.joint {
                LinkJoint::Ball { .. } => Vec3::zero(graph),
                LinkJoint::Axis { .. } => {
                    let along = self.choice.links[k].place / self.choice.unit;
                    Vec3([0.0, 0.0, along].map(|a| graph.constant(a)))
                }
            },
            against: constant.against,
        });
        self.aligning.push(own_turns);
        self.constants.push(constant);
    }

    /// The constants of a link, which do not depend on the coordinates: its body, its place on the parent and its
    /// constant rotation.
    fn constant(&self, k: usize) -> Constant<'g> {
        let carrier = self.tree.links[k].parent.map_or(IDENTITY, |p| self.axes[p]);
        let against = snapped(&product(&transpose(&carrier), &self.axes[k]));
        let in_numbers = match self.purpose {
            Purpose::Equations => None,
            Purpose::Trial { .. } => self.constant_in_numbers(k, &carrier),
        };
        let (body, place) = in_numbers.unwrap_or_else(|| self.constant_in_nodes(k, &carrier));
        Constant {
            body,
            place,
            against,
        }
    }

    /// The body of a link and its place on the parent, as nodes; `carrier` are the parent's axes.
    fn constant_in_nodes(&self, k: usize, carrier: &Matrix) -> (Body<'g>, Vec3<'g>) {
        let (tree, unit) = (self.tree, self.choice.unit);
        let (graph, link) = (tree.graph, &tree.links[k]);
        let origin = |k: usize| {
            Vec3(origin_of(tree, self.natural, self.choice, k).map(|a| graph.constant(a)))
        };
        let shift = link.parent.map_or(Vec3::zero(graph), origin);
        let place = link.place + origin(k) - shift;
        let place = in_axes(&transpose(carrier), place);
        let place = cleaned((1.0 / unit) * place);
        let body = link.body.moved(-origin(k));
        let mut body = body.in_axes(&transpose(&self.axes[k]));
        if !(k == 0 && tree.free) {
            body = body.regrouped(&link.joint);
        }
        let body = Body {
            mass: (unit * unit) * body.mass,
            first: unit * body.first,
            second: body.second,
            sizes: [unit * body.sizes[0], body.sizes[1]],
        };
        (body, place)
    }

    /// The same by the same operations on numbers, without a node for each step; `None` if an entry is not a number.
    fn constant_in_numbers(&self, k: usize, carrier: &Matrix) -> Option<(Body<'g>, Vec3<'g>)> {
        let (tree, unit) = (self.tree, self.choice.unit);
        let (graph, link) = (tree.graph, &tree.links[k]);
        let origin = |k: usize| origin_of(tree, self.natural, self.choice, k);
        let own = origin(k);
        let shift = link.parent.map_or([0.0; 3], origin);
        let place = numbers(link.place)?;
        let place = [0, 1, 2].map(|i| place[i] + own[i] - shift[i]);
        let place = transpose(carrier).map(|row| dot(row, place));
        let place = cleaned_numbers(place.map(|r| (1.0 / unit) * r));
        let body = Numbers::of(&link.body)?.moved(own.map(|a| -a));
        let mut body = body.in_axes(&transpose(&self.axes[k]));
        if !(k == 0 && tree.free) {
            body = body.regrouped(link.joint.is_hinge());
        }
        let body = body.in_unit(unit).body(graph);
        Some((body, Vec3(place.map(|r| graph.constant(r)))))
    }

    /// The place of a link on a ball.
    fn on_ball(&self, k: usize, constant: &Constant<'g>) -> Placed<'g> {
        let (tree, link) = (self.tree, &self.tree.links[k]);
        let own = match self.is_aligned(k) {
            true => constant_matrix(tree.graph, &IDENTITY),
            false => link.rotation,
        };
        let mut place = constant.place;
        if let Some(p) = link.parent.filter(|&p| self.is_aligned(p)) {
            place = tree.links[p].rotation.times(place);
        }
        let between = self.carrier_axes(k).transposed().product(&own);
        let mut turns = Vec::new();
        if !is_identity(&between) {
            turns.push(Turn::Matrix(between));
        }
        Placed {
            turns,
            place,
            angle: (tree.graph.constant(0.0), 0.0),
            own_turned: link.parent.map_or(tree.ground.angle, |p| self.turned[p][0]),
        }
    }

    /// The place of a link on an axis, with the coordinate of its joint.
    fn on_axis(
        &self,
        k: usize,
        constant: &Constant<'g>,
        (turn, axis): (f64, [f64; 3]),
        position: Expr<'g>,
        absolute: bool,
    ) -> Placed<'g> {
        let (graph, link) = (self.tree.graph, &self.tree.links[k]);
        let [carrier_turned, axes_turned] = match link.parent {
            Some(p) => self.turned[p],
            None => [self.tree.ground.angle; 2],
        };
        let sign = self.natural[k].1;
        let (mut angle, mut own_turned) = (graph.constant(0.0), carrier_turned);
        let [outer, tilt, inner] = z_x_z(&constant.against);
        if turn != 0.0 {
            angle = sign * position;
            own_turned = carrier_turned + (turn * axis[1]) * position;
        }
        if absolute {
            angle = sign * (position - axes_turned);
            own_turned = position;
        }
        let (mut place, mut offset) = (constant.place, inner);
        let on_aligned = link.parent.filter(|&p| self.is_aligned(p));
        if let Some(p) = on_aligned {
            place = turned_about_z(place, self.angles[p]);
            if !absolute {
                angle = angle + self.angles[p].0;
            }
            offset += self.angles[p].1 + outer;
        }
        let mut turns = Vec::new();
        // the angle of an aligned link turns the links that it carries instead
        if !self.is_aligned(k) {
            push_about(graph, &mut turns, 2, angle, offset);
        }
        if on_aligned.is_none() {
            push_constant(graph, &mut turns, 0, tilt);
            push_constant(graph, &mut turns, 2, outer);
        }
        Placed {
            turns,
            place,
            angle: (angle, offset),
            own_turned,
        }
    }

    /// The rotation from the axes of a link to absolute axes; `turns` are the rotations to the parent's axes.
    fn absolute_axes(&self, k: usize, turns: &[Turn<'g>]) -> Mat3<'g> {
        let (graph, link) = (self.tree.graph, &self.tree.links[k]);
        // in a joint of several freedoms, the last link has the axes of the element
        let mut carried = self.tree.links.iter().filter(|l| l.parent == Some(k));
        let inside = carried.any(|carried| carried.element == link.element);
        match (&link.joint, self.is_aligned(k) || inside) {
            (LinkJoint::Ball { .. }, _) if self.is_aligned(k) => constant_matrix(graph, &IDENTITY),
            (LinkJoint::Ball { .. }, _) => link.rotation,
            (LinkJoint::Axis { .. }, false) => {
                let axes = constant_matrix(graph, &self.axes[k]);
                link.rotation.product(&axes)
            }
            (LinkJoint::Axis { .. }, true) => {
                let turns = turns.iter().rev();
                // the columns of the carrier's axes, turned by the constant part
                let rows = self.carrier_axes(k).0.map(|row| {
                    turns
                        .clone()
                        .fold(Vec3(row), |v, turn| turn.inverse().vector(v))
                        .0
                });
                Mat3(rows)
            }
        }
    }
}

fn constant_matrix<'g>(graph: &'g Graph, m: &Matrix) -> Mat3<'g> {
    Mat3(m.map(|row| row.map(|a| graph.constant(a))))
}

/// The axes of a link's frame after its turn about z.
pub fn turned_axes(natural: &Matrix, turn: f64) -> Matrix {
    product(natural, &about_z(turn))
}

/// The origin of a link's frame from that of its element, in the element's axes \[m\].
pub fn origin_of(
    tree: &Tree<'_>,
    natural: &[(Matrix, f64)],
    choice: &Choice,
    k: usize,
) -> [f64; 3] {
    match &tree.links[k].joint {
        LinkJoint::Axis { .. } => column(&natural[k].0, 2).map(|a| choice.links[k].place * a),
        LinkJoint::Ball { .. } if k == 0 && tree.free => choice.base,
        LinkJoint::Ball { .. } => [0.0; 3],
    }
}

fn turned_about_z<'g>(v: Vec3<'g>, (angle, offset): (Expr<'g>, f64)) -> Vec3<'g> {
    let mut turns = Vec::new();
    push_about(angle.graph(), &mut turns, 2, angle, offset);
    super::turn::through(&turns, v)
}

/// Adds a rotation by the sum of a variable and a constant angle. Right angles are split off, because they need no
/// operations.
fn push_about<'g>(
    graph: &'g Graph,
    turns: &mut Vec<Turn<'g>>,
    axis: usize,
    angle: Expr<'g>,
    offset: f64,
) {
    let (quarters, rest) = right_angles(offset);
    if angle.is_zero() {
        return push_constant(graph, turns, axis, offset);
    }
    let angle = angle + graph.constant(rest);
    if !angle.is_zero() {
        turns.push(Turn::About {
            axis,
            sine: angle.sin(),
            cosine: angle.cos(),
        });
    }
    if quarters > 0 {
        turns.push(Turn::Quarters(axis, quarters));
    }
}

fn push_constant<'g>(graph: &'g Graph, turns: &mut Vec<Turn<'g>>, axis: usize, angle: f64) {
    let (quarters, rest) = right_angles(angle);
    if rest != 0.0 {
        turns.push(Turn::About {
            axis,
            sine: graph.constant(libm::sin(rest)),
            cosine: graph.constant(libm::cos(rest)),
        });
    }
    if quarters > 0 {
        turns.push(Turn::Quarters(axis, quarters));
    }
}

/// The number of right angles in an angle, modulo 4, and the remainder, which is set to 0 if it is only rounding.
fn right_angles(angle: f64) -> (u8, f64) {
    let quarter = std::f64::consts::FRAC_PI_2;
    let quarters = (angle / quarter).round();
    let rest = angle - quarters * quarter;
    let rest = if rest.abs() < 1e-14 { 0.0 } else { rest };
    (quarters.rem_euclid(4.0) as u8, rest)
}

/// The angles outer, tilt and inner of a rotation R = Rz(outer) Rx(tilt) Rz(inner).
fn z_x_z(r: &Matrix) -> [f64; 3] {
    let across = (r[0][2] * r[0][2] + r[1][2] * r[1][2]).sqrt();
    if across < 1e-14 {
        // a rotation about z alone, or a rotation about z followed by half a turn about x
        return match r[2][2] > 0.0 {
            true => [0.0, 0.0, libm::atan2(r[1][0], r[0][0])],
            false => [0.0, std::f64::consts::PI, -libm::atan2(r[1][0], r[0][0])],
        };
    }
    let (outer, tilt) = (libm::atan2(r[0][2], -r[1][2]), libm::atan2(across, r[2][2]));
    // a small tilt leaves `outer` uncertain by ε/tilt; `inner` is the rest of the rotation, so that both together are
    // exact
    let (so, co) = (libm::sin(outer), libm::cos(outer));
    let (st, ct) = (libm::sin(tilt), libm::cos(tilt));
    let left = |j: usize| {
        let (x, y) = (co * r[0][j] + so * r[1][j], co * r[1][j] - so * r[0][j]);
        (x, ct * y + st * r[2][j])
    };
    let (cosine, sine) = left(0);
    [outer, tilt, libm::atan2(sine, cosine)]
}

fn is_identity(m: &Mat3<'_>) -> bool {
    let entries = m.0.iter().enumerate();
    entries.into_iter().all(|(i, row)| {
        row.iter().enumerate().all(|(j, e)| match i == j {
            true => e.is_one(),
            false => e.is_zero(),
        })
    })
}

/// A rotation matrix in which entries that differ from an integer only by rounding are set to that integer.
fn snapped(r: &Matrix) -> Matrix {
    r.map(|row| {
        row.map(|a| match a.round() {
            nearest if (a - nearest).abs() < ROUNDING => nearest,
            _ => a,
        })
    })
}

fn about_z(angle: f64) -> Matrix {
    let (quarters, rest) = right_angles(angle);
    let (s, c) = (libm::sin(rest), libm::cos(rest));
    let (s, c) = match quarters {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    };
    [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]
}

fn column(m: &Matrix, j: usize) -> [f64; 3] {
    m.map(|row| row[j])
}
