"""Models at states: closed forms, bits, errors."""

import concurrent.futures

import bryant
import numpy as np
import pytest

CART = """\
model: cart
dimension: 2
parameters: { mass: 2 kg }
inputs: { push: { value: 1 N, min: -100 N, max: 100 N } }
systems:
  - name: cart
    reference: fixed
    elements: [{ name: body, joint: { slider: x }, mass: mass, cg: [0, 0], inertia: 1 }]
forces: [{ joint: cart/body, motor: push }]
outputs:
  - { name: x, of: cart/body, what: position, component: x }
  - { name: a, of: cart/body, what: acceleration, component: x }
run: { duration: 1 s, every: 0.1 s }
"""


@pytest.fixture(scope="module")
def cart():
    return bryant.load(CART)


@pytest.fixture(scope="module")
def dummy():
    return bryant.load("dummy15")


def near(model, count, seed=1):
    """States near that of the start."""
    random = np.random.default_rng(seed)
    q, v = model.start()
    q = q + 0.2 * random.normal(size=(count, len(q)))
    for i, name in enumerate(model.coordinates):
        if name.endswith(".qw"):
            q[:, i : i + 4] /= np.linalg.norm(q[:, i : i + 4], axis=1, keepdims=True)
    return q, v + random.normal(size=(count, len(v)))


def test_one_state_and_many(cart):
    assert cart.accelerations([0.0], [0.0]) == [0.5]
    assert cart.accelerations([0.0], [0.0], [-8.0]) == [-4.0]
    q = np.zeros((3, 1))
    np.testing.assert_array_equal(cart.accelerations(q, q, [[2.0], [4.0], [6.0]]), [[1.0], [2.0], [3.0]])
    np.testing.assert_array_equal(cart.mass_matrix(q), np.full((3, 1, 1), 2.0))
    np.testing.assert_array_equal(cart.outputs([3.0], [0.0]), [3.0, 0.5])
    assert cart.kinetic_energy([0.0], [3.0]) == 9.0


def test_names_and_units_are_those_of_the_model(cart):
    assert list(cart.coordinates) == ["cart/body.x"] or len(cart.coordinates) == 1
    assert cart.inputs.names == ["push"] and cart.inputs.units == {"push": "N"}
    assert cart.parameters == {"mass": 2.0, "push": 1.0}
    np.testing.assert_array_equal(cart.input_limits, [[-100.0, 100.0]])
    with pytest.raises(KeyError, match="there is no y; there are x, a"):
        cart.outputs_of.index("y")


def test_parameters_change_or_vary(cart):
    model = bryant.load(CART)
    model.parameters = {"mass": 4.0, "push": 8.0}
    assert model.accelerations([0.0], [0.0]) == [2.0]
    q = np.zeros((2, 1))
    found = model.accelerations(q, q, [[1.0], [2.0]], vary=["mass"])
    np.testing.assert_array_equal(found, [[8.0], [4.0]])
    assert model.accelerations([0.0], [0.0]) == [2.0]
    assert cart.accelerations([0.0], [0.0]) == [0.5]
    with pytest.raises(bryant.Error, match="mass"):
        model.parameters = {"mass": -1.0}
    assert model.parameters["mass"] == 4.0


def test_the_matrices_obey_the_equations_of_motion(dummy):
    q, v = near(dummy, 20)
    a, s = dummy.accelerations(q, v), dummy.mass_matrix(q)
    force = dummy.applied_forces(q, v) - dummy.bias(q, v)
    np.testing.assert_allclose(np.einsum("nij,nj->ni", s, a), force, rtol=0, atol=1e-9 * np.abs(force).max())
    np.testing.assert_array_equal(s, s.transpose(0, 2, 1))


def test_a_row_has_the_same_bits_alone_on_threads_and_from_threads_of_python(dummy):
    q, v = near(dummy, 203)
    together = dummy.accelerations(q, v)
    for i in (0, 8, 202):
        np.testing.assert_array_equal(dummy.accelerations(q[i], v[i]), together[i])
    np.testing.assert_array_equal(dummy.accelerations(q, v, threads=3), together)
    np.testing.assert_array_equal(dummy.accelerations(np.asfortranarray(q), list(v)), together)
    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        for found in pool.map(lambda _: dummy.accelerations(q, v), range(64)):
            np.testing.assert_array_equal(found, together)


