//! Identities, each between two functions that are derived apart, or between a function and the derivative of another
//! by dual numbers.
//!
//! Sums of some hundred terms agree within 1e-11 of the sizes of their terms.

use super::{all, engine, models, values};
use bryant_engine::{Engine, Evaluated};
use bryant_generator::model::{Dimension, Element, Freedom, Model, Number, Reference};
use bryant_generator::program::Method;
use bryant_runtime::{Dual, Dynamics, Section, StateKind};
use bryant_tests::trees::Random;

const STATES: usize = 4;
const ROUNDING: f64 = 1e-11;

#[test]
fn functions_agree_with_each_other_on_every_model() {
    let models = models(&["../models", "models", "models/functions"]);
    let holds = |model: &&Model| Case::of(model).is_some_and(|case| case.holds());
    let checked = models.iter().filter(holds).count();
    assert!(checked > 30, "only {checked} models were checked");
}

/// A model with an engine over numbers and over dual numbers.
struct Case<'a> {
    model: &'a Model,
    engine: Engine,
    machine: Evaluated<f64>,
    duals: Evaluated<Dual<f64>>,
    frames: Vec<String>,
    /// True if no motion is prescribed.
    by_itself: bool,
}

/// A state, with accelerations.
struct At {
    t: f64,
    y: Vec<f64>,
    a: Vec<f64>,
}

impl<'a> Case<'a> {
    /// `None` for a model that does not move.
    fn of(model: &'a Model) -> Option<Self> {
        // the first element, the last and the points of each system, and the vehicles
        let mut frames = Vec::new();
        for system in &model.systems {
            let [first, .., last] = &[&system.elements[..1], &system.elements].concat()[..] else {
                continue;
            };
            frames.extend([first, last].map(|e| format!("{}/{}", system.name, e.name)));
            let points = system.elements.iter().flat_map(|element| &element.points);
            frames.extend(points.map(|point| format!("{}/{}", system.name, point.name)));
        }
        frames.extend(model.vehicles.iter().map(|vehicle| vehicle.name.clone()));
        frames.dedup();
        let engine = engine(model, &all(&frames));
        (!engine.info().velocities.is_empty()).then(|| Case {
            model,
            machine: engine.over(),
            duals: engine.over(),
            engine,
            frames,
            by_itself: model.vehicles.is_empty()
                && (model.systems.iter())
                    .all(|s| matches!(s.reference, Reference::Free | Reference::Fixed)),
        })
    }

    fn holds(&self) -> bool {
        let info = self.engine.info();
        let n = info.velocities.len();
        let mut random = Random::new(info.name.bytes().map(u64::from).sum());
        for _ in 0..STATES {
            let mut y = vec![0.0; info.state_length()];
            self.machine.initial_state(&mut y);
            for (entry, kind) in y.iter_mut().zip(info.kinds) {
                if !matches!(kind, StateKind::Memory | StateKind::Law) {
                    *entry += random.uniform(-0.4, 0.4);
                }
            }
            self.machine.normalize(&mut y);
            let at = At {
                t: random.uniform(0.0, 0.5 * self.model.run.duration),
                y,
                a: (0..n).map(|_| random.uniform(-1.0, 1.0)).collect(),
            };
            self.forces(&at);
            self.regressor(&at);
            self.energies(&at);
            self.momentum(&at);
            for frame in &self.frames {
                self.frame(&at, frame);
            }
        }
        true
    }

    fn of_state(&self, name: &str, at: &At) -> Vec<f64> {
        values(&self.engine, &self.machine, name, (at.t, &at.y), &at.a)
    }

    /// The slopes of a function where the state changes at these rates, and time at the rate 1 or 0.
    fn slopes(&self, name: &str, at: &At, rates: &[f64], time: f64) -> Vec<f64> {
        let dual = |value, slope| Dual { value, slope };
        let y: Vec<_> =
            at.y.iter()
                .zip(rates)
                .map(|(&y, &rate)| dual(y, rate))
                .collect();
        let a: Vec<_> = at.a.iter().map(|&a| dual(a, 0.0)).collect();
        let found = values(&self.engine, &self.duals, name, (dual(at.t, time), &y), &a);
        found.iter().map(|of| of.slope).collect()
    }

