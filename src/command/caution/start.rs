//! Remarks about the start of a run, or about declarations without effect, that are likely to be mistakes.
//!
//! Each remark states a fact with numbers; only the user knows whether it is intended.

use crate::pose::{Numbers, Pose, Vec3, dot};
use bryant_generator::law::ForceKind;
use bryant_generator::law::types::{Against, Contact};
use bryant_generator::model::annotated_model::AnnotatedModel;
use bryant_generator::model::{
    Active, Body, Bristle, Dimension, ElementId, Force, Friction, Model, Number, Reference, Trigger,
};

/// The start of a run.
pub struct Start<'a> {
    /// The model that is run.
    pub model: &'a Model,
    /// The values of its parameters.
    pub parameters: &'a [f64],
    /// The positions of its bodies.
    pub pose: Pose,
    /// The positions of its vehicles after the short time [`LATER`] \[s\].
    pub later: Pose,
    /// For each system the velocity of its reference joint \[m/s\], if that is free.
    pub velocities: Vec<Option<Vec3>>,
    /// True if the state was read from a file instead of following from the model.
    pub is_read: bool,
}

/// The time over which velocities of vehicles are computed by differences \[s\].
pub const LATER: f64 = 1e-6;
/// A smaller difference of velocities counts as none \[m/s\].
const SLOW: f64 = 1.0;
/// A body may be meant to touch a surface that moves relative to it more slowly than this, such as a parcel on a
/// conveyor \[m/s\].
const CONVEYED: f64 = 5.0;

/// A bristle of friction usually bends within about this time \[s\]; one that takes longer than [`SLUGGISH`] \[s\] is
/// held by its damper alone.
const BENDS: f64 = 0.01;
const SLUGGISH: f64 = 100.0;
/// A centre behind a plane by less than this share of its ellipsoid counts as on the plane.
const ROUNDING: f64 = 1e-6;

impl<'a> Start<'a> {
    /// The start of a model in its own initial state; `None` if it has no such state with these parameters.
    pub fn of_model(model: &'a Model, parameters: &'a [f64]) -> Option<Self> {
        let numbers = Numbers { model, parameters };
        let velocities = model.systems.iter().map(|system| {
            matches!(system.reference, Reference::Free).then(|| numbers.vector(&system.velocity))
        });
        Some(Start {
            model,
            parameters,
            pose: Pose::at_start(model, parameters, 0.0)?,
            later: Pose::at_start(model, parameters, LATER)?,
            velocities: velocities.collect(),
            is_read: false,
        })
    }

    /// All remarks about the start, each a sentence with a remedy. `scene` has what the user wrote.
    pub fn cautions(&self, scene: &AnnotatedModel) -> Vec<String> {
        let mut all = self.left_behind(scene);
        all.extend(self.behind_planes());
        all.extend(weightless(scene));
        all.extend(self.slow_bristles());
        all
    }

