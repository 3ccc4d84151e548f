"""Derivatives of robots by Pinocchio, in the conventions of this project: robot_derivatives.py FOLDER > robot-derivatives.txt

FOLDER has NAME.urdf as benches/peers/robots.py prepares them; NAME.yaml beside this file is `bryant import --right-angles NAME.urdf`, for
anymal with `--base free`. Written with Pinocchio 4.1.0. For each state there are q, v, v̇ and the forces r, and a direction w; then tau, and
the products of the matrices with w. Each line is of one robot and one quantity, state after state. The velocities and forces of a free base are components in absolute axes, and its orientation is
(w, x, y, z); derivatives with respect to q are along the motions of v.
"""

import sys

import numpy as np
import pinocchio as pin

FREE = {"panda": False, "ur5": False, "anymal": True}
# Pinocchio sorts joints by name: where each joint of NAME.yaml is.
ORDER = {"anymal": [0, 1, 2, 6, 7, 8, 3, 4, 5, 9, 10, 11]}


def cross(u):
    return np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])


def state(model, free, generator):
    n = model.nv
    v, a, r, w = (scale * generator.normal(size=n) for scale in (1.5, 3, 5, 1))
    if free:
        turn = generator.normal(size=4)
        turn /= np.linalg.norm(turn)
        q = np.concatenate([generator.normal(size=3), turn, generator.uniform(-np.pi, np.pi, n - 6)])
        r[:6] = 0
    else:
        q = generator.uniform(-np.pi, np.pi, n)
    return q, v, a, r, w


def base(q, v):
    """T with the velocities of Pinocchio T v, and their change with the motions of v."""
    n = len(v)
    rotation = pin.Quaternion(*q[3:7]).matrix()
    turned, moved = np.eye(n), np.zeros((n, n))
    for k in (0, 3):
        turned[k : k + 3, k : k + 3] = rotation.T
        moved[k : k + 3, 3:6] = rotation.T @ cross(v[k : k + 3])
    return rotation, turned, moved


def results(model, free, q, v, a, r, w):
    data, n = model.createData(), model.nv
    if not free:
        # a hinge without limits is a point on a circle
        theirs = np.concatenate([[np.cos(x), np.sin(x)] if model.joints[i + 1].nq == 2 else [x] for i, x in enumerate(q)])
        by_q, by_v, _ = map(np.copy, pin.computeRNEADerivatives(model, data, theirs, v, a))
        tau = pin.rnea(model, model.createData(), theirs, v, a)
        pin.computeABADerivatives(model, data, theirs, v, r)
        return tau, by_q @ w, by_v @ w, data.ddq.copy(), data.ddq_dq @ w, data.ddq_dv @ w, full(data.Minv) @ w
    rotation, turned, moved = base(q, v)
    angles = np.concatenate([[np.cos(x), np.sin(x)] if model.joints[i + 2].nq == 2 else [x] for i, x in enumerate(q[7:])])
    theirs = np.concatenate([q[:3], q[4:7], q[3:4], angles])
    rate, spin = v[:3], v[3:6]
    coriolis = np.cross(spin, rate)
    own = turned @ v
    given = turned @ (a - np.concatenate([coriolis, np.zeros(n - 3)]))
    by_q, by_v, _ = map(np.copy, pin.computeRNEADerivatives(model, data, theirs, own, given))
    inertia = full(pin.crba(model, model.createData(), theirs))
    tau = pin.rnea(model, model.createData(), theirs, own, given)
    of_v = np.zeros((n, n))
    of_v[:3, :3], of_v[:3, 3:6] = -rotation.T @ cross(spin), rotation.T @ cross(rate)
    of_q = np.zeros((n, n))
    of_q[:3, 3:6], of_q[3:6, 3:6] = rotation.T @ cross(a[:3] - coriolis), rotation.T @ cross(a[3:6])
    absolute = turned.T @ tau
    turning = np.zeros((n, n))
    turning[:3, 3:6], turning[3:6, 3:6] = -cross(absolute[:3]), -cross(absolute[3:6])
    ours_q = turned.T @ (by_q @ turned + by_v @ moved + inertia @ of_q) + turning
    ours_v = turned.T @ (by_v @ turned + inertia @ of_v)
    pin.computeABADerivatives(model, data, theirs, own, turned @ r)
    rates = turned.T @ data.ddq
    turning = np.zeros((n, n))
    turning[:3, 3:6], turning[3:6, 3:6] = -cross(rates[:3]), -cross(rates[3:6])
    rates_q = turned.T @ (data.ddq_dq @ turned + data.ddq_dv @ moved) + turning
    rates_v = turned.T @ data.ddq_dv @ turned
    rates_v[:3, :3] += cross(spin)
    rates_v[:3, 3:6] -= cross(rate)
    rates[:3] += coriolis
    inverse = turned.T @ full(data.Minv) @ turned
    return absolute, ours_q @ w, ours_v @ w, rates, rates_q @ w, rates_v @ w, inverse @ w


def full(upper):
    return np.triu(upper) + np.triu(upper, 1).T


def ours(name, values):
    """Values in the order of this project."""
    order = ORDER.get(name, range(len(values)))
    first = len(values) - len(order)
    return [*values[:first], *(values[first + k] for k in order)]


def main():
    generator = np.random.default_rng(7)
    keys = "q v a r w tau tau_q tau_v rates rates_q rates_v inverse".split()
    for name, free in FREE.items():
        first = [pin.JointModelFreeFlyer()] if free else []
        model = pin.buildModelFromUrdf(f"{sys.argv[1]}/{name}.urdf", *first)
        for _ in range(20):
            given = state(model, free, generator)
            for key, values in zip(keys, [*given, *results(model, free, *given)]):
                print(name, key, *(f"{x:.15g}" for x in ours(name, values)))


if __name__ == "__main__":
    main()
