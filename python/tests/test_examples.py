"""The examples do what they say."""

import importlib.util
import os
import pathlib

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
