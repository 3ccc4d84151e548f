//! The model resolved: indices instead of names, SI instead of units, every reference and every number proven.
//!
//! `description` holds what the user wrote, this module what it means. A [`Model`] can only be had from
//! [`read`] and [`read_str`], which report every problem they find; whoever holds one may rely on:
//! each system is one tree with parents before children; names are unique; masses are positive and inertias realisable
//! at the default parameters; all numbers are finite; curves have increasing abscissae; every index is in range; and
//! the mass matrix is not structurally singular.

pub mod airbag;
mod curve;
mod hysteresis;
mod joint;
mod normal;
mod number;
pub mod part;
mod requirement;
pub(crate) mod resolve;
pub mod rule;
pub mod scene;
mod switch;
mod unloading;
mod user;
pub mod webbing;

use std::fmt;

pub use crate::joint::{Follows, Freedom, FreedomKind, Joint};
pub use airbag::{Airbag, AirbagQuantity, Filled, Inflow};
pub use hysteresis::Hysteresis;
pub use joint::{Bending, Drive, Lock, Stop};
pub use number::Number;
pub use requirement::Requirement;
pub(crate) use resolve::is_keyword;
pub use resolve::{read, read_str, read_without_sources};
pub use rule::Rule;
pub use scene::Scene;
pub use switch::{Active, Switch, SwitchQuantity, Trigger};
pub use user::{
    Port, User, UserFreedom, UserFunction, UserLine, UserParameter, UserSource, UserState,
};
pub use webbing::{Pretensioner, Retractor, Ring};

/// A whole scene: systems of elements, the forces between them, what is to be printed.
#[derive(Clone, Debug, PartialEq)]
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
    /// SHA-256 of all of the above, as lower-case hexadecimal: of what the text means, not of how it is written.
    pub digest: String,
}

/// Number of space dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Motion in the x–z plane, one angle about +y per element (local x axis = (cos φ, −sin φ) in (x, z)).
    Plane,
    /// Motion in space.
    Space,
}

/// How orientation is described in space. In the plane there is one angle either way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinates {
    /// A unit quaternion (w, x, y, z), local to absolute; the velocity is ω in absolute axes. No singularity.
    Quaternion,
    /// Bryant angles, A = Rx(φ₁) Ry(φ₂) Rz(φ₃), absolute; the velocity is φ̇. Singular where cos φ₂ = 0:
    /// near there a run goes over to angles in another chart.
    Bryant,
}

/// A number that may be changed without compiling again.
#[derive(Clone, Debug, PartialEq)]
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
#[derive(Clone, Debug, PartialEq)]
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
}

/// Value of a curve between its points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolate {
    /// Straight lines.
    #[default]
    Linear,
    /// Cubics with a common slope at each point ([`Curve::tangent`]), monotone where the points are.
    Cubic,
}

/// Value of a curve beyond its first and last point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extrapolate {
    /// The outermost segment goes on, or the line that touches the outermost point.
    Linear,
    /// The outermost value stays.
    Hold,
    /// Leaving the range is a failure of the run: the curve yields NaN there.
    Error,
}

/// A curve scaled: `times · curve(argument / stretch)`.
#[derive(Clone, Debug, PartialEq)]
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
#[derive(Clone, Debug, PartialEq)]
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
#[derive(Clone, Debug, PartialEq)]
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
#[derive(Clone, Debug, PartialEq)]
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
#[derive(Clone, PartialEq)]
pub struct Translation {
    /// Which of the three the curves are.
    pub given: Given,
    /// Per absolute axis; displacements are 0 at t = 0 and have a continuous slope, and their v₀ is 0.
    pub curves: [Option<ScaledCurve>; 3],
    /// Where what is accelerated stays as soon as its velocity is 0, along each axis that has a curve: the line from 0 to 1, held there. Of
    /// time over the time at which that is, it says how much of the motion is over.
    pub stops: Option<ScaledCurve>,
}

impl Belt {
    /// The points that it runs straight between: its end `from`, its rings, its end `to`.
    pub fn points(&self) -> impl Iterator<Item = &Attachment> {
        let rings = self.rings.iter().map(|ring| &ring.on);
        std::iter::once(&self.from).chain(rings).chain([&self.to])
    }

    /// The same, to be changed.
    pub fn points_mut(&mut self) -> impl Iterator<Item = &mut Attachment> {
        let rings = self.rings.iter_mut().map(|ring| &mut ring.on);
        std::iter::once(&mut self.from)
            .chain(rings)
            .chain([&mut self.to])
    }
}

