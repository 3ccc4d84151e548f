//! The resolved model: indices instead of names, SI instead of units, every reference and every number checked.
//!
//! `description` holds what the user wrote, this module what it means. A [`Model`] can only be had from
//! [`read`](crate::read()) and [`read_str`](crate::read_str), which report every problem they find. Every [`Model`] has
//! these properties: each system is one tree with parents before children; names are unique; masses are positive and
//! inertias realisable at the default parameters; all numbers are finite; curves have increasing abscissae; every index
//! is in range; and the mass matrix is not structurally singular.

mod curve;
mod digest;
mod hysteresis;
pub mod joint;
pub mod law;
pub mod look;
mod normal;
mod number;
pub mod part;
pub mod placement;
pub(crate) mod requirement;
pub(crate) mod resolve;
pub mod rule;
pub mod scene;
mod surface;
mod switch;
mod thin;
pub mod units;
pub(crate) mod unloading;

use serde::Serialize;

pub use crate::description::joint::Coordinate;
pub use hysteresis::Hysteresis;
pub use joint::{Follows, Freedom, FreedomKind, Joint};
pub use law::{Law, OfLaw};
pub use number::Number;
pub use requirement::Requirement;
pub(crate) use resolve::is_keyword;
pub use rule::Rule;
pub use scene::Scene;
pub use surface::{EdgeRule, Ellipsoid, Extent, Mesh, Plane, Round, Shown, Triangles};
pub use switch::{Active, Switch, SwitchQuantity, Trigger};
pub use units::Units;

/// A whole scene: systems of elements, the forces between them, and outputs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Model {
    /// Name of the model, kebab-case as in the YAML.
    pub name: String,
    /// One sentence for listings; empty if the YAML has none.
    pub title: String,
    /// Motion in the x–z plane or in space.
    pub dimension: Dimension,
    /// The coordinates that describe orientation.
    pub coordinates: Coordinates,
    /// Numbers that the YAML leaves adjustable.
    pub parameters: Vec<Parameter>,
    /// Piecewise functions of one variable.
    pub curves: Vec<Curve>,
    /// Bodies whose motion is prescribed.
    pub vehicles: Vec<Vehicle>,
    /// Systems of elements, each a tree.
    pub systems: Vec<System>,
    /// Forces that act on the systems.
    pub forces: Vec<Force>,
    /// Events that happen at most once, and that forces wait for.
    pub switches: Vec<Switch>,
    /// The outputs of the scene, in the order of the table's columns.
    pub outputs: Vec<Output>,
    /// Duration and sampling of a run.
    pub run: Run,
    /// Surfaces that take part in no contact, and meshes: for pictures only, at the default parameters.
    #[serde(skip)]
    pub shown: Vec<Shown>,
    /// The units in which outputs are shown.
    #[serde(skip)]
    pub units: Units,
    /// SHA-256, in lower-case hexadecimal, of all of the above that affects a motion or an output. It depends on the
    /// meaning of the text, not on the way in which it is written. See [`Model::sha256`].
    #[serde(skip)]
    pub digest: String,
}

/// Number of space dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Dimension {
    /// Motion in the x–z plane, one angle about +y per element (local x axis = (cos φ, −sin φ) in (x, z)).
    Plane,
    /// Motion in space.
    Space,
}

/// The coordinates that describe orientation in space. In the plane there is one angle either way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Coordinates {
    /// A unit quaternion (w, x, y, z), local to absolute; the velocity is ω in absolute axes. No singularity.
    Quaternion,
    /// Absolute Bryant angles, A = Rx(φ₁) Ry(φ₂) Rz(φ₃); the velocity is φ̇. Singular at cos φ₂ = 0: near there a run
    /// changes to the angles of another chart.
    Bryant,
}

/// A number that may be changed without recompiling.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// A Rust identifier in snake case.
    pub name: String,
    /// Value unless the user sets another (SI).
    pub default: f64,
    /// Smallest value allowed (SI).
    pub min: Option<f64>,
    /// Largest value allowed (SI).
    pub max: Option<f64>,
    /// SI unit as text; "" if the number has none or it is unknown.
    pub unit: String,
}

