# SPDX-License-Identifier: GPL-3.0-or-later
"""The rigid spheres of spheres.toml in YADE, an independent program: the same law, number, pressure, rates and gain.

    yade -n -x examples/paper/yade_spheres.py RATE STRAIN TABLE.csv [SEED]

Hertz contacts without friction, damped by half of the critical damping, E_eff = 1, spheres of unit diameter and mass.
Compressed isotropically to P = 1e-5 and sheared in x with gradient y; velocities follow the cell (YADE's own way), where
Boba's run remaps positions. Every column is in Boba's units. Needs `apt-get install yade`."""
import csv
import sys

import numpy as np
from yade import pack
from yade.utils import getStress
from yade.wrapper import *

N, PRESSURE, GAIN, CAP, STEP = 216, 1e-5, 2.0, 1e-5, 0.5


def stress():
    """Of contacts, and of velocities beyond the cell's flow; pressure counts positive."""
    volume = O.cell.volume
    total = np.array(getStress(volume))
    relative = np.array([b.state.vel - O.cell.velGrad * b.state.pos for b in O.bodies])
    kinetic = relative.T @ relative / volume
    if np.trace(total) > 0:  # its sign differs between versions; contacts without friction only push
        total = -total
    return total - kinetic, 0.5 * (relative**2).sum()


class Barostat:
    """dh/dt = [ rate e_x (x) e_y + g (P - P_target) 1 ] h, g (P - P_target) within the cap."""

    def __init__(self, rate):
        self.rate, self.P, self.mu, self.kinetic = rate, 0.0, 0.0, 0.0

    def update(self):
        sigma, self.kinetic = stress()
        self.P = -np.trace(sigma) / 3.0
        self.mu = sigma[0, 1] / self.P if self.P > 0 else 0.0
        g = float(np.clip(GAIN * (self.P - PRESSURE), -CAP, CAP))
        O.cell.velGrad = Matrix3(g, self.rate, 0, 0, g, 0, 0, 0, g)


def phi():
    return N * np.pi / 6.0 / O.cell.volume


def main(rate, strain, path, seed):
    global barostat
    edge = (N * np.pi / 6.0 / 0.3) ** (1.0 / 3.0)
    O.periodic = True
    O.cell.setBox(edge, edge, edge)
    O.cell.flipFlippable = True  # contacts are lost in a cell that is tilted by more than twice its height
    material = O.materials.append(FrictMat(young=2.0, poisson=0.0, frictionAngle=0.0, density=6.0 / np.pi))
    cloud = pack.SpherePack()
    cloud.makeCloud((0, 0, 0), (edge, edge, edge), rMean=0.5, rRelFuzz=0.0, num=N, periodic=True, seed=seed)
    if len(cloud) != N:
        raise RuntimeError(f"only {len(cloud)} of {N} spheres found a place")
    cloud.toSimulation(material=material)
    barostat = Barostat(0.0)
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb()], allowBiggerThanPeriod=True),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom()],
            [Ip2_FrictMat_FrictMat_MindlinPhys(betan=0.5, betas=0.0)],
            [Law2_ScGeom_MindlinPhys_Mindlin()],
        ),
        NewtonIntegrator(damping=0.0),
        PyRunner(command="barostat.update()", iterPeriod=1),
    ]
    O.dt = STEP
    barostat.update()
    while abs(barostat.P / PRESSURE - 1.0) > 1e-2 or barostat.kinetic > 1e-3 * PRESSURE * O.cell.volume:
        O.run(200, wait=True)
    at_rest = phi()
    print(f"at rest: P = {barostat.P:.4g}, phi = {at_rest:.4f} after {O.iter} steps", flush=True)
    barostat.rate, start = rate, O.iter
    with open(path, "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["strain", "P_k/d", "mu", "phi", "phi_at_rest", "kinetic_energy_kd2"])
        while (O.iter - start) * STEP * rate < strain:
            O.run(max(1, int(round(0.01 / (rate * STEP)))), wait=True)
            table.writerow(
                [
                    f"{x:.9g}"
                    for x in ((O.iter - start) * STEP * rate, barostat.P, barostat.mu, phi(), at_rest, barostat.kinetic)
                ]
            )
            file.flush()


words = sys.argv[1:]
main(float(words[0]), float(words[1]), words[2], int(words[3]) if len(words) > 3 else 1)
