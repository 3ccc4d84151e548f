"""The engines, each as programs that are built for a model and give accelerations with their times.

What is built is kept in a folder, under names that hold the digest of everything it is built from.
"""

import hashlib
import json
import os
import pathlib
import subprocess
from importlib.metadata import version

import numpy as np

import states

HERE = pathlib.Path(__file__).resolve().parent
FLAGS = ["-O3", "-march=native", "-DNDEBUG"]
# gcc -O3 takes time with the square of a function's length: above this many instructions its code is compiled by -O1.
MOST_FOR_O3 = 20_000
PINOCCHIO = states.Relative(scalar_last=True, body_velocity=True)
MUJOCO = states.Relative(scalar_last=False, body_velocity=False)


class Measurement:
    """The answer of one run of a program: nanoseconds of each batch, and rows in the variables of this project."""

    def __init__(self, output, convert):
        lines = output.splitlines()
        self.times = np.array(lines[0].split(), dtype=float)
        self.rows = np.array([convert(i, np.array(line.split(), dtype=float)) for i, line in enumerate(lines[1:])])


def _run(command, rows):
    lines = [str(len(rows))] + [" ".join(repr(float(x)) for x in row) for row in rows]
    done = subprocess.run([str(part) for part in command], input="\n".join(lines) + "\n", capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{command}: {done.stderr.strip()}")
    return done.stdout


def _build(folder, compiler, sources, flags, text=""):
    """A program from sources and flags, compiled unless it already exists."""
    digest = hashlib.sha256()
    for path in [*sources, HERE / "programs" / "common.h", HERE / "programs" / "tree.hpp"]:
        digest.update(pathlib.Path(path).read_bytes())
    about = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True).stdout
    digest.update(" ".join([about, text, *flags]).encode())
    program = pathlib.Path(folder) / f"{pathlib.Path(sources[0]).stem}-{digest.hexdigest()[:16]}"
    if not program.exists():
        partial = program.with_suffix(".partial")
        subprocess.run([compiler, *map(str, sources), *flags, "-o", str(partial), "-lm"], check=True)
        os.replace(partial, program)
    return program


class Ours:
    """This project, as one of the programs of ours/."""

    methods = ["rk4", "dop853", "adams"]

    def __init__(self, name, program, column="f64"):
        self.name, self.program, self.column = name, program, column

    def accelerations(self, tree, rows):
        command = [self.program, "accelerations", tree["name"], self.column]
        return Measurement(_run(command, rows), lambda _, row: row)

    def function(self, robot, name, rows):
        command = [self.program, "function", robot["folder"], robot["name"], name, self.column]
        return Measurement(_run(command, rows), lambda _, row: row)

    def fall(self, tree, row, duration, step, method="rk4"):
        command = [self.program, "fall", duration, step, self.column, method]
        return Measurement(_run(command, [row]), lambda _, row: row)


class Peer:
    """An engine in relative variables; `command` gives the beginning of the command line for a tree."""

    methods = ["rk4"]
    relative = None

    def accelerations(self, tree, rows):
        given = [self.relative.state(tree, row) for row in rows]
        output = _run(self.command(tree, "accelerations"), given)
        return Measurement(output, lambda i, row: self.relative.accelerations(tree, rows[i], row))

    def function(self, robot, name, rows):
        given = [self.relative.with_accelerations(robot, row) for row in rows]
        return Measurement(_run(self.of_function(robot, name), given), lambda _, row: row)

    def fall(self, tree, row, duration, step, method="rk4"):
        assert method in self.methods
        command = [*self.command(tree, "fall"), duration, step]
        output = _run(command, [self.relative.state(tree, row)])
        return Measurement(output, lambda _, end: self.relative.absolute(tree, end))


class Mujoco(Peer):
    """mj_forward, and mj_step by RK4, without contacts and constraints."""

    name = "MuJoCo mj_forward"
    relative = MUJOCO

    def __init__(self, folder):
        import mujoco

        self.folder = folder
        home = pathlib.Path(mujoco.__file__).parent
        library = home / f"libmujoco.so.{version('mujoco')}"
        flags = [*FLAGS, f"-I{home / 'include'}", str(library), f"-Wl,-rpath,{home}"]
        self.program = _build(folder, "gcc", [HERE / "programs" / "mujoco.c"], flags)

    def command(self, tree, what):
        path = pathlib.Path(self.folder) / f"{tree['name']}.xml"
        path.write_text(mjcf(tree))
        return [self.program, what, path]