    /// Remarks about bristles that hold friction and need very long to bend.
    fn slow_bristles(&self) -> Vec<String> {
        let value = |number: &Number| number.value(self.parameters);
        let slow = |place: String, friction: &Option<Friction>, bristle: &Option<Bristle>, unit| {
            let (friction, bristle) = (friction.as_ref()?, bristle.as_ref()?);
            let (speed, displacement) = (value(&friction.tolerance), value(&bristle.displacement));
            let time = displacement / speed;
            (time > SLUGGISH).then(|| {
                format!(
                    "{place} holds by friction within `friction_displacement`, {displacement:e} {unit}, but at the `friction_speed` of {speed:e} {unit}/s \
                     its bristle takes {time:.0e} s to bend so far: the damper beside it is so strong that the run may take millions of steps\n  \
                     help: give a `friction_speed` near {:e} {unit}/s, or leave it out",
                    displacement / BENDS
                )
            })
        };
        let mut all = Vec::new();
        for force in &self.model.forces {
            match ForceKind::of(force) {
                ForceKind::Joint(law) => {
                    let bending = law.bending.iter();
                    let bending = bending.flat_map(|bending| [&bending.flexion, &bending.torsion]);
                    let torques = law.about.iter().chain(bending);
                    all.extend(torques.filter_map(|torque| {
                        let place = format!("joint \"{}\"", force.name);
                        slow(place, &torque.friction, &torque.bristle, "rad")
                    }));
                }
                ForceKind::Freedom(on) => {
                    let joint =
                        &self.model.systems[on.child.system].elements[on.child.element].joint;
                    let [unit, _] = joint.freedoms()[on.freedom].kind.coordinate().units();
                    let place = format!("joint \"{}\"", force.name);
                    all.extend(slow(place, &on.law.friction, &on.law.bristle, unit));
                }
                ForceKind::Contact(contact) => {
                    let place = format!("contact \"{}\"", force.name);
                    all.extend(slow(place, &contact.friction, &contact.bristle, "m"));
                }
                _ => {}
            }
        }
        all
    }

    /// The velocity of a point `at` that moves with a vehicle \[m/s\].
    fn vehicle_velocity(&self, vehicle: usize, at: Vec3) -> Vec3 {
        let [now, later] = [&self.pose, &self.later].map(|pose| pose.body(Body::Vehicle(vehicle)));
        let from: Vec3 = std::array::from_fn(|i| at[i] - now.origin[i]);
        let local = std::array::from_fn(|j| (0..3).map(|i| now.rotation[i][j] * from[i]).sum());
        let moved = later.point(local);
        std::array::from_fn(|i| (moved[i] - at[i]) / LATER)
    }

    /// Remarks about systems at rest that a force connects to a moving vehicle.
    fn left_behind(&self, scene: &AnnotatedModel) -> Vec<String> {
        let mut all = Vec::new();
        for (index, system) in self.model.systems.iter().enumerate() {
            let Some(own) = self.velocities[index] else {
                continue;
            };
            let written = scene
                .places
                .get(&format!("system {}", system.name), "start.velocity");
            let rests = length(own) == 0.0 && written.is_none();
            if !(self.is_read || rests) {
                continue;
            }
            let root = self.pose.frame(ElementId {
                system: index,
                element: 0,
            });
            let found = self.model.forces.iter().find_map(|force| {
                let (vehicle, least) = self.held_by(force, index)?;
                let speed = self.vehicle_velocity(vehicle, root.origin);
                let apart: Vec3 = std::array::from_fn(|i| speed[i] - own[i]);
                (length(apart) >= least).then_some((force, vehicle, speed))
            });
            if let Some((force, vehicle, speed)) = found {
                let (name, vehicle) = (&system.name, &self.model.vehicles[vehicle].name);
                let (kind, tie) = (force.law.key(), &force.name);
                let (own, fast) = (rounded(length(own)), rounded(length(speed)));
                let remedy = match self.is_read {
                    true => {
                        "let the state be one of a scene in which the vehicle is as fast".to_owned()
                    }
                    false => format!(
                        "give the system `start: {{ velocity: {} }}`; `velocity: {}` says that it rests",
                        self.components(speed),
                        self.components([0.0; 3])
                    ),
                };
                all.push(format!(
                    "\"{name}\" starts at {own} m/s, but \"{vehicle}\", to which its {kind} \"{tie}\" leads, at {fast} m/s\n  help: {remedy}"
                ));
            }
        }
        all
    }

