# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python module on a small run made here: tables, averages, frames, pictures."""
import pathlib
import tempfile
import unittest

import h5py
import numpy as np
import boba
from boba import look, panels, picture, plot
from boba.pictures import hull_of
from boba.render import Picture, view_axes
from made_run import write_table


def make_run(folder):
    strain = [0.01 * k for k in range(600)]
    write_table(
        folder / "table.csv",
        {
            "step": list(range(600)),
            "time_tau": [10.0 * k for k in range(600)],
            "strain": strain,
            "mu": [0.1 + 0.01 * (k % 2) for k in range(600)],
            "phi_reference": [0.9] * 600,
            "P_normalised": [None] * 600,
            "P_k/d": [0.1] * 600,
            "inertial_number": [1e-3] * 600,
        },
    )
    (folder / "measures").mkdir()
    write_table(
        folder / "measures" / "grains.csv",
        {
            "step": [0, 0, 7, 7],
            "time_tau": [0.0] * 4,
            "strain": [0.0, 0.0, 0.5, 0.5],
            "grain": [1, 2, 1, 2],
            "volume_d3": [10.0, 11.0, 12.0, 13.0],
            "asphericity": [1.0, 1.1, 1.2, 1.3],
            "facets": [12, 11, 10, 12],
        },
    )
    box = np.array([[4.0, 1.0, -0.5], [0.0, 5.0, 2.0], [0.0, 0.0, 6.0]])
    origin = np.array([1.0, 2.0, 3.0])
    unwrapped = origin + np.random.default_rng(1).normal(size=(20, 3)) * 8
    image = np.floor(np.linalg.solve(box, (unwrapped - origin).T).T).astype(int)
    with h5py.File(folder / "trajectory.h5", "w") as file:
        file["particles/all/position/value"] = (unwrapped - image @ box.T)[None]
        file["particles/all/position/step"] = np.array([7])
        file["particles/all/position/time"] = np.array([0.7])
        file["particles/all/image/value"] = image[None]
        file["particles/all/box/edges/value"] = box.T[None]
        file["particles/all/box/boba_origin/value"] = origin[None]
        file["observables/strain/value"] = np.array([0.5])
        file["observables/grain_centre/value"] = np.array([unwrapped[:10].mean(0), unwrapped[10:].mean(0)])[None]
        file["observables/grain_stress/value"] = np.zeros((1, 2, 6))
        file["parameters/grains/first_node"] = np.array([0, 10, 20])
        file["parameters/grains/species"] = np.array([0, 0])
    return unwrapped


