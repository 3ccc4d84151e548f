//! The equations against independent derivations and results.

use bryant_generator::dynamics::lagrange::{NoLagrange, lagrange};
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::equations::{Equations, Route};
use bryant_generator::expression::NodeId;
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::law::types::Load;
use bryant_generator::model::{
    Active, Attachment, Body, Component, Coordinates, Dimension, Element, ElementId,
    FieldComponent, Force, Model, Number, Output, Parameter, PointQuantity, Projection, Quantity,
    Reference, RotationQuantity,
};
use bryant_generator::motion::layout::Layout;
use bryant_tests::reference::{ReferenceTree, load};
use bryant_tests::trees::{
    Random, Shape, chain, choices, random_charts, random_state, random_tree,
};
use nalgebra::{DMatrix, DVector};

fn values(
    equations: &Equations,
    roots: &[NodeId],
    q: &[f64],
    v: &[f64],
    m: &[f64],
    parameters: &[f64],
) -> Vec<f64> {
    let inputs = Inputs {
        time: 0.0,
        coordinates: q,
        velocities: v,
        parameters,
        auxiliaries: &[],
        memory: m,
        accelerations: &[],
    };
    evaluate(&equations.graph, roots, &inputs, &choices)
}

/// S as a matrix.
fn matrix(
    equations: &Equations,
    q: &[f64],
    v: &[f64],
    m: &[f64],
    parameters: &[f64],
) -> DMatrix<f64> {
    let size = equations.velocities.len();
    DMatrix::from_row_slice(
        size,
        size,
        &values(
            equations,
            &equations.mass_matrix.concat(),
            q,
            v,
            m,
            parameters,
        ),
    )
}

/// Largest difference, relative to the largest value.
fn relative_difference(a: &[f64], b: &[f64]) -> f64 {
    let scale = b.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    a.iter()
        .zip(b)
        .fold(0.0f64, |m, (a, b)| m.max((a - b).abs()))
        / scale
}

const ROUTES: [Route; 2] = [Route::Elimination, Route::MassMatrix];

#[test]
fn quaternions_are_told_that_they_have_no_lagrange_equations() {
    let mut random = Random::new(1);
    let model = random_tree(
        &mut random,
        Dimension::Space,
        Coordinates::Quaternion,
        Reference::Free,
        Shape::Chain,
        2,
    );
    let error = lagrange(&model).err();
    assert_eq!(error, Some(NoLagrange::Quaternions));
}

#[test]
fn mass_matrix_and_velocity_forces_are_those_of_lagrange() {
    let mut random = Random::new(1);
    let cases = [
        (Dimension::Plane, vec![1, 2, 3, 5, 8], 100),
        (Dimension::Space, vec![1, 2, 3, 4, 8], 100),
    ];
    for (dimension, counts, states) in cases {
        for count in counts {
            for shape in [Shape::Chain, Shape::Star, Shape::Random] {
                for reference in [Reference::Free, Reference::Fixed] {
                    let model = random_tree(
                        &mut random,
                        dimension,
                        Coordinates::Bryant,
                        reference,
                        shape,
                        count,
                    );
                    let equations = derive_with(
                        &model,
                        Options {
                            matrices: true,
                            route: Some(Route::Elimination),
                        },
                    );
                    let oracle = lagrange(&model).expect("algebra");
                    for _ in 0..states {
                        let (q, v) = random_state(&mut random, &model);
                        let m = random_charts(&mut random, &model);
                        let inputs = Inputs {
                            time: 0.0,
                            coordinates: &q,
                            velocities: &v,
                            parameters: &[],
                            auxiliaries: &[],
                            memory: &m,
                            accelerations: &[],
                        };
                        let roots =
                            [oracle.mass_matrix.concat(), oracle.velocity_forces.clone()].concat();
                        let expected = evaluate(&oracle.graph, &roots, &inputs, &choices);
                        let (s, r) = expected.split_at(v.len() * v.len());
                        let ours = matrix(&equations, &q, &v, &m, &[]);
                        let difference = relative_difference(ours.transpose().as_slice(), s);
                        assert!(
                            difference <= 1e-12,
                            "S of {count} in {dimension:?}, {shape:?}: {difference:e}"
                        );
                        let ours = values(&equations, &equations.velocity_forces, &q, &v, &m, &[]);
                        // each term of r_s is an inertia times two rates; if all terms cancel, they are the scale
                        let scale = s.iter().fold(0.0f64, |m, x| m.max(x.abs()))
                            * v.iter().fold(0.0f64, |m, x| m.max(x * x));
                        let difference = ours
                            .iter()
                            .zip(r)
                            .fold(0.0f64, |m, (a, b)| m.max((a - b).abs()))
                            / scale;
                        assert!(
                            difference <= 1e-12,
                            "r_s of {count} in {dimension:?}, {shape:?}: {difference:e}"
                        );
                    }
                }
            }
        }
    }
}