    fn rates(&self, at: &At) -> Vec<f64> {
        let mut rates = vec![0.0; at.y.len()];
        self.machine.derivative(at.t, &at.y, &mut rates);
        rates
    }

    /// q̇, with nothing behind it.
    fn coordinate_rates(&self, at: &At) -> Vec<f64> {
        let mut rates = vec![0.0; at.y.len()];
        self.machine.coordinate_rates(&at.y, &mut rates);
        rates[self.engine.info().coordinates.len()..].fill(0.0);
        rates
    }

    fn v<'b>(&self, at: &'b At) -> &'b [f64] {
        let info = self.engine.info();
        &at.y[info.coordinates.len()..][..info.velocities.len()]
    }

    fn section(&self, section: Section, at: &At) -> Vec<f64> {
        let mut results = vec![0.0; self.engine.info().length(section)];
        self.machine.section(section, at.t, &at.y, &mut results);
        results
    }

    fn same(&self, what: &str, found: &[f64], expected: &[f64], sizes: &[f64]) {
        assert_eq!(found.len(), expected.len(), "{}: {what}", self.model.name);
        for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
            let size = sizes
                .iter()
                .fold(1e-6_f64, |most, size| most.max(size.abs()));
            let most = ROUNDING * size;
            assert!(
                (found - expected).abs() <= most,
                "{}: {what}[{i}] is {found}, and not {expected}, within {most:e}",
                self.model.name
            );
        }
    }

    /// S a + bias − r_g = inverse dynamics; of v̇ it gives r_k − r_g.
    fn forces(&self, at: &At) {
        let of = |name| self.of_state(name, at);
        let (s, bias, gravity) = (of("mass_matrix"), of("bias"), of("gravity_forces"));
        let n = at.a.len();
        let needed = |a: &[f64]| -> Vec<f64> {
            let product = times(&s, a);
            (0..n).map(|i| product[i] + bias[i] - gravity[i]).collect()
        };
        let sizes = |a: &[f64]| {
            let absolute: Vec<f64> = s.iter().map(|s| s.abs()).collect();
            let a: Vec<f64> = a.iter().map(|a| a.abs()).collect();
            [times(&absolute, &a), bias.clone(), gravity.clone()].concat()
        };
        self.same("ID", &of("inverse_dynamics"), &needed(&at.a), &sizes(&at.a));
        let coordinates = self.engine.info().coordinates.len();
        let a = self.rates(at)[coordinates..][..n].to_vec();
        let moving = At {
            y: at.y.clone(),
            a,
            ..*at
        };
        let found = self.of_state("inverse_dynamics", &moving);
        let applied = of("applied_forces");
        let expected: Vec<f64> = applied.iter().zip(&gravity).map(|(k, g)| k - g).collect();
        // v̇ is found by elimination, which loses as many digits as S has large and small pivots
        let sizes: Vec<f64> = [sizes(&moving.a), applied].concat();
        let sizes: Vec<f64> = sizes.iter().map(|size| 1e3 * size).collect();
        self.same("ID of v̇", &found, &expected, &sizes);
        for i in 0..n {
            for j in 0..i {
                assert_eq!(
                    s[n * i + j].to_bits(),
                    s[n * j + i].to_bits(),
                    "S is symmetric"
                );
            }
        }
    }

    /// The regressor times the inertia of the elements, and the armatures, are the inverse dynamics.
    fn regressor(&self, at: &At) {
        let elements = self
            .model
            .systems
            .iter()
            .flat_map(|system| &system.elements);
        let plane = self.model.dimension == Dimension::Plane;
        let Some(p) = elements
            .clone()
            .map(|e| inertia(e, plane))
            .collect::<Option<Vec<_>>>()
        else {
            return;
        };
        let armed = |freedom: &Freedom| freedom.armature.constant() != Some(0.0);
        if elements.flat_map(|e| e.joint.freedoms()).any(armed) {
            return;
        }
        let (p, y) = (p.concat(), self.of_state("regressor", at));
        let needed = self.of_state("inverse_dynamics", at);
        let sizes: Vec<f64> = (y.iter().enumerate())
            .map(|(k, y)| y * p[k % p.len()])
            .collect();
        self.same(
            "Y p",
            &times(&y, &p),
            &needed,
            &[&sizes[..], &needed].concat(),
        );
    }

    /// T = ½ v S v, Ṫ = the sum of all powers, and the rate of the potential energy is −r_g v.
    fn energies(&self, at: &At) {
        let v = self.v(at);
        let energy = self.of_state("kinetic_energy", at);
        self.same(
            "T",
            &energy,
            &self.section(Section::KineticEnergy, at),
            &energy,
        );
        let powers = self.section(Section::Powers, at);
        let slope = self.slopes("kinetic_energy", at, &self.rates(at), 1.0);
        let sizes: Vec<f64> = powers.iter().map(|power| 1e3 * power).collect();
        let sizes = [&sizes[..], &[1e3 * energy[0]]].concat();
        self.same("Ṫ", &slope, &[powers.iter().sum()], &sizes);
        if self.by_itself {
            let half = 0.5 * dot(v, &times(&self.of_state("mass_matrix", at), v));
            self.same("½ v S v", &energy, &[half], &energy);
            let gravity = self.of_state("gravity_forces", at);
            let slope = self.slopes("potential_energy", at, &self.coordinate_rates(at), 0.0);
            let sizes: Vec<f64> = gravity.iter().zip(v).map(|(g, v)| g * v).collect();
            self.same("rate of V", &slope, &[-dot(&gravity, v)], &sizes);
        }
    }

    /// The momentum is A v, its linear part the mass times the velocity of the centre of mass, and its angular part
    /// that about the origin less that of the centre of mass.
    fn momentum(&self, at: &At) {
        let momentum = self.of_state("centroidal_momentum", at);
        let mut rest = At {
            y: at.y.clone(),
            a: at.a.clone(),
            ..*at
        };
        let first = self.engine.info().coordinates.len();
        rest.y[first..][..at.a.len()].fill(0.0);
        let given = self.of_state("centroidal_momentum", &rest);
        let matrix = self.of_state("centroidal_matrix", at);
        let product = times(&matrix, self.v(at));
        let expected: Vec<f64> = product.iter().zip(&given).map(|(a, b)| a + b).collect();
        let sizes = [&momentum[..], &given, &matrix].concat();
        self.same("A v", &expected, &momentum, &sizes);
        let center = self.of_state("center_of_mass", at);
        let velocity = self.slopes("center_of_mass", at, &self.coordinate_rates(at), 1.0);
        let masses = self.model.systems.iter().flat_map(|s| &s.elements);
        let masses = masses.map(|element| match element.mass {
            Number::Constant(mass) => Some(mass),
            _ => None,
        });
        if let Some(mass) = masses.sum::<Option<f64>>() {
            let expected: Vec<f64> = velocity.iter().map(|v| mass * v).collect();
            self.same("M ċ", &momentum[..3], &expected, &sizes);
        }
        let free = self.model.systems.iter().all(|system| {
            matches!(system.reference, Reference::Free)
                && !system.elements[0].joint.turns_with_carrier()
        });
        if free {
            let about_origin = self.machine.results(Method::Momentum, at.t, &at.y);
            let [x, y, z] = [0, 1, 2].map(|i| momentum[i]);
            let moved = [
                center[1] * z - center[2] * y,
                center[2] * x - center[0] * z,
                center[0] * y - center[1] * x,
            ];
            let expected = [0, 1, 2].map(|i| about_origin[3 + i] - moved[i]);
            let sizes = [&about_origin[..], &moved, &momentum].concat();
            self.same("L about the centre", &momentum[3..], &expected, &sizes);
        }
    }

    /// The derivatives of a pose and of a velocity, by dual numbers.
    fn frame(&self, at: &At, frame: &str) {
        let of = |name: &str, at: &At| self.of_state(&format!("{name}({frame})"), at);
        let slopes =
            |name: &str, rates: &[f64]| self.slopes(&format!("{name}({frame})"), at, rates, 1.0);
        let rates = self.coordinate_rates(at);
        let (velocity, jacobian) = (of("velocity", at), of("jacobian", at));
        let (pose, turning) = (of("pose", at), slopes("pose", &rates));
        let row = |matrix: &[f64], i: usize| [0, 1, 2].map(|j| matrix[4 * i + j]);
        // Ṙ Rᵀ = ω ×
        let spin = |i: usize, j: usize| dot(&row(&turning, i), &row(&pose, j));
        let found = [
            turning[3],
            turning[7],
            turning[11],
            spin(2, 1),
            spin(0, 2),
            spin(1, 0),
        ];
        let sizes = [&velocity[..], &rates].concat();
        self.same("velocity", &velocity, &found, &sizes);
        for i in 0..3 {
            for j in 0..3 {
                let unit = dot(&row(&pose, i), &row(&pose, j));
                self.same("R Rᵀ", &[unit], &[f64::from(u8::from(i == j))], &[1.0]);
            }
        }
        let mut rest = At {
            y: at.y.clone(),
            a: at.a.clone(),
            ..*at
        };
        let first = self.engine.info().coordinates.len();
        rest.y[first..][..at.a.len()].fill(0.0);
        let add = |a: Vec<f64>, b: Vec<f64>| -> Vec<f64> {
            a.iter().zip(&b).map(|(a, b)| a + b).collect()
        };
        let product = times(&jacobian, self.v(at));
        let sizes = [&velocity[..], self.v(at)].concat();
        let expected = add(product, of("velocity", &rest));
        self.same(&format!("J v of {frame}"), &expected, &velocity, &sizes);
        let bias = of("bias_acceleration", at);
        let found = slopes("velocity", &rates);
        let sizes = [&bias[..], &velocity, &rates].concat();
        self.same("J̇ v", &bias, &found, &sizes);
        let accelerated = add(times(&jacobian, &at.a), bias);
        let sizes = [&sizes[..], &accelerated, &at.a].concat();
        self.same(
            "acceleration",
            &of("acceleration", at),
            &accelerated,
            &sizes,
        );
    }
}

