"""Functions of a robot: closed forms, identities, differences."""

import bryant
import numpy as np
import pytest

# a pendulum of 2 kg at 0.5 m on a cart of 3 kg on a rail, with a motor on the cart
CARTPOLE = """\
model: cartpole
dimension: 2
inputs: { push: { value: 0 N, min: -20 N, max: 20 N } }
systems:
  - name: s
    reference: fixed
    elements:
      - { name: cart, joint: { slider: x }, mass: 3, cg: [0, 0], inertia: 1 }
      - { name: pole, on: cart, at: [0, 0], mass: 2, cg: [0, 0.5], inertia: 0, points: [{ name: tip, at: [0, 1] }] }
forces:
  - { field: gravity, acceleration: [0, -10] }
  - { joint: s/cart, motor: push }
outputs:
  - { name: x, of: s/cart, what: position, component: x }
  - { name: angle, of: s/pole, what: angle }
run: { duration: 1 s, every: 0.1 s }
"""


@pytest.fixture(scope="module")
def cartpole():
    return bryant.load(CARTPOLE)


@pytest.fixture(scope="module")
def arm():
    return bryant.load("robot-arm")


def states(model, count, seed=1):
    random = np.random.default_rng(seed)
    q, v = model.start()
    return q + 0.5 * random.normal(size=(count, len(q))), random.normal(size=(count, len(v)))


def test_a_pendulum_on_a_cart_is_that_of_textbooks(cartpole):
    # S = [[M + m, ± m l cos], [., m l²]], potential energy m g l cos
    angle = 0.3
    s = cartpole.mass_matrix([0.0, angle])
    np.testing.assert_allclose(np.abs(s), [[5, np.cos(angle)], [np.cos(angle), 0.5]], atol=1e-14)
    assert cartpole.potential_energy([0.0, angle]) == pytest.approx(10 * np.cos(angle))
    # upright and at rest nothing is needed; a push of 5 N on 5 kg needs 5 N more where the pole is held
    np.testing.assert_allclose(cartpole.inverse_dynamics([0.0, 0], [0.0, 0], [0.0, 0]), [0, 0], atol=1e-14)
    assert cartpole.inverse_dynamics([0.0, 0], [0.0, 0], [1.0, 0])[0] == pytest.approx(5)
    pose = cartpole.pose("tip", [0.25, 0.0])
    np.testing.assert_allclose(pose, [[1, 0, 0, 0.25], [0, 1, 0, 0], [0, 0, 1, 1]], atol=1e-15)


def test_the_linearisation_of_a_pendulum_on_a_cart_is_that_of_textbooks(cartpole):
    a, b, c, d = cartpole.linearise([0.0, 0.0], [0.0, 0.0])
    # upright: θ'' = (M + m) g θ / (M l), x'' = ∓ m g θ / M, and a push gives 1/M and 1/(M l)
    np.testing.assert_allclose(a[:2], [[0, 0, 1, 0], [0, 0, 0, 1]], atol=1e-14)
    np.testing.assert_allclose(np.abs(a[2:]), [[0, 20 / 3, 0, 0], [0, 100 / 3, 0, 0]], atol=1e-12)
    assert a[3, 1] > 0
    np.testing.assert_allclose(np.abs(b[:, 0]), [0, 0, 1 / 3, 2 / 3], atol=1e-14)
    np.testing.assert_allclose(c, [[1, 0, 0, 0], [0, 1, 0, 0]], atol=1e-15)
    np.testing.assert_allclose(d, 0, atol=1e-15)
    # over a step: the exponential, by its series for a short one
    h = 1e-3
    step, push, _, _ = cartpole.linearise([0.0, 0.0], [0.0, 0.0], dt=h)
    m = h * a
    np.testing.assert_allclose(step, np.eye(4) + m + m @ m / 2 + m @ m @ m / 6 + m @ m @ m @ m / 24, atol=1e-14)
    np.testing.assert_allclose(push, h * (np.eye(4) + m / 2 + m @ m / 6 + m @ m @ m / 24) @ b, atol=1e-14)