def mjcf(tree):
    """A tree in MuJoCo's language."""

    def text(values):
        return " ".join(repr(float(value)) for value in values)

    if "joints" in tree:
        return mjcf_of_robot(tree, text)
    elements = tree["elements"]

    def body(i):
        element = elements[i]
        inertia = element["inertia"]
        if tree["plane"]:
            # nothing rotates about x and z, but a moment of inertia of 0 is refused
            inertia = [inertia[1]] * 3
        if tree["plane"]:
            slides = '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>'
            joint = (slides if element["parent"] is None and tree["free"] else "") + '<joint type="hinge" axis="0 1 0"/>'
        else:
            joint = "<freejoint/>" if element["parent"] is None and tree["free"] else '<joint type="ball"/>'
        inertial = f'<inertial pos="{text(element["cg"])}" mass="{element["mass"]!r}" diaginertia="{text(inertia)}"/>'
        children = "".join(body(k) for k, child in enumerate(elements) if child["parent"] == i)
        return f'<body pos="{text(element["at"])}">{joint}{inertial}{children}</body>'

    if _depth_first(elements) != list(range(len(elements))):
        raise ValueError(f"{tree['name']}: MuJoCo takes elements depth first, so they must stand in that order")
    roots = "".join(body(i) for i, element in enumerate(elements) if element["parent"] is None)
    flags = '<flag contact="disable" constraint="disable"/>'
    return f'<mujoco><option gravity="{text(tree["gravity"])}">{flags}</option><worldbody>{roots}</worldbody></mujoco>\n'


def mjcf_of_robot(robot, text):
    """A robot in MuJoCo's language."""
    joints = robot["joints"]

    def body(j):
        """The body outboard of a joint; joints count from 1, 0 is the world."""
        of = joints[j - 1]
        i = of["inertia"]
        full = [i[0][0], i[1][1], i[2][2], i[0][1], i[0][2], i[1][2]]
        joint = "<freejoint/>" if of["kind"] == "free" else f'<joint type="{of["kind"].replace("slider", "slide")}" axis="{text(of["axis"])}"/>'
        inertial = f'<inertial pos="{text(of["cg"])}" mass="{float(of["mass"])!r}" fullinertia="{text(full)}"/>'
        axes = text([*of["rotation"][:, 0], *of["rotation"][:, 1]])
        children = "".join(body(k) for k, child in enumerate(joints, 1) if child["parent"] == j)
        return f'<body pos="{text(of["at"])}" xyaxes="{axes}">{joint}{inertial}{children}</body>'

    roots = "".join(body(j) for j, joint in enumerate(joints, 1) if joint["parent"] == 0)
    order = _depth_first([{"parent": joint["parent"] - 1 if joint["parent"] else None} for joint in joints])
    if order != list(range(len(joints))):
        raise ValueError(f"{robot['name']}: MuJoCo takes bodies depth first, so they must stand in that order")
    flags = '<flag contact="disable" constraint="disable"/>'
    compiler = '<compiler balanceinertia="false" boundmass="0" angle="radian"/>'
    return f'<mujoco>{compiler}<option gravity="{text(robot["gravity"])}">{flags}</option><worldbody>{roots}</worldbody></mujoco>\n'


def _depth_first(elements, parent=None):
    """Indices of the elements, each followed by all elements that it carries."""
    order = []
    for i, element in enumerate(elements):
        if element["parent"] == parent:
            order += [i, *_depth_first(elements, i)]
    return order


