//! Contact laws against closed forms: hysteresis, damping that fades in, friction that holds, edges, other shapes.
//!
//! The error of a run is bounded as in `laws`: steps · tolerance · max(ω, 1).

use crate::laws::{G, TOLERANCE, close, integration, last};
use bryant_tests::models;
use bryant_tests::runs::{Recording, run, run_for};

fn largest(column: &[f64]) -> f64 {
    column.iter().fold(0.0, |most: f64, x| most.max(*x))
}

#[test]
fn a_dent_stays_and_takes_its_part_of_the_energy() {
    let entry = models::plastic_bounce::ENTRY;
    let (mass, speed) = (1.0, 1.0);
    for (k1, k2) in [(1e4, 1e4), (1e4, 4e4), (2e4, 2e5), (1e4, 1e6)] {
        let run = run(
            &entry,
            &[("stiffness", k1), ("unloading_stiffness", k2)],
            TOLERANCE,
        );
        let bound = integration(&run, f64::sqrt(k2 / mass));
        let deepest = speed * f64::sqrt(mass / k1);
        let what = format!("k1 {k1}, k2 {k2}");
        let restitution = f64::sqrt(k1 / k2);
        let velocity = run.column("lead velocity");
        close(
            &format!("restitution, {what}"),
            last(&velocity),
            restitution,
            bound,
        );
        let set = deepest * (1.0 - k1 / k2);
        let ours = last(&run.column("permanent set"));
        assert!(
            (ours - set).abs() <= bound,
            "{what}: set {ours} instead of {set}, allowed {bound:e}"
        );
        // the force falls to 0 at the end of the dent, not at the first touch
        for (force, dent) in run.column("dent force").iter().zip(run.column("dent")) {
            assert!(*force >= 0.0);
            assert!(*force > 0.0 || dent <= set + bound, "{force} {dent}");
        }
    }
}

#[test]
fn a_cushion_gives_back_the_energy_under_its_lower_curve() {
    let entry = models::plastic_bounce::ENTRY;
    let (mass, speed) = (1.0, 1.0);
    for (k1, ku, s) in [(1e4, 4e3, 4e4), (1e4, 0.0, 1e5), (1e4, 9e3, 1e6)] {
        let run = run(
            &entry,
            &[
                ("stiffness", k1),
                ("given_back", ku),
                ("unloading_stiffness", s),
            ],
            TOLERANCE,
        );
        // loading to δ_m, then down the line of slope s to the straight unloading curve, and along it
        let deepest = speed * f64::sqrt(mass / k1);
        let foot = deepest * (1.0 - k1 / s);
        let meets = s * foot / (s - ku);
        let line = 0.5 * (k1 * deepest + ku * meets) * (deepest - meets);
        let given_back = line + 0.5 * ku * meets * meets;
        let taken = 0.5 * k1 * deepest * deepest;
        let bound = integration(&run, f64::sqrt(s / mass));
        close(
            &format!("restitution, k1 {k1}, ku {ku}, s {s}"),
            last(&run.column("foam velocity")),
            f64::sqrt(given_back / taken),
            bound,
        );
    }
}

/// The force after a whole history of penetrations, computed branch by branch: on the loading curve, on a line, on the
/// unloading curve.
struct History<'a> {
    loading: &'a dyn Fn(f64) -> f64,
    unloading: Option<&'a dyn Fn(f64) -> f64>,
    slope: f64,
    /// A point of the current line.
    through: (f64, f64),
}

impl History<'_> {
    fn force(&mut self, penetration: f64) -> f64 {
        let (loading, unloading) = ((self.loading)(penetration), self.unloading);
        let on_line = self.through.1 + self.slope * (penetration - self.through.0);
        if on_line >= loading {
            self.through = (penetration, loading);
            loading
        } else if let Some(lower) = unloading.map(|u| u(penetration)).filter(|u| on_line <= *u) {
            self.through = (penetration, lower);
            lower
        } else {
            on_line.max(0.0)
        }
    }
}

