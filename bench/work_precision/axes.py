# SPDX-License-Identifier: GPL-3.0-or-later
"""What is varied: the runs of each axis. A run's name says all its values, so that axes share runs."""
import pathlib

from runner import Run

DATA = pathlib.Path(__file__).resolve().parents[2] / "tests/data/packing64"
RATE, STEP, SKIN = 1.024e-3, 0.1, 0.3  # the values of all axes but one; RATE is the fastest of the published rates
HELD = {"pressure": 0.1 * 1.84 / 1.875, "gain": 0.02, "rate": 1e-3}  # as LAMMPS held the pressure of the recorded run

PACKING = f"""title = "64 grains of 303 nodes, sheared from one compressed state"
[start]
lammps_reference = "{DATA}/p64.data.gz"
lammps_state = "{DATA}/dense64_a0.dump.gz"
alpha = 0.0
[output.table]
every_strain = 0.002
every_time = 1e9
[output.checkpoint]
every_seconds = 60
[[stage]]
type = "shear"
rate = {RATE}
strain = 0.1
"""

PRESS = """title = "sphere between two walls"
[[template]]
name = "sphere"
nodes = 1000
[[species]]
template = "sphere"
count = 1
alpha = 0.0
[output.table]
every_time = 1.0
[[stage]]
type = "specimen"
[[stage]]
type = "press"
strain = 0.06
velocity = 1e-3
"""


class Plan:
    """Values of each axis, full or quick."""

    def __init__(self, quick):
        pick = lambda full, short: short if quick else full
        self.strain = pick(0.4, 0.02)
        self.steps = pick((0.02, 0.05, 0.1, 0.13, 0.16, 0.19, 0.21), (0.05, 0.1))
        self.mixed_steps = pick((0.05, 0.1, 0.16), (0.1,))
        self.skins = pick((0.1, 0.2, 0.3, 0.5, 0.8), (0.3, 0.5))
        self.rates = pick((1.024e-3, 2.56e-4, 6.4e-5, 1.6e-5), (1.024e-3, 2.56e-4))
        self.mixed_rates = pick((1.024e-3, 2.56e-4, 6.4e-5, 1.6e-5), (1.024e-3,))
        self.rate_strain = pick(0.1, 0.02)
        self.long_strain = pick(2.0, 0.1)
        self.alphas = pick((2.0, -0.8), (2.0,))  # beside 0, where all axes are
        # All but the first make other paths of the same long run.
        self.twin_steps = pick(
            {2.0: [STEP - 0.001 * k for k in range(9)], -0.8: [STEP - 0.001 * k for k in range(4)]}, {2.0: [STEP]}
        )
        self.alpha_steps = pick((0.02, 0.05, 0.1, 0.13, 0.16), (0.05, 0.1))
        self.points = pick((1000, 10_000, 100_000, 1_000_000), (1000, 10_000))
        self.reference_points = pick(10_000_000, 100_000)
        self.point_seeds = pick((1, 2, 3, 4), (1, 2))
        self.cosines = pick((0.9, 0.97, 0.98, 0.99, 0.995, 0.999), (0.98, 0.99))
        self.boxes = pick({300: 3, 1000: 3, 3000: 3, 8000: 3, 20_000: 1}, {300: 2, 1000: 2})  # nodes: number of boxes
        self.tolerance_box = pick((3000, 3), (1000, 2))
        self.tolerances = pick((5e-2, 1e-2, 1e-3, 1e-5, 1e-8), (1e-2, 1e-8))
        self.radii = pick("3,4,5,7", "3,4")
        self.press_steps = pick((0.02, 0.05, 0.1, 0.13, 0.16, 0.19), (0.05, 0.1))
        self.velocities = pick((1.6e-2, 8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 1.25e-4, 3.125e-5), (4e-3, 2e-3))


def packing(dt=STEP, precision="double", skin=SKIN, rate=RATE, strain=0.1, held=False, frames=False, alpha=0.0):
    """A shear of the packing, at constant volume or at the recorded run's pressure."""
    rate = HELD["rate"] if held else rate
    name = (
        f"packing-{precision}-dt{dt:g}-skin{skin:g}-rate{rate:g}-strain{strain:g}" + "-held" * held + "-frames" * frames
    )
    name += f"-alpha{alpha:g}" if alpha != 0.0 else ""
    values = {
        "run.dt": dt,
        "run.precision": f'"{precision}"',
        "run.skin": skin,
        "stage.shear.rate": rate,
        "stage.shear.strain": strain,
    }
    if held:
        values |= {"stage.shear.pressure": HELD["pressure"], "stage.shear.gain": HELD["gain"]}
    if alpha != 0.0:
        values["start.alpha"] = alpha
    if frames:
        values |= {"output.trajectory.every_strain": strain}
    return engine(name, "packing.toml", values)