class Module(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        self.unwrapped = make_run(self.folder)
        self.run_ = boba.open(self.folder)

    def tearDown(self):
        self.temporary.cleanup()

    def test_tables_and_rows(self):
        self.assertEqual(self.run_.measures, ["grains"])
        self.assertTrue(np.isnan(self.run_.table["P_normalised"][0]))
        self.assertEqual(list(self.run_.rows("grains", 7)["volume_d3"]), [12.0, 13.0])
        strains, values = self.run_.grain_traces("facets")
        self.assertEqual(values.tolist(), [[12, 11], [10, 12]])
        self.assertEqual(strains.tolist(), [0.0, 0.5])
        with self.assertRaises(KeyError):
            self.run_.measure("order")
        with self.assertRaises(FileNotFoundError):
            boba.open(self.folder / "nothing")

    def test_a_packing_crystallises_when_a_nucleus_was_seen_before_it_spanned_the_cell(self):
        strain = np.arange(40.0)
        share = np.where(strain < 10, 0.1, 0.9)
        share[3] = 1.0  # for a moment
        finite = np.where(strain < 10, 2.0 * strain, 0.0)  # 18 grains in the last frame before the onset
        found = boba.crystallisation({"strain": strain, "solid_share": share, "largest_finite_cluster": finite})
        self.assertTrue(found.crystallised)
        self.assertEqual(found.nucleus, 18)
        self.assertAlmostEqual(found.onset, 8.0)  # three of the five frames from 8 on are ordered
        self.assertAlmostEqual(found.share, 0.9)
        spanned = boba.crystallisation({"strain": strain, "solid_share": share, "largest_finite_cluster": finite / 2})
        self.assertFalse(spanned.crystallised)
        self.assertAlmostEqual(spanned.onset, 8.0)
        lost = boba.crystallisation({"strain": strain, "solid_share": share[::-1], "largest_finite_cluster": finite})
        self.assertIsNone(lost.onset)
        self.assertFalse(lost.crystallised)
        with self.assertRaises(KeyError):
            boba.crystallisation({"strain": strain, "disordered_share": share})

    def test_a_row_that_is_still_being_written_is_left_out(self):
        with (self.folder / "table.csv").open("a") as file:
            file.write("600,6.0,0.3")
        self.assertEqual(len(boba.open(self.folder).table["step"]), 600)

    def test_average_over_a_window(self):
        mean, error = self.run_.average("mu", 1, 5)
        self.assertAlmostEqual(mean, 0.105, delta=2e-5)
        self.assertLess(error, 5e-4)

    def test_blocked_error_of_a_correlated_series(self):
        generator = np.random.default_rng(3)
        ratios = []
        for _ in range(10):
            x, series = 0.0, np.empty(8192)
            noise = generator.normal(size=8192)
            for k in range(8192):
                x = 0.8 * x + 0.6 * noise[k]
                series[k] = x
            ratios.append(boba.blocked_mean(series)[1] / np.sqrt(9 / 8192))  # (1 + rho) / (1 - rho) = 9
        self.assertAlmostEqual(np.mean(ratios), 1.0, delta=0.12)

    def test_frames_are_unwrapped(self):
        self.assertEqual(len(self.run_.frames), 1)
        frame = self.run_.frames[-1]
        np.testing.assert_allclose(frame.positions, self.unwrapped, atol=1e-12)
        np.testing.assert_allclose(frame.grains[1], self.unwrapped[10:], atol=1e-12)
        self.assertAlmostEqual(frame.volume, 120.0)
        inside = np.linalg.solve(frame.box, self.unwrapped[3] + frame.shift_into_cell(self.unwrapped[3]) - frame.origin)
        self.assertTrue(((inside >= 0) & (inside < 1)).all())
        with self.assertRaises(IndexError):
            self.run_.frames[1]

    def test_nearer_sphere_hides_the_farther(self):
        picture = Picture(view_axes((0, 0, 1)), (0, 0, 0), (4, 4), width=40)
        picture.spheres([[0, 0, 0], [0, 0, 2], [1.4, 0, 0]], [[255, 0, 0], [0, 255, 0], [0, 0, 255]])
        pixels = picture.colour.reshape(picture.ny, picture.nx, 3)
        centre = pixels[picture.ny // 2, picture.nx // 2]
        self.assertGreater(centre[1], 100)
        self.assertEqual(centre[0], 0)
        self.assertGreater(pixels[picture.ny // 2, picture.nx // 2 + 28][2], 50)
        self.assertEqual(pixels[2, 2].tolist(), [255, 255, 255])
        covered = (picture.depth > -np.inf).sum() / picture.scale**2
        self.assertAlmostEqual(covered, 2 * np.pi / 4, delta=0.08)  # two discs of diameter 1 are seen

    def test_hull_of_a_cube_has_outward_normals(self):
        corners = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)], dtype=float)
        vertices, triangles, normals = hull_of(np.concatenate([corners, 0.1 * corners]))
        self.assertEqual(len(vertices), 8)
        self.assertEqual(len(triangles), 12)
        self.assertTrue((np.einsum("ij,ij->i", normals, vertices[triangles[:, 0]]) > 0.99).all())

    def test_plot_draws_what_there_is(self):
        self.assertEqual(plot.main([str(self.folder), "--pictures", "--hulls", "0", "1"]), 0)
        names = {path.stem for path in (self.folder / "plots").glob("*.png")}
        self.assertTrue((self.folder / "plot.png").exists())
        self.assertLessEqual(
            {"stress_ratio", "volume_distribution", "facet_counts", "grains", "hulls"},
            names,
        )
        # Nothing to show: no order measured, one run alone, a pressure and a packing fraction that stay as they are.
        for absent in ("crystal_classes", "rheology", "pressure", "packing_fraction", "compaction", "press"):
            self.assertNotIn(absent, names)
        self.assertEqual(plot.main([str(self.folder / "nothing")]), 2)

    def test_plot_writes_vector_formats_and_refuses_others(self):
        self.assertEqual(plot.main([str(self.folder), "--format", "svg", "--output", str(self.folder / "v")]), 0)
        self.assertIn("<svg", (self.folder / "v" / "stress_ratio.svg").read_text())
        self.assertEqual(plot.main([str(self.folder), "--dpi", "5"]), 2)

    def test_a_shear_that_turns_back_is_drawn_along_its_way(self):
        there = [0.0, 0.0, 0.1, 0.2, 0.3, 0.2, 0.1]
        write_table(
            self.folder / "table.csv",
            {"step": list(range(7)), "time_tau": [float(k) for k in range(7)], "strain": there, "mu": [0.1] * 7},
        )
        run = boba.open(self.folder)
        rows, x, label = panels.abscissa(run)
        np.testing.assert_allclose(x, [0.0, 0.1, 0.2, 0.3, 0.4, 0.5])
        self.assertEqual(list(run.table["strain"][rows]), there[1:])
        self.assertIn("way", label)
        # A table of measures with fewer rows gets its places from the run's own table.
        rows, x, _ = panels.abscissa(run, {"step": np.array([0.0, 4.0, 6.0]), "strain": np.array([0.0, 0.3, 0.1])})
        np.testing.assert_allclose(x, [0.3, 0.5])

    def test_a_compression_is_the_rows_that_grow_denser_above_rounding(self):
        write_table(
            self.folder / "table.csv",
            {
                "step": list(range(8)),
                "time_tau": [float(k) for k in range(8)],
                "strain": [0.0] * 6 + [0.1, 0.2],
                "phi_reference": [0.4, 0.5, 0.6, 0.7, 0.69, 0.71, 0.8, 0.9],
                "P_k/d": [1e-17, 1e-3, 1e-2, 0.1, 0.09, 0.1, 0.2, 0.3],
            },
        )
        # Row 0 is rounding, row 4 is less dense than the one before, rows 6 and 7 are sheared; a step of strain
        # belongs to the row where it begins, the last one at rest.
        self.assertEqual(list(panels.compression_rows(boba.open(self.folder))), [1, 2, 3])

    def test_labels_are_sorted_as_numbers_and_carry_units(self):
        self.assertEqual(sorted(["1e-2", "9e-3", "0.1"], key=look.natural), ["9e-3", "1e-2", "0.1"])
        self.assertEqual(sorted(["run10", "run2", "run1"], key=look.natural), ["run1", "run2", "run10"])
        self.assertEqual(look.quantity("P_k/d", "pressure"), "pressure $P$ ($k/d$)")
        self.assertEqual(look.quantity("volume_d3"), "$V$ ($d^3$)")
        self.assertEqual(look.quantity("mu"), r"$\mu$")
        self.assertEqual(len(set(map(str, look.colours(20)))), 20)

    def test_picture_is_coloured_by_what_was_measured(self):
        out = str(self.folder / "p.png")
        for arguments in (["--colour", "volume"], ["--colour", "facets", "--hulls"], ["--section", "z", "--no-cell"]):
            self.assertEqual(picture.main([str(self.folder), "--output", out, "--width", "200", *arguments]), 0)
        colouring = picture.Colouring(boba.open(self.folder), boba.open(self.folder).frames[0], picture.parse(["x"]))
        self.assertEqual(len(colouring.of_grain), 2)
        chosen = picture.parse(["x", "--colour", "volume"])
        colouring = picture.Colouring(boba.open(self.folder), boba.open(self.folder).frames[0], chosen)
        self.assertEqual(colouring.limits, (12.0, 13.0))  # volumes of step 7, which the frame is
        # The ends of viridis: dark violet and yellow.
        np.testing.assert_allclose(colouring.of_grain[0], [68, 1, 84], atol=1)
        np.testing.assert_allclose(colouring.of_grain[1], [253, 231, 37], atol=1)
        for wrong in (["--colour", "nonsense"], ["--frame", "3"], ["--section", "q"], ["--output", "x.doc"]):
            self.assertEqual(picture.main([str(self.folder), *wrong]), 2)

    def test_pressure_of_a_grain_is_its_part_of_the_stress_over_its_volume(self):
        frame = boba.open(self.folder).frames[0]
        frame.grain_stress = np.array([[-3.0, -6.0, -9.0, 0, 0, 0], [-12.0, -12.0, -12.0, 0, 0, 0]])
        np.testing.assert_allclose(picture.pressures(boba.open(self.folder), frame), [6.0 / 12.0, 12.0 / 13.0])