#[test]
fn loops_of_any_depth_close() {
    let entry = models::press::ENTRY;
    let run = run(&entry, &[], TOLERANCE);
    let line = |points: &'static [[f64; 2]]| {
        move |x: f64| {
            let pairs = points.windows(2);
            let last = points.len() - 2;
            let pair = pairs.clone().position(|p| x < p[1][0]).unwrap_or(last);
            let [[x0, y0], [x1, y1]] = [points[pair], points[pair + 1]];
            y0 + (y1 - y0) / (x1 - x0) * (x - x0)
        }
    };
    let loading = line(&[[0.0, 0.0], [5e-3, 100.0], [10e-3, 400.0]]);
    let unloading = line(&[[0.0, 0.0], [4e-3, 0.0], [10e-3, 150.0]]);
    // ten times the steepest slope of loading
    let steep = 10.0 * 300.0 / 5e-3;
    let mut dented = History {
        loading: &loading,
        unloading: None,
        slope: 2e5,
        through: (0.0, 0.0),
    };
    let mut springy = History {
        loading: &loading,
        unloading: Some(&unloading),
        slope: steep,
        through: (0.0, 0.0),
    };
    // The samples miss a turning point by at most half their interval Δt: by a (Δt/2)²/2 of the penetration, where a is
    // the largest acceleration. Every turn may contribute this error, which the slopes of the lines convert to a force.
    let (acceleration, sampling, turns) = (55.0, 1e-4f64, 10.0);
    let missed = turns * acceleration * sampling * sampling / 8.0;
    let (mut least, mut turned, mut before) = (f64::INFINITY, 0, 0.0);
    let columns =
        ["penetration", "dented", "springy", "permanent set"].map(|name| run.column(name));
    for (k, t) in run.times.iter().enumerate() {
        let [penetration, ours_dented, ours_springy, set] = std::array::from_fn(|i| columns[i][k]);
        let depth = penetration.max(0.0);
        for (law, ours, slope) in [
            (&mut dented, ours_dented, 2e5),
            (&mut springy, ours_springy, steep),
        ] {
            let expected = law.force(depth);
            let bound = slope * (missed + run.steps * TOLERANCE);
            assert!(
                (ours - expected).abs() <= bound,
                "at {t} s, {penetration} m: {ours} instead of {expected}, allowed {bound:e}"
            );
        }
        assert!(set >= before, "the dent fell from {before} to {set}");
        turned += usize::from(set > before && set - before > 1e-5);
        before = set;
        least = least.min(penetration);
    }
    assert!(turned > 100 && least < -1e-3);
    // 300 N/5 mm: the deepest point is 22 mm deep; a force of 1120 N dents it, and 5.6 mm spring back
    let deepest = largest(&columns[0]);
    let set = deepest - loading(deepest) / 2e5;
    close(
        "set",
        last(&columns[3]),
        set,
        missed + run.steps * TOLERANCE,
    );
    let work = work(&run, "penetration", "dented");
    assert!(work > 0.0, "a loop gives energy: {work}");
}

/// ∮ F dδ over a run, by trapezoids.
fn work(run: &Recording, penetration: &str, force: &str) -> f64 {
    let (x, f) = (run.column(penetration), run.column(force));
    let pairs = x.windows(2).zip(f.windows(2));
    pairs
        .map(|(x, f)| 0.5 * (f[0] + f[1]) * (x[1] - x[0]))
        .sum()
}