    /// The vehicle that a force connects to a system, and the least difference of their velocities that deserves a
    /// remark \[m/s\].
    fn held_by(&self, force: &Force, system: usize) -> Option<(usize, f64)> {
        let least = match ForceKind::of(force) {
            ForceKind::Belt(_) | ForceKind::Spring(_) | ForceKind::Bushing(_) => SLOW,
            ForceKind::Contact(contact) if self.touches(contact, force.active) => CONVEYED,
            _ => return None,
        };
        let mut kind = force.law.clone();
        let bodies: Vec<Body> = kind.bodies_mut().into_iter().map(|body| *body).collect();
        let belongs = |body: &Body| matches!(body, Body::Element(id) if id.system == system);
        let vehicle = bodies.iter().find_map(|body| match body {
            Body::Vehicle(vehicle) => Some(vehicle),
            _ => None,
        });
        bodies.iter().any(belongs).then_some((*vehicle?, least))
    }

    /// True if an ellipsoid touches a plane: its centre is in front of the plane, and nearer than the ellipsoid
    /// reaches.
    fn touches(&self, contact: &Contact, active: Active) -> bool {
        let place = self.place(contact, active);
        place.is_some_and(|(height, reach)| 0.0 < height && height < reach)
    }

    /// The height of the centre of an ellipsoid over a plane that acts at the start, and how far the ellipsoid reaches
    /// towards the plane \[m\]. `None` if the contact does not act at the start, if the ellipsoid is beside the plane,
    /// and for two ellipsoids.
    fn place(&self, contact: &Contact, active: Active) -> Option<(f64, f64)> {
        let Against::Plane(plane) = &contact.against else {
            return None;
        };
        if active.since.is_some() || contact.elastic.is_none() {
            return None;
        }
        let numbers = Numbers {
            model: self.model,
            parameters: self.parameters,
        };
        let [centre, origin] =
            [&contact.ellipsoid.center, &plane.at].map(|place| self.pose.point(&numbers, place));
        let body = self.pose.body(plane.at.on);
        let local = numbers.vector(&plane.normal);
        let normal = body.direction(local);
        let from: Vec3 = std::array::from_fn(|i| centre[i] - origin[i]);
        if let Some(extent) = &plane.extent {
            let tangents = match self.model.dimension {
                Dimension::Plane => vec![[normal[2], 0.0, -normal[0]]],
                Dimension::Space => {
                    let first = body.direction(numbers.vector(&plane.tangent));
                    vec![first, cross(normal, first)]
                }
            };
            let mut inside = tangents.iter().zip(&extent.half_lengths);
            if inside.any(|(tangent, half)| dot(*tangent, from).abs() >= numbers.value(half)) {
                return None;
            }
        }
        let semi_axes = numbers.vector(&contact.ellipsoid.semi_axes);
        let used = match self.model.dimension {
            Dimension::Plane => &[0, 2][..],
            Dimension::Space => &[0, 1, 2][..],
        };
        let reach = used.iter().fold(0.0f64, |most, i| most.max(semi_axes[*i]));
        Some((dot(normal, from), reach))
    }

    /// Remarks about ellipsoids whose centre is behind the plane of their contact.
    fn behind_planes(&self) -> Vec<String> {
        let found = self.model.forces.iter().filter_map(|force| {
            let ForceKind::Contact(contact) = ForceKind::of(force) else {
                return None;
            };
            let (height, reach) = self.place(contact, force.active)?;
            (height < -ROUNDING * reach).then(|| {
                let body = name_of(self.model, contact.ellipsoid.center.on);
                format!(
                    "contact \"{}\" begins with {body} on the wrong side: the centre of its ellipsoid is {} m behind the plane, which pushes from there with all its force\n  \
                     help: the normal points to the side where the body belongs; turn it round, or move the body or the plane",
                    force.name,
                    rounded(-height)
                )
            })
        });
        found.collect()
    }

    /// The components of a velocity in the form of a model file.
    fn components(&self, [x, y, z]: Vec3) -> String {
        let [x, y, z] = [x, y, z].map(|v| rounded(v).to_string());
        match self.model.dimension {
            Dimension::Plane => format!("[{x}, {z}]"),
            Dimension::Space => format!("[{x}, {y}, {z}]"),
        }
    }
}

