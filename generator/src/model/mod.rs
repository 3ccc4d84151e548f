//! The model resolved: indices instead of names, SI instead of units, every reference and every number proven.
//!
//! `description` holds what the user wrote, this module what it means. A [`Model`] can only be had from
//! [`read`] and [`read_str`], which report every problem they find; whoever holds one may rely on:
//! each system is one tree with parents before children; names are unique; masses are positive and inertias realisable
//! at the default parameters; all numbers are finite; curves have increasing abscissae; every index is in range; and
//! the mass matrix is not structurally singular.

mod curve;
mod digest;
mod hysteresis;
mod normal;
mod number;
pub mod part;
pub(crate) mod requirement;
pub(crate) mod resolve;
pub mod rule;
pub mod scene;
mod switch;
mod thin;
pub mod units;
pub(crate) mod unloading;

use serde::Serialize;

pub use crate::joint::{Follows, Freedom, FreedomKind, Joint};
pub use crate::law::types::*;
pub use crate::law::{Asked, ForceKind};
pub use hysteresis::Hysteresis;
pub use number::Number;
pub use requirement::Requirement;
pub(crate) use resolve::is_keyword;
pub use resolve::{read, read_str, read_without_sources};
pub use rule::Rule;
pub use scene::Scene;
pub use switch::{Active, Switch, SwitchQuantity, Trigger};
pub use units::Units;

/// A whole scene: systems of elements, the forces between them, what is to be printed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Model {
    /// Name of the model, kebab-case as in the YAML.
    pub name: String,
    /// One sentence for listings; empty where the YAML gives none.
    pub title: String,
    /// Motion in the x–z plane or in space.
    pub dimension: Dimension,
    /// Which coordinates describe orientation.
    pub coordinates: Coordinates,
    /// What the YAML left adjustable.
    pub parameters: Vec<Parameter>,
    /// Piecewise functions of one variable.
    pub curves: Vec<Curve>,
    /// Bodies whose motion is given.
    pub vehicles: Vec<Vehicle>,
    /// The trees.
    pub systems: Vec<System>,
    /// What acts on them.
    pub forces: Vec<Force>,
    /// What happens once and is waited for.
    pub switches: Vec<Switch>,
    /// What the scene asks to see, in the order of the table's columns.
    pub outputs: Vec<Output>,
    /// Duration and sampling of a run.
    pub run: Run,
    /// Surfaces that meet nothing, and meshes, for pictures; at the default parameters.
    #[serde(skip)]
    pub shown: Vec<Shown>,
    /// The units in which outputs are shown.
    #[serde(skip)]
    pub units: Units,
    /// SHA-256 of all of the above that changes a motion or an output, as lower-case hexadecimal: of what the text means, not of how it is written. See [`Model::sha256`].
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

/// How orientation is described in space. In the plane there is one angle either way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Coordinates {
    /// A unit quaternion (w, x, y, z), local to absolute; the velocity is ω in absolute axes. No singularity.
    Quaternion,
    /// Bryant angles, A = Rx(φ₁) Ry(φ₂) Rz(φ₃), absolute; the velocity is φ̇. Singular where cos φ₂ = 0:
    /// near there a run goes over to angles in another chart.
    Bryant,
}

/// A number that may be changed without compiling again.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// A Rust identifier in snake case.
    pub name: String,
    /// Value where nobody sets another (SI).
    pub default: f64,
    /// Smallest value allowed (SI).
    pub min: Option<f64>,
    /// Largest value allowed (SI).
    pub max: Option<f64>,
    /// SI unit as text, "" where the number has none or it is unknown.
    pub unit: String,
}

/// A function through points (SI).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Curve {
    /// Name in the YAML, or one made of the force it was written in ("belt chest force").
    pub name: String,
    /// (abscissa, ordinate), abscissae strictly increasing, at least two points.
    pub points: Vec<[f64; 2]>,
    /// What holds between the points.
    pub interpolate: Interpolate,
    /// What holds outside the points.
    pub extrapolate: Extrapolate,
    /// Whether the description says so: a run in which a curve is left that was merely not told otherwise deserves a doubt.
    pub told: bool,
    /// What was left out of its file; `None` if nothing was.
    #[serde(skip)]
    pub thinned: Option<Thinned>,
}

