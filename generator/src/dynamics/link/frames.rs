//! The frames of links, and the constants of the system in these frames.
//!
//! The frame of a link is fixed to the link, with its origin on the axis of its joint and z along this axis. Two choices remain: the rotation about z
//! and the place of the origin along z. The frame of a ball is that of its element, or the absolute frame.
//!
//! Bodies are regrouped, so of the bodies on a hinge only h_x, h_y and five entries of Σ are left.

use super::body::{Body, cleaned, in_axes};
use super::keep::{Constant, kept};
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
    /// Angle of its frame about z \[rad\].
    pub turn: f64,
    /// Place of its origin along z \[m\].
    pub place: f64,
    /// Whether it keeps the axes of the inboard side of its joint; for a ball, the absolute axes.
    pub aligned: bool,
    /// Its angular acceleration about z in the reference motion.
    pub reference: ReferenceTurn,
    /// Whether its moment in the reference motion is written with J instead of Σ.
    pub by_inertia: bool,
    /// The order of the axes along which the bodies that it carries are moved to its origin.
    pub order: [usize; 3],
    /// The child that keeps a component of the first moment of this link in the reference motion, and the component.
    pub keep: Option<(usize, usize)>,
    /// Whether the pass inwards multiplies U by u/D; otherwise it multiplies G by u.
    pub scales_bias: bool,
    /// Whether the pass outwards uses G; otherwise U and then 1/D.
    pub scales_rate: bool,
}

/// The choice of α⁰_z of a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReferenceTurn {
    /// 0
    Zero,
    /// Its value for q̈ = 0
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
}

/// Whether a link can keep the axes of the inboard side of its joint: it is a hinge whose children all turn about its axis, or a ball whose children
/// are all on balls.
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
    /// The body for the reference motion: the same, or with [a part of it moved elsewhere](super::keep).
    pub in_reference: Body<'g>,
    /// Whether it keeps the axes of the inboard side of its joint.
    pub aligned: bool,
    /// The sign of its axis relative to the axis of the model.
    pub sign: f64,
    /// The rotation from its axes to absolute axes.
    pub axes: Mat3<'g>,
    /// Its origin from that of its element, in its axes.
    pub origin: Vec3<'g>,
    /// R, the constant part of its rotation relative to the parent.
    pub against: [[f64; 3]; 3],
}

/// The size below which an entry of a rotation counts as rounding.
const ROUNDING: f64 = 4e-15;