#[test]
fn damping_that_fades_in_takes_what_hunt_and_crossley_say() {
    // While the damping fades in, the force is k δ + λ δ δ̇ with λ = d/depth: m v dv/dδ = −δ (k + λ v), so v/λ − k/λ²
    // ln(1 + λ v/k) is the same at the first touch and at the last.
    let entry = models::bounce::ENTRY;
    let (stiffness, mass, speed) = (1e4f64, 1.0, 1.0);
    for (damping, depth) in [(20.0, 0.02), (200.0, 0.02), (200.0, 0.5)] {
        let run = run(
            &entry,
            &[("damping", damping), ("damping_depth", depth)],
            TOLERANCE,
        );
        let lambda = damping / depth;
        let invariant =
            |v: f64| v / lambda - stiffness / (lambda * lambda) * (stiffness + lambda * v).ln();
        let (mut least, mut most) = (0.0, speed);
        for _ in 0..60 {
            let middle = 0.5 * (least + most);
            // it grows with the speed of leaving
            if invariant(-middle) < invariant(speed) {
                least = middle;
            } else {
                most = middle;
            }
        }
        // the rate is that of ω, or that of damping at the deepest point, which is deeper than the speed divided by ω
        let deepest = speed * f64::sqrt(mass / stiffness);
        let rate = f64::sqrt(stiffness / mass) + lambda * deepest / mass;
        let what = format!("restitution, damping {damping} N s/m over {depth} m");
        let bound = integration(&run, rate) + 1e-12 * rate;
        close(&what, last(&run.column("velocity")), least, bound);
        // F ≤ (k + λ v) δ: the force does not jump
        for (height, force) in run.column("height").iter().zip(run.column("force")) {
            let penetration = (0.1 - height).max(0.0);
            assert!(force <= (stiffness + lambda * speed) * penetration * (1.0 + 1e-9));
        }
    }
}

/// Downhill displacement of the block on its slope.
fn downhill(run: &Recording, slope: f64) -> Vec<f64> {
    let (x, z) = (run.column("x"), run.column("z"));
    let pairs = x.iter().zip(&z);
    pairs
        .map(|(x, z)| x * slope.cos() - z * slope.sin())
        .collect()
}

#[test]
fn a_block_holds_on_a_slope() {
    let entry = models::incline::ENTRY;
    for (degrees, mu, displacement, duration) in [
        (15.0f64, 0.4, 1e-4, 10.0),
        (15.0, 0.27, 1e-4, 10.0),
        (30.0, 0.6, 1e-3, 100.0),
    ] {
        let slope = degrees.to_radians();
        let run = run_for(
            &entry,
            &[("slope", slope), ("mu", mu), ("displacement", displacement)],
            TOLERANCE,
            Some(duration),
        );
        // While the block sticks, its displacement and the deflection of the bristle have the same rate, so that their
        // difference is constant whatever the errors of the steps are; the deflection tends to z_b tan θ/μ.
        let way = downhill(&run, slope);
        let held = displacement * slope.tan() / mu;
        let bound = run.steps * TOLERANCE;
        let rest = way[run.at(1.0)];
        for (t, way) in run.times.iter().zip(&way).filter(|(t, _)| **t >= 1.0) {
            assert!(
                (way - rest).abs() <= 2.0 * bound,
                "creeps from {rest} to {way} in {t} s, allowed {bound:e}"
            );
            // with a smaller margin it slips after the release, until it is at rest
            if slope.tan() < 0.9 * mu {
                close(&format!("{degrees} degrees at {t} s"), *way, held, bound);
            }
        }
    }
}

#[test]
fn a_block_slides_where_the_slope_exceeds_the_friction_angle() {
    let entry = models::incline::ENTRY;
    for (degrees, mu) in [(30.0f64, 0.4), (22.0, 0.4), (45.0, 0.9)] {
        let slope = degrees.to_radians();
        let run = run(&entry, &[("slope", slope), ("mu", mu)], TOLERANCE);
        let (vx, vz) = (run.column("vx"), run.column("vz"));
        let speed = |k: usize| vx[k] * slope.cos() - vz[k] * slope.sin();
        let acceleration = G * (slope.sin() - mu * slope.cos());
        // the normal force oscillates with the contact's frequency, and the bristle is equally fast
        let bound = integration(&run, f64::sqrt(1e5 / 2.0));
        let (from, to) = (run.at(2.0), run.at(10.0));
        close(
            "speed gained",
            speed(to) - speed(from),
            8.0 * acceleration,
            bound,
        );
    }
}

