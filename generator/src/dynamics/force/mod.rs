//! The force interactions of a scene, as forces and moments on its elements.
//!
//! One file per law; each adds to the [`Load`] of the elements that it touches and leaves its [`Measures`] for the outputs.

mod airbag;
pub mod belt;
mod bending;
mod contact;
mod drive;
mod fade;
mod field;
mod hysteresis;
mod joint;
mod load;
pub mod onset;
mod ring;
mod spring;
mod sticking;
pub mod switch;
mod user;
mod webbing;

use super::kinematics::{ElementMotion, Motion};
use crate::dynamics::numbers::{curve, number, rate, zigzag};
use crate::dynamics::time;
use crate::equations;
use crate::expression::passes::recall;
use crate::expression::vector::Vec3;
use crate::expression::{ApproachCall, Expr, Function, Graph, Node, Symbol};
use crate::model::{
    Body, Contact, Curve, ElementId, Extrapolate, FieldComponent, ForceKind, Model, ScaledCurve,
};

pub use user::{LineMeasures, UserMeasures};

/// What acts on one element, absolute axes.
#[derive(Clone, Copy)]
pub struct Load<'g> {
    /// Resultant force \[N\].
    pub force: Vec3<'g>,
    /// Resultant moment about the element's joint \[N m\].
    pub moment: Vec3<'g>,
}

impl Load<'_> {
    /// True where nothing acts.
    pub fn is_zero(&self) -> bool {
        self.force.is_zero() && self.moment.is_zero()
    }
}

/// Everything that acts.
pub struct Loads<'g> {
    /// By system and element; without the fields common to a whole system.
    pub elements: Vec<Vec<Load<'g>>>,
    /// By system and element: the moments of laws in its joint, on the element.
    pub in_joints: Vec<Vec<Vec<Vec3<'g>>>>,
    /// By system, element and freedom of its joint: the torques and forces of laws on its coordinate.
    pub on_freedoms: Vec<Vec<Vec<Expr<'g>>>>,
    /// By vehicle, moments about its origin: what nothing feels, but whatever moves it works against.
    pub vehicles: Vec<Load<'g>>,
    /// By system: the sum of the fields that act on all of its elements \[m/s²\].
    pub fields: Vec<Vec3<'g>>,
    /// By system and element: the sum of the other fields \[m/s²\].
    pub partial_fields: Vec<Vec<Vec3<'g>>>,
    /// By force of the model.
    pub measures: Vec<Measures<'g>>,
    /// States z of force laws, integrated with q and v.
    pub auxiliaries: Vec<LawState<'g>>,
    /// The charts of Bryant angles, and the memory m of force laws, renewed when a step is accepted.
    pub memory: Vec<LawState<'g>>,
    /// Functions whose change of sign is where a law changes its branch, by name.
    pub guards: Vec<(String, Expr<'g>)>,
    /// Functions whose change of sign is where a law is not smooth, by name. They are made when everything else is
    /// derived, so that they leave no trace in the equations.
    kinks: Vec<(String, Box<dyn Fn() -> Expr<'g> + 'g>)>,
    /// When laws begin to act, by name, made like kinks.
    onsets: Vec<onset::Told<'g>>,
    /// How far the nearest corner of each curve is, by name, made like onsets.
    corners: Vec<onset::Told<'g>>,
    /// By curve of the model: whether it has kinks.
    kinked: Vec<bool>,
    /// By curve of the model: where it is 0 on a whole interval.
    idle: Vec<Vec<[f64; 2]>>,
    /// By curve of the model: its first abscissa, whether it is a line through 0 everywhere, and whether it ends.
    first_points: Vec<f64>,
    straight: Vec<bool>,
    ends: Vec<bool>,
    /// Curves of the state, by name, made like kinks.
    curves: Vec<CurveOfState<'g>>,
    /// What each effect does work by, for the balance of energy.
    pub works: Vec<Work<'g>>,
    /// By switch of the model: its memory.
    pub switches: Vec<switch::Remembered<'g>>,
}

