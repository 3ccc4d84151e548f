"""Identification: the masses of an arm from torques that were measured on it, with noise.

τ = Y(q, v, v̇) p is linear in the inertia p of the elements (regressor), so least squares find what the torques determine.

    python python/examples/identify.py
"""

import pathlib

import bryant
import numpy as np

ARM = pathlib.Path(__file__).with_name("arm.urdf")


def main(samples=400, noise=0.02, payload=0.35, seed=1):
    truth = bryant.load(ARM.read_text().replace('mass value="0.5"', f'mass value="{0.5 + payload}"'))
    m = bryant.load(ARM)
    random = np.random.default_rng(seed)
    q, v, a = (scale * random.normal(size=(samples, 3)) for scale in (0.8, 1.5, 5.0))
    measured = truth.inverse_dynamics(q, v, a) + noise * random.normal(size=(samples, 3))
    # the change of the hand's mass, at its centre of mass, explains the torques beyond those of the model
    _, columns = m.names_of("regressor")
    y = m.regressor(q, v, a).reshape(3 * samples, -1)
    hand = [columns.index(name) for name in columns if "hand.m" in name or "hand.h" in name or "hand.j" in name]
    # one mass at the place of the hand's centre of mass: m, h = m c, J = m (c² 1 − c cᵀ)
    c = np.array([0, 0, 0.05])
    j = c @ c * np.eye(3) - np.outer(c, c)
    direction = np.array([1, *c, j[0, 0], j[0, 1], j[1, 1], j[0, 2], j[1, 2], j[2, 2]])
    rest = (measured - m.inverse_dynamics(q, v, a)).ravel()
    column = y[:, hand] @ direction
    found = column @ rest / (column @ column)
    deviation = noise / np.sqrt(column @ column)
    print(f"payload {found:.4f} kg ± {deviation:.4f} kg; it is {payload} kg")
    return found, deviation


if __name__ == "__main__":
    main()