/// A function through points (SI).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Curve {
    /// Name in the YAML, or a name made from the force in which the curve is written ("belt chest force").
    pub name: String,
    /// (abscissa, ordinate), abscissae strictly increasing, at least two points.
    pub points: Vec<[f64; 2]>,
    /// Interpolation between the points.
    pub interpolate: Interpolate,
    /// Extrapolation beyond the points.
    pub extrapolate: Extrapolate,
    /// True if the description states the extrapolation. Otherwise a run that leaves the curve raises a doubt.
    pub told: bool,
    /// Points of the curve's file that were left out; `None` if there are none.
    #[serde(skip)]
    pub thinned: Option<Thinned>,
}

/// Facts about the points that were left out of a curve, because its file has too many.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thinned {
    /// Number of points in the file.
    pub points: usize,
    /// Largest distance between the curve and the points that were left out, in the SI unit of its ordinate.
    pub error: f64,
}

/// Interpolation of a curve between its points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub enum Interpolate {
    /// Straight lines.
    #[default]
    Linear,
    /// Cubics with a common slope at each point ([`Curve::tangent`]), monotone wherever the points are.
    Cubic,
}

/// Extrapolation of a curve beyond its first and last point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Extrapolate {
    /// The outermost segment continues; for cubics, its tangent at the outermost point.
    Linear,
    /// The outermost value is held.
    Hold,
    /// The curve is NaN there, so that a run that leaves the range fails.
    Error,
}

/// A scaled curve: `times · curve(argument / stretch)`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScaledCurve {
    /// Index into [`Model::curves`].
    pub curve: usize,
    /// Factor on the ordinate.
    pub times: Number,
    /// Factor on the abscissa, positive.
    pub stretch: Number,
    /// True if the curve is a line through 0 that is written as its slope, `stiffness`: `times` must then not be
    /// negative.
    pub stiffness: bool,
}

/// A rigid body whose motion is prescribed: it has neither mass nor equations. In a model, something refers to every
/// vehicle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Vehicle {
    /// Name, unique among the vehicles and systems.
    pub name: String,
    /// Position of the origin at t = 0, absolute frame \[m\].
    pub position: [Number; 3],
    /// Velocity of the origin at t = 0, less the part that curves determine \[m/s\].
    pub velocity: [Number; 3],
    /// Motion of the origin.
    pub translation: Translation,
    /// Absolute Bryant angles \[rad\]; curves have a continuous slope. In the plane only the second (about y) is used.
    pub angles: [FieldComponent; 3],
    /// The angles at t = 0 \[rad\].
    pub angles_at_start: [Number; 3],
}

/// One tree of elements.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct System {
    /// Name, unique among the systems.
    pub name: String,
    /// Elements, parents before children; element 0 is the root, whose origin is the reference joint.
    pub elements: Vec<Element>,
    /// Motion of the reference joint.
    pub reference: Reference,
    /// Initial position of the reference joint, absolute frame \[m\]. In the plane the second component is 0.
    pub position: [Number; 3],
    /// Initial velocity of the reference joint, absolute frame \[m/s\]; if its motion is prescribed, less the part that
    /// curves determine.
    pub velocity: [Number; 3],
}

/// Motion of a reference joint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Reference {
    /// Its coordinates are unknowns of the equations of motion.
    Free,
    /// It stays at [`System::position`].
    Fixed,
    /// It moves as prescribed, from [`System::position`] with [`System::velocity`].
    Prescribed(Translation),
    /// It moves with a point of a vehicle, which is at [`System::position`] at t = 0.
    Riding {
        /// Index into [`Model::vehicles`].
        vehicle: usize,
        /// The point in the vehicle's local frame \[m\].
        at: [Number; 3],
    },
}

/// A prescribed translation x(t) along each absolute axis, from the start position x₀ and the start velocity v₀:
///
/// x = x₀ + c,   x = x₀ + v₀ t + ∫ c   or   x = x₀ + v₀ t + ∬ c
///
/// with a curve of time c; c is 0 if there is none. Velocity and acceleration follow in closed form.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Translation {
    /// Which of these three formulas applies.
    pub given: Given,
    /// The curve c for each absolute axis. A displacement is 0 at t = 0 and has a continuous slope, and its v₀ is 0.
    pub curves: [Option<ScaledCurve>; 3],
    /// Present if a motion given by acceleration stops as soon as its velocity is 0, along each axis that has a curve:
    /// the line from 0 to 1, held at both ends. Its abscissa is the time divided by the time of the stop; its value is
    /// the fraction of the motion that is over.
    pub stops: Option<ScaledCurve>,
}