/// A reference tree with its joint moments as parameters and its accelerations as outputs.
fn instrumented(mut tree: ReferenceTree) -> ReferenceTree {
    let model = &mut tree.model;
    let plane = model.dimension == Dimension::Plane;
    let axes: &[(usize, Component)] = if plane {
        &[(0, Component::X), (2, Component::Z)]
    } else {
        &[(0, Component::X), (1, Component::Y), (2, Component::Z)]
    };
    let turns: &[(usize, Component)] = if plane { &[(1, Component::Y)] } else { axes };
    let elements = model.systems[0].elements.clone();
    let zero = || [0.0; 3].map(Number::from);
    for (k, element) in elements.iter().enumerate() {
        let mut moment = zero();
        for &(axis, _) in turns {
            moment[axis] = Number::Parameter(model.parameters.len());
            let name = format!("moment_{k}_{axis}");
            model.parameters.push(Parameter {
                name,
                default: 0.0,
                min: None,
                max: None,
                unit: "N m".into(),
                input: false,
            });
        }
        let mut act = |on: usize, moment: [Number; 3]| {
            let on = Attachment {
                on: Body::Element(ElementId {
                    system: 0,
                    element: on,
                }),
                at: zero(),
            };
            let law = Box::new(Load {
                on,
                force: zero().map(FieldComponent::Constant),
                moment: moment.map(FieldComponent::Constant),
            });
            model.forces.push(Force {
                name: format!("moment {k} {}", model.forces.len()),
                law,
                active: Active::default(),
            });
        };
        act(k, moment.clone());
        if let Some(parent) = element.parent {
            act(
                parent,
                moment.map(|m| {
                    if m == Number::ZERO {
                        m
                    } else {
                        Number::Negative(Box::new(m))
                    }
                }),
            );
        }
    }
    let mut output = |quantity| {
        model.outputs.push(Output {
            name: format!("{}", model.outputs.len()),
            quantity,
            unit: String::new(),
            code: None,
            filter: None,
            channel: None,
        });
    };
    for (k, element) in elements.iter().enumerate() {
        let id = ElementId {
            system: 0,
            element: k,
        };
        for &(_, component) in turns {
            output(Quantity::Rotation {
                body: Body::Element(id),
                what: RotationQuantity::AngularAcceleration,
                relative_to: Body::Frame,
                projection: Projection::absolute(component),
            });
        }
        for &(_, component) in axes {
            output(Quantity::Point {
                body: Body::Element(id),
                at: element.cg.clone(),
                what: PointQuantity::Acceleration,
                relative_to: Body::Frame,
                projection: Projection::absolute(component),
            });
        }
    }
    tree
}

/// q, v and charts for a state of a reference tree, in the coordinates of the model; every other element is in the
/// second chart.
fn in_coordinates(tree: &ReferenceTree, index: usize) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let (model, state) = (&tree.model, &tree.states[index]);
    let layout = Layout::of(model);
    let (mut q, mut v, mut m) = (vec![], vec![], vec![]);
    if model.systems[0].reference == Reference::Free {
        q.extend(&state.position);
        v.extend(&state.velocity);
    }
    let motions = state.orientation.iter().zip(&state.angular_velocity);
    for (k, (orientation, rate)) in motions.enumerate() {
        if model.dimension == Dimension::Space && model.coordinates == Coordinates::Bryant {
            let chart = (k + index) % 2;
            let (angles, rates) = bryant_of(orientation, rate, chart);
            m.push(chart as f64);
            q.extend(angles);
            v.extend(rates);
        } else {
            q.extend(orientation);
            v.extend(rate);
        }
    }
    assert_eq!(
        (q.len(), v.len()),
        (layout.coordinates.len(), layout.velocities.len())
    );
    assert_eq!(m.len(), layout.charts());
    (q, v, m)
}

