"""Compares the Python package with Pinocchio and MuJoCo: the times that a user of Python sees, with their goals.

python.sh prepares what this needs. The robot is the panda of robots.py, with motors. All engines read the same file;
their accelerations are compared first. The rounds take turns, so that a machine that is slower for a while is so for
all; the result is the median of all rounds. One thread, unless the row says another number.

A goal is a time on the machine on which it was set. It is multiplied by the time that the others take here for what
they took there: the geometric mean of the ratios to THERE. So a slower machine has longer goals. Sizes are not scaled.
"""

import argparse
import os
import pathlib
import subprocess
import sys
import timeit
import xml.etree.ElementTree as ElementTree

import bryant
import bryant.gym
import mujoco
import mujoco.rollout
import numpy as np
import pinocchio

import compare

# Times of the others on the machine on which the goals were set, by row and column [s].
THERE = {("call", "Pinocchio"): 2.5e-6, ("call", "MuJoCo"): 2.2e-6, ("rollout", "MuJoCo"): 9098e-9}
# By row: what it says, the goal, its unit, the factor from s to that unit, whether more is better, whether it depends on the machine.
ROWS = {
    "call": ("accelerations of one state, with `out=`", 0.7, "µs", 1e6, False, True),
    "rows": ("accelerations of {count} states, for each", 40, "ns", 1e9, False, True),
    "rollout": ("{copies} rollouts of {steps} steps by RK4 with torques, for each step", 150, "ns", 1e9, False, True),
    "environment": ("environments of {copies} arms, steps per second, {threads} threads", 1e6, "1/s", 1, True, True),
    "import": ("import, after that of numpy", 30, "ms", 1e3, False, True),
    "load": ("load of a URDF", 100, "ms", 1e3, False, True),
    "kept": ("load from a file of its own", 2, "ms", 1e3, False, True),
    "wheel": ("size of the wheel", 5, "MB", 1e-6, False, False),
}
COLUMNS = ["bryant", "Pinocchio", "MuJoCo"]
COUNT, COPIES, STEPS, ACTIONS, THREADS = 10_000, 1024, 100, 20, 2
STEP = 1e-3
# Steps of an environment between two actions, and their length [s].
PARTS, PAUSE = 4, 0.02
EFFORT = 87.0
# Time that a measurement lasts at least [s].
LASTS = 0.05


def main():
    arguments = parse()
    robot = with_motors(arguments.robots / "panda.urdf")
    tried = tasks(robot, arguments.robots)
    rounds = [{key: task() for key, task in tried.items()} for _ in range(arguments.rounds)]
    times = {key: float(np.median([turn[key] for turn in rounds])) for key in tried}
    times |= sizes(arguments.wheels)
    slower = [times[key] / there for key, there in THERE.items()]
    scale = float(np.exp(np.mean(np.log(slower))))
    rows, missed = [["", *COLUMNS, "goal", "goal here", ""]], []
    for name, (title, goal, unit, factor, more, scales) in ROWS.items():
        title = title.format(count=COUNT, copies=COPIES, steps=STEPS, threads=THREADS)
        here = goal * ((1 / scale if more else scale) if scales else 1)
        found = times[name, "bryant"] * factor
        met = found >= here if more else found <= here
        if not met:
            missed.append(title)
        cells = [figure(times[name, column] * factor) if (name, column) in times else "–" for column in COLUMNS]
        rows.append([f"{title} [{unit}]", *cells, figure(goal), figure(here), "met" if met else "missed"])
    of = ", ".join(f"{column} {row} {ratio:.2f}" for (row, column), ratio in zip(THERE, slower))
    notes = [
        f"{compare.processor()}, Python {sys.version.split()[0]}, numpy {np.__version__}, bryant {bryant.__version__}, Pinocchio {pinocchio.__version__}, MuJoCo {mujoco.__version__}.",
        f"{arguments.rounds} rounds; medians. This machine takes {scale:.2f} times as long as the one of the goals ({of}).",
        f"import of numpy: {times['numpy', 'bryant'] * 1e3:.0f} ms. Goals missed: {'; '.join(missed) or 'none'}.",
    ]
    print("\n".join(notes))
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    for row in rows:
        print("  ".join(cell.ljust(w) if k == 0 else cell.rjust(w) for k, (cell, w) in enumerate(zip(row, widths))).rstrip())
    if arguments.markdown:
        head, *body = rows
        lines = [*notes, "", compare.line(head), "|---|" + "---:|" * (len(head) - 2) + "---|", *map(compare.line, body)]
        arguments.markdown.write_text("\n".join(lines) + "\n")