#[test]
fn a_sliding_block_stops_and_springs_back_by_its_bristle() {
    let entry = models::incline::ENTRY;
    for (speed, mu, displacement) in [(2.0, 0.4, 1e-4), (2.0, 0.2, 3e-4), (1.0, 0.1, 1e-3)] {
        let parameters = [
            ("slope", 0.0),
            ("speed", speed),
            ("mu", mu),
            ("displacement", displacement),
        ];
        let run = run(&entry, &parameters, TOLERANCE);
        let (distance, time) = (speed * speed / (2.0 * mu * G), speed / (mu * G));
        // During sliding, the deflection tends to z_b with the rate v_s/z_b. It springs back by the deflection reached,
        // and the friction leaves μN when s_t falls below 1, within that share of v_s.
        let lacks = f64::exp(-time * 0.01 / displacement);
        let error = run.steps * TOLERANCE * f64::max(1.0, time);
        let bound = error + displacement * lacks + 0.01 * lacks * time;
        let way = downhill(&run, 0.0);
        close("stop", last(&way), distance - displacement, bound);
        let furthest = largest(&way);
        assert!(furthest <= distance + bound, "{furthest} {distance}");
        for (t, v) in run
            .times
            .iter()
            .zip(run.column("vx"))
            .filter(|(t, _)| **t < time)
        {
            let expected = speed - mu * G * t;
            assert!(
                (v - expected).abs() <= integration(&run, 224.0),
                "{v} {expected}"
            );
        }
    }
}

#[test]
fn friction_that_holds_knows_no_direction() {
    let entry = models::incline_space::ENTRY;
    let (slope, mu, displacement) = (15f64.to_radians(), 0.4, 1e-4);
    for azimuth in [0.0, 30f64, 135.0, -77.0].map(f64::to_radians) {
        let parameters = [("slope", slope), ("azimuth", azimuth)];
        let run = run(&entry, &parameters, TOLERANCE);
        let columns = ["x", "y", "z"].map(|name| run.column(name));
        let bound = run.steps * TOLERANCE;
        let [xs, ys, zs] = columns.each_ref().map(|column| &column[run.at(1.0)..]);
        for ((x, y), z) in xs.iter().zip(ys).zip(zs) {
            let level = x * azimuth.cos() + y * azimuth.sin();
            let down = level * slope.cos() - z * slope.sin();
            let across = y * azimuth.cos() - x * azimuth.sin();
            close("held", down, displacement * slope.tan() / mu, bound);
            assert!(across.abs() <= bound, "across {across}");
        }
        // on level ground, pushed in that direction
        let speed = 1.5;
        let parameters = [
            ("slope", 0.0),
            ("vx", speed * azimuth.cos()),
            ("vy", speed * azimuth.sin()),
        ];
        let run = self::run(&entry, &parameters, TOLERANCE);
        let (x, y) = (last(&run.column("x")), last(&run.column("y")));
        let distance = speed * speed / (2.0 * mu * G) - displacement;
        let bound = run.steps * TOLERANCE;
        close(
            "stop",
            x * azimuth.cos() + y * azimuth.sin(),
            distance,
            bound,
        );
        assert!((y * azimuth.cos() - x * azimuth.sin()).abs() <= bound);
    }
}

#[test]
fn a_ball_falls_freely_from_an_edge_that_cuts() {
    let entry = models::edge::ENTRY;
    let run = run(&entry, &[], TOLERANCE);
    let (x, z, force) = (
        run.column("cut x"),
        run.column("cut z"),
        run.column("cut force"),
    );
    let bound = integration(&run, f64::sqrt(1e5 / 2.0));
    let (edge, speed, height) = (0.2, 0.5, 0.1 - 2.0 * G / 1e5);
    let leaves = (edge - 0.1) / speed;
    for (k, t) in run.times.iter().enumerate() {
        let falls = (t - leaves).max(0.0);
        let expected = [0.1 + speed * t, height - 0.5 * G * falls * falls];
        for (ours, expected) in [x[k], z[k]].into_iter().zip(expected) {
            assert!(
                (ours - expected).abs() <= bound,
                "at {t} s: {ours} instead of {expected}"
            );
        }
        if (t - leaves).abs() > 1e-6 {
            let expected = if *t < leaves { 2.0 * G } else { 0.0 };
            let bound = 1e5 * bound;
            assert!(
                (force[k] - expected).abs() <= bound,
                "at {t} s: {} N",
                force[k]
            );
        }
    }
}

