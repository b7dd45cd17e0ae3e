# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens what a run of Boba wrote: frames, tables, measures, the contact network.

    import boba
    run = boba.open("out/shear")
    run.table["mu"]                        # a column of table.csv; run.table.to_pandas(), run.table.units
    run.measure("shape")["facets_mean"]    # a column of measures/shape.csv
    run.average("mu", 1, 5)                # mean and standard error over 1 < strain < 5
    run.average("mu", 0, 1, stage="back")  # of one stage: its number, name or type
    run.frames[-1].grains[0]               # unwrapped node positions of a grain, d
    run.contacts(step)                     # contacts of one frame
    run.universe()                         # MDAnalysis, where it is installed
    boba.crystallisation(run.measure("order"))  # onset, largest nucleus, whether the packing crystallised

    sim = boba.Simulation("scene.toml", set={"stage.shear.rate": 1e-4}, output="out/slow")
    for state in sim.steps(every=100):     # runs; state.positions, state.stress, state.mu ...
        ...

Needs numpy, h5py for the frames, and for Simulation the program boba. Columns and units: docs/formats-measure.md.
"""
from ._version import __version__
from .blocking import blocked_mean
from .crystals import Crystallisation, crystallisation
from .frames import Frame, Frames
from .program import InputError, RunError
from .run import Run, open_run
from .scene import Stage
from .simulation import Simulation, State
from .table import Table, read_table

open = open_run  # the module's own name for it: boba.open(run)

__all__ = [
    "Crystallisation",
    "Frame",
    "Frames",
    "InputError",
    "Run",
    "RunError",
    "Simulation",
    "Stage",
    "State",
    "Table",
    "__version__",
    "blocked_mean",
    "crystallisation",
    "open",
    "open_run",
    "read_table",
]