/// The quantity that the curves of a prescribed motion give.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Given {
    /// Displacement from the start \[m\].
    Displacement,
    /// Velocity \[m/s\].
    Velocity,
    /// Acceleration \[m/s²\].
    Acceleration,
}

/// One rigid element.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Element {
    /// Name, unique in its system; with underscores in place of dashes, a Rust identifier.
    pub name: String,
    /// Index of the parent in the same system; `None` for element 0 only.
    pub parent: Option<usize>,
    /// Position of the joint in the parent's local frame \[m\]; zero for the root.
    pub at: [Number; 3],
    /// The joint: its freedoms relative to the parent.
    pub joint: Joint,
    /// Mass \[kg\].
    pub mass: Number,
    /// Centre of gravity, local frame \[m\].
    pub cg: [Number; 3],
    /// Principal moments of inertia about the centre of gravity \[kg m²\]. In the plane only the second (about y) is used.
    pub inertia: [Number; 3],
    /// Bryant angles of the principal axes relative to the local frame \[rad\]; zero if the axes coincide.
    pub axes: [Number; 3],
    /// Initial absolute Bryant angles on a ball joint \[rad\]. In the plane only the second (about y) is used.
    pub angles: [Number; 3],
    /// Initial angular velocity on a ball joint: in space ω in absolute axes \[rad/s\]; in the plane only the second component is used.
    pub angular_velocity: [Number; 3],
}

impl System {
    /// True if all joints are ball joints, or hinges in the plane: then every orientation is absolute.
    pub fn has_balls_alone(&self) -> bool {
        self.elements.iter().all(|e| e.joint == Joint::Ball)
    }

    /// The freedoms of all joints.
    pub fn freedoms(&self) -> impl Iterator<Item = &Freedom> {
        self.elements.iter().flat_map(|e| e.joint.freedoms())
    }

    /// True if a freedom follows another: then S has more nonzero entries than the tree implies.
    pub fn is_coupled(&self) -> bool {
        self.freedoms().any(|freedom| !freedom.is_own())
    }
}

/// Identifies an element: index of the system, and of the element in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct ElementId {
    /// Index into [`Model::systems`].
    pub system: usize,
    /// Index into [`System::elements`].
    pub element: usize,
}

/// A body that a point or a plane is attached to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Body {
    /// The absolute frame.
    Frame,
    /// An element.
    Element(ElementId),
    /// A vehicle: index into [`Model::vehicles`].
    Vehicle(usize),
}

/// A point fixed in a body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Attachment {
    /// The body.
    pub on: Body,
    /// Position in the body's local frame \[m\].
    pub at: [Number; 3],
}

/// A named force interaction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Force {
    /// Name as in the YAML: "chest"; for a joint force, the path of the element ("man/head"). Unique among forces of
    /// the same law.
    pub name: String,
    /// The law.
    pub law: Box<dyn Law>,
    /// The switches between which the force acts.
    pub active: Active,
}

/// Coulomb friction with a linear ramp through zero speed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Friction {
    /// Limit of friction. Joint: torque \[N m\]. Contact: coefficient μ.
    pub limit: Number,
    /// Speed up to which friction is proportional to speed \[rad/s\] or \[m/s\]; positive.
    pub tolerance: Number,
}

/// One component of an acceleration field or of a given load, or the torque of a motor.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum FieldComponent {
    /// A constant.
    Constant(Number),
    /// A curve of time \[s\].
    Curve(ScaledCurve),
}

/// A bristle by which friction holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bristle {
    /// Deflection at which friction reaches its limit \[m\]; \[rad\] in joints that turn.
    pub displacement: Number,
}

/// A column of the output table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Output {
    /// Heading, unique.
    pub name: String,
    /// The quantity that is measured.
    pub quantity: Quantity,
    /// SI unit of the values.
    pub unit: String,
    /// Channel code of ISO-MME, 16 letters and digits, unique.
    pub code: Option<String>,
    /// The filter that tables, responses and studies apply: `CFC60`, `CFC180`, `CFC600` or `CFC1000`; those of SAE
    /// J211-1 with `SAE` in front. Generated code returns unfiltered values.
    pub filter: Option<&'static str>,
    /// The output as a channel of a test, for an output whose code gives a direction, or that the criteria name.
    pub channel: Option<Channel>,
}