/// S(x) = x² (3 − 2x) within 0..=1.
fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

#[test]
fn an_edge_that_fades_keeps_the_energy_of_a_ball() {
    let entry = models::edge::ENTRY;
    for width in [5e-3, 20e-3, 90e-3] {
        let run = run(&entry, &[("width", width)], TOLERANCE);
        let columns = ["x", "z", "vx", "vz"].map(|name| run.column(&format!("fade {name}")));
        // an energy of 1 J whose velocities are wrong by e is wrong by 2 e √(1 J · 2 kg)
        let bound = 4.0 * integration(&run, f64::sqrt(2e3 / 2.0));
        let mut energies = (0..run.times.len()).map(|k| {
            let [x, z, vx, vz] = std::array::from_fn(|i| columns[i][k]);
            let depth = (0.1 - z).max(0.0);
            let stored = smooth((0.2 - x) / width) * 0.5 * 2e3 * depth * depth;
            vx * vx + vz * vz + 2.0 * G * z + stored
        });
        let start = energies.next().expect("a sample");
        for energy in energies {
            assert!(
                (energy - start).abs() <= bound,
                "{energy} {start} {bound:e}"
            );
        }
        let forces = run
            .column("fade normal")
            .into_iter()
            .zip(run.column("fade force"));
        let pushed = forces
            .filter(|(normal, force)| force > &(normal + 0.01))
            .count();
        assert!(pushed > 3, "the edge never pushes");
    }
}

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn plus(a: Vector, factor: f64, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] + factor * b[i])
}

fn unit(a: Vector) -> Vector {
    a.map(|x| x / dot(a, a).sqrt())
}

/// A vector, rotated by an angle about an axis.
fn turned(axis: usize, angle: f64, v: Vector) -> Vector {
    let (s, c) = angle.sin_cos();
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut w = v;
    (w[i], w[j]) = (c * v[i] - s * v[j], s * v[i] + c * v[j]);
    w
}

/// The pose of a body from seven coordinates: position and quaternion.
struct Pose<'a>(&'a [f64]);

impl Pose<'_> {
    fn direction(&self, v: Vector) -> Vector {
        let [w, x, y, z] = [self.0[3], self.0[4], self.0[5], self.0[6]];
        let u = [x, y, z];
        let t = cross(u, v);
        let twice = plus(t.map(|a| w * a), 1.0, cross(u, t));
        plus(v, 2.0, twice)
    }

    fn point(&self, v: Vector) -> Vector {
        plus([self.0[0], self.0[1], self.0[2]], 1.0, self.direction(v))
    }
}

/// Deepest point of an ellipsoid in a direction: the point farthest against it from the centre, by its own axes.
fn furthest(
    pose: &Pose<'_>,
    centre: Vector,
    semi: Vector,
    axes: Vector,
    towards: Vector,
) -> Vector {
    let columns: [Vector; 3] = std::array::from_fn(|k| {
        let mut axis = [0.0; 3];
        axis[k] = 1.0;
        for about in [2, 1, 0] {
            axis = turned(about, axes[about].to_radians(), axis);
        }
        pose.direction(axis)
    });
    let stretched: Vector = std::array::from_fn(|k| semi[k] * dot(columns[k], towards));
    let reach = dot(stretched, stretched).sqrt();
    let mut point = pose.point(centre);
    for k in 0..3 {
        point = plus(point, semi[k] * stretched[k] / reach, columns[k]);
    }
    point
}

