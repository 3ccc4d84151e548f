//! D'Alembert's principle for given accelerations, body by body \[Newton–Euler\]. It gives the residual S v̇ − r of the
//! equations of motion, but needs neither S nor any part of the generator's derivation or solution.
//!
//! From the root to the leaves, with α = Σ e_j v̇_j + Σ ė_j v_j, and with the vectors u from a joint to the next and c
//! from a joint to the centre of gravity,
//!
//! a_c = a + α × u + ω × (ω × u),   F = m (a + α × c + ω × (ω × c) − g),   N = I α + ω × I ω + c × F
//!
//! From the leaves to the root, forces and moments outboard of each joint are added up: F += ΣF_c, N += Σ u_c × F_c. A
//! ball joint transmits no moment, so by virtual power the residual for v_j of an element is e_j · N, and that for a
//! free reference joint is F of the root. Loads are subtracted from F and N of the element on which they act. Each term
//! is a sum of products of body quantities, the effort is proportional to the number of elements, and there are no
//! divisions: in double-double the residual is correct to 30 digits of its largest term.

use bryant_generator::law::ForceKind;
use bryant_generator::model::{Body, ElementId, FieldComponent, Model, Number, Reference};
use bryant_generator::motion::Layout;
use bryant_generator::motion::ball::Orientation;
use bryant_runtime::Real;

use crate::bench::Trouble;

type Vector<S> = [S; 3];

/// A tree of elements with constant forces on it.
#[derive(Clone, Debug)]
pub struct Tree {
    layout: Layout,
    free: bool,
    elements: Vec<Element>,
}

/// An element, with the loads on it.
#[derive(Clone, Debug, Default)]
struct Element {
    parent: Option<usize>,
    at: Vector<f64>,
    mass: f64,
    cg: Vector<f64>,
    inertia: Vector<f64>,
    axes: Vector<f64>,
    field: Vector<f64>,
    loads: Vec<Load>,
}

/// A constant force at a point of the local frame, and a moment; both in absolute axes.
#[derive(Clone, Debug)]
struct Load {
    at: Vector<f64>,
    force: Vector<f64>,
    moment: Vector<f64>,
}

/// An element in its current orientation: all vectors in absolute axes.
struct Turned<S> {
    /// e_j, the axes of its velocities.
    axes: Vec<Vector<S>>,
    /// Principal axes of inertia.
    principal: [Vector<S>; 3],
    /// u: from the joint of its parent to its own joint.
    offset: Vector<S>,
    /// c: from its joint to its centre of gravity.
    center: Vector<S>,
    /// The points of the loads, from its joint.
    loaded: Vec<Vector<S>>,
}

/// The elements of a tree at given coordinates.
pub struct Posture<'t, S> {
    tree: &'t Tree,
    turned: Vec<Turned<S>>,
    /// True if the velocities are rates of Bryant angles, whose axes move.
    of_angles: bool,
}

impl Tree {
    /// The tree of a model that has only one system, no parameters, and only constant fields and loads as forces.
    ///
    /// # Errors
    /// The model is of another form.
    pub fn of(model: &Model) -> Result<Tree, Trouble> {
        let unfit = || Trouble::Case("only one system with constant fields and loads".to_owned());
        let [system] = &model.systems[..] else {
            return Err(unfit());
        };
        let number = |number: &Number| number.constant().ok_or_else(unfit);
        let vector = |v: &[Number; 3]| -> Result<Vector<f64>, Trouble> {
            Ok([number(&v[0])?, number(&v[1])?, number(&v[2])?])
        };
        let given = |v: &[FieldComponent; 3]| -> Result<Vector<f64>, Trouble> {
            let mut values = [0.0; 3];
            for (value, component) in values.iter_mut().zip(v) {
                let FieldComponent::Constant(component) = component else {
                    return Err(unfit());
                };
                *value = number(component)?;
            }
            Ok(values)
        };
        let mut elements = Vec::new();
        for element in &system.elements {
            elements.push(Element {
                parent: element.parent,
                at: vector(&element.at)?,
                mass: number(&element.mass)?,
                cg: vector(&element.cg)?,
                inertia: vector(&element.inertia)?,
                axes: vector(&element.axes)?,
                ..Element::default()
            });
        }
        for force in &model.forces {
            match ForceKind::of(force) {
                ForceKind::Field(law) => {
                    for ElementId { element, .. } in &law.on {
                        let field = &mut elements[*element].field;
                        *field = sum(*field, given(&law.acceleration)?);
                    }
                }
                ForceKind::Load(load) => {
                    let Body::Element(ElementId { element, .. }) = load.on.on else {
                        return Err(unfit());
                    };
                    elements[element].loads.push(Load {
                        at: vector(&load.on.at)?,
                        force: given(&load.force)?,
                        moment: given(&load.moment)?,
                    });
                }
                _ => return Err(unfit()),
            }
        }
        let free = match system.reference {
            Reference::Free => true,
            Reference::Fixed => false,
            _ => return Err(unfit()),
        };
        Ok(Tree {
            layout: Layout::of(model),
            free,
            elements,
        })
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        self.elements.len()
    }