/// Bryant angles of a quaternion in a chart, and their rates for ω in absolute axes: from A = Rx Ry Rz, followed in the
/// second chart by a rotation about y by −90°, and from ω = W φ̇ with W inverted numerically.
fn bryant_of(quaternion: &[f64], omega: &[f64], chart: usize) -> ([f64; 3], [f64; 3]) {
    let &[w, x, y, z] = quaternion else {
        panic!("a quaternion")
    };
    let a = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z))
        .to_rotation_matrix();
    let quarter = chart as f64 * std::f64::consts::FRAC_PI_2;
    let a = a * nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::y_axis(), quarter);
    let first = (-a[(1, 2)]).atan2(a[(2, 2)]);
    let second = a[(0, 2)].atan2(a[(1, 2)].hypot(a[(2, 2)]));
    let third = (-a[(0, 1)]).atan2(a[(0, 0)]);
    let columns = nalgebra::Matrix3::new(
        1.0,
        0.0,
        second.sin(),
        0.0,
        first.cos(),
        -first.sin() * second.cos(),
        0.0,
        first.sin(),
        first.cos() * second.cos(),
    );
    let rates = columns
        .lu()
        .solve(&nalgebra::Vector3::from_column_slice(omega))
        .expect("cos φ₂ ≠ 0");
    ([first, second, third], rates.into())
}

#[test]
fn accelerations_are_those_of_the_reference_trees() {
    let cases = [
        ("chain5", Coordinates::Quaternion),
        ("chain5", Coordinates::Bryant),
        ("dummy15", Coordinates::Quaternion),
        ("dummy15", Coordinates::Bryant),
        ("planar9", Coordinates::Quaternion),
    ];
    for (name, coordinates) in cases {
        for route in ROUTES {
            let tree = instrumented(load(name, coordinates));
            let equations = derive_with(
                &tree.model,
                Options {
                    matrices: true,
                    route: Some(route),
                },
            );
            for (index, state) in tree.states.iter().enumerate() {
                let (q, v, m) = in_coordinates(&tree, index);
                let moments = state.joint_moment.concat();
                let mut ours = values(&equations, &equations.outputs, &q, &v, &m, &moments);
                let mut expected: Vec<f64> = vec![];
                for (alpha, a) in state
                    .angular_acceleration
                    .iter()
                    .zip(&state.cg_acceleration)
                {
                    expected.extend(alpha.iter().chain(a));
                }
                if tree.model.systems[0].reference == Reference::Free {
                    let count = state.reference_joint_acceleration.len();
                    ours.extend(&values(
                        &equations,
                        &equations.accelerations[..count],
                        &q,
                        &v,
                        &m,
                        &moments,
                    ));
                    expected.extend(&state.reference_joint_acceleration);
                }
                let difference = relative_difference(&ours, &expected);
                assert!(
                    difference <= 1e-12,
                    "{name} {coordinates:?} {route:?} state {index}: {difference:e}"
                );
            }
        }
    }
}

#[test]
fn elimination_solves_the_system() {
    let mut random = Random::new(2);
    for dimension in [Dimension::Plane, Dimension::Space] {
        for coordinates in [Coordinates::Quaternion, Coordinates::Bryant] {
            for count in [1, 2, 5, 12] {
                for reference in [Reference::Free, Reference::Fixed] {
                    let model = random_tree(
                        &mut random,
                        dimension,
                        coordinates,
                        reference,
                        Shape::Random,
                        count,
                    );
                    let case = format!("{dimension:?} {coordinates:?} {count}");
                    eliminates(&mut random, &model, &case);
                }
            }
        }
    }
}