#[test]
fn a_fading_edge_conserves_energy_and_momentum_while_turning() {
    let entry = models::edge_space::ENTRY;
    let run = run(&entry, &[], TOLERANCE);
    let sum = |what: &str| -> Vec<f64> {
        let (stone, slab) = (
            run.column(&format!("stone {what}")),
            run.column(&format!("slab {what}")),
        );
        stone.iter().zip(&slab).map(|(a, b)| a + b).collect()
    };
    let (kinetic, deep) = (sum("energy"), run.column("penetration"));
    // speeds of a few m/s and masses of at most 30 kg: ten times the error of a coordinate
    let bound = 100.0 * integration(&run, f64::sqrt(1e5 / 2.0));
    let normal = unit([0.1, 0.2, 1.0]);
    let along = unit(plus([1.0, 1.0, 0.0], -dot([1.0, 1.0, 0.0], normal), normal));
    let across = cross(normal, along);
    let (mut faded, mut least) = (0, f64::INFINITY);
    for (k, state) in run.states.iter().enumerate() {
        let (stone, slab) = (Pose(&state[..7]), Pose(&state[7..14]));
        let [n, t1, t2] = [normal, along, across].map(|v| slab.direction(v));
        let deepest = furthest(
            &stone,
            [0.02, -0.01, 0.01],
            [0.12, 0.07, 0.09],
            [10.0, 40.0, -20.0],
            n.map(|x| -x),
        );
        let from = plus(deepest, -1.0, slab.point([0.01, 0.02, 0.0]));
        assert!((deep[k] + dot(n, from)).abs() <= 1e-12);
        let weight = smooth((0.15 - dot(t1, from).abs()) / 0.08)
            * smooth((0.12 - dot(t2, from).abs()) / 0.08);
        let depth = deep[k].max(0.0);
        let stored = 0.5e4 * depth * depth + 0.5 * 8e4 * (depth - 0.01).max(0.0).powi(2);
        let energy = kinetic[k] + weight * stored;
        assert!(
            (energy - kinetic[0]).abs() <= bound,
            "at {} s: {energy} J instead of {} J",
            run.times[k],
            kinetic[0]
        );
        faded += usize::from(weight > 0.1 && weight < 0.9 && depth > 2e-3);
        least = least.min(kinetic[k]);
    }
    assert!(faded > 5, "{faded} samples within the edge");
    assert!(kinetic[0] - least > 1e3 * bound, "little was exchanged");
    for what in ["px", "py", "pz", "lx", "ly", "lz"] {
        let column = sum(what);
        for value in &column {
            assert!(
                (value - column[0]).abs() <= bound,
                "{what}: {value} {}",
                column[0]
            );
        }
    }
}

#[test]
fn a_rounded_box_keeps_its_energy() {
    let entry = models::chest_drop::ENTRY;
    let run = run(&entry, &[], TOLERANCE);
    let columns = ["energy", "z", "floor", "wall"].map(|name| run.column(name));
    let mass = 2.0;
    let energy = |k: usize| {
        let [kinetic, z, floor, wall] = std::array::from_fn(|i| columns[i][k]);
        let springs = [floor, wall].map(|x: f64| 0.5 * 2e4 * x.max(0.0).powi(2));
        kinetic + mass * G * z + springs[0] + springs[1]
    };
    // A corner of degree 8 and radius r/8 rotates under the deepest point: a few times the rate of the springs. The
    // error of an energy of 10 J and 2 kg is that of its speed of 3 m/s times its mass.
    let bound = 6.0 * integration(&run, 4.0 * f64::sqrt(2e4 / 0.5));
    for (k, t) in run.times.iter().enumerate() {
        let error = (energy(k) - energy(0)).abs();
        assert!(
            error <= bound,
            "at {t} s: off by {error:e} J, allowed {bound:e}"
        );
    }
    assert!(largest(&columns[2]) > 5e-3 && largest(&columns[3]) > 5e-3);
}

