# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a run has crystallised: shares, nuclei and percolation from the table of order."""
import dataclasses

import numpy as np

#: Critical nuclei in sheared spheres have 10 to 15 grains (Rietz et al. 2018, Jin et al. 2020).
CRITICAL_NUCLEUS = 15


@dataclasses.dataclass
class Crystallisation:
    """What a table of order says of crystallisation.

    onset: strain from which the share of ordered grains stays above one half; None when it does not.
    nucleus: grains of the largest cluster before the onset that did not percolate (in the whole table without onset).
    share: mean share in the last fifth of the strain.
    crystallised: there is an onset, and a nucleus larger than CRITICAL_NUCLEUS was seen before it.
    """

    onset: float | None
    nucleus: int
    share: float
    crystallised: bool


def crystallisation(order, frames=5):
    """Judges the columns of a table of order (Run.measure("order")).

    The share is that of grains with at least seven solid bonds (`solid_share`), meaned over `frames` frames, so that a
    crystal whose layers slide, which no template fits at that moment, still counts as ordered. A table written before
    clusters were measured raises KeyError: of such a run nothing can be said.
    """
    strain, share = np.asarray(order["strain"]), np.asarray(order["solid_share"])
    width = min(frames, len(share))
    mean = np.convolve(share, np.ones(width) / width, "valid")
    below = np.flatnonzero(mean <= 0.5)
    first = int(below[-1]) + 1 if len(below) else 0
    stays = first < len(mean)
    onset = float(strain[first]) if stays else None
    # Frames whose mean is above one half from `first` on: a nucleus may still be seen in them.
    before = order["largest_finite_cluster"][: first + width] if stays else order["largest_finite_cluster"]
    nucleus = int(np.max(before, initial=0))
    late = float(np.mean(share[strain >= strain[0] + 0.8 * (strain[-1] - strain[0])]))
    return Crystallisation(onset, nucleus, late, stays and nucleus > CRITICAL_NUCLEUS)