/// The digest of a model is made of this: what does not stop leaves no trace.
impl fmt::Debug for Translation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Translation {
            given,
            curves,
            stops,
        } = self;
        let mut text = f.debug_struct("Translation");
        text.field("given", given).field("curves", curves);
        if let Some(stops) = stops {
            text.field("stops", stops);
        }
        text.finish()
    }
}

/// What curves give of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Given {
    /// Displacement from the start \[m\].
    Displacement,
    /// Velocity \[m/s\].
    Velocity,
    /// Acceleration \[m/s²\].
    Acceleration,
}

/// One rigid element.
#[derive(Clone, PartialEq)]
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

/// The digest of a model is made of this: a ball joint leaves no trace.
impl fmt::Debug for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Element {
            name,
            parent,
            at,
            joint,
            mass,
            cg,
            inertia,
            axes,
            angles,
            angular_velocity,
        } = self;
        let mut text = f.debug_struct("Element");
        text.field("name", name)
            .field("parent", parent)
            .field("at", at)
            .field("mass", mass)
            .field("cg", cg)
            .field("inertia", inertia)
            .field("axes", axes)
            .field("angles", angles)
            .field("angular_velocity", angular_velocity);
        if *joint != Joint::Ball {
            text.field("joint", joint);
        }
        text.finish()
    }
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ElementId {
    /// Index into [`Model::systems`].
    pub system: usize,
    /// Index into [`System::elements`].
    pub element: usize,
}

/// What a point or a plane is attached to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// The absolute frame.
    Frame,
    /// An element.
    Element(ElementId),
    /// A vehicle: index into [`Model::vehicles`].
    Vehicle(usize),
}

/// A point fixed in a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Attachment {
    /// The body.
    pub on: Body,
    /// Position in the body's local frame \[m\].
    pub at: [Number; 3],
}

/// A named force interaction.
#[derive(Clone, Debug, PartialEq)]
pub struct Force {
    /// Name as in the YAML: "chest", or the element's path for a joint ("man/head"). Unique among its kind.
    pub name: String,
    /// The law.
    pub kind: ForceKind,
    /// When it acts.
    pub active: Active,
}

/// The four force interaction models of the paper, given loads, and the user's own.
#[derive(Clone, Debug, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "a scene has few forces, and an array is matched on more plainly than a box"
)]
pub enum ForceKind {
    /// Torque in the joint that carries `child`, between it and its parent (or the absolute frame, for a root).
    Joint {
        /// The element outboard of the joint.
        child: ElementId,
        /// Laws about the first, second, third Bryant angle of the relative rotation A_parentᵀ A_child.
        /// In the plane only the second is used, its angle being φ_child − φ_parent.
        about: [JointTorque; 3],
        /// Flexion and torsion, in space.
        bending: Option<Box<Bending>>,
    },
    /// Torque or force of one freedom of the joint that carries `child`, on its own coordinate.
    Freedom {
        /// The element outboard of the joint.
        child: ElementId,
        /// Index into its freedoms.
        freedom: usize,
        /// The law of the coordinate, in \[m\] and \[N\] where it slides.
        law: Box<JointTorque>,
    },
    /// Uniform acceleration field: a force m·a at the centre of gravity of every element of `on`.
    Field {
        /// Elements that feel it.
        on: Vec<ElementId>,
        /// Per absolute axis \[m/s²\].
        acceleration: [FieldComponent; 3],
    },
    /// Contact between an ellipsoid (an ellipse in the plane) and a plane (a line).
    Contact(Box<Contact>),
    /// A belt: a tensile force along the line between two attachments.
    Belt(Box<Belt>),
    /// Spring and damper between two points.
    Spring(Box<Spring>),
    /// An airbag.
    Airbag(Box<Airbag>),
    /// A given force and moment on an element.
    Load(Box<Load>),
    /// Forces computed by a function of the user's.
    User(Box<User>),
}

/// A given force and moment, absolute axes: thrust, actuation, a reaction known from a test.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Where the force acts.
    pub on: Attachment,
    /// Per absolute axis \[N\], constant or a curve of time.
    pub force: [FieldComponent; 3],
    /// Per absolute axis \[N m\], constant or a curve of time. In the plane only the second is used.
    pub moment: [FieldComponent; 3],
}