/// Points that a curve does not have, because its file has too many.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thinned {
    /// Number of points in the file.
    pub points: usize,
    /// Largest distance of the points that were left out from the curve, in the SI unit of its ordinate.
    pub error: f64,
}

/// Value of a curve between its points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub enum Interpolate {
    /// Straight lines.
    #[default]
    Linear,
    /// Cubics with a common slope at each point ([`Curve::tangent`]), monotone where the points are.
    Cubic,
}

/// Value of a curve beyond its first and last point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Extrapolate {
    /// The outermost segment goes on, or the line that touches the outermost point.
    Linear,
    /// The outermost value stays.
    Hold,
    /// Leaving the range is a failure of the run: the curve yields NaN there.
    Error,
}

/// A curve scaled: `times · curve(argument / stretch)`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScaledCurve {
    /// Index into [`Model::curves`].
    pub curve: usize,
    /// Factor on the ordinate.
    pub times: Number,
    /// Factor on the abscissa, positive.
    pub stretch: Number,
    /// Whether it is a line through 0 that was written as its slope, `stiffness`: the factor is then never negative.
    pub stiffness: bool,
}

/// A rigid body whose motion is given: it has no mass and no equation. Every vehicle of a model is used by something.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Vehicle {
    /// Name, unique among the vehicles and systems.
    pub name: String,
    /// Position of its origin at t = 0, absolute frame \[m\].
    pub position: [Number; 3],
    /// Velocity of its origin at t = 0, as far as curves do not say it \[m/s\].
    pub velocity: [Number; 3],
    /// How the origin moves.
    pub translation: Translation,
    /// Bryant angles, absolute \[rad\]; curves have a continuous slope. In the plane only the second (about y) is used.
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
    /// What the reference joint does.
    pub reference: Reference,
    /// Initial position of the reference joint, absolute frame \[m\]. In the plane the second component is 0.
    pub position: [Number; 3],
    /// Initial velocity of the reference joint, absolute frame \[m/s\]; where it is prescribed, as far as its curves do not
    /// say it.
    pub velocity: [Number; 3],
}

/// Motion of a reference joint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Reference {
    /// Its coordinates are unknowns.
    Free,
    /// It stays where [`System::position`] puts it.
    Fixed,
    /// It moves as given, from [`System::position`] with [`System::velocity`].
    Prescribed(Translation),
    /// It moves with a point of a vehicle; [`System::position`] is where that is at t = 0.
    Riding {
        /// Index into [`Model::vehicles`].
        vehicle: usize,
        /// The point, the vehicle's local frame \[m\].
        at: [Number; 3],
    },
}

/// A given translation x(t), per absolute axis from the position x₀ and the velocity v₀ of a start:
///
/// x = x₀ + c,   x = x₀ + v₀ t + ∫ c   or   x = x₀ + v₀ t + ∬ c
///
/// with a curve of time c, or none, which is 0. All else follows in closed form.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Translation {
    /// Which of the three the curves are.
    pub given: Given,
    /// Per absolute axis; displacements are 0 at t = 0 and have a continuous slope, and their v₀ is 0.
    pub curves: [Option<ScaledCurve>; 3],
    /// Where what is accelerated stays as soon as its velocity is 0, along each axis that has a curve: the line from 0 to 1, held there. Of
    /// time over the time at which that is, it says how much of the motion is over.
    pub stops: Option<ScaledCurve>,
}

/// What curves give of a motion.
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
    /// Name, unique in its system; a Rust identifier once dashes are underscores.
    pub name: String,
    /// Index of the parent in the same system; `None` for element 0 alone.
    pub parent: Option<usize>,
    /// The joint on the parent, parent's local frame \[m\]; zero for the root.
    pub at: [Number; 3],
    /// What the joint lets it do.
    pub joint: Joint,
    /// Mass \[kg\].
    pub mass: Number,
    /// Centre of gravity, local frame \[m\].
    pub cg: [Number; 3],
    /// Principal moments of inertia about the centre of gravity \[kg m²\]. In the plane only the second (about y) is used.
    pub inertia: [Number; 3],
    /// Bryant angles of the principal axes relative to the local frame \[rad\]; zero where the axes are the frame's.
    pub axes: [Number; 3],
    /// Initial Bryant angles on a ball joint, absolute \[rad\]. In the plane only the second (about y) is used.
    pub angles: [Number; 3],
    /// Initial angular velocity on a ball joint: in space ω in absolute axes \[rad/s\]; in the plane only the second component is used.
    pub angular_velocity: [Number; 3],
}

