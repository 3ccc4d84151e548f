"""Simulate how mechanisms move: crash-test dummies in belts and seats, robots, any tree of rigid bodies.

    m = bryant.load("child-seat")             # a bundled model, a file (YAML, URDF), or a text
    r = m.run(set={"lap_slack": "20 mm"})     # error control, events, checks, as `bryant run` does
    r["head excursion"]                       # an array over r.time
    a = m.accelerations(q, v)                 # one state, or many as rows

All arrays are of doubles in SI units; names and units of their columns are in the model.
"""

from ._bryant import VERSION as __version__
from ._bryant import Error
from .model import Contacts, Model, Simulation, load
from .run import Run
from .study import Study

__all__ = ["Contacts", "Error", "Model", "Run", "Simulation", "Study", "__version__", "load"]