/// An output in the axes and signs of SAE J211-1 and ISO 6487: x forward, y to the right, z down. Loads are those of
/// the lower part on the upper part of a body that stands upright.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Channel {
    /// True if the channel has the opposite sign of the quantity.
    pub reversed: bool,
    /// A remark on the place of measurement.
    #[serde(skip)]
    pub remark: Option<&'static str>,
}

/// The criteria by which a run is judged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Criteria {
    /// The regulation.
    pub standard: String,
    /// The dummy.
    pub dummy: String,
    /// True for the filters of SAE J211-1, false for those of ISO 6487.
    pub sae: bool,
    /// Test object and position of the occupant: the first two characters of the codes of its outputs; `None` if there
    /// is only one occupant.
    pub occupant: Option<String>,
    /// The known places of the dummy, such as `neck-fx`, each with the name of the output that measures there.
    pub places: Vec<(String, String)>,
}

/// Component of a vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Component {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z.
    Z,
    /// Euclidean norm.
    Resultant,
}

/// One component of a vector, along the axes of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Projection {
    /// The component.
    pub component: Component,
    /// The body whose axes are used.
    pub axes: Body,
}

impl Projection {
    /// A component along the absolute axes.
    pub fn absolute(component: Component) -> Projection {
        Projection {
            component,
            axes: Body::Frame,
        }
    }
}

impl Projection {
    /// True if this component of a vector in the plane x–z can differ from 0.
    pub fn lies_in_plane(self) -> bool {
        self.component != Component::Y
    }

    /// True if this component of a vector along y can differ from 0.
    pub fn is_about_y(self) -> bool {
        matches!(self.component, Component::Y | Component::Resultant)
    }
}

/// A quantity that an output measures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Quantity {
    /// Kinematics of a point of an element or a vehicle.
    Point {
        /// The body; never the absolute frame.
        body: Body,
        /// The point in the local frame \[m\]; the centre of gravity is resolved to its coordinates.
        at: [Number; 3],
        /// The kind of kinematic quantity. The reading of an accelerometer exists for elements only.
        what: PointQuantity,
        /// The body that the observer moves with.
        relative_to: Body,
        /// The component.
        projection: Projection,
    },
    /// Rotation of an element or a vehicle; in the plane the component is always [`Component::Y`].
    Rotation {
        /// The body; never the absolute frame.
        body: Body,
        /// The angle or one of its derivatives.
        what: RotationQuantity,
        /// The body that the observer moves with.
        relative_to: Body,
        /// The component. For angles, X, Y, Z are the first, second, third Bryant angle, and the resultant is the angle
        /// of the single rotation from the observer's axes to those of the body; `axes` has no meaning.
        projection: Projection,
    },
    /// Force or moment that a joint transmits.
    JointLoad {
        /// The element that the joint carries.
        element: ElementId,
        /// Force or moment.
        what: JointLoadQuantity,
        /// True for the load on the carrier, which is opposite to that on the element.
        on_carrier: bool,
        /// The component.
        projection: Projection,
    },
    /// The force of a law between two bodies, on one of them.
    ForceOn {
        /// Index into [`Model::forces`].
        force: usize,
        /// True for the force on the second body, which is opposite to that on the first. The first body is that of a
        /// contact's `ellipsoid`, or of the end `from`.
        on_second: bool,
        /// The component.
        projection: Projection,
    },
    /// The coordinate of a freedom of a joint, or a derivative.
    Freedom {
        /// The element that the joint carries.
        element: ElementId,
        /// Index of the freedom among those of the joint.
        freedom: usize,
        /// The coordinate or one of its derivatives.
        what: FreedomQuantity,
    },
    /// The force on one body by a belt that runs through rings, or by an airbag: the sum over all points of the law on
    /// this body.
    ForceOnPoints {
        /// Index into [`Model::forces`].
        force: usize,
        /// The points on that body. The points of a belt are numbered from its end `from`; those of an airbag are its
        /// own body, then the bodies that it meets.
        points: Vec<usize>,
        /// The component.
        projection: Projection,
    },
    /// A quantity of a law.
    OfForce {
        /// Index into [`Model::forces`].
        force: usize,
        /// The quantity.
        what: Box<dyn OfLaw>,
    },
    /// A quantity of a switch.
    Switch {
        /// Index into [`Model::switches`].
        switch: usize,
        /// The quantity.
        what: SwitchQuantity,
    },
    /// A quantity of a whole system.
    System {
        /// Index into [`Model::systems`].
        system: usize,
        /// The quantity.
        what: SystemQuantity,
        /// The component, if the quantity is a vector.
        projection: Projection,
    },
    /// An arithmetic expression of other quantities.
    Formula(Box<Formula>),
}

