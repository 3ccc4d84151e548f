#!/usr/bin/env python3
"""Integrates the bundled model child-seat by scipy and writes child-seat-scipy.json beside this file.

Both integrators and their error control are independent of the project. The equations are not: generated/examples/derivatives.rs,
which this script starts by cargo, evaluates their derivative. The equations themselves are compared with other engines elsewhere.

To run it, from anywhere, with cargo on the path:

    python3 -m venv venv
    venv/bin/pip install numpy==2.4.6 scipy==1.17.1
    venv/bin/python tests/reference/child_seat_scipy.py

The stored numbers were made by Python 3.11.7 with these versions; the file names them, too. It takes some minutes, mostly for compilation.

- Integration restarts at each kink of a curve of time, so that error control need not find these kinks. Error control handles
  kinks of force laws: the force laws of this model are continuous, and it has neither memory nor event functions. By chance an
  error estimate may miss a kink: that of DOP853 at a tolerance of 1e-12 misses one between 50 and 60 ms by hundreds of
  tolerances. Two integrators are unlikely to miss the same kink, so there are two, and a test compares them.
- DOP853 is explicit, Radau is implicit, and they share no coefficients. scipy allows in each step an error whose root
  mean square over the entries, each over atol + rtol |y|, is 1; here atol = rtol.
- "growth" is the growth of errors. Motions with a small deviation from the true one at a time s, in one entry of the state,
  give the derivative of all later states with respect to that entry. In units 1 + |y| of the entry, its magnitudes are summed over all
  entries that may err, and of all s up to a sample the largest sum counts: for each sample and entry of the state. An
  integrator that errs by tau units in each entry and in each of n steps is then off by n tau growth at most, to first order in
  tau. For outputs, the same holds with their derivatives with respect to the state.
"""

import json
import platform
import subprocess
from pathlib import Path

import numpy as np
import scipy
from scipy.integrate import solve_ivp

MODEL = "child-seat"
SAMPLES = np.arange(17) * 10e-3
"""[s]"""
SOLUTIONS = [("DOP853", 1e-13), ("Radau", 1e-12)]
SPACING = 2e-3
"""Distance of the times s at which an error may begin [s], a fraction of the time between samples."""
PERTURBATION = 1e-5
"""In units 1 + |y|: so small that its square is negligible, and far above the error of integration."""
PERTURBED = 1e-10
"""Tolerance of perturbed motions."""


