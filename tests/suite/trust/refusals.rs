//! Every number of every law at −1, 0, what is no number, and extremes, as a constant and as a parameter, in single
//! runs, in rows of a study and in gradients: what is refused of one is refused of the others, in the same words, and
//! what is not refused gives finite results or says that it cannot.

use super::{read, run, sound};
use crate::share::share;
use bryant::accuracy::check::{self as accuracy, Verdict};
use bryant::equations::Engine;
use bryant::simulation::Recording;
use bryant::sweep;
use bryant_generator::model::Model;
use bryant_runtime::batch::rows::{Asked, Job as RowsJob};
use bryant_runtime::batch::{Pace, Settings, Status};
use bryant_runtime::program::{ErrorKind, Job};
use bryant_runtime::simulate::ENERGY_LIMIT;
use bryant_runtime::{Response, Tolerances, Width};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

const HEAD: &str = "
curves:
  line: { points: [[0, 0], [1, 1000]], extrapolate: linear }
  through: { points: [[-1, -50], [1, 50]], extrapolate: linear }
  ends: { points: [[0, 0], [1, 1000]] }
  soft: { points: [[-1, -5], [0, 0], [1, 8]], extrapolate: linear }
  low: { points: [[0, 0], [1, 300]], extrapolate: linear }
  pull: { points: [[0, 0], [0.01, 0.02]] }
  pulse: { points: [[0, 0], [0.01, 3], [0.02, 0]] }
";

