"""Models: their equations at states, runs, studies, gradients."""

import json
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _bryant, differentiable
from ._command import call, call_json
from .run import Run
from .study import Study


class Contacts(NamedTuple):
    """Where surfaces touch, or may: a row for each contact, and for each body that an airbag meets."""

    names: list[str]
    gap: NDArray
    """Positive while the surfaces are apart, negative while they overlap [m]: (contacts,)."""
    place: NDArray
    """Where the force acts: the deepest point over a plane, half-way between the nearest points of two ellipsoids [m]: (contacts, 3)."""
    normal: NDArray
    """From the second body to the first, which has the contact's `ellipsoid`: (contacts, 3)."""
    force: NDArray
    """On the first body [N]: (contacts, 3)."""


def load(model: str | os.PathLike[str], **options: Any) -> "Model":
    """Loads a model: a bundled one by name, a file in YAML or URDF by path, or a text of either.

    Options are those of `bryant import`, for a robot in URDF: base="free", stops=1e4, right_angles=True, uncouple=True,
    no_inputs=True, repair_inertias=True. A file that `Model.keep` wrote is read in a millisecond.
    Raises Error with every problem of the description, its place and what to do.
    """
    path = os.fspath(model)
    folder = tempfile.TemporaryDirectory(prefix="bryant-") if "\n" in path or options else None
    if folder and "\n" in path:
        ending = "urdf" if path.lstrip().startswith("<") else "yaml"
        text, path = path, os.path.join(folder.name, f"model.{ending}")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    if folder and options:
        imported = os.path.join(folder.name, "imported.yaml")
        call("import", path, out=imported, **options)
        path = imported
    loaded = Model(path)
    # a folder lives as long as its model
    loaded._folder = folder
    return loaded


class Named:
    """Names in the order of the columns of an array, and their units."""

    def __init__(self, pairs):
        self.names = [name for name, _ in pairs]
        self.units = dict(pairs)

    def __len__(self):
        return len(self.names)

    def __iter__(self):
        return iter(self.names)

    def __getitem__(self, index):
        return self.names[index]

    def index(self, name: str) -> int:
        """The column of a name."""
        try:
            return self.names.index(name)
        except ValueError:
            raise KeyError(f"there is no {name}; there are {', '.join(self.names)}") from None

    def __repr__(self):
        return "\n".join(f"{name} [{self.units[name]}]" for name in self.names)


