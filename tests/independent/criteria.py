"""Judges a made-up test with `bryant criteria`, and compares filters and criteria with an independent program (crashmetrics).

python3 criteria.py BRYANT
"""

import json
import math
import random
import subprocess
import sys
import tempfile

import numpy as np
from crashmetrics.acceleration import clip_3ms
from crashmetrics.lower_extremity import femur_force_criterion, tibia_index
from crashmetrics.pedestrian.hic import calculate_hic
from crashmetrics.signals import cfc_filter, resultant

G = 9.80665
ARM = 0.01778
bryant = sys.argv[1]
times = np.arange(2001) * 1e-4
noise = random.Random(43)


def pulse(size, vibrations, flat=1):
    """A haversine from 40 to 140 ms with vibrations on it, which is 0 at both ends of the test; times `flat`, and cut off at 1."""
    inside = np.clip((times - 0.04) / 0.1, 0, 1)
    window = np.minimum(flat * np.sin(math.pi * inside) ** 2, 1)
    total = np.ones_like(times)
    for frequency in vibrations:
        total += 0.3 * np.sin(2 * math.pi * frequency * times + noise.uniform(0, 6))
    return size * window * total


VIBRATIONS = [37, 180, 440, 900, 1900]
signals = {
    "11HEADCG00H3ACXP [g]": pulse(-60, VIBRATIONS),
    "11HEADCG00H3ACYP [g]": pulse(9, VIBRATIONS),
    "11HEADCG00H3ACZP [g]": pulse(25, VIBRATIONS),
    "11CHST0000H3ACXP [g]": pulse(-40, VIBRATIONS),
    "11CHST0000H3ACYP [g]": pulse(5, VIBRATIONS),
    "11CHST0000H3ACZP [g]": pulse(14, VIBRATIONS),
    "11CHST0000H3DSXP [mm]": pulse(-35, [90, 300]),
    "11NECKUP00H3FOXP [N]": pulse(-600, VIBRATIONS, 4),
    "11NECKUP00H3FOZP [kN]": pulse(1.3, [37, 440], 4),
    "11NECKUP00H3MOYP [Nm]": pulse(-30, VIBRATIONS),
    "11FEMRLE00H3FOZP [kN]": pulse(-4.5, [37], 4),
    "11TIBIRI00H3MOXP [Nm]": pulse(70, VIBRATIONS),
    "11TIBIRI00H3MOYP [Nm]": pulse(-50, VIBRATIONS),
    "11TIBIRI00H3FOZP [kN]": pulse(-2, VIBRATIONS),
}


def judged(standard):
    with tempfile.TemporaryDirectory() as folder:
        table = f"{folder}/test.csv"
        with open(table, "w") as out:
            print(";".join(["time [ms]", *signals]), file=out)
            for row in zip(times * 1e3, *signals.values()):
                print(";".join(repr(float(x)) for x in row), file=out)
        command = [bryant, "criteria", table, "--standard", standard, "--dummy", "Hybrid III 50M"]
        command += ["--filter-standard", "sae-j211", "--json"]
        found = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    assert found["occupant"] == "11", found["occupant"]
    return {one["criterion"]: one for one in found["criteria"]}


def of(begin, cfc):
    """The filtered channel whose code begins like this."""
    names = [name for name in signals if name.startswith(begin)]
    assert len(names) == 1, names
    return cfc_filter(times, signals[names[0]], cfc)


def of_three(begin, cfc):
    return resultant(*(of(f"{begin}AC{axis}", cfc) for axis in "XYZ"))


head = of_three("11HEADCG00H3", 1000)
chest = of_three("11CHST0000H3", 180)
neck = {name: of(f"11NECKUP00H3{name}", 600) for name in ["FOX", "FOZ", "MOY"]}
moment = neck["MOY"] - ARM * neck["FOX"]
force = 1e3 * neck["FOZ"]
nij = np.where(force >= 0, force / 6806, -force / 6160) + np.where(moment >= 0, moment / 310, -moment / 135)
hic = {window: calculate_hic(times, head, window, 0.1) for window in (15, 36)}
shin = [of(f"11TIBIRI00H3{name}", 600) for name in ["MOX", "MOY", "FOZ"]]
tibia = tibia_index(times, shin[0], shin[1], 1e3 * shin[2], dummy="hybrid3_50")

tension = [(0.0, 3300.0), (35.0, 2900.0), (60.0, 1100.0)]
shear = [(0.0, 3100.0), (25.0, 1500.0), (35.0, 1500.0), (45.0, 1100.0)]
femur = "r94_hybrid3_50"
falling = {
    "neck tension": femur_force_criterion(times, -1e3 * of("11NECKUP00H3FOZ", 1000), limit=tuple(tension)),
    "neck shear": femur_force_criterion(times, -np.abs(of("11NECKUP00H3FOX", 1000)), limit=tuple(shear)),
    "femur left": femur_force_criterion(times, -1e3 * np.abs(of("11FEMRLE00H3FOZ", 600)), limit=femur),
}

# none of them is limited by its peak
assert all(one.critical_duration_ms > 5 for one in falling.values()), falling
verdicts = {name: judged(name) for name in ["FMVSS 208", "UN R94"]}
american, european = ({name: one["value"] for name, one in found.items()} for found in verdicts.values())
ratios = {name: verdicts["UN R94"][name]["value"] / verdicts["UN R94"][name]["limit"] for name in falling}
# Filters are the same recursion, and all signals are 0 where they begin and end: only rounding differs. Windows of HIC end on samples
# there and between them here, which changes a maximum by the square of a sample's share of the window, (0.1 ms / 15 ms)^2 = 4e-5.
for name, found, expected, tolerance in [
    ("HIC15", american["HIC15"], hic[15].value, 1e-4),
    ("HIC36", european["HIC36"], hic[36].value, 1e-4),
    ("head 3 ms", european["head 3 ms"], clip_3ms(times, head), 1e-9),
    ("chest 3 ms", american["chest 3 ms"], clip_3ms(times, chest), 1e-9),
    ("chest deflection", american["chest deflection"], np.max(np.abs(of("11CHST0000H3DSX", 600))), 1e-9),
    ("chest deflection by R94", european["chest deflection"], np.max(np.abs(of("11CHST0000H3DSX", 180))), 1e-9),
    ("Nij", american["Nij"], np.max(nij), 1e-9),
    ("neck tension", american["neck tension"], 1e3 * np.max(of("11NECKUP00H3FOZ", 1000)), 1e-9),
    ("femur left", american["femur left"], 1e3 * np.max(np.abs(of("11FEMRLE00H3FOZ", 600))), 1e-9),
    ("tibia right", european["tibia right"], tibia.value, 1e-9),
    ("tibia force right", european["tibia force right"], 1e3 * np.max(np.abs(shin[2])), 1e-9),
    *((f"{name}, its duration", ratios[name], one.utilisation, 1e-9) for name, one in falling.items()),
]:
    assert abs(found / expected - 1) < tolerance, (name, found, expected)
    print(f"{name:24} {found:10.4f} {expected:10.4f}")