class Derivatives:
    """The running program that evaluates the equations."""

    def __init__(self):
        root = Path(__file__).resolve().parents[2]
        command = "cargo run --quiet --locked -p bryant-generated --example derivatives --"
        self.process = subprocess.Popen(
            command.split() + [MODEL],
            cwd=root,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def ask(self, request):
        self.process.stdin.write(request + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            raise SystemExit(f"no answer to {request!r}")
        return answer.rstrip("\n")

    def numbers(self, request):
        return np.array([float(word) for word in self.ask(request).split()])

    def at(self, request, t, y):
        return self.numbers(" ".join([request, repr(float(t)), *map(repr, y.tolist())]))

    def rate(self, t, y):
        return self.at("rate", t, y)

    def output(self, t, y):
        return self.at("output", t, y)


def pieces(start, end, breakpoints):
    """Splits an interval at kinks in time."""
    inner = [t for t in breakpoints if start < t < end]
    return list(zip([start, *inner], [*inner, end]))


def advance(model, y, start, end, breakpoints, method, tolerance):
    """The state at `end`, from the state at `start`, with the numbers of steps and evaluations."""
    steps = evaluations = 0
    for a, b in pieces(start, end, breakpoints):
        # stages at the end use the curve of time before its kink
        before = np.nextafter(b, a)
        solution = solve_ivp(
            lambda t, y: model.rate(min(t, before), y),
            (a, b),
            y,
            method=method,
            rtol=tolerance,
            atol=tolerance,
        )
        if not solution.success:
            raise SystemExit(f"{method}: {solution.message}")
        y = solution.y[:, -1]
        steps += len(solution.t) - 1
        evaluations += solution.nfev
    return y, steps, evaluations


def trajectory(model, start, breakpoints, method, tolerance):
    """States and outputs at all samples, the number of steps up to each, and the number of evaluations up to the last.

    Every sample is the end of a step: scipy's interpolants are of lower order than its steps.
    """
    y, states, steps, evaluations = start, [start], [0], 0
    for a, b in zip(SAMPLES, SAMPLES[1:]):
        y, more, calls = advance(model, y, a, b, breakpoints, method, tolerance)
        states.append(y)
        steps.append(steps[-1] + more)
        evaluations += calls
    outputs = [model.output(t, y) for t, y in zip(SAMPLES, states)]
    return states, outputs, steps, evaluations


def transition(model, y, start, end, breakpoints):
    """The derivative of the state at `end` with respect to the state at `start`, in columns per unit of tolerance."""
    columns = []
    for entry in range(len(y)):
        change = np.zeros(len(y))
        change[entry] = PERTURBATION * (1 + abs(y[entry]))
        above, below = (
            advance(model, y + sign * change, start, end, breakpoints, "DOP853", PERTURBED)[0]
            for sign in (1, -1)
        )
        columns.append((above - below) / (2 * PERTURBATION))
    return np.array(columns).T


def output_slopes(model, t, y):
    """|∂o/∂y|, the larger one of both sides, because a force law may have a kink here."""
    here, columns = model.output(t, y), []
    for entry in range(len(y)):
        change = np.zeros(len(y))
        change[entry] = size = PERTURBATION * (1 + abs(y[entry]))
        sides = [abs(model.output(t, y + sign * change) - here) / size for sign in (1, -1)]
        columns.append(np.maximum(*sides))
    return np.array(columns).T


def growth(model, start, breakpoints):
    """The growth of errors of states and of outputs, at all samples."""
    parts = round((SAMPLES[1] - SAMPLES[0]) / SPACING)
    y, later = start, [np.diag(1 + abs(start))]
    of_states, of_outputs = [], []
    for sample, t in enumerate(SAMPLES):
        slopes = output_slopes(model, t, y)
        of_states.append(np.max([abs(m).sum(axis=1) for m in later], axis=0))
        of_outputs.append(np.max([slopes @ abs(m).sum(axis=1) for m in later], axis=0))
        if sample + 1 == len(SAMPLES):
            break
        times = np.append(t + np.arange(parts) * SPACING, SAMPLES[sample + 1])
        for a, b in zip(times, times[1:]):
            units = 1 + abs(y)
            step = transition(model, y, a, b, breakpoints)
            y, _, _ = advance(model, y, a, b, breakpoints, "DOP853", PERTURBED)
            # columns are per unit at `a`, rows are not
            later = [step @ (m / units[:, None]) for m in later]
            later.append(np.diag(1 + abs(y)))
    return of_states, of_outputs


def text(rows, digits=None):
    """Rows of numbers, each with the fewest digits that read back exactly, or fewer."""
    show = repr if digits is None else lambda x: f"{x:.{digits - 1}e}"
    lines = ["[" + ", ".join(show(float(x)) for x in row) + "]" for row in rows]
    return "[\n    " + ",\n    ".join(lines) + "\n  ]"


def main():
    model = Derivatives()
    start = model.numbers("start")
    breakpoints = model.numbers("breakpoints").tolist()
    names = {"state": model.ask("names").split("\t"), "outputs": model.ask("outputs").split("\t")}
    versions = f"Python {platform.python_version()}, numpy {np.__version__}, scipy {scipy.__version__}"
    parts = [
        f'"made_by": "child_seat_scipy.py with {versions}"',
        f'"model": "{MODEL}"',
        f'"digest": "{model.ask("digest")}"',
        f'"names": {json.dumps(names)}',
        f'"breakpoints": {json.dumps(breakpoints)}',
        f'"times": {json.dumps(SAMPLES.tolist())}',
    ]
    for method, tolerance in SOLUTIONS:
        states, outputs, steps, evaluations = trajectory(model, start, breakpoints, method, tolerance)
        print(f"{method} at {tolerance:g}: {steps[-1]} steps, {evaluations} evaluations", flush=True)
        parts += [
            f'"{method}": {{\n  "tolerance": {tolerance!r},\n  "steps": {json.dumps(steps)},'
            f'\n  "states": {text(states)},\n  "outputs": {text(outputs)}\n}}'
        ]
    of_states, of_outputs = growth(model, start, breakpoints)
    parts.append(
        f'"growth": {{\n  "states": {text(of_states, 3)},\n  "outputs": {text(of_outputs, 3)}\n}}'
    )
    file = Path(__file__).with_name("child-seat-scipy.json")
    file.write_text("{\n" + ",\n".join(parts) + "\n}\n")


if __name__ == "__main__":
    main()