/// A remark about a model without any field, but with contacts, belts or airbags: in most of these scenes gravity was
/// forgotten. A field without acceleration says that nothing is to have weight.
fn weightless(scene: &AnnotatedModel) -> Option<String> {
    let model = &scene.model;
    let field = |force: &Force| {
        matches!(
            ForceKind::of(force),
            ForceKind::Field(_) | ForceKind::User(_)
        )
    };
    let holds = |force: &Force| {
        matches!(
            ForceKind::of(force),
            ForceKind::Contact(_) | ForceKind::Belt(_) | ForceKind::Airbag(_)
        )
    };
    // a field without acceleration is in the text alone, and so are forces that are switched off, which come last
    let written = &scene.written.forces;
    let any = written[..written.len() - scene.off].iter().any(field);
    (!any && model.forces.iter().any(holds)).then(|| {
        let (down, none) = match model.dimension {
            Dimension::Plane => ("[0, -1 gn]", "[0, 0]"),
            Dimension::Space => ("[0, 0, -1 gn]", "[0, 0, 0]"),
        };
        format!(
            "no field acts, so nothing has weight\n  help: gravity is a force of its own: `- {{ field: gravity, acceleration: {down} }}`; \
             if nothing is to have weight, say so: `- {{ field: none, acceleration: {none} }}`"
        )
    })
}

/// Remarks about items that a model file declares and never uses. Included files are not checked, because they may be
/// collections.
pub fn unused(scene: &AnnotatedModel) -> Vec<String> {
    let mut written = scene.written.clone();
    let mut used = vec![false; written.curves.len()];
    for curve in written.curve_uses_mut() {
        used[curve.curve] = true;
    }
    let curves = written.curves.iter().zip(used);
    let curves = curves
        .filter(|(_, used)| !used)
        .map(|(curve, _)| &curve.name);
    let mut mentioned = vec![false; written.parameters.len()];
    let mut written = scene.written.clone();
    for number in written.numbers_mut() {
        number.for_each_parameter(&mut |index| mentioned[index] = true);
    }
    let parameters = scene.written.parameters.iter().zip(mentioned);
    let parameters = parameters.filter(|(_, used)| !used).map(|(p, _)| &p.name);
    let declared = curves
        .map(|name| ("curve", name))
        .chain(parameters.map(|name| ("parameter", name)));
    let own = scene
        .read
        .first()
        .map(|path| bryant_generator::description::load::shown(path));
    let mut all: Vec<String> = declared
        .filter_map(|(kind, name)| {
            let place = scene.places.get(&format!("{kind} {name}"), "")?;
            let here = own.as_ref().is_none_or(|own| *own == place.file);
            here.then(|| {
                format!("the {kind} \"{name}\" ({place}) is used by nothing\n  help: name it where it is meant, or remove it")
            })
        })
        .collect();
    let switches = scene.written.switches.iter().map(|switch| &switch.name);
    let waited = scene.written.clone().used_switches();
    let idle = switches.zip(waited).filter(|(_, used)| !used);
    all.extend(idle.map(|(name, _)| {
        format!("nothing waits for the switch \"{name}\"\n  help: name it in `since`, `until` or `lock` of what it is meant for, or remove it")
    }));
    all
}

