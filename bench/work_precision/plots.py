# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of results.csv: error against processor seconds."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # the backend is chosen first
from matplotlib import ticker

QUIET = {"double": ("C0", "o-"), "mixed": ("C1", "s--")}


def chosen(rows, axis, quantity):
    """Rows of one axis whose quantity begins so."""
    return [r for r in rows if r["axis"] == axis and r["quantity"].startswith(quantity)]


def draw(rows, folder):
    """Three pictures: the packing, the specimen and the calibration, the measures."""
    packing_picture(rows, folder / "work-precision-packing.png")
    specimen_picture(rows, folder / "work-precision-specimen.png")
    other_picture(rows, folder / "work-precision-measure.png")


def panel(axis, rows, title, ylabel, label=True, style="o-", colour=None, name=None):
    """One curve of absolute error with its bar against seconds; `label` names the points by their setting."""
    rows = sorted((r for r in rows if r["error"] != 0), key=lambda r: r["setting"])
    axis.set(title=title, xlabel="processor seconds", ylabel=ylabel)
    axis.grid(alpha=0.3, which="both")
    if not rows:
        return
    x, y = [r["seconds"] for r in rows], [abs(r["error"]) for r in rows]
    bars = [min(float(r["error_bar"] or 0), 0.95 * abs(r["error"])) for r in rows]
    axis.errorbar(
        x,
        y,
        yerr=[bars, [float(r["error_bar"] or 0) for r in rows]],
        fmt=style,
        ms=4,
        lw=1,
        capsize=2,
        color=colour,
        label=name,
    )
    axis.set(xscale="log", yscale="log")
    axis.xaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
    axis.xaxis.set_major_formatter(ticker.FormatStrFormatter("%g"))
    axis.xaxis.set_minor_formatter(ticker.NullFormatter())
    for r, a, b in zip(rows, x, y) if label else ():
        text = r["setting"] if isinstance(r["setting"], str) else f"{r['setting']:g}"
        axis.annotate(text, (a, b), fontsize=6, xytext=(3, -8), textcoords="offset points")


def save(figure, path):
    """Writes a picture without its empty panels."""
    for axis in figure.axes:
        axis.set_visible(axis.has_data())
    figure.savefig(path, dpi=80)
    plt.close(figure)


def packing_picture(rows, path):
    """Time step and precision, cost of the skin, rate, and LAMMPS."""
    figure, panels = plt.subplots(2, 3, figsize=(11, 6.4), constrained_layout=True)
    for column, kind in enumerate(("P, path", "mu, path", "mu, mean")):
        axis = panels[0, column]
        for precision, (colour, style) in QUIET.items():
            part = [r for r in chosen(rows, "time step", kind) if r["precision"] == precision]
            panel(axis, part, f"time step: {kind}", "error", precision == "double", style, colour, precision)
        if axis.has_data():
            axis.legend(fontsize=7)
    for kind, colour in (("P, mean", "C2"), ("mu, mean", "C3")):
        for precision, (_, style) in QUIET.items():
            part = [r for r in chosen(rows, "shear rate", kind) if r["precision"] == precision]
            is_first = precision == "double" and kind.startswith("P")
            panel(
                panels[1, 1],
                part,
                "shear rate",
                "difference from the slowest",
                is_first,
                style,
                colour,
                f"{kind}, {precision}",
            )
    part = chosen(rows, "skin", "cost")
    panels[1, 0].plot([r["setting"] for r in part], [r["seconds"] for r in part], "o-", ms=4, lw=1)
    panels[1, 0].set(title="skin: cost alone", xlabel="skin (d)", ylabel="processor seconds", ylim=(0, None))
    panels[1, 0].grid(alpha=0.3)
    for kind, colour in (("mu", "C3"), ("P", "C2"), ("volume", "C4")):
        for setting, style in (("engine", "o"), ("LAMMPS", "*")):
            part = [r for r in chosen(rows, "peer", kind) if r["setting"].startswith(setting)]
            panel(
                panels[1, 2],
                part,
                "held pressure, strain 0.1",
                "path error",
                False,
                style,
                colour,
                f"{kind}, {setting}",
            )
    for axis in panels[1, 1:]:
        if axis.has_data():
            axis.legend(fontsize=6)
    save(figure, path)


def specimen_picture(rows, path):
    """A pressed sphere, cylinders and boxes."""
    figure, panels = plt.subplots(2, 2, figsize=(8, 6.4), constrained_layout=True)
    for precision, (colour, style) in QUIET.items():
        part = [r for r in chosen(rows, "specimen, time step", "force") if r["precision"] == precision]
        panel(
            panels[0, 0],
            part,
            "sphere between walls: time step",
            "relative error of the force",
            style=style,
            colour=colour,
            name=precision,
        )
    panel(
        panels[0, 1],
        chosen(rows, "specimen, wall speed", "force"),
        "sphere between walls: speed of the walls",
        "relative error of the force",
        name="double",
    )
    for quantity, colour in (("E", "C0"), ("nu", "C1")):
        panel(
            panels[1, 0],
            chosen(rows, "cylinder, nodes", quantity),
            "cylinder: nodes",
            "against its network",
            colour=colour,
            name=quantity,
        )
        for alpha, style in ((0, "o-"), (2, "s--")):
            panel(
                panels[1, 1],
                chosen(rows, "nodes of the box", f"{quantity}, alpha {alpha}"),
                "periodic box: nodes (seconds a box)",
                "against the installed table",
                (quantity, alpha) == ("E", 2),
                style,
                colour,
                f"{quantity}, alpha {alpha}",
            )
    for axis in panels.flat:
        if axis.has_data():
            axis.legend(fontsize=7)
    save(figure, path)


def other_picture(rows, path):
    """Random points, thresholds of facets, residual of the solves."""
    figure, panels = plt.subplots(1, 3, figsize=(11, 3.4), constrained_layout=True)
    panel(panels[0], chosen(rows, "random points", "phi"), "phi: random points", "root mean square error")
    for quantity, colour in (("E", "C0"), ("nu", "C1")):
        panel(
            panels[1],
            chosen(rows, "residual of the solves", quantity),
            "E, nu: residual of the solves",
            "error",
            colour=colour,
            name=quantity,
        )
    part = chosen(rows, "hull threshold", "faceted_share minus")
    panels[2].plot([1 - r["setting"] for r in part], [r["error"] for r in part], "o-", ms=4, lw=1)
    panels[2].set(
        xscale="log",
        title="facets: threshold (a definition)",
        xlabel="1 - least cosine",
        ylabel="faceted share minus that at 0.99",
    )
    panels[2].grid(alpha=0.3, which="both")
    panels[1].legend(fontsize=7) if panels[1].has_data() else None
    save(figure, path)
