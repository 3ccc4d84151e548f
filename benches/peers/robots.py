"""Compares this project with other engines on robots: accelerations of the same URDF files at the same states, in one run on one machine.

`robots.py prepare FOLDER` writes the files that the programs are built from; robots.sh calls it, builds `ours/` with them, and calls this
again to measure. All torques are 0 and gravity acts; damping, friction and limits of joints are taken out of the files. The rounds take turns.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
import pinocchio

import compare
import engines
import states

# By name: the file in example-robot-data, whether the base is free, and the joints that are held.
ROBOTS = {
    "panda": ("panda_description/urdf/panda.urdf", False, "panda_finger_joint"),
    "ur5": ("ur_description/urdf/ur5_robot.urdf", False, None),
    "hyq": ("hyq_description/robots/hyq_no_sensors.urdf", True, None),
    "anymal": ("anymal_b_simple_description/robots/anymal.urdf", True, None),
    "talos": ("talos_data/robots/talos_reduced.urdf", True, None),
}
RIGHT_ANGLES = 1e-3
FUNCTIONS = ["inverse_dynamics", "inverse_dynamics_derivatives", "acceleration_derivatives"]
# How many times as fast as Pinocchio's library one state has to be, and states in lanes.
GOALS = [3, 15]


def main():
    if sys.argv[1:2] == ["prepare"]:
        return prepare(pathlib.Path(sys.argv[2]))
    arguments = parse()
    arguments.work.mkdir(parents=True, exist_ok=True)
    if arguments.functions is not None:
        return compare_functions(arguments)
    ours = [engines.Ours("bryant", arguments.ours)]
    ours += [engines.Ours("bryant, fused", arguments.ours, "1"), engines.Ours("bryant, lanes", arguments.ours, "widest")]
    peers = [engines.Casadi(arguments.work), engines.Aba(arguments.work), engines.Mujoco(arguments.work)]
    for peer in peers:
        peer.relative = Relative(peer.relative)
    columns = ours + peers
    rows, least, wrong = [], [], []
    for name in ROBOTS:
        if arguments.models and name not in arguments.models:
            continue
        robot = read(arguments.robots, name, arguments.ours)
        sample = random(robot, arguments.states, arguments.seed)
        rounds = [[column.accelerations(robot, sample) for column in columns] for _ in range(arguments.rounds)]
        cells = []
        for k, column in enumerate(columns):
            apart = compare.difference(rounds[0][k].rows, rounds[0][0].rows)
            cells.append((compare.median(turn[k] for turn in rounds), apart, 0.0))
            if not apart <= compare.AGREE:
                wrong.append(f"{column.name} on {name}")
        rows.append((name, cells))
        least.append((name, [(min(turn[k].times.min() for turn in rounds), 0.0, 0.0) for k in range(len(columns))]))
        compare.progress(f"{name}: " + ", ".join(f"{cell[0]:.0f}" for cell in cells) + " ns")
    casadi = columns.index(peers[0])
    gains = [[(name, [(cells[casadi][0] / cell[0],) for cell in cells]) for name, cells in times] for times in (rows, least)]
    sections = [
        ("Accelerations, ns per evaluation, medians", compare.table(columns, rows, lambda cell, _: compare.time(cell), "robot")),
        ("The least of all batches, ns", compare.table(columns, least, lambda cell, _: compare.time(cell), "robot")),
        ("As many times as fast as CasADi's code, by medians", compare.table(columns, gains[0], lambda cell, _: f"{cell[0]:.1f}", "robot")),
        ("The same by the least", compare.table(columns, gains[1], lambda cell, _: f"{cell[0]:.1f}", "robot")),
        ("Largest difference from bryant, of the largest acceleration", compare.table(columns, rows, lambda cell, _: compare.share(cell[1]), "robot")),
    ]
    counted = ", ".join(f"{name} {count}" for name, count in peers[0].operations.items())
    compare.report(arguments, [f"CasADi's instructions: {counted}."], sections)
    if wrong:
        sys.exit("these differ where they must not: " + "; ".join(wrong))


def compare_functions(arguments):
    """Functions of a robot: the machine code of the engine beside Pinocchio's library and the code of its algorithms by CasADi."""
    ours = [engines.Ours("bryant", arguments.ours, "f64"), engines.Ours("bryant, lanes", arguments.ours, "widest")]
    casadi = engines.Casadi(arguments.work)
    peers = [casadi, engines.Functions(arguments.work)]
    for peer in peers:
        peer.relative = Relative(peer.relative)
    columns, sections, notes, wrong, missed = ours + peers, [], [], [], []
    for function in arguments.functions or FUNCTIONS:
        rows = []
        for name in arguments.models or ROBOTS:
            robot = read(arguments.robots, name, arguments.ours)
            sample = random(robot, arguments.states, arguments.seed)
            given = np.random.default_rng(arguments.seed + 1).normal(size=(len(sample), velocities(robot)))
            sample = np.hstack([sample, given])
            rounds = [[column.function(robot, function, sample) for column in columns] for _ in range(arguments.rounds)]
            found = [joints_of(robot, measured.rows, of_bryant=k < len(ours)) for k, measured in enumerate(rounds[0])]
            cells = []
            for k, column in enumerate(columns):
                apart = compare.difference(found[k], found[0])
                cells.append((compare.median(turn[k] for turn in rounds), apart, 0.0))
                if not apart <= compare.AGREE:
                    wrong.append(f"{column.name}: {function} of {name}, by {apart:.0e}")
            rows.append((name, cells))
            for cell, goal, column in zip(cells, GOALS, ours):
                if cells[-1][0] < goal * cell[0]:
                    missed.append(f"{column.name}: {function} of {name} is {cells[-1][0] / cell[0]:.1f} times as fast as Pinocchio, and not {goal}")
            compare.progress(f"{function} of {name}: " + ", ".join(f"{cell[0]:.0f}" for cell in cells) + " ns")
        gains = [(name, [(cells[-1][0] / cell[0],) for cell in cells]) for name, cells in rows]
        of_casadi = [(name, [(cells[len(ours)][0] / cell[0],) for cell in cells]) for name, cells in rows]
        sections += [
            (f"{function}, ns per evaluation, medians", compare.table(columns, rows, lambda cell, _: compare.time(cell), "robot")),
            (f"{function}: as many times as fast as Pinocchio (goals: {GOALS[0]}, in lanes {GOALS[1]})", compare.table(columns, gains, lambda cell, _: f"{cell[0]:.1f}", "robot")),
            (f"{function}: as many times as fast as CasADi's code", compare.table(columns, of_casadi, lambda cell, _: f"{cell[0]:.1f}", "robot")),
            (f"{function}: largest difference from bryant, of the largest number", compare.table(columns, rows, lambda cell, _: compare.share(cell[1]), "robot")),
        ]
    counted = ", ".join(f"{name} {count}" for name, count in casadi.operations.items())
    notes.append(f"CasADi's instructions: {counted}.")
    notes.append("Goals missed: " + ("none." if not missed else "; ".join(missed) + "."))
    compare.report(arguments, notes, sections)
    if wrong:
        sys.exit("these differ where they must not: " + "; ".join(wrong))