class Model(_bryant.Model):
    """The equations of motion of one mechanism, as machine code.

    q, v are arrays of one state (n,) or of many (states, n), a row each; many go through the registers of the
    processor side by side, without the lock of Python. u has the inputs of the model, or the parameters that `vary`
    names, in the same way. `out` is an array for the results; `threads` is a number of threads.
    States of the same model may be evaluated by several threads of Python at once; all give the same bits.
    """

    # names of the columns of q, v, z and m, of outputs and of inputs; the limits of inputs, a row each
    coordinates: Named
    velocities: Named
    auxiliaries: Named
    memory: Named
    outputs_of: Named
    inputs: Named
    input_limits: NDArray
    _path: str
    _parameter_names: Named
    _folder: tempfile.TemporaryDirectory | None

    def __new__(cls, path: str) -> "Model":
        made = super().__new__(cls, path)
        made._path = path
        made.coordinates, made.velocities, made.auxiliaries, made.memory = map(Named, made.state)
        made.outputs_of = Named(made.outputs_named)
        named = made.parameters_named
        made.inputs = Named([(name, unit) for name, unit, _, _, _, given in named if given])
        made.input_limits = np.array([[low, high] for _, _, _, low, high, given in named if given]).reshape(-1, 2)
        made._parameter_names = Named([(name, unit) for name, unit, *_ in named])
        made._folder = None
        return made

    def __repr__(self):
        return (
            f"<bryant model {self.name}: {len(self.velocities)} degrees of freedom, "
            f"{len(self.inputs)} inputs, {self.arithmetic}>"
        )

    def keep(self, path: str | os.PathLike[str], functions: Iterable[str] = ()) -> None:
        """Writes the derived equations into a file whose name ends in .bryant; `load` reads it in a millisecond.

        Of the functions of a robot those are in it that are named here, as "inverse_dynamics" or "jacobian(arm/hand)".
        Runs, studies and gradients need the description, and are not there. A kept file is a program: load only what you trust.
        """
        path = os.fspath(path)
        if not path.endswith(".bryant"):
            raise _bryant.Error(f"the name of a kept file ends in .bryant, and {path} does not")
        content = self.derived(list(functions))
        with open(path, "wb") as file:
            file.write(bytes(content))

    @property
    def path(self) -> str:
        """Where the description is: a file, or the name of a bundled model."""
        if self._path.endswith(".bryant"):
            raise _bryant.Error(f"{self._path} has equations only: load the description for runs, studies and gradients")
        return self._path

    # -- parameters

    @property
    def parameters(self) -> dict[str, float]:
        """Parameters [SI], inputs among them, by name. Assign a dictionary to change some of them."""
        return dict(zip(self._parameter_names, self.values))

    @parameters.setter
    def parameters(self, values: Mapping[str, float]) -> None:
        new = list(self.values)
        for name, value in values.items():
            new[self._parameter_names.index(name)] = float(value)
        self.values = new

    # -- states

    def start(self) -> tuple[NDArray, NDArray]:
        """q and v with which a run begins."""
        q, v, _, _ = self.begin()
        return np.array(q), np.array(v)

    def rates(self, q: ArrayLike, v: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """The rates of q, v and of the states of force laws."""
        return self.evaluate("rates", q, v, u, **options)

    def mass_matrix(self, q: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """S [SI]: (n, n) for one state, (states, n, n) for many."""
        return self.evaluate("mass_matrix", q, None, u, **options)

    def bias(self, q: ArrayLike, v: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """−r_s: centrifugal, Coriolis and gyroscopic forces, without gravity, which is in `applied_forces`."""
        return -self.evaluate("velocity_forces", q, v, u, **options)

    def applied_forces(self, q: ArrayLike, v: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """r_k: gravity, motors, joints, contacts, and all other forces, for each velocity."""
        return self.evaluate("applied_forces", q, v, u, **options)

    def outputs(self, q: ArrayLike, v: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """The outputs of the model, in the order of `outputs_of`."""
        return self.evaluate("outputs", q, v, u, **options)

    def kinetic_energy(self, q: ArrayLike, v: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """The kinetic energy [J]."""
        return self.evaluate("kinetic_energy", q, v, u, **options)

    # -- functions of a robot: derived when they are asked for first, which takes milliseconds

    def inverse_dynamics(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """S a − r_s − r_g [N m, N]: what motors, springs and contacts have to provide together for the accelerations a."""
        return self.evaluate("inverse_dynamics", q, v, u, a=a, **options)

    def gravity_forces(self, q: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """r_g [N m, N]: the generalised forces of all fields."""
        return self.evaluate("gravity_forces", q, None, u, **options)

    def pose(self, frame: str, q: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """Rotation from the axes of the frame to those of the world, and beside it its origin [m]: (3, 4). A frame is an
        element, a point with a name, or a link of a URDF: "tool0", "arm/hand"."""
        return self.evaluate(f"pose({frame})", q, None, u, **options)

    def velocity(self, frame: str, q: ArrayLike, v: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """The velocity of the frame's origin [m/s] and its angular velocity [rad/s], in axes of the world: (6,)."""
        return self.evaluate(f"velocity({frame})", q, v, u, **options)

    def acceleration(self, frame: str, q: ArrayLike, v: ArrayLike, a: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """The acceleration of the frame's origin [m/s²] and its angular acceleration [rad/s²], for the accelerations a."""
        return self.evaluate(f"acceleration({frame})", q, v, u, a=a, **options)

    def jacobian(self, frame: str, q: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """J: the velocity of the frame is J v, linear part first, in axes of the world: (6, n)."""
        return self.evaluate(f"jacobian({frame})", q, None, u, **options)

    def bias_acceleration(self, frame: str, q: ArrayLike, v: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """The rate of J times v: the acceleration of the frame where a is 0."""
        return self.evaluate(f"bias_acceleration({frame})", q, v, u, **options)

    def center_of_mass(self, q: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """The centre of mass of all systems [m]."""
        return self.evaluate("center_of_mass", q, None, u, **options)

    def centroidal_momentum(self, q: ArrayLike, v: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """The linear momentum [N s], and the angular momentum about the centre of mass [N m s]."""
        return self.evaluate("centroidal_momentum", q, v, u, **options)

    def centroidal_matrix(self, q: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """A: the centroidal momentum is A v: (6, n)."""
        return self.evaluate("centroidal_matrix", q, None, u, **options)

    def contacts(self, q: ArrayLike, v: ArrayLike, u: ArrayLike | None = None, **options: Any) -> Contacts:
        """Gaps, places, normals and forces of all contacts and airbags, in axes of the world."""
        all = self.evaluate("contacts", q, v, u, **options)
        names, _ = self.names_of("contacts")
        return Contacts(names, all[..., 0], *(all[..., k : k + 3] for k in (1, 4, 7)))

    def potential_energy(self, q: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """The potential energy in all fields [J]; 0 for a mass at the origin."""
        return self.evaluate("potential_energy", q, None, u, **options)

    def regressor(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, u: ArrayLike | None = None, **options: Any) -> NDArray:
        """Y: inverse dynamics, but for armatures, is Y p, p being m, m c and J of each element: (n, 10 N)."""
        return self.evaluate("regressor", q, v, u, a=a, **options)

    def inverse_dynamics_derivatives(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, u: ArrayLike | None = None, **options: Any) -> list[NDArray]:
        """∂τ/∂q and ∂τ/∂v, exact: (n, n) each. Columns by q are along the motion of each velocity: turns, for quaternions."""
        both = self.evaluate("inverse_dynamics_derivatives", q, v, u, a=a, **options)
        return np.split(both, 2, axis=-1)

    def acceleration_derivatives(self, q: ArrayLike, v: ArrayLike, u: ArrayLike | None = None, **options: Any) -> tuple[NDArray, ...]:
        """v̇, ∂v̇/∂q, ∂v̇/∂v and S⁻¹, exact, with the forces of motors, springs and contacts constant."""
        n = len(self.velocities)
        all = self.evaluate("acceleration_derivatives", q, v, u, **options)
        return (all[..., 0], *np.split(all[..., 1:], [n, 2 * n], axis=-1))

    def linearise(
        self, q: ArrayLike, v: ArrayLike, u: ArrayLike | None = None, *, dt: float | None = None, **options: Any
    ) -> tuple[NDArray, NDArray, NDArray, NDArray]:
        """A, B, C, D of the whole scene with its forces at a state, exact: δẋ = A δx + B δu, δy = C δx + D δu.

        x has the positions along the motion of each velocity, the velocities, and the states of force laws; u the inputs;
        y the outputs. With dt [s], A and B are those of a step with held inputs: δx⁺ = A δx + B δu.
        """
        all = self.evaluate("linearisation", q, v, u, **options)
        x, m = all.shape[-2] - len(self.outputs_of), len(self.inputs)
        a, b, c, d = all[..., :x, :x], all[..., :x, x:], all[..., x:, :x], all[..., x:, x:]
        if dt is not None:
            both = np.zeros((*a.shape[:-2], x + m, x + m))
            both[..., :x, :x], both[..., :x, x:] = a, b
            both = _exponential(dt * both)
            a, b = both[..., :x, :x], both[..., :x, x:]
        return a, b, c, d

    # -- functions of other libraries

    def jax(self) -> Callable[..., Any]:
        """The accelerations as a function f(q, v, u=None) of JAX, under `jit`, `vmap`, `grad` and the like, of one state (n,) or of many.

        Its first derivatives are the exact ones of `linearise`, with all forces; there are no second ones. Quaternions are scaled to length 1
        first. Without u the inputs are those of `parameters` when it is called. The engine computes doubles on the processor; JAX passes floats
        of 32 bits unless jax_enable_x64 is set.
        """
        return differentiable.of_jax(self)

    def torch(self) -> Callable[..., Any]:
        """The accelerations as a function f(q, v, u=None) of PyTorch, with `backward`: see `jax`. The engine computes doubles on the processor."""
        return differentiable.of_torch(self)

    # -- motions

    def rollout(
        self,
        q: ArrayLike,
        v: ArrayLike,
        u: ArrayLike | None = None,
        *,
        dt: float,
        steps: int | None = None,
        parts: int = 1,
        linear: bool = False,
        outputs: bool = False,
        states: ArrayLike | None = None,
        t: float = 0.0,
        vary: list[str] | None = None,
        out: NDArray | None = None,
        threads: int = 1,
    ) -> NDArray:
        """Steps of length `dt` [s] from one state or from many, by the classical Runge–Kutta method.

        u: (steps, inputs), or (states, steps, inputs): held over each step, or with `linear` going from one to the next,
        one more than there are steps. Each step is computed in `parts`.
        Returns the states (q, v, then those of force laws) after each step, (states, steps, length), or the outputs.
        Steps pass over events; `simulation` does not.
        """
        q = np.ascontiguousarray(q, dtype=float)
        if u is not None:
            width = len(self.inputs) if vary is None else len(vary)
            u = np.ascontiguousarray(u, dtype=float)
            shape = q.shape[:-1] + u.shape[q.ndim - 1 :]
            if u.ndim != q.ndim + 1 or u.shape[-1] != width or u.shape != shape:
                raise ValueError(f"u must have the shape {q.shape[:-1]} + (steps, {width}), and has {u.shape}")
            given = u.shape[-2] - (1 if linear else 0)
            if steps not in (None, given):
                raise ValueError(f"u has the inputs of {given} steps, not of {steps}")
            steps = given
        if steps is None:
            raise ValueError("without inputs, the number of steps must be given")
        return self.march(q, v, dt, steps, u, states, t, parts, linear, outputs, vary, out, threads)

    def run(self, set: Mapping[str, Any] | None = None, *, quiet: bool = True, **options: Any) -> Run:
        """A run with error control, events and checks, as `bryant run` does it. Options are those of the command, with
        `_` for `-`: accuracy=1e-3, duration="80 ms", every="0.1 ms", method="rodas5", response=["HIC15 of head"],
        criteria="FMVSS 208, Hybrid III 50M".

        Raises Error if the run fails or cannot be trusted; `error.run` then has what was computed.
        """
        return Run._of(self, dict(set=self._changed(set), **options))

    def simulation(
        self, state: ArrayLike | tuple[ArrayLike, ArrayLike] | None = None, *, t: float = 0.0, tolerance: float = 1e-7
    ) -> "Simulation":
        """A run that is advanced from time to time, with inputs that change between: see Simulation."""
        return Simulation(self, state, t, tolerance)

    def sweep(
        self,
        parameters: Mapping[str, Any],
        *,
        responses: Iterable[Any],
        runs: int | None = None,
        design: str = "sobol",
        seed: int = 0,
        fixed: Mapping[str, Any] | None = None,
        accuracy: float | None = None,
        duration: Any = None,
        sampling: Any = None,
        **options: Any,
    ) -> Study:
        """A study: many runs with other parameters, as `bryant sweep` does it.

        parameters: {"slack": (0, 0.06)}, {"slack": ("0 mm", "60 mm")}, or a dictionary as in a study file;
        responses: ["HIC15 of head accelerometer"], or dictionaries as in a study file.
        """
        fixed = self._changed(fixed)
        run = {"accuracy": accuracy, "duration": duration, "sampling": sampling}
        return Study._of(self, parameters, responses, runs, design, seed, fixed, run, options)

    def gradient(
        self, of: str | Iterable[str], wrt: str | Iterable[str] | None = None, *, set: Mapping[str, Any] | None = None, **options: Any
    ) -> dict[str, dict[str, float]]:
        """Derivatives of responses of a run with respect to parameters, exact: {response: {parameter: derivative}} [SI]."""
        of = [of] if isinstance(of, str) else list(of)
        wrt = None if wrt is None else ",".join([wrt] if isinstance(wrt, str) else wrt)
        found, _ = call_json("gradient", self.path, of=of, wrt=wrt, set=self._changed(set), units="SI", **options)
        return {
            one["response"]: {of["name"]: of["derivative"] for of in one["parameters"]} for one in found["responses"]
        }

    def settle(self, **options: Any) -> dict[str, Any]:
        """A state of rest, as `bryant settle` finds it: a dictionary of what it prints."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "rest.json")
            call("settle", self.path, output=path, set=self._changed(None), **options)
            with open(path, encoding="utf-8") as file:
                return json.load(file)

    def modes(self, start: str | os.PathLike[str] | None = None, **options: Any) -> list[dict[str, Any]]:
        """The modes about a state of rest, as `bryant modes` finds them, slowest first: frequency_Hz, damping, rate_per_s,
        the shares of the kinetic energy, shapes. start: the file of a state, otherwise that in which runs start. report="modes.html"
        writes a page in which the mechanism moves in each of them."""
        found, _ = call_json("modes", self.path, start=start, set=self._changed(None), **options)
        return found["modes"]

    def fmu(
        self,
        path: str | os.PathLike[str],
        *,
        fmi: int = 2,
        library: str | os.PathLike[str] | Iterable[str | os.PathLike[str]] | None = None,
        **options: Any,
    ) -> None:
        """Writes the model as an FMU for co-simulation (version 2 or 3 of FMI), as `bryant export fmu` does it.

        library: the shared library that it carries, one for each platform. The default is that beside the program `bryant`,
        for a wheel has none. Other options are those of the command: tolerance=1e-8, start="rest.json", duration="1 s".
        """
        given = [library] if isinstance(library, (str, os.PathLike)) else list(library or [_beside_program()])
        files = [os.fspath(file) for file in given]
        call("export", "fmu", self.path, out=os.fspath(path), fmi=fmi, library=files, set=self._changed(None), **options)

    def _changed(self, new):
        """Values for commands: those of the model that are not the defaults, and these."""
        changed = {
            name: now
            for (name, _, default, *_), now in zip(self.parameters_named, self.values)
            if now != default
        }
        changed.update(new or {})
        return changed


def _beside_program():
    """The library of FMUs that lies beside the program."""
    name = {"win32": "bryant_fmi.dll", "darwin": "libbryant_fmi.dylib"}.get(sys.platform, "libbryant_fmi.so")
    program = shutil.which("bryant")
    if program:
        file = os.path.join(os.path.dirname(os.path.realpath(program)), name)
        if os.path.isfile(file):
            return file
    raise _bryant.Error(
        f"{name}, which an FMU carries, is not beside a program `bryant` on the PATH\n"
        f"  help: it is in the archive of a release, or `cargo build --release -p bryant-fmi` makes it; name it by library="
    )


def _exponential(matrix):
    """The exponential of matrices: squared as often as makes the rest of the series smaller than rounding."""
    size = np.abs(matrix).sum(axis=-1).max()
    squarings = max(0, int(np.ceil(np.log2(max(size, 1e-300)))) + 1)
    matrix = matrix / 2.0**squarings
    term = total = np.broadcast_to(np.eye(matrix.shape[-1]), matrix.shape)
    for k in range(1, 19):
        term = term @ matrix / k
        total = total + term
    for _ in range(squarings):
        total = total @ total
    return total


class Simulation:
    """A run with error control that is advanced from time to time; inputs are held between.

        simulation = m.simulation()
        while simulation.time < 1:
            torque = -80 * simulation.q[0] - 4 * simulation.v[0]
            simulation.advance(simulation.time + 1e-3, [torque])

    time [s], q, v, state (all of it) and outputs are those reached. Contacts, stops and events act within advances.
    """

    def __init__(self, model, state, t, tolerance):
        self.model = model
        if isinstance(state, tuple):
            q, v = state
            _, _, z, m = model.begin()
            state = np.concatenate([np.asarray(part, dtype=float) for part in (q, v, z, m)])
        self._run = _bryant.Simulation(model, state, t, tolerance)
        self._reach(t, None)

    def _reach(self, t, u):
        self.time, self.state, self.outputs, self.steps = self._run.advance(float(t), u)
        n = len(self.model.coordinates)
        self.q, self.v = self.state[:n], self.state[n : n + len(self.model.velocities)]

    def advance(self, t: float, u: ArrayLike | None = None) -> NDArray:
        """Sets the inputs, if any are given, and advances to the time t [s]. Returns the outputs then.

        Inputs out of their limits are refused with an Error, and nothing has changed."""
        self._reach(t, u)
        return self.outputs

    def __getitem__(self, output):
        return self.outputs[self.model.outputs_of.index(output)]

    def finish(self) -> None:
        """Ends the run. Raises Error if it cannot be trusted: energy that is missing, contacts that were missed."""
        doubts = self._run.finish()
        if doubts:
            raise _bryant.Error("\n".join(doubts))

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if kind is None:
            self.finish()