/// Torque about one relative rotation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointTorque {
    /// Elastic torque as a function of the relative angle less `neutral`: resists with −curve. \[rad\] → \[N m\].
    pub elastic: Option<ScaledCurve>,
    /// Relative angle at which the elastic curve has its zero abscissa \[rad\]; none is 0.
    pub neutral: Option<Number>,
    /// What unloading adds to the elastic curve, on both sides of its zero.
    pub hysteresis: Option<Hysteresis>,
    /// Viscous coefficient \[N m s/rad\]; none is 0.
    pub damping: Option<Number>,
    /// Coulomb friction torque; none is 0.
    pub friction: Option<Friction>,
    /// By what the friction holds; without one it is a function of speed.
    pub bristle: Option<Bristle>,
    /// Where the rotation ends.
    pub stop: Option<Stop>,
    /// What holds the angle from a switch on.
    pub lock: Option<Lock>,
    /// Torque of a motor \[N m\]; none is 0.
    pub motor: Option<FieldComponent>,
    /// What drives the angle to one that is given.
    pub drive: Option<Drive>,
}

/// Coulomb friction with a linear ramp through zero speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// Joint: torque \[N m\]. Contact: coefficient μ.
    pub limit: Number,
    /// Speed below which friction is proportional to speed \[rad/s\] or \[m/s\]; positive.
    pub tolerance: Number,
}

/// One component of an acceleration field, or of a given load; the torque of a motor.
#[derive(Clone, Debug, PartialEq)]
pub enum FieldComponent {
    /// Constant.
    Constant(Number),
    /// A curve of time \[s\].
    Curve(ScaledCurve),
}

/// Contact of an ellipsoid with a plane or another ellipsoid.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Centre of the ellipsoid.
    pub ellipsoid: Attachment,
    /// Semi-axes along the ellipsoid's own axes \[m\], positive. In the plane the first and third (x, z) are used.
    pub semi_axes: [Number; 3],
    /// Bryant angles of the ellipsoid's axes relative to the body's frame \[rad\]. In the plane only the second.
    pub axes: [Number; 3],
    /// n of Σ |x_i/a_i|ⁿ = 1, even: 2 is an ellipsoid, more are rounded boxes.
    pub degree: u32,
    /// What it meets, on another body.
    pub against: Against,
    /// Elastic force as a function of the perpendicular penetration: \[m\] → \[N\].
    pub elastic: Option<ScaledCurve>,
    /// Unloading along another curve than `elastic`, against the penetration \[m\].
    pub hysteresis: Option<Hysteresis>,
    /// Viscous coefficient on the penetration rate \[N s/m\]; the sum of elastic and viscous force is never below zero.
    pub damping: Option<Number>,
    /// Penetration up to which damping grows from 0 to its whole \[m\]; without one it is there at once.
    pub damping_depth: Option<Number>,
    /// Coulomb friction on the normal force.
    pub friction: Option<Friction>,
    /// By what friction holds; without one it only resists motion.
    pub bristle: Option<Bristle>,
}

/// A bristle by which friction holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Bristle {
    /// Deflection at which friction is fully there \[m\], in joints of what turns \[rad\].
    pub displacement: Number,
}

/// What an ellipsoid meets.
#[derive(Clone, Debug, PartialEq)]
pub enum Against {
    /// A plane.
    Plane(Plane),
    /// An ellipsoid; both are of degree 2 then.
    Ellipsoid(Ellipsoid),
}

impl Against {
    /// The body that it belongs to, and a point of it: of the plane, or the centre of the ellipsoid.
    pub fn place(&self) -> &Attachment {
        match self {
            Against::Plane(plane) => &plane.at,
            Against::Ellipsoid(ellipsoid) => &ellipsoid.center,
        }
    }

    /// The same, to be changed.
    pub fn place_mut(&mut self) -> &mut Attachment {
        match self {
            Against::Plane(plane) => &mut plane.at,
            Against::Ellipsoid(ellipsoid) => &mut ellipsoid.center,
        }
    }

    /// The plane, if it is one.
    pub fn plane(&self) -> Option<&Plane> {
        match self {
            Against::Plane(plane) => Some(plane),
            Against::Ellipsoid(_) => None,
        }
    }
}

/// A plane that an ellipsoid meets.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// A point of it.
    pub at: Attachment,
    /// Unit normal, in its body's local frame, pointing to the side where the ellipsoid belongs.
    pub normal: [Number; 3],
    /// In space: unit vector along it, in its body's local frame; a second one is normal × tangent.
    pub tangent: [Number; 3],
    /// Where it ends; without one nowhere.
    pub extent: Option<Extent>,
}

/// An ellipsoid that an ellipsoid meets.
#[derive(Clone, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Its centre.
    pub center: Attachment,
    /// As [`Contact::semi_axes`].
    pub semi_axes: [Number; 3],
    /// As [`Contact::axes`].
    pub axes: [Number; 3],
}

