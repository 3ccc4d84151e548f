"""States of a free base in other conventions: cases whose answers one sees."""

import bryant
import numpy as np
import pytest
from bryant import conventions

# a box in space with an arm and a slider on it
BOX = """\
model: cube
dimension: 3
systems:
  - name: cube
    elements:
      - { name: cube, mass: 2, cg: [0, 0, 0], inertia: [1, 2, 3] }
      - { name: arm, on: cube, at: [0, 0, 1], joint: { hinge: z, name: elbow }, mass: 1, cg: [0, 1, 0], inertia: [1, 1, 1] }
      - { name: rod, on: cube, at: [0, 1, 0], joint: { slider: x, name: rail }, mass: 1, cg: [0, 1, 0], inertia: [1, 1, 1] }
run: { duration: 1 s, every: 0.1 s }
"""


@pytest.fixture(scope="module")
def box():
    return bryant.load(BOX)


def test_a_box_that_is_turned_by_a_quarter(box):
    half = np.sqrt(0.5)
    # the box's x axis is along y; it moves along y, and turns about x
    q = [1.0, 2.0, 3.0, half, 0, 0, half, 0.4, 0.5]
    v = [0, 7.0, 0, 8.0, 0, 0, 0.1, 0.2]
    p, w = conventions.to_pinocchio(box, q, v, ["rail", "elbow"])
    np.testing.assert_allclose(p, [1, 2, 3, 0, 0, half, half, 0.5, 0.4])
    # along its own x; about −y of its own
    np.testing.assert_allclose(w, [7, 0, 0, 0, -8, 0, 0.2, 0.1], atol=1e-14)
    p, w = conventions.to_mujoco(box, q, v)
    np.testing.assert_allclose(p, q)
    np.testing.assert_allclose(w, [0, 7, 0, 0, -8, 0, 0.1, 0.2], atol=1e-14)


def test_a_continuous_joint_has_a_cosine_and_a_sine_in_pinocchio(box):
    q = [0, 0, 0, 1.0, 0, 0, 0, 0.4, 0.5]
    p, _ = conventions.to_pinocchio(box, q, np.zeros(8), ["rail", "elbow"], continuous=["elbow"])
    np.testing.assert_allclose(p, [0, 0, 0, 0, 0, 0, 1, 0.5, np.cos(0.4), np.sin(0.4)])
    back, _ = conventions.from_pinocchio(box, p, np.zeros(8), ["rail", "elbow"], continuous=["elbow"])
    np.testing.assert_allclose(back, q, atol=1e-15)
    with pytest.raises(ValueError, match="continuous"):
        conventions.from_pinocchio(box, p, np.zeros(8), ["rail", "elbow"])


def test_there_and_back_is_the_same(box):
    random = np.random.default_rng(3)
    q, v = random.normal(size=(50, 9)), random.normal(size=(50, 8))
    q[:, 3:7] /= np.linalg.norm(q[:, 3:7], axis=1, keepdims=True)
    for there, back in [
        (conventions.to_pinocchio, conventions.from_pinocchio),
        (conventions.to_mujoco, conventions.from_mujoco),
    ]:
        found = back(box, *there(box, q, v, ["rail", "elbow"]), ["rail", "elbow"])
        np.testing.assert_allclose(found[0], q, atol=1e-14)
        np.testing.assert_allclose(found[1], v, atol=1e-13)


def test_other_joints_are_refused(box):
    with pytest.raises(ValueError, match="the joints of cube are elbow, rail; those given are elbow, knee"):
        conventions.to_mujoco(box, np.zeros(9), np.zeros(8), ["elbow", "knee"])
    with pytest.raises(ValueError, match="ball"):
        conventions.to_mujoco(bryant.load("dummy15"), *bryant.load("dummy15").start())