impl System {
    /// Whether all its joints are balls, or hinges in the plane: every orientation is absolute then.
    pub fn has_balls_alone(&self) -> bool {
        self.elements.iter().all(|e| e.joint == Joint::Ball)
    }

    /// All freedoms of its joints.
    pub fn freedoms(&self) -> impl Iterator<Item = &Freedom> {
        self.elements.iter().flat_map(|e| e.joint.freedoms())
    }

    /// Whether a freedom follows another: then more of S is not 0 than the tree says.
    pub fn is_coupled(&self) -> bool {
        self.freedoms().any(|freedom| !freedom.is_own())
    }
}

/// Place of an element: system and element index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct ElementId {
    /// Index into [`Model::systems`].
    pub system: usize,
    /// Index into [`System::elements`].
    pub element: usize,
}

/// What a point or a plane is attached to.
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
    /// Name as in the YAML: "chest", or the element's path for a joint ("man/head"). Unique among its kind.
    pub name: String,
    /// The law.
    pub kind: ForceKind,
    /// When it acts.
    pub active: Active,
}

/// Coulomb friction with a linear ramp through zero speed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Friction {
    /// Joint: torque \[N m\]. Contact: coefficient μ.
    pub limit: Number,
    /// Speed below which friction is proportional to speed \[rad/s\] or \[m/s\]; positive.
    pub tolerance: Number,
}

/// One component of an acceleration field, or of a given load; the torque of a motor.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum FieldComponent {
    /// Constant.
    Constant(Number),
    /// A curve of time \[s\].
    Curve(ScaledCurve),
}

/// A bristle by which friction holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bristle {
    /// Deflection at which friction is fully there \[m\], in joints of what turns \[rad\].
    pub displacement: Number,
}

/// A column of the output table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Output {
    /// Heading, unique.
    pub name: String,
    /// What is measured.
    pub quantity: Quantity,
    /// SI unit of the values.
    pub unit: String,
    /// Channel code of ISO-MME, 16 letters and digits, unique.
    pub code: Option<String>,
    /// The filter that tables, responses and studies apply: `CFC60`, `CFC180`, `CFC600` or `CFC1000`, of SAE J211-1 with `SAE` in front. The generated code has what
    /// is not filtered.
    pub filter: Option<&'static str>,
    /// What it is as a channel of a test: of an output with a code that says a direction, or that the criteria name.
    pub channel: Option<Channel>,
}

/// An output in the axes and signs of SAE J211-1 and ISO 6487: x forward, y to the right, z down; loads are those of the lower part on the
/// upper one, of a body that stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Channel {
    /// Whether it is the opposite of the quantity.
    pub reversed: bool,
    /// What is to be known of its place.
    #[serde(skip)]
    pub remark: Option<&'static str>,
}

/// By what a run is judged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Criteria {
    /// The regulation.
    pub standard: String,
    /// The dummy.
    pub dummy: String,
    /// Whether filters are those of SAE J211-1, and not of ISO 6487.
    pub sae: bool,
    /// Test object and position of the occupant, the first two characters of the codes of its outputs; `None` if there is one only.
    pub occupant: Option<String>,
    /// The places of the dummy that are known, such as `neck-fx`, each with the name of the output that is there.
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

/// One number of a vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Projection {
    /// Which component.
    pub component: Component,
    /// The body along whose axes.
    pub axes: Body,
}

impl Projection {
    /// In absolute axes.
    pub fn absolute(component: Component) -> Projection {
        Projection {
            component,
            axes: Body::Frame,
        }
    }
}

impl Projection {
    /// Whether it is not 0 by itself, of a vector in the plane x–z.
    pub fn lies_in_plane(self) -> bool {
        self.component != Component::Y
    }

    /// Whether it is not 0 by itself, of a vector along y.
    pub fn is_about_y(self) -> bool {
        matches!(self.component, Component::Y | Component::Resultant)
    }
}

