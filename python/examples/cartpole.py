"""A pole on a cart, held upright by a linear-quadratic regulator at 100 Hz. The cart runs between stops.

    python python/examples/cartpole.py
"""

import bryant
import numpy as np

MODEL = """\
model: cartpole
dimension: 2
inputs: { push: { value: 0 N, min: -30 N, max: 30 N } }
systems:
  - name: s
    reference: fixed
    elements:
      - { name: cart, joint: { slider: x }, mass: 1 kg, cg: [0, 0], inertia: 1 }
      - { name: pole, on: cart, at: [0, 0], mass: 0.2 kg, cg: [0, 0.4], inertia: 0.01 }
forces:
  - { field: gravity, acceleration: [0, -9.81] }
  - { joint: s/cart, motor: push, damping: 0.5, stop: { from: -0.6 m, to: 0.6 m, stiffness: 20 kN/m } }
outputs:
  - { name: x, of: s/cart, what: position, component: x }
  - { name: angle, of: s/pole, what: angle }
run: { duration: 5 s, every: 10 ms }
"""


def regulator(a, b, weights, effort):
    """The gain K of u = −K x with the least Σ xᵀ Q x + uᵀ R u, by repeating Riccati's equation."""
    q, r = np.diag(weights), np.diag(effort)
    p = q
    for _ in range(5000):
        k = np.linalg.solve(r + b.T @ p @ b, b.T @ p @ a)
        p = q + a.T @ p @ (a - b @ k)
    return k


def main(angle=0.25, seconds=5.0, step=0.01):
    m = bryant.load(MODEL)
    # upright, at rest: δx⁺ = A δx + B u over a step with a held push
    a, b, _, _ = m.linearise([0.0, 0.0], [0.0, 0.0], dt=step)
    gain = regulator(a, b, weights=[10, 10, 1, 1], effort=[0.01])
    low, high = m.input_limits.T
    furthest = 0.0
    with m.simulation(([0.0, angle], [0.0, 0.0])) as s:
        for k in range(round(seconds / step)):
            push = np.clip(-gain @ [*s.q, *s.v], low, high)
            s.advance((k + 1) * step, push)
            furthest = max(furthest, abs(s["x"]))
        print(f"from {angle} rad: cart at {s['x']:.2e} m, pole at {s['angle']:.2e} rad; furthest {furthest:.3f} m; {s.steps} steps")
        return s["x"], s["angle"]


if __name__ == "__main__":
    main()
