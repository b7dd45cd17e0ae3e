#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sphere of the benchmark (nu = 0.25, a/R = 0.1) in CalculiX: axisymmetric CAX8 elements on a graded mesh.

Two ways: `contact`, its own surface-to-surface contact with a stiff plate, and `nodal`, a hand-made active set that
presses surface nodes by *BOUNDARY and repeats the linear solution. Prints CSV like continuum_bench.
Usage: calculix_peer.py APPROACH_OF_ONE_PLATE FORCE (both of the exact solution, E = R = 1)"""
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

YOUNG, POISSON, EDGE = 1.0, 0.25, 0.1
# CalculiX turns an axisymmetric element into a wedge of 2 degrees and prints the wedge's reactions.
WEDGES = 180


def graded(fine, width, growth, length):
    """Lines from 0: even steps out to width, then growing ones to length."""
    lines = list(np.arange(0, width + 0.5 * fine, fine))
    step = fine
    while lines[-1] < length:
        step *= growth
        lines.append(lines[-1] + step)
    tail = np.array(lines[len(np.arange(0, width + 0.5 * fine, fine)) - 1 :])
    tail = tail[0] + (tail - tail[0]) * (length - tail[0]) / (tail[-1] - tail[0])
    return np.concatenate([lines[: len(lines) - len(tail)], tail])


class Grid:
    """Eight-node quadrilaterals on a tensor grid; place(u, v) gives (r, z)."""

    def __init__(self, u, v, place, first_node, first_element):
        self.columns, self.rows = len(u) - 1, len(v) - 1
        self.number, self.nodes, self.elements = {}, {}, {}
        fine_u = np.sort(np.concatenate([u, 0.5 * (u[1:] + u[:-1])]))
        fine_v = np.sort(np.concatenate([v, 0.5 * (v[1:] + v[:-1])]))
        number = first_node
        for i, a in enumerate(fine_u):
            for j, b in enumerate(fine_v):
                if i % 2 and j % 2:
                    continue
                self.number[i, j] = number
                self.nodes[number] = place(a, b)
                number += 1
        element = first_element
        self.grid = {}
        for i in range(self.columns):
            for j in range(self.rows):
                corner = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
                self.elements[element] = [self.number[2 * i + a, 2 * j + b] for a, b in corner]
                self.grid[i, j] = element
                element += 1
        self.next_node, self.next_element = number, element


def in_disk(u, v):
    """Quarter square to quarter disk; the pole is at u = 0, v = 1."""
    return u * np.sqrt(1 - v * v / 2), v * np.sqrt(1 - u * u / 2)


def sphere(across):
    fine = EDGE * np.sqrt(2) / across
    u = graded(fine, 1.4 * EDGE * np.sqrt(2), 1.25, 1.0)
    v = 1 - graded(fine, 4 * fine, 1.25, 1.0)[::-1]
    return Grid(u, np.clip(v, 0, 1), in_disk, 1, 1)


def mesh_lines(grids):
    lines = ["*NODE, NSET=NALL"]
    for grid in grids:
        lines += [f"{n}, {x:.15g}, {y:.15g}, 0" for n, (x, y) in grid.nodes.items()]
    for name, grid in zip(("BODY", "PLATE"), grids):
        lines.append(f"*ELEMENT, TYPE=CAX8, ELSET={name}")
        lines += [f"{e}, " + ", ".join(map(str, nodes)) for e, nodes in grid.elements.items()]
    lines += ["*MATERIAL, NAME=SOFT", "*ELASTIC", f"{YOUNG}, {POISSON}", "*SOLID SECTION, ELSET=BODY, MATERIAL=SOFT"]
    if len(grids) > 1:
        lines += [
            "*MATERIAL, NAME=HARD",
            "*ELASTIC",
            f"{1e5 * YOUNG}, 0.3",
            "*SOLID SECTION, ELSET=PLATE, MATERIAL=HARD",
        ]
    return lines


def symmetry(grid):
    lines = ["*BOUNDARY"]
    for n, (x, y) in grid.nodes.items():
        if abs(x) < 1e-12:
            lines.append(f"{n}, 1, 1, 0")
        if abs(y) < 1e-12:
            lines.append(f"{n}, 2, 2, 0")
    return lines


def run(lines, folder):
    """Runs the deck; returns the vertical reactions of the nodes asked for."""
    (folder / "deck.inp").write_text("\n".join(lines) + "\n")
    done = subprocess.run(["ccx", "-i", "deck"], cwd=folder, capture_output=True, text=True, check=False)
    text = (folder / "deck.dat").read_text() if (folder / "deck.dat").exists() else ""
    rows = [line.split() for line in text.splitlines()]
    found = {int(r[0]): float(r[2]) for r in rows if len(r) == 4 and r[0].isdigit()}
    if not found:
        sys.exit(f"CalculiX gave no reactions:\n{done.stdout[-2000:]}")
    return found


def native(across, approach, folder):
    body = sphere(across)
    fine = EDGE / across
    lines_u = graded(fine, 1.4 * EDGE, 1.25, 0.4)
    plate = Grid(lines_u, np.linspace(0, 1, 3), lambda a, b: (a, 1 + 0.05 * b), body.next_node, body.next_element)
    top = [plate.number[i, 2 * plate.rows] for i in range(2 * plate.columns + 1)]
    deck = mesh_lines([body, plate]) + symmetry(body)
    deck += [f"{n}, 1, 1, 0" for n, (x, y) in plate.nodes.items() if abs(x) < 1e-12]
    pressed = [body.grid[i, body.rows - 1] for i in range(body.columns) if lines_reach(body, i)]
    deck += ["*SURFACE, NAME=SLAVE, TYPE=ELEMENT"] + [f"{e}, S3" for e in pressed]
    deck += ["*SURFACE, NAME=MASTER, TYPE=ELEMENT"] + [f"{plate.grid[i, 0]}, S1" for i in range(plate.columns)]
    deck += [
        "*SURFACE INTERACTION, NAME=SI",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
        f"{1e5 * YOUNG}",
        "*CONTACT PAIR, INTERACTION=SI, TYPE=SURFACE TO SURFACE",
        "SLAVE, MASTER",
        "*NSET, NSET=TOP",
    ]
    deck += [f"{n}," for n in top]
    deck += [
        "*STEP, INC=1000",
        "*STATIC",
        "0.25, 1.",
        "*BOUNDARY",
        "TOP, 1, 1, 0",
        f"TOP, 2, 2, {-approach:.15g}",
        "*NODE PRINT, NSET=TOP, FREQUENCY=1000",
        "RF",
        "*END STEP",
    ]
    reactions = run(deck, folder)
    return -WEDGES * sum(reactions.values()), 2 * len(body.nodes)


def lines_reach(body, column):
    x, _ = body.nodes[body.number[2 * column, 2 * body.rows]]
    return x < 1.35 * EDGE


def nodal(across, approach, folder):
    body = sphere(across)
    row = 2 * body.rows
    surface = [body.number[i, row] for i in range(2 * body.columns + 1)]
    height = {n: 1 - approach - body.nodes[n][1] for n in surface}
    active = {n for n in surface if height[n] < 0 and body.nodes[n][0] < 1.3 * EDGE}
    active = {n for n in active if body.nodes[n][0] < EDGE * 1.02}
    head = mesh_lines([body]) + symmetry(body)
    for _ in range(30):
        deck = head + [f"{n}, 2, 2, {height[n]:.15g}" for n in sorted(active)] + ["*NSET, NSET=TOP"]
        deck += [f"{n}," for n in surface]
        deck += ["*STEP", "*STATIC", "*NODE PRINT, NSET=TOP", "RF", "*NODE PRINT, NSET=TOP", "U", "*END STEP"]
        (folder / "deck.inp").write_text("\n".join(deck) + "\n")
        subprocess.run(["ccx", "-i", "deck"], cwd=folder, capture_output=True, text=True, check=False)
        blocks = (folder / "deck.dat").read_text().split("displacements")
        reaction, u = [
            {int(r[0]): float(r[2]) for r in map(str.split, block.splitlines()) if len(r) == 4 and r[0].isdigit()}
            for block in blocks
        ]
        # Corner and edge nodes of quadratic elements share a load unevenly: only the outermost ones are released.
        ordered = sorted(active, key=lambda n: body.nodes[n][0])
        pulled = [n for n in ordered[-3:] if reaction[n] > 0]
        pressed = [n for n in surface if n not in active and u[n] > height[n] + 1e-12 and body.nodes[n][0] < 1.3 * EDGE]
        if not pulled and not pressed:
            break
        active = (active - set(pulled)) | set(pressed)
    return -WEDGES * sum(reaction[n] for n in active), 2 * len(body.nodes)


def main():
    approach, exact = float(sys.argv[1]), float(sys.argv[2])
    print("problem,element,size,unknowns,error_force,error_radius,error_pressure,seconds")
    for name, method in (("CalculiX nodal set", nodal), ("CalculiX contact", native)):
        for across in (8, 16, 32):
            with tempfile.TemporaryDirectory() as folder:
                start = time.perf_counter()
                force, unknowns = method(across, approach, pathlib.Path(folder))
                seconds = time.perf_counter() - start
            print(f"{name},CAX8,{across},{unknowns},{abs(force / exact - 1):.3e},,,{seconds:.3f}", flush=True)


if __name__ == "__main__":
    main()