def press(dt=STEP, precision="double", velocity=1e-3, warm=False):
    """A sphere squeezed by 6 % between walls; `warm` builds the template that the others read."""
    name = f"press-{precision}-dt{dt:g}-v{velocity:g}" + "-warm" * warm
    values = {"run.dt": dt, "run.precision": f'"{precision}"', "stage.press.velocity": velocity}
    if warm:
        values["stage.press.strain"] = 1e-4
    return engine(name, "press.toml", values, () if warm else ("press-double-dt0.1-v0.01-warm",))


def engine(name, scene, values, after=()):
    """A run of the engine on one thread."""
    settings = [word for key, value in values.items() for word in ("--set", f"{key}={value}")]
    return Run(
        name, ("boba", "run", f"{{here}}/{scene}", *settings, "--threads", "1", "--quiet", "--output", "{out}"), after
    )


def measured(name, *options):
    """Measures of the last frame of the packing that was stored."""
    frames = packing(frames=True).name
    return Run(
        name,
        ("boba", "measure", f"{{{frames}}}", "--frame", "-1", "--threads", "1", *options, "--output", "{out}"),
        (frames,),
    )


def fraction(points, seed):
    """The packing fraction from so many random points."""
    return measured(
        f"fraction-{points}-{seed}", "--what", "packing-fraction", "--points", str(points), "--seed", str(seed)
    )


def facets(cosine, share):
    """Facets at one pair of thresholds."""
    return measured(
        f"facets-{cosine:g}-{share:g}", "--what", "shape", "--min-cosine", str(cosine), "--min-area-share", str(share)
    )


def table(nodes, seeds, tolerance=1e-5, warm=False):
    """E and nu of periodic boxes at alpha = 0 and 2; `warm` builds the boxes that the other reads."""
    name = f"table-{nodes}-{tolerance:g}" + "-warm" * warm
    after = () if warm else (f"table-{nodes}-1e-05-warm",)
    return Run(
        name,
        (
            "boba-calibrate",
            "table",
            "--alpha",
            "0,2",
            "--nodes",
            str(nodes),
            "--seeds",
            str(seeds),
            "--seed",
            "101",
            "--tolerance",
            str(tolerance),
            "--output",
            "{out}",
        ),
        after,
    )


def specimen(radii):
    """E and nu of cylinders cut from the bulk."""
    return Run(
        f"specimen-{radii}",
        ("boba-calibrate", "specimen", "--alpha", "0", "--radius", radii, "--samples", "3", "--output", "{out}"),
    )


def unique(runs):
    """Each run once, in order."""
    return list({run.name: run for run in runs}.values())


def engine_runs(plan):
    """Time step, precision, skin, rate, and the runs beside LAMMPS's."""
    runs = [packing(dt, "double", strain=plan.strain) for dt in sorted(plan.steps, reverse=True)]
    runs += [packing(dt, "mixed", strain=plan.strain) for dt in plan.mixed_steps]
    runs += [packing(STEP, held=True), packing(min(plan.steps), held=True), packing(STEP, "mixed", held=True)]
    runs += [packing(strain=plan.long_strain, precision=precision) for precision in ("double", "mixed")]
    runs += [packing(skin=skin, strain=plan.strain) for skin in plan.skins]
    runs += [packing(rate=rate, strain=plan.rate_strain) for rate in plan.rates]
    return runs + [packing(rate=rate, precision="mixed", strain=plan.rate_strain) for rate in plan.mixed_rates]


def many_body_runs(plan):
    """Time step and precision with the many-body force."""
    runs = [
        packing(dt, strain=plan.strain, alpha=alpha)
        for alpha in plan.alphas
        for dt in sorted(plan.alpha_steps, reverse=True)
    ]
    runs += [packing(precision="mixed", strain=plan.strain, alpha=alpha) for alpha in plan.alphas]
    return runs + [
        packing(dt, precision, strain=plan.long_strain, alpha=alpha)
        for alpha in plan.alphas
        for dt in plan.twin_steps[alpha]
        for precision in ("double", "mixed")
    ]


def specimen_runs(plan):
    """A sphere between walls."""
    runs = [press(velocity=0.01, warm=True)]
    runs += [press(dt, precision) for precision in ("double", "mixed") for dt in plan.press_steps]
    return runs + [press(velocity=velocity) for velocity in plan.velocities]


def measure_runs(plan):
    """Measures of one stored frame."""
    runs = [packing(frames=True), fraction(plan.reference_points, 99)]
    runs += [fraction(points, seed) for points in plan.points for seed in plan.point_seeds]
    return runs + [facets(cosine, 0.01) for cosine in plan.cosines]


def calibration_runs(plan):
    """Boxes and cylinders."""
    runs = [table(nodes, seeds, warm=warm) for nodes, seeds in plan.boxes.items() for warm in (True, False)]
    runs += [table(*plan.tolerance_box, tolerance) for tolerance in plan.tolerances]
    return [specimen(plan.radii), *runs]


def all_runs(plan):
    """Everything, each run after those it needs."""
    return unique(
        measure_runs(plan) + specimen_runs(plan) + engine_runs(plan) + many_body_runs(plan) + calibration_runs(plan)
    )