/// What an output measures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Quantity {
    /// Kinematics of a point of an element or a vehicle.
    Point {
        /// The body; never the absolute frame.
        body: Body,
        /// The point, local frame \[m\]; the centre of gravity is resolved to its coordinates.
        at: [Number; 3],
        /// Which derivative; of an element alone what an accelerometer reads.
        what: PointQuantity,
        /// The body that the observer rides on.
        relative_to: Body,
        /// Which component.
        projection: Projection,
    },
    /// Rotation of an element or a vehicle; in the plane the component is always [`Component::Y`].
    Rotation {
        /// The body; never the absolute frame.
        body: Body,
        /// Which derivative.
        what: RotationQuantity,
        /// The body that the observer rides on.
        relative_to: Body,
        /// Which component. Of angles X, Y, Z are the first, second, third Bryant angle, and the resultant is the angle of the one
        /// turn that leads from the observer's axes to those of the body; axes mean nothing.
        projection: Projection,
    },
    /// What a joint transmits.
    JointLoad {
        /// The element that the joint carries.
        element: ElementId,
        /// What of it.
        what: JointLoadQuantity,
        /// Whether that on the carrier is meant, which is opposite to that on the element.
        on_carrier: bool,
        /// Which component.
        projection: Projection,
    },
    /// The force of a law between two bodies on one of them.
    ForceOn {
        /// Index into [`Model::forces`].
        force: usize,
        /// Whether that on the second body is meant, which is opposite to that on the first: the first is that of a contact's
        /// `ellipsoid`, or of the end `from`.
        on_second: bool,
        /// Which component.
        projection: Projection,
    },
    /// Of a freedom of a joint.
    Freedom {
        /// The element that the joint carries.
        element: ElementId,
        /// Index into its freedoms.
        freedom: usize,
        /// Which derivative of its coordinate.
        what: FreedomQuantity,
    },
    /// The force of a belt that runs through rings, or of an airbag, on one of its bodies, of all its points there.
    ForceOnPoints {
        /// Index into [`Model::forces`].
        force: usize,
        /// The points on that body: of a belt from its end `from` on, of an airbag what it is on and then what it meets.
        points: Vec<usize>,
        /// Which component.
        projection: Projection,
    },
    /// A quantity of a law.
    OfForce {
        /// Index into [`Model::forces`].
        force: usize,
        /// What of it.
        what: Asked,
    },
    /// Of a switch.
    Switch {
        /// Index into [`Model::switches`].
        switch: usize,
        /// What of it.
        what: SwitchQuantity,
    },
    /// Of a whole system.
    System {
        /// Index into [`Model::systems`].
        system: usize,
        /// What of it.
        what: SystemQuantity,
        /// Which component, where it is a vector.
        projection: Projection,
    },
    /// Arithmetic of others.
    Formula(Box<Formula>),
}

/// Arithmetic of quantities, in SI.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Formula {
    /// The arithmetic. Its parameters are not those of the model, but the indices of the leaves.
    pub value: Number,
    /// What it is made of.
    pub leaves: Vec<Leaf>,
}

/// What stands in a formula.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Leaf {
    /// An expression of the model's parameters.
    Number(Number),
    /// A quantity.
    Quantity(Quantity),
}

impl Quantity {
    /// What is looked at: of a formula all that stands in it, of others themselves.
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

    /// The same, to be changed.
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

    /// Whether it is the length of a vector.
    pub fn is_resultant(&self) -> bool {
        match self {
            // in the plane one number
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

/// What a joint transmits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum JointLoadQuantity {
    /// Force at the joint \[N\].
    Force,
    /// Moment about the joint \[N m\].
    Moment,
}

/// Kinematics of a point, as an observer sees it who rides on a body.
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
    /// What an accelerometer reads there: acceleration less every field that acts on the element \[m/s²\].
    Accelerometer,
}

/// Rotation of a body, as an observer sees it who rides on another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum RotationQuantity {
    /// (Bryant) angle \[rad\].
    Angle,
    /// Angular velocity \[rad/s\].
    AngularVelocity,
    /// Angular acceleration \[rad/s²\].
    AngularAcceleration,
}

/// Of a freedom of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum FreedomQuantity {
    /// Its coordinate \[rad\] or \[m\].
    Position,
    /// Its rate.
    Rate,
    /// The rate of that.
    Acceleration,
}

/// Of a system.
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
    /// \[s\], positive.
    pub duration: f64,
    /// Time between samples \[s\], positive.
    pub every: f64,
}
