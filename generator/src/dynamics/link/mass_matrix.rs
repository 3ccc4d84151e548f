//! S in the frames of links, by the composite-body algorithm.   \[Featherstone 2008, ch. 6\]
//!
//! The composite body of a link consists of the link and all links that turn with it, with m, h and Σ about the link's
//! origin. Regrouped bodies mostly have m = 0. The wrench that the composite body needs for v̇ = 1 of the link's joint,
//!
//! f = s m z + t z × h,   n = s h × z + t J z   with   J z = (−Σ_xz, −Σ_yz, Σ_xx + Σ_yy)
//!
//! is passed from link to link towards the root. Its power per velocity is an entry of S.

use super::body::Body;
use super::tree::{Carried, LinkJoint};
use super::wrench::{Arrived, Written};
use crate::dynamics::augmented_body::rotated;
use crate::dynamics::spatial::Wrench;
use crate::expression::Expr;
use crate::expression::vector::Vec3;

/// The entries of S found so far.
pub struct Entries<'g> {
    /// Terms of the upper or the lower triangle: row, column, value. Terms with the same place must be added.
    pub terms: Vec<(usize, usize, Expr<'g>)>,
    /// The wrenches that a part of a tree passes on to the rest.
    pub passed: Vec<Wrench<'g>>,
}

/// The composite body of every link, in its axes about its origin.
pub fn composites<'g>(written: &Written<'g, '_>) -> Vec<Body<'g>> {
    let links = &written.tree.links;
    let mut bodies: Vec<Body<'g>> = written.framed.links.iter().map(|l| l.body).collect();
    for k in (0..links.len()).rev() {
        if let Some(Carried::Composite { body, .. }) = &links[k].carries {
            bodies[k] = bodies[k].plus(body);
        }
        if let Some(parent) = links[k].parent {
            let carried = written.body_on_parent(k, bodies[k]);
            bodies[parent] = bodies[parent].plus(&carried);
        }
    }
    bodies
}

/// S of the system.
pub fn mass_matrix<'g>(
    written: &Written<'g, '_>,
    composites: &[Body<'g>],
    name: &dyn Fn(usize) -> String,
) -> Entries<'g> {
    let (tree, graph) = (written.tree, written.tree.graph);
    let mut entries = Entries {
        terms: Vec::new(),
        passed: Vec::new(),
    };
    if let Some(base) = tree.base {
        let unit = written.choice.unit;
        let mass = (1.0 / (unit * unit)) * composites[0].mass;
        let rows = base..base + tree.directions.len();
        let diagonal = rows.map(|i| (i, i, mass));
        entries.terms.extend(diagonal);
    }
    for (k, link) in tree.links.iter().enumerate() {
        graph.section(format!("S[·, {}]", name(k)));
        if let Some(Carried::Composite { columns, .. }) = &link.carries {
            for column in columns {
                let wrench = written.settled(k, Arrived::InLink(*column));
                let beyond = Column {
                    row: usize::MAX,
                    share: graph.constant(1.0),
                };
                entries.take(written, &beyond, k, &wrench);
                entries.inwards(written, &beyond, k, wrench);
            }
        }
        if k == 0 && tree.carrier.is_some() {
            continue;
        }
        match link.joint {
            LinkJoint::Ball { .. } => entries.ball(written, k, &composites[k]),
            LinkJoint::Axis { armature, .. } => {
                let wrench = needed(written, k, &composites[k]);
                let column = Column {
                    row: link.row,
                    share: written.share(k),
                };
                for (row, power) in written.powers(k, &wrench) {
                    let own = column.share * power + column.share.squared() * armature;
                    entries.terms.push((row, row, own));
                }
                entries.inwards(written, &column, k, wrench);
            }
        }
    }
    entries
}

/// The wrench that the composite body of an axis needs for v̇ = 1 about z of the link.
fn needed<'g>(written: &Written<'g, '_>, k: usize, body: &Body<'g>) -> Wrench<'g> {
    let LinkJoint::Axis { turn, slide, .. } = written.tree.links[k].joint else {
        unreachable!("only an axis has one column")
    };
    let graph = written.tree.graph;
    let (zero, turn) = (graph.constant(0.0), graph.constant(turn));
    let slide = (1.0 / written.choice.unit) * slide;
    let [x, y, _] = body.first.0;
    let second = |i: usize, j: usize| body.second.entry(i, j);
    let turning = Vec3([-second(0, 2), -second(1, 2), second(0, 0) + second(1, 1)]);
    Wrench {
        force: turn * Vec3([-y, x, zero]) + slide * Vec3([zero, zero, body.mass]),
        moment: turn * turning + slide * Vec3([y, -x, zero]),
    }
}

/// A velocity for which wrenches are computed.
struct Column<'g> {
    /// Index in v.
    row: usize,
    /// The share that the joint has in this velocity; the wrenches are those for a unit rate of the joint itself.
    share: Expr<'g>,
}

impl<'g> Entries<'g> {
    /// Adds the columns of a ball.
    fn ball(&mut self, written: &Written<'g, '_>, k: usize, body: &Body<'g>) {
        let (link, frame) = (&written.tree.links[k], &written.framed.links[k]);
        let LinkJoint::Ball { columns, .. } = &link.joint else {
            unreachable!("only a ball has three columns")
        };
        let first = frame.axes.times(body.first);
        let inertia = match frame.aligned {
            true => body.inertia(),
            false => rotated(written.tree.graph, &frame.axes, &body.inertia()),
        };
        for j in 0..3 {
            let axis = columns.column(j);
            let wrench = Wrench {
                force: axis.cross(first),
                moment: inertia.times(axis),
            };
            let column = Column {
                row: link.row + j,
                share: written.tree.graph.constant(1.0),
            };
            for (row, power) in written.powers(k, &wrench).into_iter().take(j + 1) {
                self.terms.push((row, column.row, power));
            }
            self.inwards(written, &column, k, wrench);
        }
    }

    /// Adds the power of a wrench per velocity of a link.
    fn take(
        &mut self,
        written: &Written<'g, '_>,
        column: &Column<'g>,
        k: usize,
        wrench: &Wrench<'g>,
    ) {
        for (row, power) in written.powers(k, wrench) {
            let power = column.share * power;
            // on the diagonal, the cross term of two links counts twice
            let together = if row == column.row {
                2.0 * power
            } else {
                power
            };
            self.terms.push((row, column.row, together));
        }
    }

    /// Passes the wrench on link `k` to all links that carry it, and adds its powers.
    fn inwards(
        &mut self,
        written: &Written<'g, '_>,
        column: &Column<'g>,
        k: usize,
        mut wrench: Wrench<'g>,
    ) {
        let mut link = k;
        while let Some(parent) = written.tree.links[link].parent {
            let arrived = written.on_parent(link, parent, wrench);
            if parent == 0 && written.tree.carrier.is_some() {
                self.passed.push(arrived.as_it_is());
                return;
            }
            wrench = written.settled(parent, arrived);
            self.take(written, column, parent, &wrench);
            link = parent;
        }
        for (row, force) in written.on_base(&wrench) {
            self.terms.push((row, column.row, column.share * force));
        }
    }
}