/// An arithmetic expression of quantities, in SI.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Formula {
    /// The expression. Its parameters are indices into `leaves`, not parameters of the model.
    pub value: Number,
    /// The operands of the expression.
    pub leaves: Vec<Leaf>,
}

/// An operand of a formula.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Leaf {
    /// An expression of the model's parameters.
    Number(Number),
    /// A quantity.
    Quantity(Quantity),
}

impl Quantity {
    /// A quantity of the law of a force.
    pub fn of_force(force: usize, what: impl OfLaw) -> Self {
        let what = Box::new(what);
        Quantity::OfForce { force, what }
    }

    /// The measured quantities: for a formula all its operands that are quantities, otherwise the quantity itself.
    pub fn leaves(&self) -> Vec<&Quantity> {
        let Quantity::Formula(formula) = self else {
            return vec![self];
        };
        let leaves = formula.leaves.iter().flat_map(|leaf| match leaf {
            Leaf::Number(_) => Vec::new(),
            Leaf::Quantity(quantity) => quantity.leaves(),
        });
        leaves.collect()
    }

    /// Like [`leaves`](Self::leaves), mutable.
    pub fn leaves_mut(&mut self) -> Vec<&mut Quantity> {
        match self {
            Quantity::Formula(formula) => {
                let leaves = formula.leaves.iter_mut().flat_map(|leaf| match leaf {
                    Leaf::Number(_) => Vec::new(),
                    Leaf::Quantity(quantity) => quantity.leaves_mut(),
                });
                leaves.collect()
            }
            leaf => vec![leaf],
        }
    }

    /// True if the quantity is the magnitude of a vector.
    pub fn is_resultant(&self) -> bool {
        match self {
            // the angle of rotation in the plane is a single number
            Quantity::Rotation {
                what: RotationQuantity::Angle,
                ..
            } => false,
            Quantity::System {
                what: SystemQuantity::KineticEnergy,
                ..
            } => false,
            Quantity::Point { projection, .. }
            | Quantity::Rotation { projection, .. }
            | Quantity::JointLoad { projection, .. }
            | Quantity::ForceOn { projection, .. }
            | Quantity::ForceOnPoints { projection, .. }
            | Quantity::System { projection, .. } => projection.component == Component::Resultant,
            Quantity::OfForce { what, .. } => what.component() == Some(Component::Resultant),
            _ => false,
        }
    }
}

/// A load that a joint transmits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum JointLoadQuantity {
    /// Force at the joint \[N\].
    Force,
    /// Moment about the joint \[N m\].
    Moment,
}

/// Kinematics of a point, as seen by an observer who moves with a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum PointQuantity {
    /// Position relative to the origin of the observer's frame \[m\].
    Position,
    /// Position less initial position ("excursion") \[m\].
    Displacement,
    /// Velocity \[m/s\].
    Velocity,
    /// Second derivative of the position \[m/s²\].
    Acceleration,
    /// Reading of an accelerometer: acceleration less that of every field that acts on the element \[m/s²\].
    Accelerometer,
}

/// Rotation of a body, as seen by an observer who moves with another body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum RotationQuantity {
    /// (Bryant) angle \[rad\].
    Angle,
    /// Angular velocity \[rad/s\].
    AngularVelocity,
    /// Angular acceleration \[rad/s²\].
    AngularAcceleration,
}

/// The coordinate of a freedom of a joint, or a derivative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum FreedomQuantity {
    /// The coordinate \[rad\] or \[m\].
    Position,
    /// Rate of the coordinate.
    Rate,
    /// Second derivative of the coordinate.
    Acceleration,
}

/// A quantity of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum SystemQuantity {
    /// Kinetic energy \[J\].
    KineticEnergy,
    /// Momentum \[kg m/s\].
    Momentum,
    /// Angular momentum about the origin of the absolute frame \[kg m²/s\].
    AngularMomentum,
    /// Position of the centre of gravity \[m\].
    Position,
}

/// Duration and sampling of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Run {
    /// Duration \[s\], positive.
    pub duration: f64,
    /// Time between samples \[s\], positive.
    pub every: f64,
}