def parse():
    parser = argparse.ArgumentParser(description="Compares the Python package with Pinocchio and MuJoCo.")
    parser.add_argument("--robots", required=True, type=pathlib.Path, help="folder of `robots.py prepare`")
    parser.add_argument("--wheels", required=True, type=pathlib.Path, help="folder of the wheels")
    parser.add_argument("--markdown", type=pathlib.Path, help="where to write the table as Markdown")
    parser.add_argument("--rounds", type=int, default=7)
    return parser.parse_args()


def with_motors(path):
    """The same robot with a motor on each hinge. The limits of its angles are beyond all that are reached."""
    root = ElementTree.parse(path)
    for joint in root.getroot().iter("joint"):
        if joint.get("type") == "continuous":
            # Pinocchio describes a continuous joint by two numbers
            joint.set("type", "revolute")
            ElementTree.SubElement(joint, "limit", lower="-1000", upper="1000", effort=repr(EFFORT), velocity="1000")
    made = path.with_name("panda-with-motors.urdf")
    root.write(made)
    return str(made)


def tasks(path, folder):
    """By row and column, a function that measures it [s]."""
    ours = bryant.load(path)
    theirs = pinocchio.buildModelFromUrdf(path)
    data = theirs.createData()
    third = of_mujoco(path)
    state = mujoco.MjData(third)
    n = len(ours.velocities)
    # all engines have the joints in the order of the file here; the comparison below would find another one
    assert theirs.nq == third.nq == n and len(ours.inputs) == n
    random = np.random.default_rng(1)
    q, v = random.uniform(-np.pi, np.pi, (COUNT, n)), 2 * random.normal(size=(COUNT, n))
    u = random.uniform(-0.1 * EFFORT, 0.1 * EFFORT, (COUNT, n))
    forces = ours.accelerations(q[:16], v[:16], u[:16])
    for k in range(16):
        alike(forces[k], pinocchio.aba(theirs, data, q[k], v[k], u[k]), "Pinocchio")
        alike(forces[k], forward(third, state, q[k], v[k], u[k]).copy(), "MuJoCo")

    one, all = np.empty(n), np.empty((COUNT, n))
    q0, v0, u0 = q[0].copy(), v[0].copy(), u[0].copy()
    torques = random.uniform(-0.1 * EFFORT, 0.1 * EFFORT, (COPIES, STEPS, n))
    begin, still = np.ascontiguousarray(0.1 * q[:COPIES]), np.zeros((COPIES, n))
    states = np.empty((COPIES, STEPS, 2 * n))
    its = of_mujoco(path)
    its.opt.integrator, its.opt.timestep = mujoco.mjtIntegrator.mjINT_RK4, STEP
    its_data = mujoco.MjData(its)
    full = np.concatenate([np.zeros((COPIES, 1)), begin, still], axis=1)
    control = dict(control_spec=mujoco.mjtState.mjSTATE_QFRC_APPLIED)
    its_states = np.empty((COPIES, STEPS, full.shape[1]))
    ours.rollout(begin, still, torques, dt=STEP, out=states)
    with mujoco.rollout.Rollout(nthread=0) as alone:
        alone.rollout(its, its_data, full, torques, state=its_states, **control)
    alike(states[:, -1].ravel(), its_states[:, -1, 1:].ravel(), "rollout of MuJoCo")

    def mujoco_rollout():
        with mujoco.rollout.Rollout(nthread=0) as alone:
            return per(lambda: alone.rollout(its, its_data, full, torques, state=its_states, **control), COPIES * STEPS)

    env = bryant.gym.make_vec(ours, COPIES, dt=PAUSE, parts=PARTS, horizon=10 * ACTIONS, threads=THREADS)
    env.reset(seed=1)
    actions = random.uniform(-1, 1, (ACTIONS, COPIES, n))

    def environment():
        def steps():
            for action in actions:
                env.step(action)

        return 1 / per(steps, COPIES * ACTIONS)

    its_steps = of_mujoco(path)
    its_steps.opt.integrator, its_steps.opt.timestep = mujoco.mjtIntegrator.mjINT_RK4, PAUSE / PARTS
    its_datas = [mujoco.MjData(its_steps) for _ in range(THREADS)]
    held = np.repeat(actions[0][:, None], PARTS, axis=1)

    def mujoco_environment():
        with mujoco.rollout.Rollout(nthread=THREADS) as several:
            return 1 / per(lambda: several.rollout(its_steps, its_datas, full, held, **control), COPIES)

    kept = str(folder / "panda.bryant")
    ours.keep(kept)
    binary = str(folder / "panda.mjb")
    mujoco.mj_saveModel(third, binary)
    archive = str(folder / "panda.bin")
    theirs.saveToBinary(archive)

    def rows_of(call):
        def loop():
            for k in range(COUNT // 10):
                call(k)

        return lambda: per(loop, COUNT // 10)

    return {
        ("call", "bryant"): lambda: per(lambda: ours.accelerations(q0, v0, u0, out=one)),
        ("call", "Pinocchio"): lambda: per(lambda: pinocchio.aba(theirs, data, q0, v0, u0)),
        ("call", "MuJoCo"): lambda: per(lambda: mujoco.mj_forward(third, state)),
        ("rows", "bryant"): lambda: per(lambda: ours.accelerations(q, v, u, out=all), COUNT),
        ("rows", "Pinocchio"): rows_of(lambda k: pinocchio.aba(theirs, data, q[k], v[k], u[k])),
        ("rows", "MuJoCo"): rows_of(lambda k: forward(third, state, q[k], v[k], u[k])),
        ("rollout", "bryant"): lambda: per(lambda: ours.rollout(begin, still, torques, dt=STEP, out=states), COPIES * STEPS),
        ("rollout", "MuJoCo"): mujoco_rollout,
        ("environment", "bryant"): environment,
        ("environment", "MuJoCo"): mujoco_environment,
        ("import", "bryant"): lambda: imported("bryant"),
        ("import", "Pinocchio"): lambda: imported("pinocchio"),
        ("import", "MuJoCo"): lambda: imported("mujoco"),
        ("numpy", "bryant"): lambda: imported("numpy", before="sys"),
        ("load", "bryant"): lambda: per(lambda: bryant.load(path)),
        ("load", "Pinocchio"): lambda: per(lambda: pinocchio.buildModelFromUrdf(path)),
        ("load", "MuJoCo"): lambda: per(lambda: mujoco.MjModel.from_xml_path(path)),
        ("kept", "bryant"): lambda: per(lambda: bryant.load(kept)),
        ("kept", "Pinocchio"): lambda: per(lambda: pinocchio.Model().loadFromBinary(archive)),
        ("kept", "MuJoCo"): lambda: per(lambda: mujoco.MjModel.from_binary_path(binary)),
    }


def of_mujoco(path):
    model = mujoco.MjModel.from_xml_path(path)
    disabled = mujoco.mjtDisableBit
    model.opt.disableflags |= int(disabled.mjDSBL_CONTACT) | int(disabled.mjDSBL_CONSTRAINT)
    return model


def forward(model, data, q, v, u):
    data.qpos[:], data.qvel[:], data.qfrc_applied[:] = q, v, u
    mujoco.mj_forward(model, data)
    return data.qacc


def alike(ours, others, name):
    apart = np.abs(ours - others).max() / np.abs(ours).max()
    if not apart <= compare.AGREE:
        sys.exit(f"{name} differs from bryant by {apart:.0e} of the largest number")


def per(call, count=1):
    """The time of a call, or of each of `count` things that it does [s]."""
    timer = timeit.Timer(call)
    once = timer.timeit(1)
    number = max(1, int(LASTS / max(once, 1e-9)))
    # the first calls of a loop are slower
    number = max(1, int(number * LASTS / max(timer.timeit(number), 1e-9)))
    return timer.timeit(number) / number / count


def imported(package, before="numpy"):
    """The time of an import in a new process [s]."""
    text = f"import {before}, time; begin = time.perf_counter(); import {package}; print(time.perf_counter() - begin)"
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True)
    return float(done.stdout)


def sizes(folder):
    """The size of each wheel [bytes]; that of Pinocchio is without those of its libraries."""
    names = {"bryant": "bryant", "Pinocchio": "pin", "MuJoCo": "mujoco_core"}
    found = {column: next(folder.glob(f"{name}-*.whl"), None) for column, name in names.items()}
    return {("wheel", column): os.path.getsize(path) for column, path in found.items() if path}


def figure(value):
    if value >= 1e5:
        power = int(np.floor(np.log10(value)))
        return f"{value / 10**power:.2f}e{power}"
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


if __name__ == "__main__":
    main()
