"""Compares this project with other engines: the same models and states, side by side, in one run on one machine.

run.sh prepares what this needs. The rounds take turns, so that a machine that is slower for a while is so for all; the median is over
all batches of all rounds. First the results are compared, then the times.
"""

import argparse
import json
import pathlib
import platform
import subprocess
import sys
from importlib.metadata import version

import numpy as np

import engines
import judge
import states

# Accelerations agree to this share of the largest, and the remaining moments are at most this share.
AGREE = 1e-9
# Models on which all engines must agree. On longer chains of ball joints the peers may be wrong, and this is marked.
SURE = ["planar9", "chain5", "dummy15"]
# Duration of the fall [s]; the ends agree to this share of the largest entry of the state.
DURATION, STEP = 0.15, 1e-4
FALLS_AGREE = 1e-9
# Allowed errors of a fall, relative to the largest entry of the state at its end, and the numbers of steps that are tried.
ERRORS = [1e-6, 1e-9, 1e-12, 1e-14]
STEPS = [3, 5, 8, 10, 15, 20, 30, 50, 75, 100, 150, 250, 400, 600, 1000, 1500]
METHODS = {"rk4": "RK4", "dop853": "order 8", "adams": "Adams"}
# Methods with so little work in a step that they can be compared in steps of one length.
IN_EQUAL_STEPS = ["rk4", "adams"]
# Steps of order 8 for the exact end: with 10 or more only rounding is left, and with some hundred there is little of it.
EXACT_STEPS = 150


def main():
    arguments = parse()
    arguments.work.mkdir(parents=True, exist_ok=True)
    ours = [
        engines.Ours("bryant", arguments.ours),
        engines.Ours("bryant, fused", arguments.ours, "1"),
        engines.Ours("bryant, lanes", arguments.ours, "widest"),
    ]
    if arguments.ours_native:
        ours.append(engines.Ours("bryant, native", arguments.ours_native))
    peers = [engines.Casadi(arguments.work), engines.Aba(arguments.work), engines.Mujoco(arguments.work)]
    columns = ours + peers
    trees = json.loads(ask(arguments.ours, "trees"))
    if arguments.models:
        trees = [tree for tree in trees if tree["name"] in arguments.models]

    rows, wrong = [], []
    for tree in trees:
        sample = states.random(tree, arguments.states, arguments.seed)
        rounds = [[column.accelerations(tree, sample) for column in columns] for _ in range(arguments.rounds)]
        cells = []
        for k, column in enumerate(columns):
            found = rounds[0][k].rows
            residual = max(judge.residual(tree, *pair) for pair in zip(sample, found, strict=True))
            cells.append((median(turn[k] for turn in rounds), difference(found, rounds[0][0].rows), residual))
            sound = residual <= AGREE and (tree["name"] not in SURE or cells[-1][1] <= AGREE)
            if not sound and (column in ours or tree["name"] in SURE):
                wrong.append(f"{column.name} on {tree['name']}")
        rows.append((tree["name"], cells))
        progress(f"{tree['name']}: " + ", ".join(f"{cell[0]:.0f}" for cell in cells) + " ns")

    sections = [
        ("Accelerations, ns per evaluation", table(columns, rows, lambda cell, _: time(cell))),
        (f"Ratio to {ours[0].name}", table(columns, rows, lambda cell, first: ratio(cell, first))),
        (f"Largest difference from {ours[0].name}, of the largest acceleration", table(columns, rows, lambda cell, _: share(cell[1]))),
        ("Moments and forces left over, of the largest", table(columns, rows, lambda cell, _: share(cell[2]))),
    ]
    fallen = [tree for tree in trees if tree["name"] == "dummy15"]
    if fallen:
        falls = falls_in_equal_steps(fallen[0], columns, arguments)
        for method, cells in falls:
            wrong += [f"{column.name}, whole fall by {method}" for column, cell in zip(columns, cells, strict=True) if cell and not cell[1] <= FALLS_AGREE]
        first = falls[0][1][0]
        at_end = f"Largest difference at the end from {ours[0].name} in {EXACT_STEPS} steps of order 8, of the largest entry of the state"
        sections += [
            (f"Whole fall, {DURATION} s in steps of {STEP} s, ms", table(columns, falls, lambda cell, _: f"{cell[0] / 1e6:.2f}" if cell else "–", "method")),
            (f"Ratio to {ours[0].name} by RK4", table(columns, falls, lambda cell, _: quotient(cell, first), "method")),
            (at_end, table(columns, falls, lambda cell, _: share(cell[1]) if cell else "–", "method")),
        ]
        rows = within_errors(fallen[0], columns, arguments)
        title = f"Whole fall, {DURATION} s, with as few steps as an error at its end allows"
        sections += [
            (f"{title}, ms", table(columns, rows, lambda cell, _: of_steps(cell), "error")),
            (f"Ratio to {ours[0].name}", table(columns, rows, lambda cell, first: quotient(cell, first), "error")),
        ]
    counted = ", ".join(f"{name} {count}" for name, count in peers[0].operations.items())
    report(arguments, [f"CasADi's instructions: {counted}."], sections)
    if wrong:
        sys.exit("these differ where they must not: " + "; ".join(wrong))