/// A curve at an argument that depends on the state, the bearing of a bent joint, or a component of the direction of a contact.
struct CurveOfState<'g> {
    /// Its name.
    name: String,
    /// What it is.
    what: equations::Watched,
    /// What stands for it where the force does not act: the first abscissa of a curve.
    idle: f64,
    /// Its argument in its own abscissa, the bearing, or the component.
    argument: Box<dyn Fn() -> Expr<'g> + 'g>,
    /// What is 0 while the force that it is part of does not act; else it is more.
    acts: Option<Expr<'g>>,
}

/// Where a curve acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acts {
    /// At all arguments.
    Everywhere,
    /// From its first point on: below, the law that it is part of makes 0 of it, as a slack belt and a contact apart do.
    AboveFirst,
}

/// A state that a force law keeps besides q and v.
pub struct LawState<'g> {
    /// Name for people, which begins with that of the force: "contact seat: permanent set".
    pub name: String,
    /// SI unit.
    pub unit: &'static str,
    /// Value at the start of a run.
    pub initial: Expr<'g>,
    /// Of an auxiliary its rate, of a memory its value after an accepted step. Before a law says otherwise an auxiliary
    /// stays, and so does a memory.
    pub next: Expr<'g>,
}

/// How one effect does work.
pub struct Work<'g> {
    /// Name for people: "contact seat: friction".
    pub name: String,
    /// Its power is their sum. Kept apart until everything else is derived, so that the balance of energy leaves no trace
    /// in the equations.
    pub products: Vec<Product<'g>>,
}

/// A factor of a power and the other.
#[derive(Clone, Copy)]
pub enum Product<'g> {
    /// A torque and a rate, a tension and the rate of a length.
    Scalars(Expr<'g>, Expr<'g>),
    /// A force and a velocity, a moment and an angular velocity.
    Vectors(Vec3<'g>, Vec3<'g>),
    /// A field's acceleration and the momentum of an element that feels it.
    Field(Vec3<'g>, ElementId),
}