#[test]
fn the_deepest_point_of_a_rounded_box_is_the_deepest() {
    // The penetration of an output, against the surface itself, sampled in all directions from its centre.
    let entry = models::chest_drop::ENTRY;
    let run = run(&entry, &[], 1e-6);
    let (floor, wall) = (run.column("floor"), run.column("wall"));
    const GRID: usize = 400;
    for k in (0..run.times.len()).step_by(50) {
        let pose = Pose(&run.states[k][..7]);
        for (degree, down, ours) in [
            (4.0, [0.0, 0.0, -1.0], floor[k]),
            (8.0, [-1.0, 0.0, 0.0], wall[k]),
        ] {
            let mut deepest = f64::NEG_INFINITY;
            for i in 0..=GRID {
                let polar = std::f64::consts::PI * i as f64 / GRID as f64;
                for j in 0..2 * GRID {
                    let azimuth = std::f64::consts::PI * j as f64 / GRID as f64;
                    let sphere = [
                        polar.sin() * azimuth.cos(),
                        polar.sin() * azimuth.sin(),
                        polar.cos(),
                    ];
                    let semi = [0.15, 0.1, 0.12];
                    let parts = (0..3).map(|i| f64::powf((sphere[i] / semi[i]).abs(), degree));
                    let length = parts.sum::<f64>().powf(-1.0 / degree);
                    let mut point = sphere.map(|x| length * x);
                    for (about, degrees) in [(2, 5.0f64), (0, 10.0)] {
                        point = turned(about, degrees.to_radians(), point);
                    }
                    point = plus(point, 1.0, [0.01, 0.0, 0.0]);
                    deepest = deepest.max(dot(pose.point(point), down));
                }
            }
            // No sample is deeper. At a distance of at most 0.2 m, two directions of the grid are one grid width apart,
            // and the surface between them rises by no more than this, however steep it is.
            let width = 2.0 * 0.2 * std::f64::consts::PI / GRID as f64;
            assert!(deepest <= ours + 1e-12, "{deepest} {ours}");
            assert!(ours - deepest <= width, "{deepest} {ours}");
        }
    }
}

#[test]
fn discs_part_as_the_laws_of_impact_say() {
    let entry = models::discs::ENTRY;
    let run = run(&entry, &[], TOLERANCE);
    // 1 kg and 3 kg at 1 m/s each along (3, 4): a spring of 10 kN/m and the reduced mass, for half a period
    let (stiffness, reduced, speed) = (1e4f64, 0.75, 2.0);
    let omega = f64::sqrt(stiffness / reduced);
    let bound = integration(&run, omega);
    let columns = ["left vx", "left vz", "right vx", "right vz"].map(|name| run.column(name));
    // the common velocity is −1/2 m/s
    for (column, along) in columns.iter().zip([-2.0 * 0.6, -2.0 * 0.8, 0.0, 0.0]) {
        assert!(
            (last(column) - along).abs() <= bound,
            "{} {along}",
            last(column)
        );
    }
    for (t, force) in run.times.iter().zip(run.column("discs force")) {
        let expected = stiffness * (speed / omega * (omega * t).sin());
        let expected = if omega * t < std::f64::consts::PI {
            expected
        } else {
            0.0
        };
        assert!(
            (force - expected).abs() <= stiffness * bound,
            "{force} {expected}"
        );
    }
}

#[test]
fn a_disc_as_large_as_a_planet_is_a_plane_from_either_side() {
    let entry = models::discs::ENTRY;
    let run = run(&entry, &[], TOLERANCE);
    let names = [
        "x",
        "line",
        "planet",
        "turned round",
        "normal",
        "normal turned round",
    ];
    let columns = names.map(|name| run.column(name));
    let (rub, turned) = (run.column("friction"), run.column("friction turned round"));
    // kilometres are rounded by this
    let (radius, rounding) = (1e3, 8.0 * f64::EPSILON * 1e3);
    let (stiffness, mu, displacement) = (1e4, 0.3, 1e-3);
    let strongest = largest(&columns[4]);
    for k in 0..run.times.len() {
        let [x, line, planet, other, normal, opposite] = std::array::from_fn(|i| columns[i][k]);
        assert!((planet - other).abs() <= rounding, "{planet} {other}");
        assert!((normal - opposite).abs() <= stiffness * rounding);
        // two bristles with two states, each with the error of the tolerance in every step
        let bound = mu * strongest / displacement * run.steps * TOLERANCE;
        assert!(
            (rub[k] - turned[k]).abs() <= bound,
            "{} {}",
            rub[k],
            turned[k]
        );
        // the surface of the disc falls away by X²/2R, wherever they meet in the ellipse
        let furthest = x.abs() + 0.31;
        let falls = furthest * furthest / (2.0 * radius) * 1.01;
        let less = line - planet;
        assert!(
            less >= -rounding && less <= falls + rounding,
            "{less} {falls}"
        );
    }
    assert!(strongest > 20.0);
}