/// m, h and J of an element about its origin, in its axes; `None` where they depend on parameters.
fn inertia(element: &Element, plane: bool) -> Option<Vec<f64>> {
    let three = |numbers: &[Number; 3]| -> Option<[f64; 3]> {
        let [x, y, z] = [0, 1, 2].map(|i| numbers[i].constant());
        Some([x?, y?, z?])
    };
    let (m, c) = (element.mass.constant()?, three(&element.cg)?);
    let (moments, angles) = (three(&element.inertia)?, three(&element.axes)?);
    let [[s1, c1], [s2, c2], [s3, c3]] = angles.map(|angle| [angle.sin(), angle.cos()]);
    // Rx Ry Rz
    let b = [
        [c2 * c3, -c2 * s3, s2],
        [c1 * s3 + s1 * s2 * c3, c1 * c3 - s1 * s2 * s3, -s1 * c2],
        [s1 * s3 - c1 * s2 * c3, s1 * c3 + c1 * s2 * s3, c1 * c2],
    ];
    let entry = |i: usize, j: usize| {
        let own: f64 = (0..3).map(|k| b[i][k] * moments[k] * b[j][k]).sum();
        let whole = if i == j { dot(&c, &c) } else { 0.0 };
        // in the plane only the moment about y counts
        match plane && (i, j) != (1, 1) {
            true => 0.0,
            false => own + m * (whole - c[i] * c[j]),
        }
    };
    let places = [[0, 0], [0, 1], [1, 1], [0, 2], [1, 2], [2, 2]];
    let mut all = vec![m, m * c[0], m * c[1], m * c[2]];
    all.extend(places.map(|[i, j]| entry(i, j)));
    Some(all)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The product of a matrix by rows with a vector.
fn times(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    let rows = matrix.chunks_exact(vector.len());
    rows.map(|row| dot(row, vector)).collect()
}
