# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens what a run of Boba wrote: frames, tables, measures, the contact network.

    import boba
    run = boba.open("out/shear")
    run.table["mu"]                        # a column of table.csv
    run.measure("shape")["facets_mean"]    # a column of measures/shape.csv
    run.average("mu", 1, 5)                # mean and standard error over 1 < strain < 5
    run.frames[-1].grains[0]               # unwrapped node positions of a grain, d
    run.contacts(step)                     # contacts of one frame
    boba.crystallisation(run.measure("order"))  # onset, largest nucleus, whether the packing crystallised

Needs numpy, and h5py for the frames. Columns and units: docs/formats-measure.md.
"""
from .crystals import Crystallisation, crystallisation
from .run import Frame, Frames, Run, blocked_mean, open_run

open = open_run  # the module's own name for it: boba.open(run)

__all__ = ["Crystallisation", "Frame", "Frames", "Run", "blocked_mean", "crystallisation", "open", "open_run"]