/// What can be asked of a force.
pub enum Measures<'g> {
    /// A field or a given load: nothing.
    None,
    /// A joint: per relative rotation, then of flexion and of torsion, where a law acts or somebody looks.
    Joint([Option<JointMeasures<'g>>; 5]),
    /// A contact.
    Contact(ContactMeasures<'g>),
    /// An airbag.
    Airbag(AirbagMeasures<'g>),
    /// A belt.
    Belt(BeltMeasures<'g>),
    /// A spring.
    Spring(SpringMeasures<'g>),
    /// A user force.
    User(UserMeasures<'g>),
}

/// Of a joint about one relative rotation.
#[derive(Clone, Copy)]
pub struct JointMeasures<'g> {
    /// Generalised torque on the child \[N m\].
    pub torque: Expr<'g>,
    /// Relative angle \[rad\].
    pub angle: Expr<'g>,
    /// Its rate \[rad/s\].
    pub rate: Expr<'g>,
    /// Where the elastic torque ends that falls from here, beyond the neutral angle and before it \[rad\]; 0 without hysteresis.
    pub permanent_sets: [Expr<'g>; 2],
}

/// Of a contact.
#[derive(Clone, Copy)]
pub struct ContactMeasures<'g> {
    /// The whole force on the body of its `ellipsoid` \[N\].
    pub on_first: Vec3<'g>,
    /// Magnitude of the whole force \[N\].
    pub force: Expr<'g>,
    /// Normal force \[N\].
    pub normal: Expr<'g>,
    /// Magnitude of the friction force \[N\]; signed in the plane.
    pub friction: Expr<'g>,
    /// Penetration \[m\].
    pub penetration: Expr<'g>,
    /// Penetration at which the unloading line meets no force \[m\]; 0 without hysteresis.
    pub permanent_set: Expr<'g>,
}

/// Of an airbag.
pub struct AirbagMeasures<'g> {
    /// The force on what it is on, and on each that it meets \[N\].
    pub on: Vec<Vec3<'g>>,
    /// Absolute pressure \[Pa\].
    pub pressure: Expr<'g>,
    /// Temperature \[K\].
    pub temperature: Expr<'g>,
    /// Mass of gas \[kg\].
    pub mass: Expr<'g>,
    /// Its volume \[m³\].
    pub volume: Expr<'g>,
    /// Mass flow out \[kg/s\].
    pub outflow: Expr<'g>,
    /// Area that pushes \[m²\].
    pub area: Expr<'g>,
}

/// Of a belt.
pub struct BeltMeasures<'g> {
    /// The force on each of its points, from its end `from` to its end `to` \[N\].
    pub on: Vec<Vec3<'g>>,
    /// Its straight parts, from `from` on.
    pub segments: Vec<SegmentMeasures<'g>>,
    /// What has slipped through each ring, from the side of `from` \[m\].
    pub slipped: Vec<Expr<'g>>,
    /// What its untensioned length has grown since the start \[m\].
    pub payout: Expr<'g>,
}

/// Of a straight part of a belt.
#[derive(Clone, Copy)]
pub struct SegmentMeasures<'g> {
    /// Tension \[N\].
    pub tension: Expr<'g>,
    /// Distance of its points \[m\].
    pub length: Expr<'g>,
    /// Relative elongation.
    pub elongation: Expr<'g>,
    /// Untensioned length \[m\].
    pub untensioned: Expr<'g>,
    /// Elongation at which the unloading line meets no force; 0 without hysteresis.
    pub permanent_set: Expr<'g>,
}

/// Of a spring.
#[derive(Clone, Copy)]
pub struct SpringMeasures<'g> {
    /// The force on the body of its end `from` \[N\].
    pub on_first: Vec3<'g>,
    /// Force, positive where it pulls \[N\].
    pub force: Expr<'g>,
    /// Distance of the attachments \[m\].
    pub length: Expr<'g>,
    /// What it is longer than without force \[m\].
    pub elongation: Expr<'g>,
    /// Rate of the length \[m/s\].
    pub rate: Expr<'g>,
}

impl<'g> Loads<'g> {
    /// A new state z of a force law, and its index, by which the law sets the rate.
    pub fn auxiliary(
        &mut self,
        name: impl Into<String>,
        unit: &'static str,
        initial: Expr<'g>,
    ) -> (usize, Expr<'g>) {
        let (graph, index) = (initial.graph(), self.auxiliaries.len());
        self.auxiliaries.push(LawState {
            name: name.into(),
            unit,
            initial,
            next: graph.constant(0.0),
        });
        (index, graph.symbol(Symbol::Auxiliary(index as u32)))
    }

    /// A new memory m of a force law, and its index, by which the law sets what it becomes after an accepted step.
    ///
    /// Its value must always be finite: what has not happened yet happens at [`NEVER`].
    pub fn memory(
        &mut self,
        name: impl Into<String>,
        unit: &'static str,
        initial: Expr<'g>,
    ) -> (usize, Expr<'g>) {
        let (graph, index) = (initial.graph(), self.memory.len());
        let value = graph.symbol(Symbol::Memory(index as u32));
        self.memory.push(LawState {
            name: name.into(),
            unit,
            initial,
            next: value,
        });
        (index, value)
    }

    /// Ends steps where an expression changes its sign.
    pub fn guard(&mut self, name: impl Into<String>, expression: Expr<'g>) {
        if expression.as_constant().is_none() {
            self.guards.push((name.into(), expression));
        }
    }

    /// Tells where a law is not smooth: where an expression changes its sign. `expression` is called when everything else
    /// is derived.
    pub fn kink(&mut self, name: impl Into<String>, expression: impl Fn() -> Expr<'g> + 'g) {
        self.kinks.push((name.into(), Box::new(expression)));
    }

    /// Tells of a curve of the state: what it is evaluated at, and where it is not smooth, if it is not. `which` it is of the
    /// `owner`; `argument` as in [`Loads::kink`].
    pub fn curve_of_state(
        &mut self,
        owner: &str,
        which: &str,
        curve: &ScaledCurve,
        acts: Acts,
        argument: impl Fn() -> Expr<'g> + Copy + 'g,
    ) {
        let (scaled, first) = (curve.clone(), self.first_points[curve.curve]);
        let abscissa = move || {
            let argument = argument();
            let graph = argument.graph();
            let abscissa = argument * rate(graph, &scaled);
            match acts {
                Acts::Everywhere => abscissa,
                Acts::AboveFirst => abscissa.max(graph.constant(first)),
            }
        };
        // a line through 0 is as good a law beyond its points as between them
        if !self.straight[curve.curve] {
            self.curves.push(CurveOfState {
                name: format!("{owner}: {which}"),
                what: equations::Watched::Curve(curve.curve),
                idle: first,
                argument: Box::new(abscissa),
                acts: None,
            });
        }
        if self.kinked[curve.curve] {
            let curve = curve.clone();
            self.kink(format!("{owner}: kink of the {which}"), move || {
                let argument = argument();
                zigzag(argument.graph(), &curve, argument)
            });
        }
    }

    /// Whether a curve of a contact must not be left, and has no value beyond its points.
    pub fn may_end(&self, contact: &Contact) -> bool {
        let unloading = contact.hysteresis.as_ref().map(|law| &law.unloading);
        let curves = [Some(&contact.elastic), unloading].into_iter().flatten();
        curves.flatten().any(|scaled| self.ends[scaled.curve])
    }

    /// How many curves of the state are told of.
    pub fn curves_so_far(&self) -> usize {
        self.curves.len()
    }

    /// Of the curves of the state told of since there were so many: they count only while a force is not 0. It is never negative.
    pub fn curves_act(&mut self, since: usize, force: Expr<'g>) {
        for curve in &mut self.curves[since..] {
            curve.acts = Some(force);
        }
    }

    /// Tells of the bearing of a joint that bends, [`NO_BEARING`](equations::NO_BEARING) where it is bent by less than 90°, so that a run that goes through 180°
    /// says so.
    pub fn bearing(&mut self, owner: &str, bearing: impl Fn() -> Expr<'g> + 'g) {
        self.curves.push(CurveOfState {
            name: owner.to_owned(),
            what: equations::Watched::Bearing,
            idle: equations::NO_BEARING,
            argument: Box::new(bearing),
            acts: None,
        });
    }

    /// Tells of the share of the volume of an airbag that what it meets takes, while a force that is never negative is not 0.
    pub fn volume(&mut self, owner: &str, share: impl Fn() -> Expr<'g> + 'g, acts: Expr<'g>) {
        self.curves.push(CurveOfState {
            name: owner.to_owned(),
            what: equations::Watched::Volume,
            idle: 0.0,
            argument: Box::new(share),
            acts: Some(acts),
        });
    }

    /// Tells of the direction in which two ellipsoids push each other, of length 1, or shorter where it is not determined, so that a run in
    /// which it leaps says so.
    pub fn direction(&mut self, owner: &str, components: Vec<impl Fn() -> Expr<'g> + 'g>) {
        for (i, component) in components.into_iter().enumerate() {
            self.curves.push(CurveOfState {
                name: owner.to_owned(),
                what: equations::Watched::Direction(i as u8),
                idle: equations::NO_BEARING,
                argument: Box::new(component),
                acts: None,
            });
        }
    }

    /// The curves of the state that all laws evaluate, with their abscissae, the bearings of joints that bend, and the directions of
    /// contacts of two ellipsoids. Made when everything else is derived.
    pub fn curves(&self, graph: &'g Graph) -> Vec<equations::CurveOfState> {
        graph.section("arguments of curves");
        let mut curves = Vec::new();
        for curve in &self.curves {
            // of a curve that must not be left the force is no number, and tells nothing
            let ends = matches!(curve.what, equations::Watched::Curve(index) if self.ends[index]);
            let argument = match curve.acts {
                Some(force) if !ends => {
                    let least = graph.constant(f64::MIN_POSITIVE);
                    let (idle, argument) = (graph.constant(curve.idle), (curve.argument)());
                    choose(force, least, idle, argument)
                }
                _ => (curve.argument)(),
            };
            if argument.as_constant().is_none() {
                curves.push(equations::CurveOfState {
                    name: curve.name.clone(),
                    what: curve.what,
                    argument: argument.id(),
                });
            }
        }
        curves
    }

    /// The kinks of all laws, each expression once.
    pub fn kinks(&self, graph: &'g Graph) -> Vec<(String, Expr<'g>)> {
        // the sign of a negative changes where that of the value does
        let unsigned = |value: Expr<'g>| match graph.node(value.id()) {
            Node::Neg(a) => a,
            _ => value.id(),
        };
        let mut kinks: Vec<(String, Expr<'g>)> = Vec::new();
        for (name, expression) in &self.kinks {
            graph.section(format!("kink {name}"));
            // whose sign is looked for must be continuous: no bound in the place of a distance
            let value = exact(expression());
            let known = kinks
                .iter()
                .any(|(_, kink)| unsigned(*kink) == unsigned(value));
            if value.as_constant().is_none() && !known {
                kinks.push((name.clone(), value));
            }
        }
        kinks
    }

    /// Counts a power to an effect.
    pub fn work(&mut self, name: impl Into<String>, product: Product<'g>) {
        let name = name.into();
        match self.works.iter_mut().find(|work| work.name == name) {
            Some(work) => work.products.push(product),
            None => self.works.push(Work {
                name,
                products: vec![product],
            }),
        }
    }

    /// Applies a force at an offset from the body's joint.
    fn apply(&mut self, body: Body, offset: Vec3<'g>, force: Vec3<'g>) {
        if let Some(load) = self.on(body) {
            load.force = load.force + force;
            load.moment = load.moment + offset.cross(force);
        }
    }

    /// Applies a moment.
    fn turn(&mut self, body: Body, moment: Vec3<'g>) {
        if let Some(load) = self.on(body) {
            load.moment = load.moment + moment;
        }
    }

    /// Applies a moment in the joint of an element, and the opposite one to its carrier.
    fn turn_joint(&mut self, child: ElementId, carrier: Body, moment: Vec3<'g>) {
        self.turn(Body::Element(child), moment);
        self.turn(carrier, -moment);
        self.in_joints[child.system][child.element].push(moment);
    }

    /// What acts on a body; `None` for the absolute frame.
    fn on(&mut self, body: Body) -> Option<&mut Load<'g>> {
        match body {
            Body::Frame => None,
            Body::Element(id) => Some(&mut self.elements[id.system][id.element]),
            Body::Vehicle(index) => Some(&mut self.vehicles[index]),
        }
    }
}