def test_parameters_that_change_during_calls_hold_for_all_later_ones():
    model = bryant.load(CART)
    q = np.zeros((2000, 1))
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        for mass in (2.0, 4.0, 5.0, 8.0, 10.0):
            calls = [pool.submit(model.accelerations, q, q) for _ in range(8)]
            model.parameters = {"mass": mass}
            for call in calls:
                call.result()
            # as many at once as models were taken before
            for found in pool.map(lambda _: model.accelerations(q, q), range(8)):
                np.testing.assert_array_equal(found, 1 / mass)


def test_results_go_to_an_array_that_is_given(dummy):
    q, v = near(dummy, 5)
    out = np.empty((5, len(dummy.velocities)))
    assert dummy.accelerations(q, v, out=out) is out
    np.testing.assert_array_equal(out, dummy.accelerations(q, v))
    for wrong in (out[:4], out.T, out.astype("float32")):
        with pytest.raises((ValueError, TypeError), match="array for results"):
            dummy.accelerations(q, v, out=wrong)


def test_arrays_of_every_form_give_the_same_bits(dummy):
    q, v = near(dummy, 9)
    expected = dummy.accelerations(q, v)
    n = q.shape[1]
    # the same doubles: in every second place, from behind, at odd addresses, in the other order of bytes, of another type, read-only, as a list
    spread = np.full((18, 2 * n), 7.0)
    spread[::2, ::2] = q
    odd = np.frombuffer(b"x" + q.tobytes(), dtype=np.uint8)[1:].view(float).reshape(q.shape)
    assert not odd.flags.aligned
    fixed = q.copy()
    fixed.flags.writeable = False

    class Other(np.ndarray):
        pass

    forms = [spread[::2, ::2], q[::-1, ::-1].copy()[::-1, ::-1], odd, q.astype(">f8"), q.astype(np.longdouble), q.view(Other), fixed, q.tolist(), memoryview(q)]
    for form in forms:
        np.testing.assert_array_equal(dummy.accelerations(form, v), expected)
    # whole numbers and floats of 32 bits are turned into doubles
    whole = np.zeros(n, dtype=int)
    whole[3::4] = 1
    still = np.zeros(len(v[0]))
    for form in (whole, whole.astype(np.float32), whole.astype(bool)):
        np.testing.assert_array_equal(dummy.accelerations(form, still), dummy.accelerations(whole.astype(float), still))
    # results go to doubles in rows without gaps that can be written, and nowhere else
    shape = expected.shape
    closed = np.empty(shape)
    closed.flags.writeable = False
    for wrong in (closed, np.empty(shape, order="F"), np.empty(shape, dtype=">f8"), np.empty(shape, dtype=np.float32), np.empty((18, shape[1]))[::2]):
        with pytest.raises((TypeError, ValueError, BufferError), match="array for results"):
            dummy.accelerations(q, v, out=wrong)
    view = np.empty((20, shape[1]))
    dummy.accelerations(q, v, out=view[3:12])
    np.testing.assert_array_equal(view[3:12], expected)


def test_results_that_would_be_written_over_what_is_read_are_refused(cart):
    # one memory for q and for v, each a column
    both = np.linspace(0.1, 1.0, 10)
    q, v = both[:5].reshape(5, 1), both[5:].reshape(5, 1)
    expected = cart.accelerations(q.copy(), v.copy())
    for name, out in [("q", both[:5]), ("v", both[5:]), ("q", both[3:8])]:
        with pytest.raises(ValueError, match=f"shares memory with {name}"):
            cart.accelerations(q, v, out=out.reshape(5, 1))
    room = np.zeros((5, 1))
    with pytest.raises(ValueError, match="shares memory with u"):
        cart.accelerations(q, v, room, out=room)
    room = np.zeros((5, 4, 2))
    with pytest.raises(ValueError, match="shares memory with u"):
        cart.rollout(q, v, room.reshape(-1)[:20].reshape(5, 4, 1), dt=1e-3, out=room)
    # beside each other they may lie
    room = np.empty((15, 1))
    room[:5], room[10:] = q, v
    np.testing.assert_array_equal(cart.accelerations(room[:5], room[10:], out=room[5:10]), expected)