def test_derivatives_are_those_of_differences(arm):
    q, v = states(arm, 6)
    a = np.random.default_rng(5).normal(size=v.shape)
    by_q, by_v = arm.inverse_dynamics_derivatives(q, v, a)
    free, fq, fv, inverse = arm.acceleration_derivatives(q, v)
    np.testing.assert_allclose(free, arm.accelerations(q, v), rtol=1e-9, atol=1e-9)
    h = 1e-6
    for j in range(v.shape[1]):
        d = np.zeros_like(v)
        d[:, j] = h
        torque = lambda q, v: arm.inverse_dynamics(q, v, a)
        for found, high, low in [
            (by_q, torque(q + d, v), torque(q - d, v)),
            (by_v, torque(q, v + d), torque(q, v - d)),
        ]:
            # differences of h have an error of h² and of ε/h
            size = np.abs(found).max() + np.abs(high).max()
            np.testing.assert_allclose(found[:, :, j], (high - low) / (2 * h), atol=1e-7 * size)
    # M⁻¹ ∂τ/∂q = −∂v̇/∂q at the accelerations of the motion
    at_motion, at_motion_v = arm.inverse_dynamics_derivatives(q, v, free)
    np.testing.assert_allclose(inverse @ arm.mass_matrix(q), np.broadcast_to(np.eye(v.shape[1]), inverse.shape), atol=1e-8)
    for found, of in [(fq, at_motion), (fv, at_motion_v)]:
        np.testing.assert_allclose(found, -inverse @ of, rtol=1e-7, atol=1e-7 * np.abs(found).max())


def test_frames_move_as_their_jacobians_say(arm):
    frame = "hand"
    q, v = states(arm, 20, 2)
    jacobian = arm.jacobian(frame, q)
    velocity = np.einsum("nij,nj->ni", jacobian, v)
    np.testing.assert_allclose(arm.velocity(frame, q, v), velocity, atol=1e-12)
    h = 1e-6
    high, low = (arm.pose(frame, q + s * h * v)[:, :, 3] for s in (1, -1))
    np.testing.assert_allclose(velocity[:, :3], (high - low) / (2 * h), atol=1e-8)
    a = np.random.default_rng(3).normal(size=v.shape)
    expected = np.einsum("nij,nj->ni", jacobian, a) + arm.bias_acceleration(frame, q, v)
    np.testing.assert_allclose(arm.acceleration(frame, q, v, a), expected, atol=1e-11)


def test_momentum_and_regressor(arm):
    q, v = states(arm, 10, 3)
    momentum = np.einsum("nij,nj->ni", arm.centroidal_matrix(q), v)
    np.testing.assert_allclose(arm.centroidal_momentum(q, v), momentum, atol=1e-11)
    force = arm.gravity_forces(q)
    np.testing.assert_allclose(arm.inverse_dynamics(q, 0 * v, 0 * v), -force, atol=1e-11 * np.abs(force).max())


def test_functions_follow_parameters_and_have_the_same_bits_in_rows():
    model = bryant.load(CARTPOLE.replace("mass: 3", "mass: load").replace("dimension: 2", "dimension: 2\nparameters: { load: 3 }"))
    q, v = states(model, 33)
    together = model.inverse_dynamics(q, v, v)
    np.testing.assert_array_equal(model.inverse_dynamics(q[7], v[7], v[7]), together[7])
    np.testing.assert_array_equal(model.inverse_dynamics(q, v, v, threads=2), together)
    model.parameters = {"load": 4.0}
    np.testing.assert_allclose(model.inverse_dynamics(q, v, v)[:, 0] - together[:, 0], v[:, 0], atol=1e-13)


def test_what_is_not_there_is_refused(arm):
    with pytest.raises(bryant.Error, match="there is no frame `?\"?hnd"):
        arm.pose("hnd", arm.start()[0])
    with pytest.raises(bryant.Error, match="there is no function"):
        arm.evaluate("inverse_dynamic", *arm.start())


def test_contacts(cartpole):
    ball = bryant.load("""\
model: ball
dimension: 3
systems: [{ name: ball, reference: free, elements: [{ name: body, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }], start: { position: [0, 0, 0.4] } }]
forces:
  - { contact: ground, ellipsoid: { on: ball/body, center: [0, 0, 0], semi_axes: [0.5, 0.5, 0.5] }, plane: { on: frame, at: [0, 0, 0], normal: [0, 0, 1] }, stiffness: 1000 }
  - { contact: wall, ellipsoid: { on: ball/body, center: [0, 0, 0], semi_axes: [0.5, 0.5, 0.5] }, plane: { on: frame, at: [2, 0, 0], normal: [-1, 0, 0] }, stiffness: 1000 }
run: { duration: 1, every: 0.1 }
""")
    q, v = ball.start()
    found = ball.contacts(q, v)
    assert found.names == ["ground", "wall"]
    assert np.allclose(found.gap, [-0.1, 1.5])
    assert np.allclose(found.place, [[0, 0, -0.1], [0.5, 0, 0.4]])
    assert np.allclose(found.normal, [[0, 0, 1], [-1, 0, 0]])
    assert np.allclose(found.force, [[0, 0, 100], [0, 0, 0]])
    many = ball.contacts(np.array([q, q, q]), np.array([v, v, v]))
    assert many.force.shape == (3, 2, 3) and many.gap.shape == (3, 2)
    q, v = states(cartpole, 4)
    none = cartpole.contacts(q, v)
    assert none.names == [] and none.gap.shape == (4, 0) and none.force.shape == (4, 0, 3)
