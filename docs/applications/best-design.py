#!/usr/bin/env python3
"""The best design of `child-restraint` under two limits, by the derivatives of `bryant gradient`.

Least head excursion, with the chest (3 ms) and HIC36 below limits. In each step the responses are taken as linear within a box around the
design, and the best corner of the box, or of its cut with the limits, is tried; where it is no better, the box is halved (a
trust region with a merit function). Usage: best-design.py [BRYANT]
"""
import json
import subprocess
import sys

BRYANT = sys.argv[1] if len(sys.argv) > 1 else "bryant"
MODEL = "child-restraint"
GN = 9.80665
OBJECTIVE = "peak of head excursion"
LIMITS = {"3 ms clip of chest acceleration resultant": 38 * GN, "HIC36 of head acceleration resultant": 450.0}
# parameter: from, to, in SI units
DESIGN = {"slot": (0.26, 0.40), "anchor_x": (-0.20, 0.0), "anchor_z": (-0.30, -0.15), "padding": (0.5, 2.0), "webbing": (0.6, 1.6)}
START = {"slot": 0.33, "anchor_x": -0.12, "anchor_z": -0.20, "padding": 1.0, "webbing": 1.0}
# metres that a limit, exceeded by its whole size, is worth
PENALTY = 2.0


def evaluate(design):
    """Values and derivatives, {response: (value, {parameter: derivative})}, parameters as shares of their ranges."""
    command = [BRYANT, "gradient", MODEL, "--json", "--wrt", ",".join(DESIGN)]
    for response in [OBJECTIVE, *LIMITS]:
        command += ["--of", response]
    for name, share in design.items():
        low, high = DESIGN[name]
        command += ["--set", f"{name}={low + share * (high - low):.12g}" + ("" if name in ("padding", "webbing") else " m")]
    # exit code 3: a derivative is not as accurate as 1 %, which is enough for a step that is tried
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode not in (0, 3):
        sys.exit(run.stderr)
    answer = json.loads(run.stdout)
    found = {}
    for response in answer["responses"]:
        slopes = {p["name"]: p["derivative"] * (DESIGN[p["name"]][1] - DESIGN[p["name"]][0]) for p in response["parameters"]}
        found[response["response"]] = (response["value"], slopes)
    return found


def merit(values):
    excess = sum(max(0.0, values[name] / limit - 1.0) for name, limit in LIMITS.items())
    return values[OBJECTIVE] + PENALTY * excess


def predicted(found, step):
    return {name: value + sum(slopes[p] * step[p] for p in step) for name, (value, slopes) in found.items()}


def best_step(found, design, box):
    """The step of least merit of the linear responses in a box: coordinate by coordinate, over the places where the merit bends."""
    step = dict.fromkeys(DESIGN, 0.0)
    for _ in range(40):
        before = dict(step)
        for name in DESIGN:
            low, high = max(-box, -design[name]), min(box, 1.0 - design[name])
            places = [low, high, step[name]]
            for response, limit in LIMITS.items():
                rest = predicted(found, {**step, name: 0.0})[response]
                slope = found[response][1][name]
                if slope:
                    places.append(min(high, max(low, (limit - rest) / slope)))
            step[name] = min(places, key=lambda x: merit(predicted(found, {**step, name: x})))
        if step == before:
            break
    return step


design = {name: (START[name] - low) / (high - low) for name, (low, high) in DESIGN.items()}
found = evaluate(design)
box, evaluations = 0.2, 1
while True:
    values = {name: value for name, (value, _) in found.items()}
    shown = ", ".join(f"{n} {DESIGN[n][0] + s * (DESIGN[n][1] - DESIGN[n][0]):.4g}" for n, s in design.items())
    print(f"{evaluations:3} excursion {1e3 * values[OBJECTIVE]:6.1f} mm, "
          + ", ".join(f"{name} {values[name]:.4g}" for name in LIMITS) + f": {shown}")
    while box > 1e-3:
        step = best_step(found, design, box)
        trial = {name: min(1.0, max(0.0, design[name] + step[name])) for name in DESIGN}
        there = evaluate(trial)
        evaluations += 1
        if merit({n: v for n, (v, _) in there.items()}) < merit(values) - 1e-6:
            design, found, box = trial, there, min(0.4, 1.5 * box)
            break
        box *= 0.5
    else:
        break
