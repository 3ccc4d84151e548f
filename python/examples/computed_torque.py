"""Computed torque at 1 kHz: an arm from URDF follows a path, whose damping the controller does not know.

    python python/examples/computed_torque.py
"""

import pathlib

import bryant
import numpy as np

ARM = pathlib.Path(__file__).with_name("arm.urdf")


def path(t):
    """Angles, speeds and accelerations of the joints at a time."""
    amplitude, frequency, phase = np.array([[0.8, 0.6, 0.5], [2.0, 3.0, 4.0], [0.0, 0.5, 1.0]])
    sine, cosine = np.sin(frequency * t + phase), np.cos(frequency * t + phase)
    return amplitude * sine, amplitude * frequency * cosine, -amplitude * frequency**2 * sine


def main(seconds=2.0, step=1e-3, stiffness=400.0, damping=40.0):
    m = bryant.load(ARM)
    low, high = m.input_limits.T
    worst = 0.0
    with m.simulation(path(0.0)[:2]) as s:
        for k in range(round(seconds / step)):
            q, v, a = path(s.time)
            a = a + stiffness * (q - s.q) + damping * (v - s.v)
            torque = m.inverse_dynamics(s.q, s.v, a)
            s.advance((k + 1) * step, np.clip(torque, low, high))
            worst = max(worst, np.abs(path(s.time)[0] - s.q).max())
        place = m.pose("tool0", s.q)[:, 3]
    print(f"largest error of an angle {worst:.2e} rad; the tool ends at {place.round(3)} m")
    return worst


if __name__ == "__main__":
    main()