def test_what_does_not_fit_is_refused(cart):
    with pytest.raises(ValueError, match=r"q must have the shape \(1,\) or \(states, 1\), and has \[2\]"):
        cart.accelerations([0.0, 1.0], [0.0])
    # a number is no array of one
    for number in (0.5, np.float64(0.5), np.array(0.5), None):
        with pytest.raises(ValueError, match=r"q must have the shape \(1,\) or \(states, 1\), and has \[\]"):
            cart.accelerations(number, [0.0])
    with pytest.raises(ValueError, match="v must have the shape"):
        cart.accelerations([0.0], [0.0, 1.0])
    with pytest.raises(bryant.Error, match="inputs must have 1 numbers, and has 2"):
        cart.accelerations([0.0], [0.0], [1.0, 2.0])
    with pytest.raises(bryant.Error, match='row 1: the input "push" is 101 N, which is out of its limits, -100 to 100'):
        cart.accelerations([[0.0], [0.0]], [[0.0], [0.0]], [[1.0], [101.0]])
    with pytest.raises(bryant.Error, match="must be finite"):
        cart.accelerations([0.0], [0.0], [np.nan])


def test_an_error_has_the_text_of_the_command_with_place_and_remedy():
    with pytest.raises(bryant.Error, match=r"(?s)massx.*help"):
        bryant.load(CART.replace("mass: mass", "massx: mass"))
    with pytest.raises(bryant.Error, match="there-is-none"):
        bryant.load("there-is-none.yaml")


def test_rollouts_follow_closed_forms(cart):
    random = np.random.default_rng(2)
    n, steps, h = 7, 40, 0.05
    q, v = random.normal(size=(2, n, 1))
    u = random.uniform(-50, 50, size=(n, steps, 1))
    states = cart.rollout(q, v, u, dt=h)
    a = u[:, :, 0] / 2
    speed = v + np.cumsum(a * h, axis=1)
    before = np.concatenate([v, speed[:, :-1]], axis=1)
    place = q + np.cumsum(before * h + a * h * h / 2, axis=1)
    np.testing.assert_allclose(states, np.stack([place, speed], axis=2), rtol=0, atol=1e-11)
    # one state, and outputs
    outputs = cart.rollout(q[3], v[3], u[3], dt=h, outputs=True)
    np.testing.assert_array_equal(outputs[:, 0], states[3, :, 0])
    with pytest.raises(ValueError, match="u must have the shape"):
        cart.rollout(q, v, u[:3], dt=h)


def test_a_simulation_is_driven_and_stops_act_within_advances():
    # a ball that an input pushes up for half a second, and that falls on the floor again
    model = bryant.load(
        """\
model: ball
dimension: 2
inputs: { thrust: { value: 0 N, min: 0 N, max: 100 N } }
systems:
  - name: ball
    elements: [{ name: ball, mass: 1 kg, cg: [0, 0], inertia: 0.1 }]
    start: { position: [0, 1] }
forces:
  - { field: gravity, acceleration: [0, -10] }
  - { load: thrust, on: ball/ball, at: [0, 0], force: [0, thrust] }
outputs: [{ name: height, of: ball/ball, what: position, component: z }]
run: { duration: 1 s, every: 0.1 s }
"""
    )
    simulation = model.simulation()
    for k in range(1, 1001):
        simulation.advance(k * 1e-3, [30.0 if k <= 500 else 0.0])
    # up with 20 m/s² for 0.5 s, then with −10
    assert simulation["height"] == pytest.approx(1 + 20 * 0.125 + 10 * 0.5 - 10 * 0.125, abs=1e-9)
    with pytest.raises(bryant.Error, match="thrust"):
        simulation.advance(1.001, [101.0])
    simulation.advance(1.001, [0.0])
    with pytest.raises(bryant.Error, match="earlier"):
        simulation.advance(0.5)
    simulation.finish()