/// The finite extent of a plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Extent {
    /// From the point of the plane to its edges, along the tangent and, in space, along normal × tangent \[m\].
    pub half_lengths: Vec<Number>,
    /// What becomes of the force there.
    pub rule: EdgeRule,
}

/// What becomes of a contact's force at the edge of a plane.
#[derive(Clone, Debug, PartialEq)]
pub enum EdgeRule {
    /// It is there while the deepest point projects inside, and nowhere else.
    Cut,
    /// It fades over this width inside the edge \[m\].
    Fade(Number),
}

/// A belt between two attachments.
#[derive(Clone, Debug, PartialEq)]
pub struct Belt {
    /// One end.
    pub from: Attachment,
    /// The other end.
    pub to: Attachment,
    /// The rings that it runs through, in order from `from`.
    pub rings: Vec<Ring>,
    /// Tension as a function of the relative elongation (L − L₀)/L₀ → \[N\].
    pub force: ScaledCurve,
    /// Unloading along another curve than `force`, against the relative elongation.
    pub hysteresis: Option<Hysteresis>,
    /// Viscous coefficient on the rate of stretch \[N s/m\]; the tension is never below zero, and zero where slack.
    pub damping: Option<Number>,
    /// Stretch up to which damping grows from 0 to its whole \[m\]; without one it is there at once.
    pub damping_stretch: Option<Number>,
    /// Untensioned length L₀; of no meaning with a retractor.
    pub length: BeltLength,
    /// Pays out webbing until it locks. As the pretensioner and the limiter, it is at the end `from`.
    pub retractor: Option<Retractor>,
    /// By what the tension exceeds the spool's once the retractor has locked, against the webbing that has come off the reel since \[m\] → \[N\].
    pub film_spool: Option<ScaledCurve>,
    /// Takes webbing in once it fires.
    pub pretensioner: Option<Pretensioner>,
    /// Largest tension \[N\]; webbing is paid out for good where it would be larger.
    pub limiter: Option<Number>,
}

/// A spring and a damper side by side between two attachments, which pull and push.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// One end.
    pub from: Attachment,
    /// The other end.
    pub to: Attachment,
    /// Force as a function of the elongation \[m\] → \[N\], positive where it pulls.
    pub elastic: Option<ScaledCurve>,
    /// Length of no elongation \[m\]; without one, the distance of the attachments at the start.
    pub length: Option<Number>,
    /// Viscous coefficient on the rate of the length \[N s/m\].
    pub damping: Option<Number>,
}

/// How the untensioned length of a belt is given.
#[derive(Clone, Debug, PartialEq)]
pub enum BeltLength {
    /// Directly \[m\].
    Given(Number),
    /// Initial distance of the attachments plus this slack \[m\].
    Slack(Number),
    /// Such that the belt pulls with this force \[N\] at the initial distance.
    Pretension(Number),
}

/// A column of the output table.
#[derive(Clone, PartialEq)]
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
    /// The places of the dummy that are known, such as `neck-fx`, each with the name of the output that is there.
    pub places: Vec<(String, String)>,
}

/// The digest of a model is made of this: a code or a filter that there is not leaves no trace.
impl fmt::Debug for Output {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Output {
            name,
            quantity,
            unit,
            code,
            filter,
        } = self;
        let mut text = f.debug_struct("Output");
        text.field("name", name)
            .field("quantity", quantity)
            .field("unit", unit);
        if let Some(code) = code {
            text.field("code", code);
        }
        if let Some(filter) = filter {
            text.field("filter", filter);
        }
        text.finish()
    }
}

/// Component of a vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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