#[test]
fn stones_keep_energy_and_momentum() {
    let entry = models::stones::ENTRY;
    let run = run(&entry, &[], TOLERANCE);
    let sum = |what: &str| -> Vec<f64> {
        let flint = run.column(&format!("flint {what}"));
        let basalt = run.column(&format!("basalt {what}"));
        flint.iter().zip(&basalt).map(|(a, b)| a + b).collect()
    };
    // speeds of a metre per second and masses of 3 kg
    let bound = 10.0 * integration(&run, f64::sqrt(1e5 / 1.2));
    let (kinetic, hit) = (sum("energy"), run.column("hit"));
    let mut least = kinetic[0];
    for (k, t) in run.times.iter().enumerate() {
        let depth = hit[k].max(0.0);
        let stored = 0.5e4 * depth * depth + 0.5 * 8e4 * (depth - 0.01).max(0.0).powi(2);
        let error = (kinetic[k] + stored - kinetic[0]).abs();
        assert!(
            error <= bound,
            "at {t} s: off by {error:e} J, allowed {bound:e}"
        );
        least = least.min(kinetic[k]);
    }
    assert!(kinetic[0] - least > 1e3 * bound, "little was exchanged");
    for what in ["px", "py", "pz", "lx", "ly", "lz"] {
        let column = sum(what);
        for value in &column {
            assert!(
                (value - column[0]).abs() <= bound,
                "{what}: {value} {}",
                column[0]
            );
        }
    }
    // the deepest points of both, along the line that connects them: as deep as the output says, and no surface in
    // between
    let touching = (0..run.times.len()).filter(|k| hit[*k] > 1e-3);
    let (mut checked, semi) = (0, [[0.12, 0.07, 0.09], [0.15, 0.08, 0.1]]);
    for k in touching {
        let (flint, basalt) = (Pose(&run.states[k][..7]), Pose(&run.states[k][7..14]));
        let overlap = |n: Vector| {
            let first = furthest(&flint, [0.02, -0.01, 0.01], semi[0], [10.0, 40.0, -20.0], n);
            let second = furthest(&basalt, [0.0, 0.02, 0.0], semi[1], [0.0; 3], n.map(|x| -x));
            dot(n, plus(first, -1.0, second))
        };
        let mut least = f64::INFINITY;
        const GRID: usize = 90;
        for i in 0..=GRID {
            for j in 0..2 * GRID {
                let (s, c) = (std::f64::consts::PI * i as f64 / GRID as f64).sin_cos();
                let (t, d) = (std::f64::consts::PI * j as f64 / GRID as f64).sin_cos();
                least = least.min(overlap([s * d, s * t, c]));
            }
        }
        // half a grid width e from the smallest overlap, the overlap is larger by e²/2 times radii of curvature, each
        // at most a²/c
        let width = std::f64::consts::PI / GRID as f64;
        let curved = 0.15 * 0.15 / 0.08 + 0.12 * 0.12 / 0.07;
        assert!(hit[k] <= least + 1e-12, "{} {least}", hit[k]);
        assert!(
            least - hit[k] <= 0.5 * width * width * curved,
            "{} {least}",
            hit[k]
        );
        checked += 1;
    }
    assert!(checked > 5, "{checked}");
}
