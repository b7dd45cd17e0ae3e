# SPDX-License-Identifier: GPL-3.0-or-later
"""The one look of all figures: colours, symbols with their units, legends."""
import re

from .table import unit_of

# Okabe and Ito's colours, told apart by colour-blind eyes too.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#5c6770")

# Symbols of docs/notation.md for names of columns without their units.
SYMBOLS = {
    "P": "P",
    "P_normalised": r"\tilde{P}",
    "mu": r"\mu",
    "phi": r"\phi",
    "phi_reference": r"\phi_\mathrm{ref}",
    "inertial_number": "I",
    "strain": r"\gamma",
    "time": "t",
    "q": "q",
    "volume": "V",
    "asphericity": "A",
    "end_gap": "h",
    "end_force": "F",
}
_UNITS = {
    "1": "",
    "tau": r"\tau",
    "k/d": "k/d",
    "k d": "kd",
    "k d^2": "kd^2",
    "d": "d",
    "d^2": "d^2",
    "d^3": "d^3",
    "1/d": "1/d",
}


def style():
    """Settings of matplotlib for all figures."""
    return {
        "font.size": 9.0,
        "axes.titlesize": 9.0,
        "axes.titlelocation": "left",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.linewidth": 0.7,
        "axes.formatter.useoffset": False,
        "lines.linewidth": 1.2,
        "legend.fontsize": 7.5,
        "legend.frameon": False,
        "mathtext.fontset": "dejavusans",
        "svg.fonttype": "none",
        "pdf.fonttype": 42,
        "savefig.facecolor": "white",
    }


def colours(n):
    """n colours: the few that are easily told apart, or steps of viridis where there are more."""
    if n <= len(COLOURS):
        return list(COLOURS[:n])
    import matplotlib

    return [matplotlib.colormaps["viridis"](k / (n - 1)) for k in range(n)]


def name_of(column):
    """A column's name without its unit."""
    unit = unit_of(column)
    ending = "_" + unit.replace(" ", "").replace("^", "")
    return column[: -len(ending)] if unit != "1" and column.endswith(ending) else column


def quantity(column, words=""):
    """Label of an axis: words, symbol and unit of a column, as "pressure $P$ ($k/d$)"."""
    name = name_of(column)
    symbol = f"${SYMBOLS[name]}$" if name in SYMBOLS else ""
    text = words or ("" if symbol else name.replace("_", " "))
    unit = unit_of(column)
    shown = _UNITS.get(unit, unit)
    return " ".join(part for part in (text, symbol, f"(${shown}$)" if shown else "") if part)


def natural(text):
    """Key of an order in which 9e-3 comes before 0.1, and run2 before run10."""
    try:
        return (0, float(text), text)
    except ValueError:
        pass
    pieces = re.split(r"([-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?)", text)
    return (1, [(1, float(p), "") if k % 2 else (0, 0.0, p) for k, p in enumerate(pieces)], text)


def legend(axes, always=False):
    """A legend beside the data, sorted as numbers; none for a single curve."""
    handles, labels = axes.get_legend_handles_labels()
    if len(labels) < 2 and not always:
        return
    order = sorted(range(len(labels)), key=lambda k: natural(labels[k]))
    axes.legend(
        [handles[k] for k in order],
        [labels[k] for k in order],
        loc="upper left",
        bbox_to_anchor=(1.01, 1.0),
        borderaxespad=0.0,
    )