def velocities(robot):
    return len(robot["places"]) + (6 if robot["free"] else 0)


def joints_of(robot, rows, of_bryant):
    """The entries of matrices whose rows and columns belong to joints, in one order for all engines: what the base adds is in other axes there."""
    n, base = velocities(robot), 6 if robot["free"] else 0
    first = len(robot["places"]) + (7 if robot["free"] else 0)
    order = np.array(robot["places"])[:, 1] - first if of_bryant else np.arange(base, n)
    matrices = rows.reshape(len(rows), n, -1)
    width = matrices.shape[2]
    before = width % n if width > 1 else 1
    columns = [*range(before), *(before + n * block + j for block in range((width - before) // n) for j in order)]
    return matrices[:, order][:, :, columns].reshape(len(rows), -1)


def parse():
    parser = argparse.ArgumentParser(description="Compares this project with Pinocchio and MuJoCo on robots.")
    parser.add_argument("--ours", required=True, type=pathlib.Path, help="the program of ours/, built with ROBOTS")
    parser.add_argument("--robots", required=True, type=pathlib.Path, help="folder of `prepare`")
    parser.add_argument("--work", required=True, type=pathlib.Path, help="folder for what is generated and compiled")
    parser.add_argument("--markdown", type=pathlib.Path, help="where to write the tables as Markdown")
    parser.add_argument("--functions", nargs="*", choices=FUNCTIONS, help="these functions instead of accelerations; all, if none is named")
    parser.add_argument("--models", nargs="*", help="only these")
    parser.add_argument("--states", type=int, default=16, help="states for each robot")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=9)
    return parser.parse_args()


def prepare(folder):
    """Writes NAME.urdf of each robot: its links with their inertia and its joints, nothing else."""
    import cmeel

    home = pathlib.Path(cmeel.__file__).parent.parent / "cmeel.prefix" / "share" / "example-robot-data" / "robots"
    folder.mkdir(parents=True, exist_ok=True)
    for name, (path, _, held) in ROBOTS.items():
        root = ElementTree.parse(home / path).getroot()
        for child in list(root):
            if child.tag not in ("link", "joint"):
                root.remove(child)
        for link in root.iter("link"):
            for child in [child for child in link if child.tag != "inertial"]:
                link.remove(child)
        for joint in root.iter("joint"):
            for child in [child for child in joint if child.tag in ("dynamics", "limit", "mimic", "safety_controller", "calibration")]:
                joint.remove(child)
            if held and joint.get("name").startswith(held):
                joint.set("type", "fixed")
            if joint.get("type") == "revolute":
                joint.set("type", "continuous")
            for origin in joint.iter("origin"):
                if origin.get("rpy"):
                    # right angles are written with few digits
                    origin.set("rpy", " ".join(repr(squared(float(angle))) for angle in origin.get("rpy").split()))
        ElementTree.ElementTree(root).write(folder / f"{name}.urdf")


def squared(angle):
    quarter = round(angle / (np.pi / 2)) * (np.pi / 2)
    return quarter if abs(angle - quarter) < RIGHT_ANGLES else angle


def read(folder, name, program):
    """A robot: joints as Pinocchio reads them, and where the coordinate of each is in the state of this project."""
    path = folder / f"{name}.urdf"
    free = ROBOTS[name][1]
    base = [pinocchio.JointModelFreeFlyer()] if free else []
    model = pinocchio.buildModelFromUrdf(str(path), *base)
    written = {joint.get("name"): joint for joint in ElementTree.parse(path).getroot().iter("joint")}
    names = compare.ask(program, "names", name).split(" ")
    plain = [clean(word.split(".")[-1]) for word in names]
    joints, places = [], []
    for j in range(1, model.njoints):
        place, inertia, joint = model.jointPlacements[j], model.inertias[j], model.names[j]
        first = free and j == 1
        # Pinocchio describes a hinge without limits by a point on a circle; here it is an angle
        kind = "free" if first else {"prismatic": "slider"}.get(written[joint].get("type"), "hinge")
        joints.append({
            "parent": int(model.parents[j]),
            "kind": kind,
            "axis": [0.0, 0.0, 0.0] if first else axis(written[joint]),
            "rotation": place.rotation,
            "at": place.translation,
            "mass": inertia.mass,
            "cg": inertia.lever,
            "inertia": inertia.inertia,
        })
        if not first:
            places.append([plain.index(clean(joint)), plain.index(clean(f"{joint}-rate"))])
    return {"name": name, "folder": folder, "free": free, "joints": joints, "places": places, "gravity": [0.0, 0.0, -9.81]}


def clean(name):
    """A name without the separators of its words."""
    return re.sub("[^a-z0-9]", "", name.lower())


def axis(joint):
    written = joint.find("axis")
    vector = np.array([1.0, 0, 0] if written is None else written.get("xyz").split(), dtype=float)
    return list(vector / (np.linalg.norm(vector) or 1.0))


def random(robot, count, seed):
    """States of this project: the base anywhere, joints from -pi to pi, rates normal with a deviation of 2 rad/s."""
    generator = np.random.default_rng(seed)
    n, rows = len(robot["places"]), []
    for _ in range(count):
        row = np.zeros(2 * n + (13 if robot["free"] else 0))
        for place, rate in robot["places"]:
            row[place], row[rate] = generator.uniform(-np.pi, np.pi), 2 * generator.normal()
        if robot["free"]:
            orientation = generator.normal(size=4)
            row[:3], row[3:7] = generator.normal(size=3), orientation / np.linalg.norm(orientation)
            row[n + 7 : n + 10], row[n + 10 : n + 13] = generator.normal(size=3), 2 * generator.normal(size=3)
        rows.append(row)
    return np.array(rows)


class Relative:
    """The variables of another engine for robots, like those of states.Relative for trees."""

    def __init__(self, of):
        self.of = of

    def base(self, robot, row):
        """The rotation of the base, its velocity and its angular velocity, the last in its axes."""
        n = len(robot["places"])
        rotation = states.matrix(row[3:7])
        return rotation, row[n + 7 : n + 10], rotation.T @ row[n + 10 : n + 13]

    def state(self, robot, row):
        q, v = [], []
        if robot["free"]:
            rotation, velocity, spin = self.base(robot, row)
            w, x, y, z = row[3:7]
            q = [*row[:3], *([x, y, z, w] if self.of.scalar_last else [w, x, y, z])]
            v = [*(rotation.T @ velocity if self.of.body_velocity else velocity), *spin]
        places = np.array(robot["places"])
        return np.concatenate([q, row[places[:, 0]], v, row[places[:, 1]]])

    def with_accelerations(self, robot, row):
        """A state that is followed by accelerations."""
        n = velocities(robot)
        state, given = row[:-n], row[-n:]
        a = []
        if robot["free"]:
            rotation, velocity, spin = self.base(robot, state)
            linear = given[:3]
            if self.of.body_velocity:
                linear = rotation.T @ linear - np.cross(spin, rotation.T @ velocity)
            a = [*linear, *(rotation.T @ given[3:6])]
        first = len(robot["places"]) + (7 if robot["free"] else 0)
        return np.concatenate([self.state(robot, state), a, given[np.array(robot["places"])[:, 1] - first]])

    def accelerations(self, robot, row, found):
        first = len(robot["places"]) + (7 if robot["free"] else 0)
        result = np.zeros(len(found))
        if robot["free"]:
            rotation, velocity, spin = self.base(robot, row)
            linear = found[:3]
            if self.of.body_velocity:
                linear = rotation @ (linear + np.cross(spin, rotation.T @ velocity))
            result[:3], result[3:6] = linear, rotation @ found[3:6]
            found = found[6:]
        result[np.array(robot["places"])[:, 1] - first] = found
        return result


if __name__ == "__main__":
    main()
