// SPDX-License-Identifier: GPL-3.0-or-later
// Colours that colour-blind eyes tell apart. Runs and classes: Okabe and Ito (2008). Numbers: viridis (matplotlib, CC0).
"use strict";
(() => {
  const viridis = [
    [68, 1, 84], [72, 36, 117], [65, 68, 135], [53, 95, 141], [42, 120, 142], [33, 145, 140], [34, 168, 132],
    [68, 191, 112], [122, 209, 81], [189, 223, 38], [253, 231, 37],
  ];
  const light = ["#0072b2", "#c65000", "#007a57", "#a8497f", "#b37400", "#2f8fc4", "#5c6670", "#1b2430"];
  const dark = ["#5ab4f0", "#ff8a3d", "#2fc79a", "#e79cc4", "#f0b434", "#8ad2ff", "#aab4c0", "#f2f5f9"];

  /** viridis at t from 0 to 1, as [r, g, b] from 0 to 255. */
  Report.viridis = (t) => {
    const place = Math.min(Math.max(t, 0), 1) * (viridis.length - 1);
    const k = Math.min(Math.floor(place), viridis.length - 2);
    return viridis[k].map((from, c) => from + (place - k) * (viridis[k + 1][c] - from));
  };
  Report.css = (rgb) => `rgb(${rgb.map(Math.round).join(" ")})`;
  Report.isDark = () => document.documentElement.dataset.theme === "dark";

  /** Colour of a run: one of eight, or of more runs its place in viridis. */
  Report.runColour = (run) => {
    const n = Report.data.runs.length;
    const palette = Report.isDark() ? dark : light;
    if (n <= palette.length) {
      return palette[run % palette.length];
    }
    const t = run / (n - 1);
    return Report.css(Report.viridis(Report.isDark() ? 0.25 + 0.75 * t : 0.9 * t));
  };

  /** Colour of a line beside others of its run: the run's own, or the next of the palette. */
  Report.lineColour = (run, offset) => {
    const palette = Report.isDark() ? dark : light;
    return offset ? palette[(run + offset) % palette.length] : Report.runColour(run);
  };

  const classes = [[0, 114, 178], [230, 159, 0], [0, 158, 115], [204, 121, 167], [213, 94, 0], [86, 180, 233], [240, 228, 66]];
  /** Colour of a class: of "unknown" and "curved" grey. */
  Report.classColour = (names, k) => {
    if (names[k] === "unknown" || names[k] === "curved") {
      return [150, 156, 164];
    }
    return classes[k % classes.length];
  };

  /** Colours that tell grains with neighbouring numbers apart: hues by the golden ratio, three lightnesses. */
  Report.grainColour = (k) => {
    const h = ((0.58 + 0.618034 * k) % 1) * 6;
    const [s, v] = [[0.6, 0.92], [0.45, 0.82], [0.55, 0.72]][k % 3];
    const f = (n) => {
      const t = (n + h) % 6;
      return 255 * (v - v * s * Math.max(0, Math.min(t, 4 - t, 1)));
    };
    return [f(5), f(3), f(1)];
  };
})();