def parse():
    parser = argparse.ArgumentParser(description="Compares this project with Pinocchio and MuJoCo.")
    parser.add_argument("--ours", required=True, type=pathlib.Path, help="the program of ours/, with default flags")
    parser.add_argument("--ours-native", type=pathlib.Path, help="the same, with -C target-cpu=native")
    parser.add_argument("--work", required=True, type=pathlib.Path, help="folder for what is generated and compiled")
    parser.add_argument("--markdown", type=pathlib.Path, help="where to write the tables as Markdown")
    parser.add_argument("--models", nargs="*", help="only these")
    parser.add_argument("--states", type=int, default=16, help="states for each model")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=3)
    return parser.parse_args()


def ask(program, *arguments):
    return subprocess.run([str(program), *arguments], capture_output=True, text=True, check=True).stdout


def progress(text):
    print(text, file=sys.stderr, flush=True)


def median(measurements):
    """[ns]"""
    return float(np.median(np.concatenate([m.times for m in measurements])))


def difference(found, expected):
    """Largest difference over all states, each relative to its largest entry."""
    with np.errstate(invalid="ignore"):
        each = np.abs(found - expected).max(axis=1) / np.abs(expected).max(axis=1)
    return float(each.max())


def exact_end(tree, columns, start):
    """The end of the fall in EXACT_STEPS of order 8. The other ends confirm it: engines that share no code agree with it within
    their own errors."""
    return signed(tree, columns[0].fall(tree, start, DURATION, DURATION / EXACT_STEPS, "dop853").rows[0])


def falls_in_equal_steps(tree, columns, arguments):
    """For each method, a row with the time [ns] and the error at the end, for each column; None if a column lacks the method."""
    start = np.array(ask(arguments.ours, "start", tree["name"]).split(), dtype=float)
    exact = exact_end(tree, columns, start)
    tries = [(k, method) for k, column in enumerate(columns) for method in IN_EQUAL_STEPS if method in column.methods]
    rounds = [{(k, method): columns[k].fall(tree, start, DURATION, STEP, method) for k, method in tries} for _ in range(arguments.rounds)]

    def cell(*key):
        if key not in rounds[0]:
            return None
        end = signed(tree, rounds[0][key].rows[0])
        return median(turn[key] for turn in rounds), difference(end[None], exact[None])

    rows = [(METHODS[method], [cell(k, method) for k in range(len(columns))]) for method in IN_EQUAL_STEPS]
    for name, cells in rows:
        progress(f"fall by {name}: " + ", ".join(f"{cell[0] / 1e6:.2f}" if cell else "none" for cell in cells) + " ms")
    return rows


