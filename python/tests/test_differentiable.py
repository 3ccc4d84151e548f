"""Accelerations in JAX and PyTorch: derivatives beside differences of the accelerations, and by the checks of these libraries."""

import builtins

import bryant
import numpy as np
import pytest
from test_functions import CARTPOLE

# a pole on a spring and a damper, so that forces have derivatives, too; turned by a torque
SPRUNG = CARTPOLE.replace("  - { joint: s/cart, motor: push }", "  - { joint: s/cart, motor: push }\n  - { joint: s/pole, stiffness: 40, damping: 3 }")
# quaternions of a free base and of ball joints
FALLING = """\
model: falling
dimension: 3
inputs: { push: { value: 0 N*m, min: -20 N*m, max: 20 N*m } }
systems:
  - name: s
    elements:
      - { name: base, mass: 3, cg: [0.1, 0, 0.05], inertia: [0.2, 0.3, 0.4] }
      - { name: arm, on: base, at: [0, 0.2, 0.4], joint: ball, mass: 1, cg: [0, 0.1, 0.3], inertia: [0.05, 0.05, 0.02] }
      - { name: hand, on: arm, at: [0, 0, 0.5], joint: { hinge: x }, mass: 0.5, cg: [0, 0, 0.1], inertia: [0.01, 0.01, 0.01] }
forces:
  - { field: gravity, acceleration: [0, 0, -9.81] }
  - { joint: s/hand, motor: push }
run: { duration: 1 s, every: 0.1 s }
"""


@pytest.fixture(scope="module", params=[SPRUNG, FALLING], ids=["sprung", "falling"])
def model(request):
    return bryant.load(request.param)


def states(model, count):
    random = np.random.default_rng(7)
    q, v = model.start()
    # quaternions that are not of length 1, too
    q = q + 0.4 * random.normal(size=(count, len(q)))
    return q, random.normal(size=(count, len(v))), random.uniform(-5, 5, (count, len(model.inputs)))


def scaled(model, q):
    q = np.array(q)
    for i, name in enumerate(model.coordinates):
        if name.endswith(".qw"):
            q[..., i : i + 4] /= np.linalg.norm(q[..., i : i + 4], axis=-1, keepdims=True)
    return q


def differences(model, q, v, u):
    """∂v̇/∂q, ∂v̇/∂v, ∂v̇/∂u by differences of the accelerations at scaled quaternions: (states, n, columns) each."""
    h = 1e-6
    found = []
    for which, part in enumerate((q, v, u)):
        columns = []
        for j in range(part.shape[1]):
            ends = []
            for sign in (1, -1):
                given = [q, v, u]
                given[which] = part + sign * h * (np.arange(part.shape[1]) == j)
                ends.append(model.accelerations(scaled(model, given[0]), given[1], given[2]))
            columns.append((ends[0] - ends[1]) / (2 * h))
        found.append(np.stack(columns, axis=-1))
    return found


def close(found, expected):
    # differences of h have an error of h² and of ε/h
    np.testing.assert_allclose(found, expected, atol=2e-7 * max(1, np.abs(expected).max()))


def test_functions_of_jax_have_the_derivatives_of_differences(model):
    jax = pytest.importorskip("jax", reason="JAX is not installed")
    check_grads = pytest.importorskip("jax.test_util").check_grads
    jax.config.update("jax_enable_x64", True)
    f = model.jax()
    q, v, u = states(model, 3)
    np.testing.assert_array_equal(f(q, v, u), model.accelerations(scaled(model, q), v, u))
    np.testing.assert_array_equal(jax.jit(f)(q[0], v[0], u[0]), model.accelerations(scaled(model, q[0]), v[0], u[0]))
    expected = differences(model, q, v, u)
    for of in (jax.jacfwd, jax.jacrev):
        derivatives = jax.vmap(of(f, argnums=(0, 1, 2)))(q, v, u)
        for found, by in zip(derivatives, expected):
            close(found, by)
    check_grads(f, (q, v, u), order=1, atol=1e-6, rtol=1e-6)
    check_grads(lambda q, v: f(q, v), (q[0], v[0]), order=1, atol=1e-6, rtol=1e-6)
    # without u they are the parameters at the time of the call, and not at the time when it was compiled
    without = jax.jit(lambda q, v: f(q, v))
    still = without(q[0], v[0])
    before = model.parameters["push"]
    model.parameters = {"push": 10.0}
    try:
        moved = without(q[0], v[0])
        np.testing.assert_array_equal(moved, model.accelerations(scaled(model, q[0]), v[0]))
        assert np.abs(moved - still).max() > 1e-3
    finally:
        model.parameters = {"push": before}
    # there are no second derivatives, and it says so
    with pytest.raises(ValueError, match="(?i)callback"):
        jax.hessian(lambda q: f(q, v[0], u[0])[0])(q[0])


def test_functions_of_torch_have_the_derivatives_of_differences(model):
    torch = pytest.importorskip("torch", reason="PyTorch is not installed")
    f = model.torch()
    given = states(model, 3)
    expected = differences(model, *given)
    q, v, u = (torch.tensor(part, requires_grad=True) for part in given)
    found = f(q, v, u)
    np.testing.assert_array_equal(found.detach(), model.accelerations(scaled(model, given[0]), *given[1:]))
    for i in range(found.shape[1]):
        rows = torch.autograd.grad(found[:, i].sum(), (q, v, u), retain_graph=True)
        for row, by in zip(rows, expected):
            close(row.numpy(), by[:, i])
    assert torch.autograd.gradcheck(f, (q, v, u), eps=1e-6, atol=1e-6, rtol=1e-6)
    assert torch.autograd.gradcheck(lambda q, v: f(q, v), (q[0], v[0]), eps=1e-6, atol=1e-6, rtol=1e-6)
    # floats of 32 bits come back as such
    assert f(q.float(), v.float(), u.float()).dtype == torch.float32
    # there are no second derivatives, and it says so
    first = torch.autograd.grad(f(q, v, u).sum(), v, create_graph=True)[0]
    with pytest.raises(RuntimeError, match="once_differentiable|does not require grad"):
        first.sum().backward()


@pytest.mark.parametrize("library", ["jax", "torch"])
def test_what_is_not_installed_is_named(monkeypatch, library):
    real = builtins.__import__

    def without(name, *rest, **options):
        if name.split(".")[0] == library:
            raise ModuleNotFoundError(f"No module named {library!r}")
        return real(name, *rest, **options)

    model = bryant.load(CARTPOLE)
    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(ImportError, match=f"pip install {library}"):
        getattr(model, library)()


@pytest.mark.parametrize("library", ["jax", "torch"])
def test_arrays_of_the_wrong_shape_and_inputs_beyond_limits_are_refused(library):
    pytest.importorskip(library)
    model = bryant.load(CARTPOLE)
    f = getattr(model, library)()
    import importlib

    array = getattr(importlib.import_module("jax.numpy" if library == "jax" else "torch"), "asarray")
    q, v, u = ([[0.0, 0.3]] * 2, [[0.0, 0.0]] * 2, [[1.0]] * 2)
    assert f(array(q), array(v), array(u)).shape == (2, 2)
    for wrong in [(q, v[:1], u), (q, v, [[1.0, 2.0]] * 2), (q, v, u[:1])]:
        with pytest.raises(Exception, match="must have the shape"):
            np.asarray(f(*map(array, wrong)))
    with pytest.raises(Exception, match="push"):
        np.asarray(f(array(q), array(v), array([[1.0], [50.0]])))
