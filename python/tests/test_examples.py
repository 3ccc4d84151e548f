"""The examples do what they say."""

import contextlib
import importlib.util
import json
import os
import pathlib

import bryant
import numpy as np
import pytest

# beside this folder in the repository; elsewhere they are named
EXAMPLES = pathlib.Path(os.environ.get("EXAMPLES", pathlib.Path(__file__).parent.parent / "examples"))


def example(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_regulator_holds_the_pole_and_stays_between_the_stops():
    place, angle = example("cartpole").main()
    assert abs(place) < 1e-2 and abs(angle) < 1e-3


def test_a_regulator_that_hits_a_stop_is_held_by_it():
    # from a large angle the cart runs into a stop: the run goes on, and the cart does not pass it
    place, _ = example("cartpole").main(angle=0.7, seconds=1.0)
    assert abs(place) < 0.65


def test_computed_torque_follows_the_path():
    # damping is left: 0.005 N m s at 2 rad/s, on 0.00225 kg m², over a stiffness of 400 /s²: 0.011 rad
    assert example("computed_torque").main() < 0.02


def test_the_payload_is_identified():
    found, deviation = example("identify").main()
    # four deviations: one seed in ten thousand is further off
    assert abs(found - 0.35) < 4 * deviation and deviation < 0.01


def test_the_pendulum_learns_to_swing_up():
    pytest.importorskip("gymnasium")
    # a pendulum that hangs has −1, one that circles about 0
    assert example("swing_up").main() > 0.8


def test_the_notebook_runs_from_its_first_cell_to_its_last():
    notebook = json.loads((EXAMPLES / "tour.ipynb").read_text(encoding="utf-8"))
    names = {}
    with contextlib.chdir(EXAMPLES):
        for cell in notebook["cells"]:
            if cell["cell_type"] == "code":
                exec(compile("".join(cell["source"]), cell["id"], "exec"), names)
    # what its text says
    assert names["study"].status.tolist() == ["done"] * 16
    assert np.abs(names["arm"].accelerations(names["q"], names["v"], names["hold"])).max() < 1e-10
    assert np.abs(names["numeric"] - names["exact"]).max() < 1e-6
    assert np.abs(names["simulation"].q - names["target"]).max() < 0.01
    assert names["run"].picture().startswith("<svg")


def test_a_robot_that_is_let_go_has_modes():
    modes = bryant.load(PENDULUM).modes()
    assert len(modes) == 1
    # √(m g s / (J + m s²)), s = 0.5
    assert abs(modes[0]["frequency_Hz"] - (2 * 9.81 * 0.5 / 0.6) ** 0.5 / (2 * np.pi)) < 1e-9


PENDULUM = """\
model: clock
dimension: 2
systems:
  - name: s
    reference: fixed
    elements: [{ name: rod, mass: 2, cg: [0, -0.5], inertia: 0.1 }]
forces: [{ field: gravity, acceleration: [0, -9.81] }]
run: { duration: 1 s, every: 10 ms }
"""