/// A number stands as `<path=value>`; where a key has several, they are told apart by what is behind `#`.
const SCENES: [&str; 10] = [
    "model: belts
dimension: 2
HEAD
systems:
  - name: one
    elements: [{ name: body, mass: <mass=1>, cg: [0, 0], inertia: <inertia=1e-3> }]
    start: { position: [0, -0.3], velocity: [0, -1] }
forces:
  - belt: a
    from: { on: one/body, at: [<from.at=0>, <from.at#2=0.01>] }
    to: { on: frame, at: [<to.at=0>, <to.at#2=0>] }
    force: { curve: line, times: <force.times=1>, stretch: <force.stretch=1> }
    unloading: { curve: low, times: <unloading.times=1>, stretch: <unloading.stretch=1> }
    unloading_slope: <unloading_slope=20000>
    damping: <damping=5>
    damping_stretch: <damping_stretch=1e-3>
    length: <length=0.25>
    limiter: { force: <limiter=200> }
  - belt: b
    from: { on: one/body, at: [0, 0] }
    to: { on: frame, at: [0.1, 0] }
    force: line
    slack: <slack=0.01>
  - belt: c
    from: { on: one/body, at: [0, 0] }
    to: { on: frame, at: [0.1, 0] }
    force: ends
    pretension: <pretension=10>
    pretensioner: { fire: fire, retract: { curve: pull, times: <pretensioner.retract.times=1>, stretch: <pretensioner.retract.stretch=1> } }
  - belt: d
    from: { on: one/body, at: [0, 0] }
    to: { on: frame, at: [-0.1, 0] }
    force: ends
    retractor: { lock: fire, spool: <retractor.spool=5> }
    limiter: { force: 300 }
switches: [{ switch: fire, when: { time: 5 ms }, after: <after=0.001> }]
outputs:
  - { name: a, of: belt a, what: force }
  - { name: b, of: belt b, what: force }
  - { name: c, of: belt c, what: force }
  - { name: d, of: belt d, what: force }
  - { name: z, of: one/body, what: position, component: z }
run: { duration: 20 ms, every: 2 ms }
",
    "model: contacts
dimension: 2
HEAD
systems:
  - name: ball
    elements: [{ name: body, mass: 1, cg: [0, 0], inertia: 1e-3 }]
    start: { position: [0, 0.095], velocity: [0.3, -1] }
  - name: other
    elements: [{ name: body, mass: 1, cg: [0, 0], inertia: 1e-3 }]
    start: { position: [0, 0.27], velocity: [0, -1] }
forces:
  - contact: floor
    ellipsoid: { on: ball/body, center: [<ellipsoid.center=0>, <ellipsoid.center#2=0.001>], semi_axes: [<ellipsoid.semi_axes[0]=0.12>, <ellipsoid.semi_axes[1]=0.1>], axes: <ellipsoid.axes=0.1> }
    plane: { on: frame, at: [<plane.at=0>, <plane.at#2=0>], normal: [<plane.normal=0.1>, <plane.normal#2=1>], extent: <plane.extent=0.5>, edge: { width: <plane.edge.width=0.02> } }
    elastic: { curve: line, times: <elastic.times=10>, stretch: <elastic.stretch=1> }
    unloading_slope: <unloading_slope=20000>
    damping: <damping=5>
    damping_depth: <damping_depth=1e-3>
    friction: <friction=0.3>
    friction_speed: <friction_speed=0.01>
    friction_displacement: <friction_displacement=1e-4>
  - contact: plain
    ellipsoid: { on: other/body, center: [0, 0], semi_axes: [0.09, 0.1] }
    plane: { on: frame, at: [0, 0], normal: [0, 1], extent: <plane.extent=0.5> }
    elastic: line
  - contact: two
    ellipsoid: { on: other/body, center: [0, 0], semi_axes: [0.09, 0.1] }
    with: { on: ball/body, center: [<with.center=0>, <with.center#2=0>], semi_axes: [<with.semi_axes[0]=0.08>, <with.semi_axes[1]=0.1>], axes: <with.axes=0.2> }
    elastic: line
    damping: 2
    friction: 0.2
outputs:
  - { name: floor, of: contact floor, what: force }
  - { name: two, of: contact two, what: force }
  - { name: z, of: ball/body, what: position, component: z }
run: { duration: 20 ms, every: 2 ms }
",
    "model: hinges
dimension: 2
HEAD
systems:
  - name: rod
    reference: fixed
    elements: [{ name: body, mass: 1, cg: [0.1, 0], inertia: 1e-2 }]
    start: { angles: { body: 0.3 }, rates: { body: 4 } }
forces:
  - joint: rod/body
    elastic: { curve: through, times: <elastic.times=1>, stretch: <elastic.stretch=1> }
    neutral: <neutral=0.1>
    damping: <damping=0.2>
    friction: <friction=0.5>
    friction_speed: <friction_speed=0.1>
    stop: { from: <stop.from=-0.2>, to: <stop.to=0.32>, stiffness: <stop.stiffness=30>, damping: <stop.damping=0.1>, damping_angle: <stop.damping_angle=0.01> }
    lock: { by: shut, stiffness: <lock.stiffness=10>, damping: <lock.damping=0.1> }
  - joint: rod/body
    name: foam
    stiffness: <stiffness=20>
    unloading: { curve: soft, times: <unloading.times=1>, stretch: <unloading.stretch=1> }
    unloading_slope: <unloading_slope=1000>
    friction: 0.3
    friction_displacement: <friction_displacement=1e-3>
    motor: { curve: pulse, times: <motor.times=0.2>, stretch: <motor.stretch=1> }
    drive: { to: { curve: pulse, times: <drive.to.times=0.1>, stretch: <drive.to.stretch=1> }, stiffness: <drive.stiffness=20>, damping: <drive.damping=0.2>, limit: <drive.limit=3> }
  - { joint: rod/body, name: steady, motor: <motor=0.5>, drive: { to: <drive.to=0.1>, stiffness: 1 } }
  - { field: gravity, acceleration: [<acceleration[0]=0>, { curve: pulse, times: <acceleration[1].times=1>, stretch: <acceleration[1].stretch=1> }] }
  - { load: push, on: rod/body, at: [<at=0.1>, <at#2=0>], force: [<force[0]=1>, <force[1]=2>], moment: <moment=0.5> }
  - { load: pull, on: rod/body, force: [{ curve: pulse, times: <force[0].times=0.1>, stretch: <force[0].stretch=1> }, 0] }
switches: [{ switch: shut, when: { time: 10 ms } }]
outputs:
  - { name: torque, of: joint rod/body, what: torque }
  - { name: angle, of: joint rod/body, what: angle }
run: { duration: 20 ms, every: 2 ms }
",
    "model: balls
dimension: 3
HEAD
systems:
  - name: arm
    reference: fixed
    elements: [{ name: body, mass: 1, cg: [0, 0, 0.1], inertia: [<inertia[0]=1e-2>, <inertia[1]=1.1e-2>, <inertia[2]=5e-3>] }]
    start: { angles: { body: [0.3, 0.2, 0.1] }, rates: { body: [1, 2, 3] } }
forces:
  - joint: arm/body
    axis: z
    about:
      x: { elastic: { curve: through, times: <about.x.elastic.times=1>, stretch: <about.x.elastic.stretch=1> }, neutral: <about.x.neutral=0.1>, damping: <about.x.damping=0.1>, friction: <about.x.friction=0.2>, friction_speed: <about.x.friction_speed=0.1>, stop: { from: <about.x.stop.from=-1>, to: <about.x.stop.to=0.3>, stiffness: <about.x.stop.stiffness=10>, damping: <about.x.stop.damping=0.1>, damping_angle: <about.x.stop.damping_angle=0.01> }, lock: { by: shut, stiffness: <about.x.lock.stiffness=10>, damping: <about.x.lock.damping=0.1> } }
    flexion: { elastic: { curve: line, times: <flexion.elastic.times=0.01>, stretch: <flexion.elastic.stretch=1> }, unloading_slope: <flexion.unloading_slope=100>, damping: <flexion.damping=0.1>, friction: <flexion.friction=0.1>, friction_speed: <flexion.friction_speed=0.1>, stop: { to: <flexion.stop.to=0.3>, stiffness: <flexion.stop.stiffness=10>, damping: <flexion.stop.damping=0.1>, damping_angle: <flexion.stop.damping_angle=0.01> } }
    torsion: { elastic: { curve: through, times: <torsion.elastic.times=1>, stretch: <torsion.elastic.stretch=1> }, neutral: <torsion.neutral=0.05>, damping: <torsion.damping=0.1>, friction: <torsion.friction=0.1>, friction_speed: <torsion.friction_speed=0.1>, stop: { from: <torsion.stop.from=-0.1>, to: <torsion.stop.to=0.1>, stiffness: <torsion.stop.stiffness=10>, damping: <torsion.stop.damping=0.1>, damping_angle: <torsion.stop.damping_angle=0.01> }, lock: { by: shut, stiffness: <torsion.lock.stiffness=10>, damping: <torsion.lock.damping=0.1> } }
switches: [{ switch: shut, when: { time: 10 ms } }]
outputs:
  - { name: x, of: joint arm/body, what: torque, about: x }
  - { name: bend, of: joint arm/body, what: torque, about: flexion }
  - { name: twist, of: joint arm/body, what: torque, about: torsion }
run: { duration: 20 ms, every: 2 ms }
",
    "model: plates
dimension: 3
HEAD
systems:
  - name: ball
    elements: [{ name: body, mass: 1, cg: [0, 0, 0], inertia: [4e-3, 4e-3, 4e-3] }]
    start: { position: [0.05, 0, 0.095], velocity: [0.3, 0.1, -1], rates: { body: [1, 2, 3] } }
forces:
  - contact: plate
    ellipsoid: { on: ball/body, center: [0, 0, 0], semi_axes: [<ellipsoid.semi_axes[0]=0.1>, <ellipsoid.semi_axes[1]=0.11>, <ellipsoid.semi_axes[2]=0.1>] }
    plane: { on: frame, at: [0, 0, 0], normal: [0, <plane.normal=0.1>, 1], along: [<plane.along=1>, <plane.along#2=0>, 0], extent: [<plane.extent[0]=0.3>, <plane.extent[1]=0.2>], edge: { width: <plane.edge.width=0.05> } }
    elastic: line
    friction: 0.3
    friction_displacement: <friction_displacement=1e-4>
outputs:
  - { name: plate, of: contact plate, what: force }
  - { name: z, of: ball/body, what: position, component: z }
run: { duration: 20 ms, every: 2 ms }
",
    "model: mounts
dimension: 2
HEAD
systems:
  - name: one
    elements: [{ name: body, mass: 1, cg: [0, 0], inertia: 1e-2 }]
    start: { position: [0.01, -0.02], velocity: [0.3, -1], rates: { body: 2 } }
forces:
  - bushing: mount
    from: { on: frame, at: [<from.at=0>, <from.at#2=0>], axes: <from.axes=0.1> }
    to: { on: one/body, at: [<to.at=0>, <to.at#2=0.01>], axes: <to.axes=0.05> }
    along:
      x: { elastic: { curve: through, times: <along.x.elastic.times=20>, stretch: <along.x.elastic.stretch=1> }, damping: <along.x.damping=5> }
      z: { stiffness: <along.z.stiffness=2000>, damping: <along.z.damping=3> }
    about:
      y: { stiffness: <about.y.stiffness=20>, damping: <about.y.damping=0.1> }
outputs:
  - { name: x, of: bushing mount, what: force, component: x }
  - { name: moment, of: bushing mount, what: moment }
  - { name: z, of: one/body, what: position, component: z }
run: { duration: 20 ms, every: 2 ms }
",
    "model: rings
dimension: 2
HEAD
systems:
  - name: one
    elements: [{ name: body, mass: 2, cg: [0, 0], inertia: 1e-2 }]
    start: { position: [0.3, 0], velocity: [2, 0] }
forces:
  - belt: a
    from: { on: frame, at: [0, -0.2] }
    through: [{ ring: guide, on: frame, at: [<through[0].at=0>, <through[0].at#2=0.3>], friction: <through[0].friction=0.2>, resistance: <through[0].resistance=60> }]
    to: { on: one/body, at: [0, 0.01] }
    force: { curve: line, times: <force.times=1>, stretch: <force.stretch=1> }
    length: <length=0.8>
    damping: <damping=5>
    pretensioner: { fire: fire, delay: <pretensioner.delay=1e-3>, retract: { curve: pull, times: <pretensioner.retract.times=1>, stretch: <pretensioner.retract.stretch=1> } }
    limiter: { force: <limiter=300> }
  - belt: b
    from: { on: frame, at: [0, -0.1] }
    through: [{ ring: guide, on: frame, at: [0, 0.2], friction: 0.1 }]
    to: { on: one/body, at: [0, 0.01] }
    force: { curve: line, times: 2 }
    retractor: { lock: fire, spool: <retractor.spool=5>, film_spool: { curve: line, times: <retractor.film_spool.times=1>, stretch: <retractor.film_spool.stretch=1> } }
switches: [{ switch: fire, when: { of: one/body, what: displacement, component: x, above: 0.01 } }]
outputs:
  - { name: a, of: belt a, what: force, segment: 2 }
  - { name: b, of: belt b, what: force, segment: 1 }
  - { name: slip, of: belt a, what: slip, ring: guide }
  - { name: x, of: one/body, what: position, component: x }
run: { duration: 20 ms, every: 2 ms }
",
    "model: freedoms
dimension: 2
HEAD
  nod: { points: [[0, 0], [0.02, 0.1]], interpolate: cubic }
vehicles:
  - { name: car, acceleration: [{ curve: pulse, times: <motion.times=1>, stretch: <motion.stretch=1> }, 0], angles: { curve: nod, times: <angles.times=1>, stretch: <angles.stretch=1> } }
  - { name: stand, angles: <angles=0.1> }
systems:
  - name: post
    reference: { velocity: [0, { curve: pulse, times: <reference.times=1>, stretch: <reference.stretch=1> }] }
    elements: [{ name: top, mass: 1, cg: [0, 0.1], inertia: 1e-2 }]
  - name: cart
    reference: fixed
    elements:
      - { name: body, joint: { slider: x, armature: <armature=0.1> }, mass: 1, cg: [0, 0], inertia: 1e-2 }
    start: { joints: { body: 0.02 }, joint_rates: { body: 0.5 } }
forces:
  - spring: curved
    from: { on: cart/body, at: [<from.at=0>, <from.at#2=0.01>] }
    to: { on: frame, at: [<to.at=-0.4>, <to.at#2=0>] }
    elastic: { curve: through, times: <elastic.times=1>, stretch: <elastic.stretch=1> }
    length: <length=0.4>
    damping: <damping=2>
  - { spring: straight, from: { on: cart/body, at: [0, 0] }, to: { on: car, at: [0.5, 0.1] }, stiffness: <stiffness=30> }
  - { spring: stay, from: { on: cart/body, at: [0, 0] }, to: { on: stand, at: [0.5, 0.1] }, stiffness: 5 }
  - { spring: leash, from: { on: cart/body, at: [0, 0] }, to: { on: post/top, at: [0, 0.2] }, stiffness: 10 }
  - joint: cart/body
    elastic: { curve: through, times: 0.9 }
    unloading: { curve: soft, times: <unloading.times=1>, stretch: <unloading.stretch=1> }
    unloading_slope: <unloading_slope=1000>
    neutral: <neutral=0.01>
    damping: <damping#2=0.3>
    friction: <friction=0.5>
    friction_speed: <friction_speed=0.02>
    friction_displacement: <friction_displacement=1e-3>
    stop: { from: <stop.from=-0.2>, to: <stop.to=0.022>, stiffness: <stop.stiffness=300>, damping: <stop.damping=0.1>, damping_angle: <stop.damping_angle=0.001> }
    lock: { by: shut, stiffness: <lock.stiffness=10>, damping: <lock.damping=0.1> }
    motor: { curve: pulse, times: <motor.times=0.2>, stretch: <motor.stretch=1> }
    drive: { to: { curve: pulse, times: <drive.to.times=0.01>, stretch: <drive.to.stretch=1> }, stiffness: <drive.stiffness=20>, damping: <drive.damping=0.2>, limit: <drive.limit=3> }
switches: [{ switch: shut, when: { time: 10 ms } }]
outputs:
  - { name: curved, of: spring curved, what: force }
  - { name: straight, of: spring straight, what: force }
  - { name: effort, of: joint cart/body, what: effort }
  - { name: place, of: joint cart/body, what: position }
run: { duration: 20 ms, every: 2 ms }
",
    "model: bags
dimension: 3
HEAD
  blow: { points: [[0, 0], [0.002, 2], [0.05, 1]] }
systems:
  - name: man
    elements: [{ name: head, mass: 5, cg: [0, 0, 0], inertia: [0.02, 0.02, 0.02] }]
    start: { position: [-0.32, 0, 0.02], velocity: [8, 0, 0] }
forces:
  - airbag: fired
    ellipsoid: { on: frame, center: [<ellipsoid.center=0>, <ellipsoid.center#2=0.01>, 0], semi_axes: [<ellipsoid.semi_axes[0]=0.25>, <ellipsoid.semi_axes[1]=0.3>, <ellipsoid.semi_axes[2]=0.3>], axes: [<ellipsoid.axes=0.1>, 0, 0] }
    against: [{ on: man/head, center: [<against[0].center=0>, 0, 0], semi_axes: [<against[0].semi_axes[0]=0.1>, <against[0].semi_axes[1]=0.08>, <against[0].semi_axes[2]=0.12>], axes: [<against[0].axes=0.2>, 0, 0] }]
    inflow: { fire: fire, flow: { curve: blow, times: <inflow.flow.times=3>, stretch: <inflow.flow.stretch=1> }, temperature: <inflow.temperature=550> }
    gas: { constant: <gas.constant=287>, gamma: <gas.gamma=1.4> }
    ambient: { pressure: <ambient.pressure=1e5>, temperature: <ambient.temperature=290> }
    vent: { area: <vent.area=2e-3>, coefficient: <vent.area#2=0.7> }
    start: { pressure: <start.pressure=1.2e5>, temperature: <start.temperature=310> }
switches: [{ switch: fire, when: { time: 1 ms } }]
outputs:
  - { name: fired, of: airbag fired, what: pressure }
  - { name: mass, of: airbag fired, what: mass }
  - { name: x, of: man/head, what: velocity, component: x }
run: { duration: 20 ms, every: 2 ms }
",
    "model: turns
dimension: 3
HEAD
systems:
  - name: arm
    reference: fixed
    elements: [{ name: body, mass: 1, cg: [0, 0, 0.1], inertia: [1e-2, 1.1e-2, 5e-3] }]
    start: { angles: { body: [0.3, 0.2, 0.1] }, rates: { body: [1, 2, 3] } }
forces:
  - joint: arm/body
    axis: z
    about:
      x: { stiffness: <about.x.stiffness=5>, friction: 0.2, friction_displacement: <about.x.friction_displacement=1e-3>, motor: <about.x.motor=0.1>, drive: { to: { curve: pulse, times: <about.x.drive.to.times=0.1>, stretch: <about.x.drive.to.stretch=1> }, stiffness: <about.x.drive.stiffness=20>, damping: <about.x.drive.damping=0.2>, limit: <about.x.drive.limit=3> } }
      y: { elastic: through, unloading: { curve: soft, times: <about.y.unloading.times=1>, stretch: <about.y.unloading.stretch=1> }, unloading_slope: <about.y.unloading_slope=1000>, motor: { curve: pulse, times: <about.y.motor.times=0.2>, stretch: <about.y.motor.stretch=1> } }
    flexion: { elastic: { curve: line, times: 0.05 }, unloading: { curve: low, times: <flexion.unloading.times=0.05>, stretch: <flexion.unloading.stretch=1> }, unloading_slope: 100 }
    torsion: { elastic: through, unloading: { curve: soft, times: <torsion.unloading.times=1>, stretch: <torsion.unloading.stretch=1> }, unloading_slope: <torsion.unloading_slope=1000>, friction: 0.1, friction_displacement: <torsion.friction_displacement=1e-3>, motor: { curve: pulse, times: <torsion.motor.times=0.2>, stretch: <torsion.motor.stretch=1> }, drive: { to: <torsion.drive.to=0.1>, stiffness: <torsion.drive.stiffness=2>, damping: <torsion.drive.damping=0.2>, limit: <torsion.drive.limit=3> } }
  - { joint: arm/body, name: straight, axis: z, flexion: { stiffness: <flexion.stiffness=0.02> }, torsion: { stiffness: <torsion.stiffness=0.1> } }
  - { load: twist, on: arm/body, moment: [<moment[0]=0.01>, 0, 0] }
outputs:
  - { name: x, of: joint arm/body, what: torque, about: x }
  - { name: y, of: joint arm/body, what: torque, about: y }
  - { name: bend, of: joint arm/body, what: torque, about: flexion }
  - { name: twist, of: joint arm/body, what: torque, about: torsion }
run: { duration: 20 ms, every: 2 ms }
",
];

/// Keys whose constant 0 says the same as no key, and whose parameter must be positive; a stiffness, where it has a
/// curve of unloading below.
const LEFT_OUT_BY_0: [&str; 3] = ["stiffness", "unloading_slope", "friction_displacement"];

/// What every number is tried at.
const VALUES: [&str; 9] = [
    "-1", "0", "-1e300", "1e300", "1e-300", "1e-9", "0.37", "1e9", "nan",
];

/// The folders with models that have every law.
const MODELS: [&str; 3] = ["models", "docs/forces", "tests/models"];

/// The path of a number, of whatever axis, ring or entry.
fn kind(path: &str) -> String {
    let mut path = path.split('#').next().unwrap_or_default().to_owned();
    for axis in ["about.y.", "about.z."] {
        path = path.replace(axis, "about.x.");
    }
    path.retain(|c| !c.is_ascii_digit());
    path
}

/// The tokens of a scene: path with what tells it apart, and value.
fn tokens(scene: &str) -> Vec<(&str, &str)> {
    let rests = scene.split('<').skip(1);
    rests
        .map(|rest| {
            let (token, _) = rest.split_once('>').expect("tokens end");
            token.split_once('=').expect("tokens have values")
        })
        .collect()
}

/// A scene with something else in the place of one number, and parameters.
fn text(scene: &str, target: &str, by: &str, parameters: &str) -> String {
    let head = format!("{parameters}{HEAD}");
    let mut text = scene.replace("HEAD", &head);
    for (path, value) in tokens(scene) {
        let with = if path == target { by } else { value };
        text = text.replace(&format!("<{path}={value}>"), with);
    }
    text
}

/// The rule that a message says is broken, without what follows.
fn sentence(message: &str) -> &str {
    let ends = [", but is ", ", which is not so", " at the default"];
    let ends = ends.iter().filter_map(|end| message.find(end));
    &message[..ends.min().unwrap_or(message.len())]
}

/// The samples of a run that went to its end.
fn samples(recording: &Recording) -> Vec<Vec<f64>> {
    let columns = recording.table.columns.iter();
    columns.map(|column| column.values.clone()).collect()
}

/// A study over the only parameter that asks for the last sample of each output.
fn study(engine: &Engine) -> RowsJob {
    let info = engine.info();
    let settings = Settings {
        duration: info.duration,
        samples: 11,
        pace: Pace::Adaptive(Tolerances::default()),
        locate: false,
        // what needs more says so
        max_steps: 10_000,
        time_limit: None,
        energy_limit: ENERGY_LIMIT,
    };
    let outputs = 0..info.outputs.len();
    RowsJob {
        settings,
        varied: vec![0],
        fixed: Vec::new(),
        responses: outputs.map(|of| Asked::of(of, Response::Final)).collect(),
        estimate: false,
        wanted: f64::INFINITY,
        width: Width::widest(),
    }
}

/// A row of a study at this value, between two rows at the default, and a gradient there: refused if and only if a
/// single run is, in its words; what they have of a row that is done.
fn in_rows(
    engine: &Engine,
    [default, number]: [f64; 2],
    refused: Option<&str>,
) -> Result<Option<Vec<f64>>, String> {
    let job = study(engine);
    let found = engine.rows(&job, &[default, number, default]);
    let found = found.expect("registers");
    let [before, row, after] = found.rows[..] else {
        panic!("{found:?}")
    };
    let gradients = engine.gradients(&job, &[number], &[1.0]);
    let slopes = gradients.expect("registers");
    let expected = refused.is_some();
    for (what, row) in [("row", row), ("gradient", slopes.rows[0])] {
        if (row.status == Status::Refused) != expected {
            return Err(format!(
                "the {what} is {:?}, the run {refused:?}",
                row.status
            ));
        }
    }
    let reason = sweep::refusal(engine, &job, &[number]);
    if reason.as_deref().map(sentence) != refused.map(sentence) {
        return Err(format!(
            "the row is refused for {reason:?}, the run for {refused:?}"
        ));
    }
    let outputs = job.responses.len();
    let of = |row: usize| &found.responses[row * outputs..][..outputs];
    let same = of(0)
        .iter()
        .zip(of(2))
        .all(|(a, b)| a.to_bits() == b.to_bits());
    if before.status != after.status || !same {
        return Err("the rows beside it differ".into());
    }
    let all = slopes.values.iter().chain(&slopes.slopes);
    let finite = |status, mut values: std::slice::Iter<'_, f64>| {
        status != Status::Done || values.all(|x| x.is_finite())
    };
    if !finite(row.status, of(1).iter())
        || slopes.rows[0].status == Status::Done && !all.clone().all(|x| x.is_finite())
    {
        return Err("the row or its gradient is done and not finite".into());
    }
    Ok((row.status == Status::Done).then(|| of(1).to_vec()))
}

/// The responses of a row that may be run again; `None` where it says that it is not accurate.
fn accurate(engine: &Engine, number: f64) -> Option<Vec<f64>> {
    let job = RowsJob {
        estimate: true,
        wanted: 1e-3,
        ..study(engine)
    };
    let found = engine.rows(&job, &[number]).expect("registers");
    let row = found.rows[0];
    (row.status == Status::Done && row.error <= job.wanted).then_some(found.responses)
}

/// What two runs of the same scene are apart by, if it is more than 2 % of an output.
fn differ(one: &Recording, other: &Recording) -> Option<String> {
    let [one, other] = [one, other].map(samples);
    one.iter().zip(&other).find_map(|(a, b)| {
        let size = a.iter().fold(1e-6, |m: f64, x| m.max(x.abs()));
        let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        let most = apart.fold(0.0, f64::max);
        (most > 2e-2 * size).then(|| format!("{most} apart of {size}"))
    })
}

/// A run that its check confirms, as `bryant run` delivers it; `None` where it says that it is not to be trusted.
fn trusted(engine: &Engine, parameters: &[(&str, f64)]) -> Option<Recording> {
    let named = parameters.iter();
    let job = Job {
        parameters: named
            .map(|(name, value)| (name.to_string(), *value))
            .collect(),
        max_steps: Some(1_000_000),
        ..Job::default()
    };
    let run = accuracy::run(engine, &job, false, &mut |_, _| {});
    let close = matches!(&run.certainty.check, Some((_, Verdict::Apart(found))) if found.worst <= run.certainty.limit);
    (close && run.recording.doubts.is_empty()).then_some(run.recording)
}

/// Everything about one number at each value.
fn checked(scene: &str, path: &str, default: &str) -> Vec<String> {
    let parameters = format!("parameters: {{ p: {default} }}\n");
    let (_, varied) = sound(&text(scene, path, "p", &parameters));
    let values = VALUES.iter();
    values
        .filter_map(|value| check(scene, path, default, value, &varied))
        .collect()
}

/// Everything about one number at one value, given the engine in which it is a parameter.
fn check(scene: &str, path: &str, default: &str, value: &str, varied: &Engine) -> Option<String> {
    let constant = read(&text(scene, path, value, ""));
    let number: f64 = value.parse().expect("a value is a number");
    let key = path.rsplit('.').next().unwrap_or(path);
    let given = run(varied, &[("p", number)]);
    let refused = match &given.result {
        Err(error) if error.kind == ErrorKind::Job => Some(error.message.clone()),
        _ => None,
    };
    let fault = |what: String| Some(format!("{path} = {value}: {what}"));
    let usual: f64 = default.parse().expect("a default is a number");
    let row = match in_rows(varied, [usual, number], refused.as_deref()) {
        Ok(row) => row,
        Err(what) => return fault(what),
    };
    let finite = |recording: &Recording| {
        recording.result.is_err() || samples(recording).iter().flatten().all(|x| x.is_finite())
    };
    match (constant, refused) {
        (Err(_), Some(_)) if number.is_nan() => None,
        (Err(messages), Some(refused)) => {
            let same = messages.iter().any(|m| sentence(m) == sentence(&refused));
            if same {
                None
            } else {
                fault(format!("{messages:?} is not {refused}"))
            }
        }
        // that nothing resists a turn is of the whole system, and the run says it
        (Err(_), None) if path.starts_with("inertia") && given.result.is_err() => None,
        (Err(messages), None) if path == "mass" && messages[0].contains("rounding hides it") => {
            None
        }
        (Err(messages), None) => fault(format!("only the constant is refused: {messages:?}")),
        // a 0 that is written leaves these out; a parameter is a number of a law that is there
        (Ok(_), Some(_)) if number == 0.0 && LEFT_OUT_BY_0.contains(&key) => None,
        (Ok(_), Some(refused)) => fault(format!("only the parameter is refused: {refused}")),
        (Ok(model), None) => {
            let engine = bryant::equations::of(&model).expect("no user forces");
            let fixed = run(&engine, &[]);
            if !finite(&fixed) || !finite(&given) {
                return fault("not finite".into());
            }
            if fixed.result.is_err() || given.result.is_err() {
                return None;
            }
            // how a force that jumps is met, and where numbers are huge, leaves a few percent
            if number.abs() > 1e6 {
                return None;
            }
            if differ(&fixed, &given).is_some() {
                // a run alone is as accurate as its tolerance allows; what is promised is said of a run with its check
                let both = (trusted(&engine, &[]), trusted(varied, &[("p", number)]));
                if let (Some(fixed), Some(given)) = both
                    && let Some(apart) = differ(&fixed, &given)
                {
                    return fault(apart);
                }
            }
            // the first column is the time
            let columns = samples(&given);
            let apart = |row: &[f64]| {
                let pairs = columns.iter().skip(1).zip(row);
                let shares = pairs.map(|(column, last)| {
                    let size = column.iter().fold(1e-6, |m: f64, x| m.max(x.abs()));
                    (column.last().expect("there are samples") - last).abs() / size
                });
                shares.fold(0.0, f64::max)
            };
            // one that is far off is run again in a study, or says that it is not accurate
            let off = row.filter(|row| apart(row) > 2e-2);
            let off = off.and_then(|_| accurate(varied, number));
            if let Some(off) = off.map(|row| apart(&row)).filter(|off| *off > 2e-2) {
                return fault(format!("the row is off by {off} of the output"));
            }
            None
        }
    }
}

/// The faults that a check finds in a share of all numbers. Two numbers are checked at a time.
fn faults(of: usize, check: impl Fn(&str, &str, &str) -> Vec<String> + Sync) -> Vec<String> {
    let all = SCENES.into_iter().flat_map(|scene| {
        let numbers = tokens(scene).into_iter();
        numbers.map(move |(path, default)| (scene, path, default))
    });
    let numbers = share(of, all);
    let next = AtomicUsize::new(0);
    let some = || {
        let mut found = Vec::new();
        while let Some((scene, path, default)) = numbers.get(next.fetch_add(1, Ordering::Relaxed)) {
            found.extend(check(scene, path, default));
        }
        found
    };
    std::thread::scope(|scope| {
        let threads = [(); 2].map(|()| scope.spawn(some));
        let found = threads.map(|thread| thread.join().expect("no check panics"));
        found.concat()
    })
}

#[test]
fn a_parameter_is_refused_where_the_constant_is() {
    let faults = faults(20, checked);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn no_number_of_a_law_is_forgotten() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut models: Vec<Model> = SCENES.map(|scene| sound(&text(scene, "", "", "")).0).into();
    for folder in MODELS {
        for entry in std::fs::read_dir(root.join(folder)).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path
                .extension()
                .is_some_and(|extension| extension == "yaml")
            {
                models.extend(bryant_generator::read(&path).map(|(model, _)| model));
            }
        }
    }
    assert!(models.len() > 60, "{}", models.len());
    let all = models.iter().flat_map(Model::requirements);
    let mut known: BTreeSet<String> = all
        .filter(|requirement| requirement.written)
        .map(|requirement| kind(&requirement.path))
        .collect();
    // what a function of the user's asks for by names of its own
    let named = ["parameters.", "curves.", "states.", "points.", "lines."];
    known.retain(|path| !named.iter().any(|name| path.starts_with(name)));
    let tried: BTreeSet<String> = SCENES
        .into_iter()
        .flat_map(tokens)
        .map(|(path, _)| kind(path))
        .collect();
    let missing: Vec<_> = known.difference(&tried).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn infinite_parameters_are_refused() {
    let faults = faults(20, |scene, path, default| {
        let parameters = format!("parameters: {{ p: {default} }}\n");
        let (_, engine) = sound(&text(scene, path, "p", &parameters));
        let values = [f64::INFINITY, f64::NEG_INFINITY, f64::NAN].into_iter();
        let fault = |value: f64| {
            let error = match run(&engine, &[("p", value)]).result {
                Err(error) if error.kind == ErrorKind::Job => error,
                other => return Some(format!("{path} = {value}: {other:?}")),
            };
            let usual = default.parse().expect("a default is a number");
            let row = in_rows(&engine, [usual, value], Some(&error.message));
            (row != Ok(None)).then(|| format!("{path} = {value}: {row:?}"))
        };
        values.filter_map(fault).collect()
    });
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn expressions_are_judged_by_their_value() {
    let parameters = "parameters: { a: 2, b: 1 }\n";
    let of = |path, by| text(SCENES[0], path, by, parameters);
    for (path, by, parameter, bad) in [
        (
            "damping",
            "a - b",
            ("b", 3.0),
            "`damping` of belt \"a\" must not be negative",
        ),
        (
            "limiter",
            "100 * a",
            ("a", -1.0),
            "`limiter` of belt \"a\" must be positive",
        ),
        (
            "slack",
            "b / a",
            ("a", 0.0),
            "`slack` of belt \"b\" must not be negative",
        ),
        (
            "mass",
            "a * b",
            ("a", 0.0),
            "`mass` of one/body must be positive",
        ),
    ] {
        let (_, engine) = sound(&of(path, by));
        assert!(run(&engine, &[]).result.is_ok(), "{path}");
        let error = run(&engine, &[parameter]).result.unwrap_err();
        assert_eq!(error.kind, ErrorKind::Job, "{path}: {error:?}");
        assert_eq!(sentence(&error.message), bad);
    }
}

#[test]
fn run_and_gradient_refuse_with_the_same_words() {
    let folder = tempfile::tempdir().expect("a folder");
    let parameters = "parameters: { p: 5 }\n";
    let scene = text(SCENES[0], "damping", "p", parameters);
    std::fs::write(folder.path().join("scene.yaml"), scene).expect("a file");
    let words = "`damping` of belt \"a\" must not be negative";
    for command in [
        &["run", "scene.yaml", "--no-files", "--set", "p=-1"][..],
        &[
            "gradient",
            "scene.yaml",
            "--of",
            "peak of a",
            "--wrt",
            "p",
            "--set",
            "p=-1",
        ],
    ] {
        let (stdout, stderr) = crate::command_call::call(folder.path(), command, 2);
        assert!(stdout.is_empty() && stderr.contains(words), "{stderr}");
    }
}