/// The loads of a model in motion; `start` is its motion where a run starts, from which belts take their length, `charts` is
/// the memory that comes before that of force laws.
pub fn loads<'g>(
    graph: &'g Graph,
    model: &Model,
    motion: &Motion<'g>,
    start: &Motion<'g>,
    charts: Vec<LawState<'g>>,
) -> Loads<'g> {
    let none = Load {
        force: Vec3::zero(graph),
        moment: Vec3::zero(graph),
    };
    let mut loads = Loads {
        elements: model
            .systems
            .iter()
            .map(|s| vec![none; s.elements.len()])
            .collect(),
        in_joints: model
            .systems
            .iter()
            .map(|s| vec![Vec::new(); s.elements.len()])
            .collect(),
        on_freedoms: (model.systems.iter())
            .map(|s| {
                let elements = s.elements.iter();
                let none = graph.constant(0.0);
                elements
                    .map(|e| vec![none; e.joint.freedoms().len()])
                    .collect()
            })
            .collect(),
        vehicles: vec![none; model.vehicles.len()],
        fields: vec![Vec3::zero(graph); model.systems.len()],
        partial_fields: model
            .systems
            .iter()
            .map(|s| vec![Vec3::zero(graph); s.elements.len()])
            .collect(),
        measures: Vec::new(),
        auxiliaries: Vec::new(),
        memory: charts,
        guards: Vec::new(),
        kinks: Vec::new(),
        onsets: Vec::new(),
        corners: Vec::new(),
        kinked: model.curves.iter().map(|c| !c.kinks().is_empty()).collect(),
        curves: Vec::new(),
        first_points: model.curves.iter().map(|c| c.points[0][0]).collect(),
        idle: model.curves.iter().map(Curve::idle).collect(),
        straight: model.curves.iter().map(Curve::is_proportional).collect(),
        ends: model
            .curves
            .iter()
            .map(|c| c.extrapolate == Extrapolate::Error)
            .collect(),
        works: Vec::new(),
        switches: Vec::new(),
    };
    loads.declare_switches(graph, model);
    for (index, force) in model.forces.iter().enumerate() {
        let gate = loads.gate(force.active);
        let measures = match &force.kind {
            ForceKind::Field { on, acceleration } => {
                graph.section(format!("field {}", force.name));
                field::apply(
                    graph,
                    model,
                    motion,
                    &mut loads,
                    &force.name,
                    gate,
                    on,
                    acceleration,
                );
                Measures::None
            }
            ForceKind::Joint {
                child,
                about,
                bending,
            } => {
                graph.section(format!("joint {}", force.name));
                Measures::Joint(joint::apply(
                    graph,
                    model,
                    motion,
                    &mut loads,
                    &force.name,
                    joint::Joint {
                        force: index,
                        child: *child,
                        gate,
                        about,
                        bending: bending.as_deref(),
                    },
                ))
            }
            ForceKind::Freedom {
                child,
                freedom,
                law,
            } => {
                graph.section(format!("joint {}", force.name));
                let joint = &model.systems[child.system].elements[child.element].joint;
                let [unit, _] = joint.freedoms()[*freedom].kind.coordinate().units();
                let which = (*child, *freedom, unit);
                let measures = joint::apply_to_freedom(
                    graph,
                    motion,
                    &mut loads,
                    &force.name,
                    gate,
                    which,
                    law,
                );
                Measures::Joint([Some(measures), None, None, None, None])
            }
            ForceKind::Contact(contact) => {
                graph.section(format!("contact {}", force.name));
                Measures::Contact(contact::apply(
                    graph,
                    model.dimension,
                    motion,
                    &mut loads,
                    &force.name,
                    gate,
                    contact,
                ))
            }
            ForceKind::Load(given) => {
                graph.section(format!("load {}", force.name));
                load::apply(graph, motion, &mut loads, &force.name, gate, given);
                Measures::None
            }
            ForceKind::Belt(belt) => {
                graph.section(format!("belt {}", force.name));
                let law = belt::Law {
                    graph,
                    model,
                    name: &force.name,
                    gate,
                    belt,
                };
                Measures::Belt(belt::apply(law, motion, start, &mut loads))
            }
            ForceKind::Airbag(airbag) => {
                graph.section(format!("airbag {}", force.name));
                Measures::Airbag(airbag::apply(
                    graph,
                    model,
                    [motion, start],
                    &mut loads,
                    &force.name,
                    airbag,
                ))
            }
            ForceKind::Spring(spring) => {
                graph.section(format!("spring {}", force.name));
                Measures::Spring(spring::apply(
                    graph,
                    motion,
                    start,
                    &mut loads,
                    &force.name,
                    gate,
                    spring,
                ))
            }
            ForceKind::User(user) => {
                graph.section(format!("user {}", force.name));
                Measures::User(user::apply(
                    graph,
                    model,
                    motion,
                    &mut loads,
                    &force.name,
                    (index, gate),
                    user,
                ))
            }
        };
        loads.measures.push(measures);
    }
    loads
}