/// Remarks about switches that did not fire in a run. `memory` has its last state and `nearest` the smallest value of
/// each event function, both by name; the run ended at `end` \[s\].
pub fn unfired(
    model: &Model,
    parameters: &[f64],
    memory: impl Fn(&str) -> Option<f64>,
    nearest: impl Fn(&str) -> Option<f64>,
    end: f64,
) -> Vec<String> {
    let idle = model.switches.iter().filter_map(|switch| {
        let name = &switch.name;
        // memory holds the time at which the switch fired, or a very large time
        let fired = memory(&format!("switch {name}: fired"))? <= end;
        if fired {
            return None;
        }
        let missing = nearest(&format!("switch {name}: fires"))?;
        let unit = match switch.shown.0.as_str() {
            "" => String::new(),
            unit => format!(" {unit}"),
        };
        let shown = |value: f64| format!("{}{unit}", rounded(value / switch.shown.1));
        Some(match &switch.trigger {
            Trigger::Time(time) => format!(
                "the switch \"{name}\" did not fire: its time is {} s, and the run ends at {} s",
                rounded(time.value(parameters)),
                rounded(end)
            ),
            Trigger::Above(_, threshold) => {
                let threshold = threshold.value(parameters);
                format!(
                    "the switch \"{name}\" did not fire: the largest value is {}, the threshold {}",
                    shown(threshold - missing),
                    shown(threshold)
                )
            }
            Trigger::Below(_, threshold) => {
                let threshold = threshold.value(parameters);
                format!(
                    "the switch \"{name}\" did not fire: the smallest value is {}, the threshold {}",
                    shown(threshold + missing),
                    shown(threshold)
                )
            }
        })
    });
    idle.collect()
}

/// A message, with a remedy, about a ball joint with laws about three axes whose middle angle is close to ±90°.
pub fn near_right_angle(model: &Model, pose: &Pose) -> Option<[String; 2]> {
    /// Distance from ±90° that counts as close, 20° \[rad\].
    const NEAR: f64 = 20.0 * std::f64::consts::PI / 180.0;
    let joints = model
        .forces
        .iter()
        .filter_map(|force| match ForceKind::of(force) {
            ForceKind::Joint(law) => Some((force, law)),
            _ => None,
        });
    joints.filter(|_| model.dimension == Dimension::Space).find_map(|(force, law)| {
        let [first, middle, last] = law.order.0;
        let axes = ["x", "y", "z"];
        let none = Default::default();
        if law.about[first] == none && law.about[last] == none {
            return None;
        }
        let system = &model.systems[law.child.system];
        let carrier = match (system.elements[law.child.element].parent, &system.reference) {
            (Some(element), _) => Body::Element(ElementId { element, ..law.child }),
            (None, Reference::Riding { vehicle, .. }) => Body::Vehicle(*vehicle),
            (None, _) => Body::Frame,
        };
        let [carrier, child] = [carrier, Body::Element(law.child)].map(|body| pose.body(body));
        let column = |rotation: [Vec3; 3], i: usize| rotation.map(|row| row[i]);
        let sine = law.order.hand() * dot(column(carrier.rotation, first), column(child.rotation, last));
        let angle = libm::asin(sine.clamp(-1.0, 1.0));
        (angle.abs() > std::f64::consts::FRAC_PI_2 - NEAR).then(|| {
            [
                format!(
                    "joint \"{}\" is turned by {:.0}° about {}; near ±90° its laws about {} and {} have no direction, and steps become very small",
                    force.name,
                    angle.to_degrees(),
                    axes[middle],
                    axes[first],
                    axes[last]
                ),
                "end this rotation by stops within ±80°, or let another rotation be the middle one of the three (`about: { order: yxz, … }`), or use `flexion` and `torsion`".to_owned(),
            ]
        })
    })
}

fn name_of(model: &Model, body: Body) -> String {
    match body {
        Body::Frame => "the frame".to_owned(),
        Body::Vehicle(index) => format!("\"{}\"", model.vehicles[index].name),
        Body::Element(id) => {
            let system = &model.systems[id.system];
            format!("\"{}/{}\"", system.name, system.elements[id.element].name)
        }
    }
}

fn length(vector: Vec3) -> f64 {
    dot(vector, vector).sqrt()
}

fn cross([a, b, c]: Vec3, [x, y, z]: Vec3) -> Vec3 {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// Rounds to three digits.
fn rounded(x: f64) -> f64 {
    format!("{x:.2e}").parse::<f64>().map_or(x, |x| x + 0.0)
}