/// Geometries in which constants of an element vanish or coincide, so that it is eliminated in fewer steps or in
/// another way.
#[test]
fn elimination_solves_the_system_where_geometry_is_special() {
    type Change = fn(usize, &mut Element);
    let cases: [(&str, Change); 9] = [
        ("centres of gravity on the link", |_, e| {
            e.cg = [0.0, 0.0, -0.1].map(Number::from);
            e.at = [0.0, 0.0, -0.2].map(Number::from);
        }),
        ("axisymmetric, along the link", |_, e| {
            e.cg = [0.1, 0.0, 0.0].map(Number::from);
            e.at = [0.2, 0.0, 0.0].map(Number::from);
            e.inertia = [0.01, 0.02, 0.02].map(Number::from);
            e.axes = [0.0; 3].map(Number::from);
        }),
        ("axes of the frame", |_, e| {
            e.axes = [0.0; 3].map(Number::from);
        }),
        ("symmetric to a plane", |_, e| {
            e.cg[1] = 0.0.into();
            e.at[1] = 0.0.into();
            e.axes = [0.0; 3].map(Number::from);
        }),
        ("joint at the centre of gravity", |_, e| {
            e.cg = [0.0; 3].map(Number::from);
        }),
        ("joints that coincide", |k, e| {
            if k % 2 == 1 {
                e.at = [0.0; 3].map(Number::from);
            }
        }),
        ("spherical", |_, e| {
            e.inertia = [0.02; 3].map(Number::from);
        }),
        ("without mass", |k, e| {
            if k % 2 == 1 {
                e.mass = 0.0.into();
            }
        }),
        ("close joints", |k, e| {
            if k % 2 == 1 {
                e.at = [1e-3, 2e-3, -1e-3].map(Number::from);
            }
        }),
    ];
    let mut random = Random::new(7);
    for (name, change) in cases {
        for coordinates in [Coordinates::Quaternion, Coordinates::Bryant] {
            for reference in [Reference::Free, Reference::Fixed] {
                for shape in [Shape::Chain, Shape::Random] {
                    let space = Dimension::Space;
                    let mut model =
                        random_tree(&mut random, space, coordinates, reference.clone(), shape, 6);
                    for (k, element) in model.systems[0].elements.iter_mut().enumerate() {
                        change(k, element);
                    }
                    if let Some(root) = model.systems[0].elements.first_mut() {
                        root.at = [0.0; 3].map(Number::from);
                    }
                    let case = format!("{name}, {coordinates:?} {reference:?} {shape:?}");
                    eliminates(&mut random, &model, &case);
                    // Loaded elements are eliminated in absolute axes, between others that are not.
                    model.forces.push(push_on(2));
                    eliminates(&mut random, &model, &format!("{case}, with a load"));
                }
            }
        }
    }
}

/// A force and a moment on one element of the first system.
fn push_on(element: usize) -> Force {
    let components = |c: [f64; 3]| c.map(|c| FieldComponent::Constant(c.into()));
    let on = Attachment {
        on: Body::Element(ElementId { system: 0, element }),
        at: [0.1, -0.2, 0.3].map(Number::from),
    };
    let load = Load {
        on,
        force: components([3.0, -2.0, 5.0]),
        moment: components([0.4, 0.1, -0.3]),
    };
    Force {
        active: Active::default(),
        name: "push".into(),
        law: Box::new(load),
    }
}

/// Compares the accelerations by elimination with S⁻¹ (r_s + r_k) by Cholesky, to c·κ·ε with c = 10.
fn eliminates(random: &mut Random, model: &Model, case: &str) {
    let equations = derive_with(
        model,
        Options {
            matrices: true,
            route: Some(Route::Elimination),
        },
    );
    for _ in 0..20 {
        let (q, v) = random_state(random, model);
        let m = random_charts(random, model);
        let s = matrix(&equations, &q, &v, &m, &[]);
        let [r_s, r_k, ours] = [
            &equations.velocity_forces,
            &equations.applied_forces,
            &equations.accelerations,
        ]
        .map(|roots| DVector::from_vec(values(&equations, roots, &q, &v, &m, &[])));
        let r = r_s + r_k;
        let spectrum = s.clone().symmetric_eigenvalues();
        let condition = spectrum.max() / spectrum.min();
        let expected = s.cholesky().expect("S is positive definite").solve(&r);
        let difference = (ours - &expected).norm() / expected.norm();
        let bound = 10.0 * condition * f64::EPSILON;
        assert!(difference <= bound, "{case}: {difference:e} > {bound:e}");
    }
}