    /// The tree at the coordinates q.
    pub fn posture<S: Real>(&self, q: &[S]) -> Posture<'_, S> {
        let mut turned: Vec<Turned<S>> = Vec::with_capacity(self.elements.len());
        let mut rotations: Vec<[Vector<S>; 3]> = Vec::with_capacity(self.elements.len());
        for (k, element) in self.elements.iter().enumerate() {
            let id = ElementId {
                system: 0,
                element: k,
            };
            let q = &q[self.layout.element_coordinates(id)];
            let (columns, axes) = orientation(self.layout.orientation, q);
            let (own, _) = bryant(element.axes.map(S::from_f64));
            let offset = match element.parent {
                Some(parent) => combination(&rotations[parent], element.at.map(S::from_f64)),
                None => [S::from_f64(0.0); 3],
            };
            turned.push(Turned {
                axes,
                principal: own.map(|axis| combination(&columns, axis)),
                offset,
                center: combination(&columns, element.cg.map(S::from_f64)),
                loaded: (element.loads.iter())
                    .map(|load| combination(&columns, load.at.map(S::from_f64)))
                    .collect(),
            });
            rotations.push(columns);
        }
        Posture {
            tree: self,
            turned,
            of_angles: self.layout.orientation == Orientation::Bryant,
        }
    }
}

