#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Time of a step at the full size on many cores, from what was measured and counted. Usage: plot_scaling.py MODEL.json PICTURE

The model. A rank of c cores has at most ceil(g / 8) blocks of its g grains; a block is one core's work:

    work     = nodes of the busiest core x time of a node-step
    halo     = messages x latency + nodes x 64 bytes / bandwidth + nodes x what one costs the processors
    sums     = 2 log2(P) latency (Allreduce) + log2(P) latency + 16 bytes x grains / bandwidth (Allgather)
    updates  = share of steps x 8 collectives x 2 log2(P) latency

Nodes: those in candidates, counted, times the share of them that two ranks exchanged a step. What one costs the processors (being
packed, searched and evaluated on both sides) is what two ranks worked longer than half of one, by node.
"""
import json
import math
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

LATENCY = 2e-6  # s a message, a common InfiniBand fabric
BANDWIDTH = 10e9  # bytes/s a rank


def step(model, count, cores_a_rank=1, split=False):
    """Seconds of a step on the counted number of ranks: work, halo, sums, updates."""
    ranks = count["ranks"]
    grains = model["grains"] / ranks
    blocks = math.ceil(grains / 8 - 1e-9)
    lanes = blocks * 8
    on_busiest = lanes / cores_a_rank if split else 8 * math.ceil(blocks / cores_a_rank)
    work = on_busiest * model["nodes_a_grain"] * model["seconds_a_node"] * max(1.0, count["imbalance"] * grains / lanes)
    depth = math.log2(max(ranks, 2))
    nodes = count["most_nodes"] * model["exchanged_share"]
    halo = count["messages"] * LATENCY + nodes * 64 / BANDWIDTH + nodes * model["seconds_a_halo_node"] / cores_a_rank
    sums = 3 * depth * LATENCY + 16 * model["grains"] / BANDWIDTH
    updates = model["updates_a_step"] * 16 * depth * LATENCY
    return work, halo, sums, updates


def main():
    model = json.load(open(sys.argv[1]))
    counts = {count["ranks"]: count for count in model["counted"]}
    rows = []
    for cores, ranks, cores_a_rank, split in [
        (16, 16, 1, False),
        (128, 128, 1, False),
        (1024, 1024, 1, False),
        (1024, 128, 8, True),
    ]:
        parts = step(model, counts[ranks], cores_a_rank, split)
        rows.append((cores, ranks, cores_a_rank, split, parts))
    serial = model["grains"] * model["nodes_a_grain"] * model["seconds_a_node"]
    print(
        "| cores | ranks x threads | work, ms | halo, ms | sums, ms | list updates, ms | step, ms | efficiency | 6.4e7 steps, days |"
    )
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for cores, ranks, threads, split, parts in rows:
        total = sum(parts)
        print(
            f"| {cores} | {ranks} x {threads}{' (split blocks)' if split else ''} | "
            + " | ".join(f"{1e3 * part:.3g}" for part in parts)
            + f" | {1e3 * total:.3g} | {100 * serial / total / cores:.0f} % | {6.4e7 * total / 86400:.3g} |"
        )
    figure, axes = plt.subplots(figsize=(6.4, 4.2))
    ranks = sorted(counts)
    for label, index in (("work", 0), ("halo", 1), ("sums over grains", 2), ("list updates", 3)):
        axes.loglog(ranks, [1e3 * step(model, counts[r])[index] for r in ranks], marker="o", label=label)
    axes.loglog(ranks, [1e3 * sum(step(model, counts[r])) for r in ranks], "k-", linewidth=2, label="step")
    axes.loglog(ranks, [1e3 * serial / r for r in ranks], "k:", label="ideal")
    axes.set_xlabel("ranks of one core")
    axes.set_ylabel("time of a step, ms")
    axes.legend()
    axes.grid(True, which="major", alpha=0.3)
    figure.tight_layout()
    figure.savefig(sys.argv[2], dpi=120)


main()