/// What an output measures.
#[derive(Clone, Debug, PartialEq)]
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
    /// The force of a contact, a belt or a spring on one of its two bodies.
    ForceOn {
        /// Index into [`Model::forces`], of kind [`ForceKind::Contact`], [`ForceKind::Belt`] or [`ForceKind::Spring`].
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
    /// Of a joint force.
    Joint {
        /// Index into [`Model::forces`], of kind [`ForceKind::Joint`] or [`ForceKind::Freedom`].
        force: usize,
        /// Which of the three relative rotations (1 in the plane); 3 is flexion, 4 torsion. Of a freedom 0.
        about: usize,
        /// What of it.
        what: JointQuantity,
    },
    /// Of a contact.
    Contact {
        /// Index into [`Model::forces`], of kind [`ForceKind::Contact`].
        force: usize,
        /// What of it.
        what: ContactQuantity,
    },
    /// The force of a belt that runs through rings, or of an airbag, on one of its bodies, of all its points there.
    ForceOnPoints {
        /// Index into [`Model::forces`], of kind [`ForceKind::Belt`] or [`ForceKind::Airbag`].
        force: usize,
        /// The points on that body: of a belt from its end `from` on, of an airbag what it is on and then what it meets.
        points: Vec<usize>,
        /// Which component.
        projection: Projection,
    },
    /// Of a belt.
    Belt {
        /// Index into [`Model::forces`], of kind [`ForceKind::Belt`].
        force: usize,
        /// The segment, or the ring, counted from the end `from`; 0 where there are no rings.
        part: usize,
        /// What of it.
        what: BeltQuantity,
    },
    /// Of an airbag.
    Airbag {
        /// Index into [`Model::forces`], of kind [`ForceKind::Airbag`].
        force: usize,
        /// What of it.
        what: AirbagQuantity,
    },
    /// Of a spring.
    Spring {
        /// Index into [`Model::forces`], of kind [`ForceKind::Spring`].
        force: usize,
        /// What of it.
        what: SpringQuantity,
    },
    /// Of a switch.
    Switch {
        /// Index into [`Model::switches`].
        switch: usize,
        /// What of it.
        what: SwitchQuantity,
    },
    /// Of a user force.
    User {
        /// Index into [`Model::forces`], of kind [`ForceKind::User`].
        force: usize,
        /// What of it.
        what: UserQuantity,
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
}

impl Quantity {
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
            _ => false,
        }
    }
}

/// What a joint transmits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointLoadQuantity {
    /// Force at the joint \[N\].
    Force,
    /// Moment about the joint \[N m\].
    Moment,
}

/// Kinematics of a point, as an observer sees it who rides on a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RotationQuantity {
    /// (Bryant) angle \[rad\].
    Angle,
    /// Angular velocity \[rad/s\].
    AngularVelocity,
    /// Angular acceleration \[rad/s²\].
    AngularAcceleration,
}

/// Of a freedom of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FreedomQuantity {
    /// Its coordinate \[rad\] or \[m\].
    Position,
    /// Its rate.
    Rate,
    /// The rate of that.
    Acceleration,
}

/// Of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointQuantity {
    /// Generalised torque on the child about the relative rotation \[N m\].
    Torque,
    /// Relative angle \[rad\].
    Angle,
    /// Its rate \[rad/s\].
    Rate,
    /// The angle beyond the neutral one that its hysteresis keeps \[rad\]; m where it slides.
    SetAbove,
    /// The same before the neutral angle, where it is negative.
    SetBelow,
}

/// Of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactQuantity {
    /// Resultant force \[N\].
    Force,
    /// Normal force \[N\].
    Normal,
    /// Friction force \[N\].
    Friction,
    /// Penetration, negative while apart \[m\].
    Penetration,
    /// Foot of the unloading line \[m\]; 0 without hysteresis.
    PermanentSet,
}

/// Of a belt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BeltQuantity {
    /// Tension \[N\].
    Force,
    /// Distance of the attachments \[m\].
    Length,
    /// (L − L₀)/L₀.
    Elongation,
    /// L₀ \[m\].
    UntensionedLength,
    /// Growth of L₀ since the start \[m\]; of a belt that runs through rings of all segments together.
    Payout,
    /// Untensioned length of webbing that has slipped through a ring since the start, from the side of `from` \[m\].
    Slip,
    /// Elongation at which the unloading line meets no force; 0 without hysteresis.
    PermanentSet,
}

/// Of a spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpringQuantity {
    /// Force, positive where it pulls \[N\].
    Force,
    /// Distance of the attachments \[m\].
    Length,
    /// Length less that of no elongation \[m\].
    Elongation,
    /// Rate of the length \[m/s\].
    Rate,
}

/// Of a user force; indices are into its points, bodies, lines, joints, states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UserQuantity {
    /// Force on a point \[N\].
    Force(usize, Projection),
    /// Moment on a body \[N m\]; in the plane the component is [`Component::Y`].
    Moment(usize, Projection),
    /// Tension in a line \[N\].
    Tension(usize),
    /// Length of a line \[m\].
    Length(usize),
    /// Its rate \[m/s\].
    LengthRate(usize),
    /// Torque in a joint about one relative rotation (1 in the plane) \[N m\].
    Torque(usize, usize),
    /// Relative angle \[rad\].
    Angle(usize, usize),
    /// Its rate \[rad/s\].
    AngleRate(usize, usize),
    /// Torque or force along a freedom of a joint \[N m\] or \[N\].
    Effort(usize),
    /// Value of a state.
    State(usize),
    /// Its rate.
    StateRate(usize),
}

/// Of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// \[s\], positive.
    pub duration: f64,
    /// Time between samples \[s\], positive.
    pub every: f64,
}