impl<S: Real> Posture<'_, S> {
    /// Linear and angular momentum of a tree whose velocities are angular velocities; the angular momentum is about the
    /// reference joint. They are sums of S v over the freedoms that translate or rotate the whole tree. The second
    /// result has the same sums over absolute values.
    pub fn momentum(&self, v: &[S]) -> [[S; 6]; 2] {
        let layout = &self.tree.layout;
        let zero = S::from_f64(0.0);
        let (mut momentum, mut size) = ([zero; 6], [zero; 6]);
        let reference = layout.reference_velocities(0).unwrap_or_default();
        let first = reference.len();
        for (i, row) in self.matrix().iter().enumerate() {
            let direction = match reference.contains(&i) {
                true => layout.directions[i - reference.start],
                false => 3 + (i - first) % 3,
            };
            for (s, v) in row.iter().zip(v) {
                momentum[direction] += *s * *v;
                size[direction] += (*s * *v).abs();
            }
        }
        [momentum, size]
    }

    /// S v̇ − r at the velocities v; `rates` are v̇.
    pub fn residual(&self, v: &[S], rates: &[S]) -> Vec<S> {
        self.balance(Some(v), rates)
    }

    /// S by rows: each is the residual of a unit acceleration at rest, without forces.
    pub fn matrix(&self) -> Vec<Vec<S>> {
        let size = self.tree.layout.velocities.len();
        let column = |j: usize| {
            let mut unit = vec![S::from_f64(0.0); size];
            unit[j] = S::from_f64(1.0);
            self.balance(None, &unit)
        };
        (0..size).map(column).collect()
    }

    /// Converts rates of Bryant angles to ω, and their derivatives to α, in absolute axes; the posture uses these from
    /// then on. Does nothing if the velocities are ω already. Velocities of a reference joint do not change.
    pub fn in_angular_velocities(&mut self, v: &mut [S], rates: &mut [S]) {
        if !std::mem::take(&mut self.of_angles) {
            return;
        }
        let (zero, one) = (S::from_f64(0.0), S::from_f64(1.0));
        for (k, turned) in self.turned.iter_mut().enumerate() {
            let range = self.tree.layout.element_velocities(ElementId {
                system: 0,
                element: k,
            });
            let (mut alpha, mut omega) = ([zero; 3], [zero; 3]);
            for (e, row) in turned.axes.iter().zip(range.clone()) {
                let rate = sum(scaled(rates[row], *e), scaled(v[row], cross(omega, *e)));
                alpha = sum(alpha, rate);
                omega = sum(omega, scaled(v[row], *e));
            }
            v[range.clone()].copy_from_slice(&omega);
            rates[range].copy_from_slice(&alpha);
            turned.axes = vec![[one, zero, zero], [zero, one, zero], [zero, zero, one]];
        }
    }

    /// The balance S v̇ − r: with velocities it includes bias forces, fields and loads; without velocities only
    /// inertia.
    fn balance(&self, v: Option<&[S]>, rates: &[S]) -> Vec<S> {
        let Tree {
            layout,
            free,
            elements,
        } = self.tree;
        let zero = [S::from_f64(0.0); 3];
        let mut joint = vec![zero; elements.len()];
        let mut spins = vec![(zero, zero); elements.len()];
        let (mut forces, mut moments) = (joint.clone(), joint.clone());
        for (k, (element, turned)) in elements.iter().zip(&self.turned).enumerate() {
            let range = layout.element_velocities(ElementId {
                system: 0,
                element: k,
            });
            let mut alpha = zero;
            for (e, rate) in turned.axes.iter().zip(&rates[range.clone()]) {
                alpha = sum(alpha, scaled(*rate, *e));
            }
            let mut omega = zero;
            if let Some(v) = v {
                // ė_j = (sum of the earlier rotations of the element) × e_j; for other velocities the axes are constant
                for (e, rate) in turned.axes.iter().zip(&v[range]) {
                    if self.of_angles {
                        alpha = sum(alpha, scaled(*rate, cross(omega, *e)));
                    }
                    omega = sum(omega, scaled(*rate, *e));
                }
            }
            let moved = |v: Vector<S>| sum(cross(alpha, v), cross(omega, cross(omega, v)));
            joint[k] = match element.parent {
                Some(parent) => {
                    let (alpha, omega) = spins[parent];
                    let u = turned.offset;
                    let relative = sum(cross(alpha, u), cross(omega, cross(omega, u)));
                    sum(joint[parent], relative)
                }
                None if *free => {
                    let mut acceleration = zero;
                    let reference = layout.reference_velocities(0).unwrap_or_default();
                    for (&direction, row) in layout.directions.iter().zip(reference) {
                        acceleration[direction] = rates[row];
                    }
                    acceleration
                }
                None => zero,
            };
            spins[k] = (alpha, omega);

            let mut acceleration = sum(joint[k], moved(turned.center));
            if v.is_some() {
                acceleration = difference(acceleration, element.field.map(S::from_f64));
            }
            let force = scaled(S::from_f64(element.mass), acceleration);
            let angular_momentum = turned.inertia(element, omega);
            let own = sum(
                turned.inertia(element, alpha),
                cross(omega, angular_momentum),
            );
            forces[k] = force;
            moments[k] = sum(own, cross(turned.center, force));
            if v.is_some() {
                for (load, at) in element.loads.iter().zip(&turned.loaded) {
                    let (force, moment) = (load.force.map(S::from_f64), load.moment);
                    forces[k] = difference(forces[k], force);
                    moments[k] = difference(moments[k], cross(*at, force));
                    moments[k] = difference(moments[k], moment.map(S::from_f64));
                }
            }
        }
        let mut residual = vec![S::from_f64(0.0); layout.velocities.len()];
        for (k, (element, turned)) in elements.iter().zip(&self.turned).enumerate().rev() {
            let range = layout.element_velocities(ElementId {
                system: 0,
                element: k,
            });
            for (row, e) in range.zip(&turned.axes) {
                residual[row] = dot(*e, moments[k]);
            }
            if let Some(parent) = element.parent {
                forces[parent] = sum(forces[parent], forces[k]);
                moments[parent] = sum(moments[parent], cross(turned.offset, forces[k]));
            }
        }
        if let Some(range) = layout.reference_velocities(0) {
            for (&direction, row) in layout.directions.iter().zip(range) {
                residual[row] = forces[0][direction];
            }
        }
        residual
    }
}