/// The same with distances of bodies that do not touch in the place of what is at most these.
fn exact(value: Expr<'_>) -> Expr<'_> {
    recall(value, |function| match function {
        Function::Approach(call) => Function::Approach(ApproachCall {
            early: false,
            ..call
        }),
        other => other,
    })
}

/// A time that is never reached, finite as every memory must be \[s\].
pub const NEVER: f64 = 1e30;

/// `then` where a < b, `otherwise` elsewhere. Both are computed: neither may be infinite or no number where it is not
/// chosen, if derivatives are wanted.
pub fn choose<'g>(a: Expr<'g>, b: Expr<'g>, then: Expr<'g>, otherwise: Expr<'g>) -> Expr<'g> {
    match (a.as_constant(), b.as_constant()) {
        (Some(a), Some(b)) if a < b => then,
        (Some(_), Some(_)) => otherwise,
        _ if then.id() == otherwise.id() => then,
        _ => a.graph().call(Function::Choose, &[a, b, then, otherwise]),
    }
}

/// Three components, each constant or a curve of time.
fn components<'g>(graph: &'g Graph, components: &[FieldComponent; 3]) -> Vec3<'g> {
    Vec3(std::array::from_fn(|i| match &components[i] {
        FieldComponent::Constant(value) => number(graph, value),
        FieldComponent::Curve(scaled) => curve(graph, scaled, time(graph)),
    }))
}

/// Offset of a point from the joint of a body, and the velocity of the body's material there.
fn point_on<'g>(body: &ElementMotion<'g>, position: Vec3<'g>) -> (Vec3<'g>, Vec3<'g>) {
    let offset = position - body.position;
    (offset, body.velocity_at(offset))
}