def within_errors(tree, columns, arguments):
    """For each of ERRORS, a row with the least time [ns], the number of steps and the method of each column; None if none suffices."""
    start = np.array(ask(arguments.ours, "start", tree["name"]).split(), dtype=float)
    exact = exact_end(tree, columns, start)
    # the first steps of Adams' method have order 8
    own = {"adams": 6}
    tries = [
        (k, method, steps)
        for k, column in enumerate(columns)
        for method in column.methods
        for steps in STEPS
        if steps >= own.get(method, 1)
    ]

    def run(k, method, steps):
        return columns[k].fall(tree, start, DURATION, DURATION / steps, method)

    errors = {key: difference(signed(tree, run(*key).rows[0])[None], exact[None]) for key in tries}
    rows = []
    for error in ERRORS:
        # for each method the fewest steps that suffice
        fewest = {}
        for key in tries:
            if errors[key] <= error:
                fewest.setdefault(key[:2], key)
        rounds = [{key: run(*key) for key in fewest.values()} for _ in range(arguments.rounds)]
        times = {key: median(turn[key] for turn in rounds) for key in fewest.values()}
        of_column = [[(time, steps, method) for (i, method, steps), time in times.items() if i == k] for k in range(len(columns))]
        rows.append((f"{error:.0e}", [min(found, default=None) for found in of_column]))
        progress(f"fall within {error:.0e}: " + ", ".join(of_steps(cell) for cell in rows[-1][1]) + " ms")
    return rows


def signed(tree, state):
    position, orientation, velocity, rates = states.split(tree, state)
    return states.join(position, orientation * np.where(orientation[:, :1] < 0, -1, 1), velocity, rates)


def time(cell):
    return f"{cell[0]:.0f}" + ("" if cell[2] <= AGREE else " †")


def ratio(cell, first):
    return f"{cell[0] / first[0]:.2f}" + ("" if cell[2] <= AGREE else " †")


def of_steps(cell):
    if cell is None:
        return "none"
    time, steps, method = cell
    return f"{time / 1e6:.3f} ({METHODS[method]}, {steps})"


def quotient(cell, first):
    return "–" if cell is None or first is None else f"{cell[0] / first[0]:.2f}"


def share(value):
    return f"{value:.0e}" if np.isfinite(value) else "not finite"


def table(columns, rows, text, what="model"):
    head = [what, *(column.name for column in columns)]
    return [head, *([name, *(text(cell, cells[0]) for cell in cells)] for name, cells in rows)]


def report(arguments, notes, sections):
    machine = f"{processor()}, {compiler('rustc')}, {compiler('gcc')}, {versions()}"
    basis = f"{arguments.states} states, seed {arguments.seed}, {arguments.rounds} rounds; medians."
    basis += f" † the result is wrong: more than {AGREE:.0e} left over."
    print("\n".join([machine, basis, *notes]))
    for title, rows in sections:
        widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
        print(f"\n{title}")
        for row in rows:
            print("  ".join(cell.ljust(w) if k == 0 else cell.rjust(w) for k, (cell, w) in enumerate(zip(row, widths, strict=True))).rstrip())
    if arguments.markdown:
        lines = [machine, "", " ".join([basis, *notes])]
        for title, (head, *rows) in sections:
            lines += ["", f"**{title}**", "", line(head), "|---|" + "---:|" * (len(head) - 1), *map(line, rows)]
        arguments.markdown.write_text("\n".join(lines) + "\n")


def line(cells):
    return "| " + " | ".join(cells) + " |"


def processor():
    """The family, from /proc/cpuinfo, and the widest vectors."""
    try:
        text = pathlib.Path("/proc/cpuinfo").read_text()
    except OSError:
        return platform.machine()
    fields = dict(entry.split(":", 1) for entry in text.split("\n\n")[0].splitlines() if ":" in entry)
    fields = {key.strip(): value.strip() for key, value in fields.items()}
    flags = fields.get("flags", "").split()
    vectors = next((name for flag, name in [("avx512f", "AVX-512"), ("avx2", "AVX2")] if flag in flags), "SSE2")
    return f"{fields.get('model name', platform.machine())} (family {fields.get('cpu family')}, model {fields.get('model')}), {vectors}"


def compiler(name):
    first = subprocess.run([name, "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[0]
    words = first.split()
    return f"{words[0]} {words[-1] if name == 'gcc' else words[1]}"


def versions():
    return f"Pinocchio {version('pin')}, CasADi {version('casadi')}, MuJoCo {version('mujoco')}"


if __name__ == "__main__":
    main()