/// The axes of each link before the choice of the rotation about z, as columns, and the sign of the joint's axis.
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
        // if two axes point in opposite directions, one is reversed
        let sign = if is_along(-1.0) { -1.0 } else { 1.0 };
        let parallel = is_along(sign);
        let axis = axis.map(|a| sign * a);
        let axes = match parallel {
            true => carrier,
            false => {
                // x is along an axis of the carrier that is perpendicular to the joint's axis, if there is one, otherwise along any perpendicular
                // direction
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
        let graph = tree.graph;
        let axes: Vec<Matrix> = (natural.iter().zip(&choice.links))
            .map(|((axes, _), link)| turned_axes(axes, link.turn))
            .collect();
        let aligned: Vec<bool> = choice.links.iter().map(|link| link.aligned).collect();
        let origin =
            |k: usize| Vec3(origin_of(tree, natural, choice, k).map(|a| graph.constant(a)));
        let mut links: Vec<FramedLink<'g>> = Vec::new();
        let mut constants: Vec<Constant<'g>> = Vec::new();
        // for each link, the rotations of links that keep the axes of the inboard side
        let mut aligning: Vec<Vec<Turn<'g>>> = Vec::new();
        // for each aligned link, the sum of the angles, variable and constant
        let mut angles: Vec<(Expr<'g>, f64)> = Vec::new();
        // by link, in the plane: the angles that it and its axes have in the absolute frame
        let mut turned: Vec<[Expr<'g>; 2]> = Vec::new();
        for (k, link) in tree.links.iter().enumerate() {
            let constant = |m: &Matrix| m.map(|row| row.map(|a| graph.constant(a)));
            let carrier = link.parent.map_or(IDENTITY, |p| axes[p]);
            let r = snapped(&product(&transpose(&carrier), &axes[k]));
            let shift = link.parent.map_or(Vec3::zero(graph), origin);
            let place = link.place + origin(k) - shift;
            let place = in_axes(&transpose(&carrier), place);
            let mut place = cleaned((1.0 / choice.unit) * place);
            let mut body = link.body.moved(-origin(k)).in_axes(&transpose(&axes[k]));
            if !(k == 0 && tree.free) {
                body = body.felt(&link.joint);
            }
            let body = Body {
                mass: (choice.unit * choice.unit) * body.mass,
                first: choice.unit * body.first,
                second: body.second,
                sizes: [choice.unit * body.sizes[0], body.sizes[1]],
            };
            constants.push(Constant {
                body,
                place,
                against: r,
            });
            let mut turns = Vec::new();
            let mut own_turns = Vec::new();
            let (mut angle, mut offset) = (graph.constant(0.0), 0.0);
            let [carrier_turned, axes_turned] = match link.parent {
                Some(p) => turned[p],
                None => [tree.ground.angle; 2],
            };
            let mut own_turned = carrier_turned;
            match &link.joint {
                LinkJoint::Ball { .. } => {
                    let own = match aligned[k] {
                        true => Mat3(constant(&IDENTITY)),
                        false => link.rotation,
                    };
                    if let Some(p) = link.parent.filter(|&p| aligned[p]) {
                        place = tree.links[p].rotation.times(place);
                    }
                    let carrier = link.parent.map_or(tree.ground.axes, |p| links[p].axes);
                    let between = carrier.transposed().product(&own);
                    if !is_identity(&between) {
                        turns.push(Turn::Matrix(between));
                    }
                }
                LinkJoint::Axis {
                    turn,
                    position,
                    axis,
                    absolute,
                    ..
                } => {
                    let sign = natural[k].1;
                    let [outer, tilt, inner] = z_x_z(&r);
                    if *turn != 0.0 {
                        angle = sign * *position;
                        own_turned = carrier_turned + (turn * axis[1]) * *position;
                    }
                    if *absolute {
                        angle = sign * (*position - axes_turned);
                        own_turned = *position;
                    }
                    offset = inner;
                    let on_aligned = link.parent.filter(|&p| aligned[p]);
                    if let Some(p) = on_aligned {
                        place = turned_about_z(place, angles[p]);
                        if !absolute {
                            angle = angle + angles[p].0;
                        }
                        offset += angles[p].1 + outer;
                    }
                    // for aligned links, the angle turns the links that they carry
                    if !aligned[k] {
                        push_about(graph, &mut turns, 2, angle, offset);
                    }
                    if on_aligned.is_none() {
                        push_constant(graph, &mut turns, 0, tilt);
                        push_constant(graph, &mut turns, 2, outer);
                    }
                }
            }
            angles.push((angle, offset));
            turned.push(match aligned[k] {
                true => [own_turned, axes_turned],
                false => [own_turned; 2],
            });
            if aligned[k] {
                match &link.joint {
                    LinkJoint::Ball { .. } => own_turns.push(Turn::Matrix(link.rotation)),
                    LinkJoint::Axis { .. } => push_about(graph, &mut own_turns, 2, angle, offset),
                }
            }
            let body = body.turned(&own_turns);
            // in a joint of several degrees of freedom, the last link has the axes of the element
            let mut carried = tree.links.iter().filter(|l| l.parent == Some(k));
            let inside = carried.any(|carried| carried.element == link.element);
            let axes = match (&link.joint, aligned[k] || inside) {
                (LinkJoint::Ball { .. }, _) if aligned[k] => Mat3(constant(&IDENTITY)),
                (LinkJoint::Ball { .. }, _) => link.rotation,
                (LinkJoint::Axis { .. }, false) => link.rotation.product(&Mat3(constant(&axes[k]))),
                (LinkJoint::Axis { .. }, true) => {
                    let carrier = link.parent.map_or(tree.ground.axes, |p| links[p].axes);
                    let turns = turns.iter().rev();
                    // the columns of the carrier's axes, turned by the constant part
                    let rows = carrier.0.map(|row| {
                        turns
                            .clone()
                            .fold(Vec3(row), |v, turn| turn.inverse().vector(v))
                            .0
                    });
                    Mat3(rows)
                }
            };
            links.push(FramedLink {
                turns,
                place,
                body,
                in_reference: body,
                aligned: aligned[k],
                sign: natural[k].1,
                axes,
                origin: match &link.joint {
                    LinkJoint::Ball { .. } => Vec3::zero(graph),
                    LinkJoint::Axis { .. } => {
                        let along = choice.links[k].place / choice.unit;
                        Vec3([0.0, 0.0, along].map(|a| graph.constant(a)))
                    }
                },
                against: r,
            });
            aligning.push(own_turns);
        }
        if choice.links.iter().any(|link| link.keep.is_some()) {
            let bodies = kept(tree, choice, &constants);
            for ((link, body), turns) in links.iter_mut().zip(bodies).zip(&aligning) {
                link.in_reference = body.turned(turns);
            }
        }
        Framed { links }
    }
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

/// Adds a rotation by a variable and a constant angle. Right angles are split off, because they cost nothing.
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

/// The number of right angles in an angle, 0 to 3, and the rest, which is 0 if it is only rounding.
fn right_angles(angle: f64) -> (u8, f64) {
    let quarter = std::f64::consts::FRAC_PI_2;
    let quarters = (angle / quarter).round();
    let rest = angle - quarters * quarter;
    let rest = if rest.abs() < 1e-14 { 0.0 } else { rest };
    (quarters.rem_euclid(4.0) as u8, rest)
}

/// R = Rz(outer) Rx(tilt) Rz(inner).
fn z_x_z(r: &Matrix) -> [f64; 3] {
    let across = (r[0][2] * r[0][2] + r[1][2] * r[1][2]).sqrt();
    if across < 1e-14 {
        // a rotation about z alone, or one after half a turn about x
        return match r[2][2] > 0.0 {
            true => [0.0, 0.0, libm::atan2(r[1][0], r[0][0])],
            false => [0.0, std::f64::consts::PI, -libm::atan2(r[1][0], r[0][0])],
        };
    }
    let (outer, tilt) = (libm::atan2(r[0][2], -r[1][2]), libm::atan2(across, r[2][2]));
    // a small tilt leaves `outer` uncertain by ε/tilt; `inner` is the rest of the rotation, so that both together are exact
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

/// A rotation without entries that are only rounding.
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