#[test]
fn a_chain_of_100_keeps_its_digits() {
    let model = chain(
        Dimension::Space,
        Coordinates::Quaternion,
        Reference::Free,
        100,
    );
    let equations = derive_with(
        &model,
        Options {
            matrices: true,
            route: Some(Route::Elimination),
        },
    );
    let mut random = Random::new(3);
    for _ in 0..3 {
        let (q, v) = random_state(&mut random, &model);
        let m = random_charts(&mut random, &model);
        let s = matrix(&equations, &q, &v, &m, &[]);
        let r = DVector::from_vec(values(
            &equations,
            &equations.velocity_forces,
            &q,
            &v,
            &m,
            &[],
        )) + DVector::from_vec(values(
            &equations,
            &equations.applied_forces,
            &q,
            &v,
            &m,
            &[],
        ));
        let a = DVector::from_vec(values(
            &equations,
            &equations.accelerations,
            &q,
            &v,
            &m,
            &[],
        ));
        let residual = (&s * &a - &r).amax() / (s.abs() * a.abs() + r.abs()).amax();
        assert!(residual <= 1e-11, "residual {residual:e}");
    }
}

#[test]
fn the_plane_is_space_confined_to_it() {
    let mut random = Random::new(4);
    for reference in [Reference::Free, Reference::Fixed] {
        for count in [1, 3, 7] {
            let shape = Shape::Random;
            let plane = random_tree(
                &mut random,
                Dimension::Plane,
                Coordinates::Bryant,
                reference.clone(),
                shape,
                count,
            );
            let space = Model {
                dimension: Dimension::Space,
                ..plane.clone()
            };
            let (planar, spatial) = (
                bryant_generator::dynamics::derive(&plane),
                bryant_generator::dynamics::derive(&space),
            );
            for _ in 0..20 {
                let (q, v) = random_state(&mut random, &plane);
                let ours = values(&planar, &planar.accelerations, &q, &v, &[], &[]);
                // planar coordinates among those of space: x, z of the joint, φ₂ of each element
                let lift = |values: &[f64]| {
                    let joint = if reference == Reference::Free { 2 } else { 0 };
                    let mut lifted = vec![];
                    if joint == 2 {
                        lifted.extend([values[0], 0.0, values[1]]);
                    }
                    lifted.extend(values[joint..].iter().flat_map(|&angle| [0.0, angle, 0.0]));
                    lifted
                };
                let expected = values_of(&spatial, &lift(&q), &lift(&v));
                let difference = relative_difference(&lift(&ours), &expected);
                assert!(difference <= 1e-12, "{count} elements: {difference:e}");
            }
        }
    }
}

fn values_of(equations: &Equations, q: &[f64], v: &[f64]) -> Vec<f64> {
    let m = vec![0.0; equations.charts];
    values(equations, &equations.accelerations, q, v, &m, &[])
}

