"""Runs, studies and gradients: the numbers of the command."""

import csv
import io
import os
import re
import signal
import threading
import time
import zipfile

import bryant
import numpy as np
import pytest


@pytest.fixture(scope="module")
def sled():
    return bryant.load("sled-pendulum")


def test_a_run_has_the_numbers_of_the_command(sled):
    run = sled.run(set={"belt_stiffness": "70 kN"}, every="5 ms")
    text, _ = bryant._command.call(
        "run", "sled-pendulum", set="belt_stiffness=70 kN", every="5 ms", csv="-", no_files=True
    )
    heading, *rows = csv.reader(line for line in io.StringIO(text) if not line.startswith("#"))
    rows = np.array([[float(number) for number in row] for row in rows])
    np.testing.assert_array_equal(run.time, rows[:, 0])
    np.testing.assert_array_equal(run["chest belt force"], rows[:, 1])
    assert set(run.table()) == {"time", *run} and run.units["chest belt force"] == "N"
    assert run.energy["not_accounted_for"] < 1 and run.parameters["belt_stiffness"]["value"] == 70e3
    assert "chest belt force" in repr(run)
    with pytest.raises(KeyError, match="there are chest belt force, head acceleration"):
        run["belt"]


def test_parameters_of_the_model_are_those_of_its_runs():
    model = bryant.load("sled-pendulum")
    stiff = model.run(set={"belt_stiffness": 70e3}, every="5 ms")
    model.parameters = {"belt_stiffness": 70e3}
    np.testing.assert_array_equal(model.run(every="5 ms")["head acceleration"], stiff["head acceleration"])


def test_responses_and_criteria(sled):
    run = sled.run(response=["HIC15 of head acceleration", "peak of chest belt force"])
    assert run.responses["peak of chest belt force"] == pytest.approx(max(run["chest belt force"]), rel=1e-3)
    judged = bryant.load("frontal").run(criteria="FMVSS 208, Hybrid III 50M")
    hic = next(of for of in judged.criteria if of["criterion"] == "HIC15")
    assert hic["limit"] == 700 and hic["value"] > 0


def test_files_and_pictures(sled, tmp_path):
    run = sled.run()
    run.report(tmp_path / "sled.html")
    assert "bryant run sled-pendulum" in (tmp_path / "sled.html").read_text(encoding="utf-8")
    run.animation(tmp_path / "sled.glb")
    assert (tmp_path / "sled.glb").read_bytes()[:4] == b"glTF"
    assert run._repr_svg_().lstrip().startswith("<svg") or "<svg" in run.picture()
    assert os.listdir(tmp_path) and not os.path.exists("sled-pendulum.csv")


def test_a_run_that_cannot_be_trusted_raises_and_has_what_was_computed(sled):
    with pytest.raises(bryant.Error, match="(?i)energy|trust|step") as raised:
        sled.run(method="semi-implicit-euler", step="5 ms", no_verify=True)
    assert len(raised.value.run.time) > 1 and raised.value.run.doubts
    with pytest.raises(bryant.Error, match="belt_stifness.*(?s:.*)belt_stiffness") as raised:
        sled.run(set={"belt_stifness": 1})
    assert raised.value.run is None


def test_a_study_has_the_numbers_of_its_runs(sled):
    study = sled.sweep({"belt_stiffness": (50e3, 70e3)}, runs=8, responses=["peak of chest belt force", "time of peak of chest belt force"])
    assert list(study.status) == ["done"] * 8 and len(study) == 8
    x, y = study["belt_stiffness"], study["peak of chest belt force"]
    assert ((50e3 <= x) & (x <= 70e3)).all()
    run = sled.run(set={"belt_stiffness": x[3]}, response="peak of chest belt force")
    assert run.responses["peak of chest belt force"] == pytest.approx(y[3], rel=2e-3)
    assert study.summary["responses"][0]["mean"] == pytest.approx(y.mean())


def test_a_gradient_is_that_of_differences(sled):
    of = "integral of chest belt force"
    slope = sled.gradient(of, ["belt_stiffness"], sampling="10 us")[of]["belt_stiffness"]
    options = {"response": of, "tolerance": 1e-11, "sampling": "10 us", "no_verify": True}
    low, high = (sled.run(set={"belt_stiffness": 60e3 + d}, **options).responses[of] for d in (-600.0, 600.0))
    # a hundredth of the stiffness: the differences have an error of its square
    assert slope == pytest.approx((high - low) / 1200, rel=1e-3)


def test_ctrl_c_ends_a_run():
    model = bryant.load("child-seat")
    # a program that was started in the background ignores Ctrl-C
    signal.signal(signal.SIGINT, signal.default_int_handler)
    threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        # it would take minutes
        run = model.run(method="rk4", step="1 ns", no_verify=True, max_steps=10**9)
        pytest.fail(f"{time.monotonic() - begin} s: {run.statistics}")
    assert time.monotonic() - begin < 20
    # the next one is not disturbed
    assert len(model.run(duration="5 ms").time) > 1


def test_a_model_becomes_an_fmu(sled, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(bryant.Error, match="is not beside a program `bryant` on the PATH"):
        sled.fmu(tmp_path / "sled.fmu")
    library = tmp_path / "library.so"
    library.write_bytes(b"nothing")
    with pytest.raises(bryant.Error, match="is no library of FMUs"):
        sled.fmu(tmp_path / "sled.fmu", library=library)


@pytest.mark.skipif("BRYANT_FMI" not in os.environ, reason="the library of FMUs is not there")
def test_an_fmu_has_the_parameters_of_the_model(tmp_path):
    model = bryant.load("sled-pendulum")
    model.parameters = {"belt_stiffness": 70e3}
    model.fmu(tmp_path / "sled.fmu", fmi=3, library=os.environ["BRYANT_FMI"], tolerance=1e-8)
    with zipfile.ZipFile(tmp_path / "sled.fmu") as archive:
        names = archive.namelist()
        description = archive.read("modelDescription.xml").decode()
    assert "resources/model.bryant" in names and any(name.startswith("binaries/") for name in names)
    stiffness = re.search(r'<[^>]*name="belt_stiffness"[^>]*>', description).group()
    assert 'start="70000"' in stiffness, stiffness
    assert 'fmiVersion="3.0"' in description