impl<S: Real> Turned<S> {
    /// I x about the centre of gravity.
    fn inertia(&self, element: &Element, x: Vector<S>) -> Vector<S> {
        let mut result = [S::from_f64(0.0); 3];
        for (axis, moment) in self.principal.iter().zip(element.inertia) {
            let along = S::from_f64(moment) * dot(*axis, x);
            result = sum(result, scaled(along, *axis));
        }
        result
    }
}

/// The columns of A, and the axes e_j of an element's velocities.
fn orientation<S: Real>(kind: Orientation, q: &[S]) -> ([Vector<S>; 3], Vec<Vector<S>>) {
    let (zero, one) = (S::from_f64(0.0), S::from_f64(1.0));
    let unit = [[one, zero, zero], [zero, one, zero], [zero, zero, one]];
    match (kind, q) {
        (Orientation::Angle, &[angle]) => {
            let (s, c) = angle.sin_cos();
            ([[c, zero, -s], unit[1], [s, zero, c]], vec![unit[1]])
        }
        (Orientation::Bryant, &[first, second, third]) => {
            let (columns, axes) = bryant([first, second, third]);
            (columns, axes.to_vec())
        }
        (Orientation::Quaternion, &[w, x, y, z]) => {
            // the rotation by the quaternion, whatever rounding did to its length: v + 2 p × (p × v + w v)
            let norm = w * w + x * x + y * y + z * z;
            let (p, two) = ([x, y, z], S::from_f64(2.0) / norm);
            let turn = |v| {
                let once = sum(cross(p, v), scaled(w, v));
                sum(v, scaled(two, cross(p, once)))
            };
            (unit.map(turn), unit.to_vec())
        }
        _ => unreachable!("the layout gives each orientation its coordinates"),
    }
}

/// The columns of Rx(φ₁) Ry(φ₂) Rz(φ₃), and the axes of the three successive rotations.
fn bryant<S: Real>([first, second, third]: Vector<S>) -> ([Vector<S>; 3], [Vector<S>; 3]) {
    let (zero, one) = (S::from_f64(0.0), S::from_f64(1.0));
    let ([s1, c1], [s2, c2], [s3, c3]) = (sin_cos(first), sin_cos(second), sin_cos(third));
    let x = [one, zero, zero];
    let y = [zero, c1, s1];
    let z = [zero, -s1, c1];
    let (x2, z2) = (
        difference(scaled(c2, x), scaled(s2, z)),
        sum(scaled(s2, x), scaled(c2, z)),
    );
    let columns = [
        sum(scaled(c3, x2), scaled(s3, y)),
        difference(scaled(c3, y), scaled(s3, x2)),
        z2,
    ];
    (columns, [x, y, z2])
}

fn sin_cos<S: Real>(angle: S) -> [S; 2] {
    let (s, c) = angle.sin_cos();
    [s, c]
}

fn combination<S: Real>(columns: &[Vector<S>; 3], by: Vector<S>) -> Vector<S> {
    let [x, y, z] = columns;
    sum(sum(scaled(by[0], *x), scaled(by[1], *y)), scaled(by[2], *z))
}

fn sum<S: Real>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn difference<S: Real>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn scaled<S: Real>(factor: S, v: Vector<S>) -> Vector<S> {
    v.map(|component| factor * component)
}

fn dot<S: Real>(a: Vector<S>, b: Vector<S>) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross<S: Real>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