class Pinocchio(Peer):
    """The common parts of programs made from Pinocchio's headers."""

    relative = PINOCCHIO
    # as the CMake files of the package require
    DEFINITIONS = [
        "-DBOOST_MPL_LIMIT_LIST_SIZE=30",
        "-DBOOST_MPL_LIMIT_VECTOR_SIZE=30",
        "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
        "-DBOOST_FUSION_INVOKE_MAX_ARITY=12",
    ]

    def __init__(self, folder):
        import casadi
        import cmeel

        self.folder = pathlib.Path(folder)
        self.casadi = pathlib.Path(casadi.__file__).parent
        prefix = pathlib.Path(cmeel.__file__).parent.parent / "cmeel.prefix"
        eigen = self.casadi / "include" / "eigen3"
        self.flags = ["-std=c++17", "-w", *self.DEFINITIONS, f"-I{prefix / 'include'}", f"-I{eigen}"]
        self.basis = version("pin") + version("casadi")

    def tree(self, tree):
        """The file of a tree or a robot, for programs/tree.hpp."""
        if "joints" in tree:
            rows = [["robot", len(tree["joints"])], tree["gravity"]]
            for j in tree["joints"]:
                inertia = [j["inertia"][a][b] for a, b in [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)]]
                rows.append([j["parent"], j["kind"], *j["axis"], *j["rotation"].ravel(), *j["at"], j["mass"], *j["cg"], *inertia])
            path = self.folder / f"{tree['name']}.txt"
            path.write_text("".join(" ".join(map(str, row)) + "\n" for row in rows))
            return path
        rows = [[int(tree["plane"]), int(tree["free"]), len(tree["elements"])], tree["gravity"]]
        for e in tree["elements"]:
            rows.append([-1 if e["parent"] is None else e["parent"], *e["at"], e["mass"], *e["cg"], *e["inertia"]])
        path = self.folder / f"{tree['name']}.txt"
        path.write_text("".join(" ".join(map(repr, row)) + "\n" for row in rows))
        return path


class Aba(Pinocchio):
    """The articulated-body algorithm, over numbers."""

    name = "Pinocchio aba"

    def __init__(self, folder):
        super().__init__(folder)
        source = HERE / "programs" / "aba.cpp"
        self.program = _build(folder, "g++", [source], [*FLAGS, *self.flags], self.basis)

    def command(self, tree, what):
        return [self.program, what, self.tree(tree)]


class Functions(Pinocchio):
    """Functions over numbers."""

    name = "Pinocchio"

    def __init__(self, folder):
        super().__init__(folder)
        source = HERE / "programs" / "functions.cpp"
        self.program = _build(folder, "g++", [source], [*FLAGS, *self.flags], self.basis)

    def of_function(self, robot, name):
        return [self.program, name, self.tree(robot)]


class Casadi(Pinocchio):
    """The same algorithm over CasADi's symbols, shared by cse, written as C and compiled.

    `operations` has, for each model met, how many CasADi counts.
    """

    name = "Pinocchio, code by CasADi"

    def __init__(self, folder):
        super().__init__(folder)
        source = HERE / "programs" / "generate.cpp"
        include, library = f"-I{self.casadi / 'include'}", str(self.casadi / "libcasadi.so")
        flags = ["-O1", "-DNDEBUG", *self.flags, include, library, f"-Wl,-rpath,{self.casadi}"]
        self.generator = _build(folder, "g++", [source], flags, self.basis)
        self.programs, self.operations = {}, {}

    def command(self, tree, what):
        name = tree["name"]
        if name not in self.programs:
            self.programs[name] = self._generate(tree)
        return [self.programs[name], what]

    def of_function(self, robot, name):
        key = f"{robot['name']} {name}"
        if key not in self.programs:
            source = f"{robot['name']}_{name}.c"
            said = self._written(robot, source, [name])
            self.operations[key] = said["operations"]
            level = "-O3" if said["operations"] < MOST_FOR_O3 else "-O1"
            flags = [level, *FLAGS[1:], *(f"-D{key.upper()}={said[key]}" for key in ["nq", "nv", "width"])]
            self.programs[key] = _build(self.folder, "gcc", [self.folder / source, HERE / "programs" / "function.c"], flags)
        return [self.programs[key]]

    def _written(self, tree, source, what):
        """Writes the C of a model; returns what the generator says of it."""
        command = [str(self.generator.resolve()), str(self.tree(tree).resolve()), source, *what]
        done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=self.folder)
        return json.loads(done.stdout)

    def _generate(self, tree):
        name = tree["name"]
        source, fall = f"{name}.c", ["rate"] if name == "dummy15" else []
        said = self._written(tree, source, fall)
        self.operations[name] = said["operations"]
        flags = [*FLAGS, f"-DNQ={said['nq']}", f"-DNV={said['nv']}"]
        if fall:
            flags += ["-DFALL", f"-DQUATERNIONS={','.join(map(str, said['quaternions']))}"]
        return _build(self.folder, "gcc", [self.folder / source, HERE / "programs" / "casadi.c"], flags)