/// The same trees in quaternions and in Bryant angles of any charts, at the same orientations and angular velocities.
///
/// ω = W φ̇ and α = W φ̈ + ε with ε = Ẇ φ̇ turn S α = r_s + r_k into Bᵀ S B φ̈ = Bᵀ (r_s − S ε) + Bᵀ r_k, with B =
/// diag(1, W₁, W₂, …).
#[test]
fn both_charts_are_of_the_motion_in_quaternions() {
    let mut random = Random::new(8);
    for reference in [Reference::Free, Reference::Fixed] {
        for count in [1, 2, 3, 6] {
            let [quaternion, bryant] = [Coordinates::Quaternion, Coordinates::Bryant].map(|c| {
                let (space, shape) = (Dimension::Space, Shape::Random);
                // the same random tree twice
                let mut random = Random::new(9 + count as u64);
                random_tree(&mut random, space, c, reference.clone(), shape, count)
            });
            for route in ROUTES {
                let options = Options {
                    matrices: true,
                    route: Some(route),
                };
                let [in_quaternions, in_angles] =
                    [&quaternion, &bryant].map(|model| derive_with(model, options));
                for _ in 0..50 {
                    let (q, v) = random_state(&mut random, &quaternion);
                    let m = random_charts(&mut random, &bryant);
                    let first = if reference == Reference::Free { 3 } else { 0 };
                    let (mut angles, mut rates) = (q[..first].to_vec(), v[..first].to_vec());
                    let mut b = DMatrix::identity(v.len(), v.len());
                    let mut bias = DVector::zeros(v.len());
                    // W is divided by the cosine of the second angle: states near its pole belong to the other chart
                    let mut smallest = 1.0f64;
                    for k in 0..count {
                        let (at, orientation) = (first + 3 * k, &q[first + 4 * k..][..4]);
                        let (phi, dphi) =
                            bryant_of(orientation, &v[at..at + 3], usize::from(m[k] > 0.5));
                        smallest = smallest.min(phi[1].cos().abs());
                        let (w, epsilon) = rates_to_omega(phi, dphi);
                        b.view_mut((at, at), (3, 3)).copy_from(&w);
                        bias.rows_mut(at, 3).copy_from(&epsilon);
                        angles.extend(phi);
                        rates.extend(dphi);
                    }
                    if smallest < 0.3 {
                        continue;
                    }
                    let s = matrix(&in_quaternions, &q, &v, &[], &[]);
                    let of = |roots: &[NodeId]| {
                        DVector::from_vec(values(&in_quaternions, roots, &q, &v, &[], &[]))
                    };
                    let r_s = of(&in_quaternions.velocity_forces);
                    let r_k = of(&in_quaternions.applied_forces);
                    let alpha = of(&in_quaternions.accelerations);
                    let here = |roots: &[NodeId]| {
                        DVector::from_vec(values(&in_angles, roots, &angles, &rates, &m, &[]))
                    };
                    let ours = matrix(&in_angles, &angles, &rates, &m, &[]);
                    let scale = ours.amax();
                    // some hundred operations, each with rates that are divided by 0.3 up to twice
                    let rounding = 1e-12;
                    let fast = 1.0 + bias.amax() + rates.iter().map(|r| r * r).sum::<f64>();
                    let difference = (&ours - b.transpose() * &s * &b).amax() / scale;
                    assert!(difference <= rounding, "S of {count}: {difference:e}");
                    let expected = b.transpose() * (r_s - &s * &bias);
                    let difference = (here(&in_angles.velocity_forces) - expected).amax();
                    assert!(difference <= rounding * scale * fast, "r_s: {difference:e}");
                    let expected = b.transpose() * r_k;
                    let difference = (here(&in_angles.applied_forces) - &expected).amax();
                    let bound = rounding * expected.amax().max(1.0);
                    assert!(difference <= bound, "r_k of {count}: {difference:e}");
                    let accelerations = &b * here(&in_angles.accelerations) + &bias;
                    let condition = s.clone().symmetric_eigenvalues();
                    let condition = condition.max() / condition.min();
                    let difference = (accelerations - &alpha).amax();
                    let bound = 10.0 * condition * f64::EPSILON * (alpha.amax() + fast) / 0.3;
                    assert!(
                        difference <= bound,
                        "v̇ of {count}: {difference:e} > {bound:e}"
                    );
                }
            }
        }
    }
}

/// W with ω = W φ̇, and Ẇ φ̇; the columns of W are e_x, Rx e_y and Rx Ry e_z.
fn rates_to_omega(
    [first, second, _]: [f64; 3],
    [d1, d2, d3]: [f64; 3],
) -> (nalgebra::Matrix3<f64>, nalgebra::Vector3<f64>) {
    let ((s1, c1), (s2, c2)) = (first.sin_cos(), second.sin_cos());
    #[rustfmt::skip]
    let w = nalgebra::Matrix3::new(
        1.0, 0.0, s2,
        0.0, c1, -s1 * c2,
        0.0, s1, c1 * c2,
    );
    let bias = nalgebra::Vector3::new(
        c2 * d2 * d3,
        -s1 * d1 * d2 + (-c1 * c2 * d1 + s1 * s2 * d2) * d3,
        c1 * d1 * d2 + (-s1 * c2 * d1 - c1 * s2 * d2) * d3,
    );
    (w, bias)
}
