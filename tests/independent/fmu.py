"""FMUs of `bryant export fmu`, validated and simulated by FMPy.

At the instants of its communications an FMU has the outputs of `bryant run`, bit for bit. A cart that is pushed from outside has closed forms: with held
pushes, other parameters, steps of uneven lengths, several instances side by side, and after a reset. What an FMU must refuse, it refuses with a message.

    python3 fmu.py BRYANT
"""

import csv
import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

import fmpy
import fmpy.fmi2
import fmpy.fmi3
import fmpy.validation

bryant = sys.argv[1]
scenes = pathlib.Path(__file__).parents[2] / "benches/scenes"

CART = """
model: cart
dimension: 2
parameters: { mass: { value: 2 kg, min: 1 kg, max: 5 kg } }
inputs: { push: { value: 0 N, min: -100 N, max: 100 N } }
systems:
  - name: s
    reference: fixed
    elements: [{ name: cart, joint: { slider: x }, mass: { param: mass }, cg: [0, 0], inertia: 1 }]
forces:
  - { joint: s/cart, motor: push }
outputs:
  - { name: x, of: s/cart, what: position, component: x }
  - { name: mass, of: s/cart, what: acceleration, component: x }
run: { duration: 1 s, every: 10 ms }
"""


def run(*arguments):
    done = subprocess.run([bryant, *arguments], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def table(*arguments):
    """Names of the columns, and the rows of a run."""
    head, *rows = csv.reader(run("run", *arguments, "--no-verify", "--no-files", "--csv", "-").splitlines())
    return [re.sub(r" \[[^]]*\]$", "", name) for name in head], [[float(cell) for cell in row] for row in rows]


class Slave:
    """An instance, with the messages that it has sent."""

    def __init__(self, path, start=0.0, stop=None, tolerance=None, values=()):
        self.description = fmpy.read_model_description(path)
        self.references = {of.name: of.valueReference for of in self.description.modelVariables}
        self.messages = []
        three = self.description.fmiVersion.startswith("3")
        made = {
            "guid": self.description.guid,
            "unzipDirectory": fmpy.extract(path),
            "modelIdentifier": self.description.coSimulation.modelIdentifier,
            "instanceName": "one",
        }
        if three:
            self.fmu = fmpy.fmi3.FMU3Slave(**made)
            self.fmu.instantiate(logMessage=self.hear3)
        else:
            self.fmu = fmpy.fmi2.FMU2Slave(**made)
            callbacks = fmpy.fmi2.fmi2CallbackFunctions()
            callbacks.logger = fmpy.fmi2.fmi2CallbackLoggerTYPE(self.hear2)
            callbacks.allocateMemory = fmpy.fmi2.fmi2CallbackAllocateMemoryTYPE(fmpy.fmi2.calloc)
            callbacks.freeMemory = fmpy.fmi2.fmi2CallbackFreeMemoryTYPE(fmpy.fmi2.free)
            self.fmu.instantiate(callbacks=callbacks)
        self.three, self.t = three, start
        self.begin(start, stop, tolerance, values)

    def hear2(self, _environment, _name, status, _category, message):
        self.messages.append((status, message.decode()))

    def hear3(self, _environment, status, _category, message):
        self.messages.append((status, message.decode()))

    def begin(self, start=0.0, stop=None, tolerance=None, values=()):
        if self.three:
            for name, value in values:
                self.set(name, value)
            self.fmu.enterInitializationMode(tolerance=tolerance, startTime=start, stopTime=stop)
        else:
            self.fmu.setupExperiment(tolerance=tolerance, startTime=start, stopTime=stop)
            for name, value in values:
                self.set(name, value)
            self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        self.t = start

    def set(self, name, value):
        (self.fmu.setFloat64 if self.three else self.fmu.setReal)([self.references[name]], [value])

    def get(self, *names):
        return list((self.fmu.getFloat64 if self.three else self.fmu.getReal)([self.references[name] for name in names]))

    def step(self, length):
        self.fmu.doStep(currentCommunicationPoint=self.t, communicationStepSize=length)
        self.t += length

    def refuses(self, words, call, *arguments):
        try:
            call(*arguments)
        except fmpy.fmi1.FMICallException:
            status, message = self.messages[-1]
            assert status == 3 and words in message, message
            return
        raise AssertionError(f"{words}: not refused")


scratch = tempfile.TemporaryDirectory()
folder = pathlib.Path(scratch.name)

# the same bits as a run, at the instants that the description suggests
compared = 0
for model in ["child-seat", "robot-arm", "frontal", str(scenes / "occupant.yaml")]:
    names, rows = table(model)
    for version in "23":
        path = folder / f"{pathlib.Path(model).stem}-{version}.fmu"
        run("export", "fmu", model, "--fmi", version, "-o", str(path))
        problems = fmpy.validation.validate_fmu(str(path))
        assert problems == [], problems
        assert path.stat().st_size < 5e6
        description = fmpy.read_model_description(str(path))
        every, stop = (float(of) for of in (description.defaultExperiment.stepSize, description.defaultExperiment.stopTime))
        result = fmpy.simulate_fmu(str(path), output_interval=every, stop_time=stop, output=names[1:])
        assert len(result) == len(rows), (len(result), len(rows))
        for expected, found in zip(rows, result):
            for name, value in zip(names, expected):
                assert found[name] == value, f"{model}, FMI {version}: {name} at {expected[0]} s is {found[name]}, not {value}"
                compared += 1

# a cart
(folder / "cart.yaml").write_text(CART, encoding="utf-8")
for version in "23":
    path = str(folder / f"cart-{version}.fmu")
    run("export", "fmu", str(folder / "cart.yaml"), "--fmi", version, "-o", path)
    assert fmpy.validation.validate_fmu(path) == []
    description = fmpy.read_model_description(path)
    kinds = {of.name: (of.causality, of.variability, of.unit, of.start, of.min, of.max) for of in description.modelVariables}
    assert kinds["mass"] == ("parameter", "fixed", "kg", "2", "1", "5"), kinds
    assert kinds["push"] == ("input", "continuous", "N", "0", "-100", "100"), kinds
    # an output with the name of the parameter
    assert kinds["output mass"][:3] == ("output", "continuous", "m/s^2"), kinds
    assert kinds["x"][:3] == ("output", "continuous", "m") and kinds["s/cart.position"][0] == "local", kinds

    one, two = Slave(path, stop=1.0), Slave(path, values=[("mass", 4.0), ("push", 8.0)])
    assert one.get("x", "output mass") == [0.0, 0.0] and two.get("mass", "output mass") == [4.0, 2.0]
    # pushes that change between steps of uneven lengths, and two instances side by side
    x = v = 0.0
    for length, push in [(0.1, 10.0), (0.05, 0.0), (0.25, -30.0), (0.0125, 100.0)]:
        one.set("push", push)
        # the acceleration follows at once
        assert one.get("output mass") == [push / 2.0]
        one.step(length)
        two.step(length)
        x, v = x + v * length + push / 2 * length**2 / 2, v + push / 2 * length
        position, speed = one.get("x", "s/cart.position-rate")
        assert abs(position - x) < 1e-13 and abs(speed - v) < 1e-12, (position, x, speed, v)
        assert abs(two.get("x")[0] - two.t**2) < 1e-13
    one.refuses("push", one.set, "push", 101.0)
    one.refuses("push", one.set, "push", float("nan"))
    one.refuses("constant during a run", one.set, "mass", 3.0)
    one.refuses("no parameter and no input", one.set, "x", 3.0)
    units = {of.name: of.baseUnit for of in description.unitDefinitions}
    assert (units["N"].kg, units["N"].m, units["N"].s) == (1, 1, -2), units
    one.refuses("the step begins at", one.fmu.doStep, 0.3, 0.1)
    one.refuses("a length of", one.fmu.doStep, one.t, -0.1)
    assert one.get("mass", "push") == [2.0, 100.0]
    # beyond the end that was announced
    one.refuses("no later than the duration", one.fmu.doStep, one.t, 1.0)
    one.fmu.reset()
    one.begin(stop=1.0, values=[("push", 4.0)])
    one.step(0.5)
    assert abs(one.get("x")[0] - 0.25) < 1e-14 and one.get("time") == [0.5]
    for slave in (one, two):
        slave.fmu.terminate()
        slave.fmu.freeInstance()

# options of the export are those of the FMU
names, rows = table("child-seat", "--step", "1 ms", "--set", "lap_slack=20 mm")
path = str(folder / "fixed.fmu")
run("export", "fmu", "child-seat", "--step", "1 ms", "--set", "lap_slack=20 mm", "-o", path)
result = fmpy.simulate_fmu(path, output=names[1:])
assert all(found[name] == value for row, found in zip(rows, result) for name, value in zip(names, row))

# from a state in the middle of a run
state = str(folder / "state.json")
run("run", "child-seat", "--no-verify", "--no-files", "--duration", "60 ms", "--final-state", state)
names, rows = table("child-seat", "--start", state)
path = str(folder / "started.fmu")
run("export", "fmu", "child-seat", "--start", state, "-o", path)
started = Slave(path, start=0.06, stop=0.16)
assert rows[0][0] == 0.06 and started.get(*names[1:]) == rows[0][1:]
for row in rows[1:]:
    started.step(row[0] - started.t)
    started.t = row[0]
    assert started.get(*names[1:]) == row[1:], row[0]

# what cannot be trusted is said at the end
path = str(folder / "coarse.fmu")
run("export", "fmu", "child-seat", "--step", "10 ms", "-o", path)
coarse = Slave(path, stop=0.16)
for _ in range(16):
    coarse.step(0.01)
assert not coarse.messages
coarse.fmu.terminate()
assert len(coarse.messages) > 1 and all(status == 1 for status, _ in coarse.messages), coarse.messages
assert any("2.13 percent of the largest energy" in message for _, message in coarse.messages), coarse.messages

# resources of another model are refused
with zipfile.ZipFile(folder / "cart-2.fmu") as cart, zipfile.ZipFile(path) as seat, zipfile.ZipFile(folder / "mixed.fmu", "w") as mixed:
    for name in cart.namelist():
        mixed.writestr(name, (seat if name == "resources/model.bryant" else cart).read(name))
try:
    Slave(str(folder / "mixed.fmu"))
    raise AssertionError("an FMU of two models is accepted")
except AssertionError:
    raise
except Exception:  # FMPy raises one without a class of its own
    pass

print(f"{compared} values have the bits of runs; a cart, in FMI 2.0 and 3.0, its closed form and its refusals")
