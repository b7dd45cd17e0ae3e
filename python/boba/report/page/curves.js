// SPDX-License-Identifier: GPL-3.0-or-later
// Panels of curves (uPlot): zoom, values under the pointer, export as PNG and CSV.
"use strict";
(() => {
  const { element, byId } = Report;
  const dashes = { dash: [7, 4], dots: [2, 4], dashdot: [8, 3, 2, 3] };
  const drawn = new Map(); // panel's id -> what draws it
  Report.panelsDrawn = drawn;

  const isClock = (panel) => panel.x === "clock";
  const clock = () => byId("clock").value;
  const xLabel = (panel) => (isClock(panel) ? (clock() === "strain" ? "strain run through" : "time (tau)") : panel.x);

  /** Abscissa, ordinate and what surrounds it, of one line as the panel shows it now. */
  const valuesOf = (panel, series) => {
    if (!isClock(panel)) {
      return { xs: series.xs, ys: series.ys, errors: series.errors };
    }
    const table = Report.data.tables[series.table];
    const xs = table[clock()];
    return {
      xs,
      ys: table.columns[series.column],
      errors: table.columns[series.error],
      deviation: table.columns[series.deviation],
      steps: table.step,
    };
  };

  const labelOf = (series, panel) => {
    const run = Report.data.runs.length > 1 && !series.plain ? Report.data.runs[series.run].name : "";
    return [run, series.label].filter(Boolean).join(": ") || panel.y;
  };

  /** Lines that can be told apart: the run's colour and a dash, or for "shade" another colour. */
  const colourOf = (panel, series) => {
    const before = panel.series.slice(0, panel.series.indexOf(series)).filter((other) => other.run === series.run);
    const several = Report.data.runs.length === 1 ? before.length : 0;
    return Report.lineColour(series.run, series.shade || several ? Math.max(before.length, 1) : 0);
  };

  /** All lines over one abscissa: rising numbers, each once, and for each line its values there. */
  const joined = (lines) => {
    const places = [...new Set(lines.flatMap((line) => line.xs.filter((x) => x !== null)))].sort((a, b) => a - b);
    const index = new Map(places.map((x, k) => [x, k]));
    const columns = lines.map((line) => {
      const column = { ys: new Array(places.length).fill(undefined), errors: [], deviation: [] };
      line.xs.forEach((x, k) => {
        if (x !== null && line.ys[k] !== null) {
          const at = index.get(x);
          column.ys[at] = line.ys[k];
          column.errors[at] = line.errors ? line.errors[k] : null;
          column.deviation[at] = line.deviation ? line.deviation[k] : null;
        }
      });
      return column;
    });
    return { places, columns };
  };

  const drawBand = (plot, k, column) => {
    const { ctx } = plot;
    const known = plot.data[0].map((_, i) => i).filter((i) => column.deviation[i] > 0 && column.ys[i] !== undefined);
    if (known.length > 1) {
      ctx.beginPath();
      known.forEach((i) => ctx.lineTo(plot.valToPos(plot.data[0][i], "x", true), plot.valToPos(column.ys[i] + column.deviation[i], "y", true)));
      known.reverse().forEach((i) => ctx.lineTo(plot.valToPos(plot.data[0][i], "x", true), plot.valToPos(column.ys[i] - column.deviation[i], "y", true)));
      ctx.globalAlpha = 0.18;
      ctx.fillStyle = plot.series[k + 1].stroke(plot, k + 1);
      ctx.fill();
      ctx.globalAlpha = 1;
    }
  };

  const drawErrors = (plot, k, column) => {
    const { ctx } = plot;
    ctx.strokeStyle = plot.series[k + 1].stroke(plot, k + 1);
    ctx.lineWidth = 1.2 * devicePixelRatio;
    ctx.beginPath();
    plot.data[0].forEach((x, i) => {
      const error = column.errors[i];
      if (error > 0 && column.ys[i] !== undefined) {
        const at = plot.valToPos(x, "x", true);
        const [top, bottom] = [column.ys[i] + error, column.ys[i] - error].map((y) => plot.valToPos(y, "y", true));
        const cap = 3 * devicePixelRatio;
        ctx.moveTo(at, top);
        ctx.lineTo(at, bottom);
        ctx.moveTo(at - cap, top);
        ctx.lineTo(at + cap, top);
        ctx.moveTo(at - cap, bottom);
        ctx.lineTo(at + cap, bottom);
      }
    });
    ctx.stroke();
  };

  /** What surrounds the lines is drawn within the axes, under the curves. */
  const surround = (columns) => (plot) => {
    plot.ctx.save();
    plot.ctx.beginPath();
    plot.ctx.rect(plot.bbox.left, plot.bbox.top, plot.bbox.width, plot.bbox.height);
    plot.ctx.clip();
    columns.forEach((column, k) => {
      if (plot.series[k + 1].show) {
        drawBand(plot, k, column);
        drawErrors(plot, k, column);
      }
    });
    plot.ctx.restore();
  };

  /** Range of the ordinate over what is shown, bands and errors included, with room above and below. */
  const rangeOf = (columns, log) => (plot) => {
    const [first, last] = plot.series[0].idxs ?? [0, plot.data[0].length - 1];
    let [low, high] = [Infinity, -Infinity];
    columns.forEach((column, k) => {
      if (plot.series[k + 1].show) {
        for (let i = first; i <= last; i += 1) {
          const y = column.ys[i];
          if (y !== undefined && (!log || y > 0)) {
            const around = Math.max(column.errors[i] || 0, column.deviation[i] || 0);
            low = Math.min(low, log && y - around <= 0 ? y : y - around);
            high = Math.max(high, y + around);
          }
        }
      }
    });
    if (!(low <= high)) {
      return log ? [1e-3, 1] : [0, 1];
    }
    if (log) {
      low = Math.max(low, high * 1e-12);
      return [10 ** Math.floor(Math.log10(low)), 10 ** Math.ceil(Math.log10(high) + 1e-9)];
    }
    const room = 0.06 * (high - low) || 0.05 * Math.abs(high) || 1;
    return [low >= 0 && low - room < 0 ? 0 : low - room, high + room];
  };

  const isLogX = (panel, places) => panel.log_x && places[0] > 0;

  const optionsFor = (panel, data, width) => {
    const { places, columns } = data;
    const ink = () => Report.style("--quiet");
    const grid = { stroke: () => Report.style("--grid"), width: 1 };
    const axis = { stroke: ink, grid, ticks: grid, font: "12px system-ui, sans-serif", labelFont: "12px system-ui, sans-serif", labelSize: 22 };
    const logX = isLogX(panel, places);
    const numbers = (_, splits) => splits.map((v) => (v === null ? "" : Report.shown(v, 4)));
    // Of a logarithmic axis the powers of ten alone have a line, where there are enough of them.
    const powers = (_, splits) => {
      const isPower = (v) => v > 0 && Math.abs(Math.log10(v) - Math.round(Math.log10(v))) < 1e-9;
      return splits.filter(isPower).length > 1 ? splits.map((v) => (isPower(v) ? v : null)) : splits;
    };
    const logGrid = { grid: { ...grid, filter: powers }, ticks: { ...grid, filter: powers }, filter: powers };
    return {
      width,
      height: 250,
      scales: {
        x: logX ? { time: false, distr: 3 } : { time: false },
        y: { distr: panel.log ? 3 : 1, range: rangeOf(columns, panel.log) },
      },
      axes: [
        { ...axis, ...(logX ? logGrid : {}), label: xLabel(panel), size: 34, values: numbers },
        { ...axis, ...(panel.log ? logGrid : {}), label: panel.y, size: 58, values: numbers },
      ],
      series: [
        { label: xLabel(panel), value: (_, v) => Report.shown(v) },
        ...panel.series.map((series, k) => {
          const several = Number(places.length < 60 && !panel.stepped);
          return {
            label: labelOf(series, panel),
            stroke: () => colourOf(panel, series),
            width: series.style === "none" ? 0 : series.style === "solid" ? 1.8 : 1.4,
            dash: dashes[series.style],
            spanGaps: true,
            paths: panel.stepped ? uPlot.paths.stepped({ align: 1 }) : series.style === "none" ? () => null : undefined,
            points: { show: Boolean(several || series.points), size: 5, fill: () => colourOf(panel, series) },
            value: (_, v) => (v === null || v === undefined ? "-" : Report.shown(v)),
            columnIndex: k,
          };
        }),
      ],
      cursor: { drag: { x: true, y: false, setScale: true }, points: { size: 7 } },
      legend: { live: true },
      hooks: { drawAxes: [surround(columns)] },
    };
  };

  /** Keyboard: arrows move the pointer, + and - zoom, 0 shows all. */
  const steer = (plot, key) => {
    const width = plot.over.clientWidth;
    const at = plot.cursor.left >= 0 ? plot.cursor.left : width / 2;
    const { min, max } = plot.scales.x;
    const middle = plot.posToVal(at, "x");
    const zoom = (factor) => plot.setScale("x", { min: middle - (middle - min) * factor, max: middle + (max - middle) * factor });
    const moves = { ArrowLeft: -width / 60, ArrowRight: width / 60 };
    if (key in moves) {
      const left = Math.min(Math.max(at + moves[key], 0), width);
      plot.setCursor({ left, top: plot.over.clientHeight / 2 });
    } else if (key === "+" || key === "=") {
      zoom(0.5);
    } else if (key === "-") {
      zoom(2);
    } else if (key === "0") {
      showAll(plot);
    } else {
      return false;
    }
    return true;
  };
  const showAll = (plot) => {
    const xs = plot.data[0];
    plot.setScale("x", { min: xs[0], max: xs[xs.length - 1] });
  };

  const reachable = (box) => {
    box.querySelectorAll(".u-legend .u-series th").forEach((cell, k) => {
      if (k > 0) {
        cell.tabIndex = 0;
        cell.setAttribute("role", "button");
        cell.addEventListener("keydown", (event) => {
          if (event.key === "Enter" || event.key === " ") {
            event.preventDefault();
            event.stopPropagation();
            cell.click();
          }
        });
      }
    });
  };

  /** The numbers of a panel as rows of a CSV file: as the run's own tables have them. */
  const rowsOf = (panel) => {
    const lines = panel.series.map((series) => ({ label: labelOf(series, panel), ...valuesOf(panel, series) }));
    const rows = [["series", ...(isClock(panel) ? ["step"] : []), xLabel(panel), panel.y, "error", "deviation"]];
    for (const line of lines) {
      line.xs.forEach((x, k) => {
        if (x !== null && line.ys[k] !== null) {
          rows.push([line.label, ...(isClock(panel) ? [line.steps[k]] : []), x, line.ys[k], line.errors?.[k], line.deviation?.[k]]);
        }
      });
    }
    return rows;
  };
  Report.rowsOf = rowsOf;

  /** A picture of a panel: title, curves, legend. */
  const pictureOf = (panel, plot) => {
    const scale = devicePixelRatio;
    const source = plot.ctx.canvas;
    const shown = panel.series.map((series, k) => [series, k]).filter(([, k]) => plot.series[k + 1].show);
    const canvas = element("canvas", { width: source.width, height: source.height + (34 + 18 * shown.length) * scale });
    const ctx = canvas.getContext("2d");
    ctx.fillStyle = Report.style("--card");
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    ctx.drawImage(source, 0, 28 * scale);
    ctx.scale(scale, scale);
    ctx.fillStyle = Report.style("--text");
    ctx.font = "600 14px system-ui, sans-serif";
    ctx.fillText(panel.title, 10, 19);
    ctx.font = "12px system-ui, sans-serif";
    shown.forEach(([series], row) => {
      const y = 28 + source.height / scale + 18 * row + 9;
      ctx.strokeStyle = colourOf(panel, series);
      ctx.lineWidth = 2;
      ctx.setLineDash(dashes[series.style] ?? []);
      ctx.beginPath();
      ctx.moveTo(14, y);
      ctx.lineTo(44, y);
      ctx.stroke();
      ctx.fillText(labelOf(series, panel), 52, y + 4);
    });
    return canvas;
  };
  Report.pictureOf = pictureOf;

  /** Draws a panel into a box; gives what redraws it. */
  Report.drawPanel = (panel, box) => {
    const state = { panel, plot: null, box };
    state.data = () => joined(panel.series.map((series) => valuesOf(panel, series)));
    state.draw = () => {
      const kept = state.plot && state.zoomed && state.axis === clock() ? { ...state.plot.scales.x } : null;
      state.plot?.destroy();
      const data = state.data();
      state.axis = clock();
      state.columns = data.columns;
      const width = Math.max(box.clientWidth, 240);
      state.plot = new uPlot(optionsFor(panel, data, width), [data.places, ...data.columns.map((column) => column.ys)], box);
      reachable(box);
      if (kept) {
        state.plot.setScale("x", { min: kept.min, max: kept.max });
      }
    };
    state.draw();
    box.tabIndex = 0;
    box.setAttribute("role", "img");
    box.setAttribute("aria-label", `${panel.title}: ${panel.y} against ${xLabel(panel)}. Arrow keys move the pointer.`);
    box.addEventListener("keydown", (event) => {
      if (!event.ctrlKey && !event.metaKey && !event.altKey && steer(state.plot, event.key)) {
        event.preventDefault();
      }
    });
    return state;
  };

  const panelCard = (panel) => {
    const box = element("div", { class: "plot" });
    const name = Report.fileName(panel.title);
    const button = (text, title, act) => element("button", { type: "button", title, "aria-label": `${panel.title}: ${title}`, onclick: act }, text);
    const zoom = (key) => () => {
      const { plot } = drawn.get(panel.id);
      drawn.get(panel.id).zoomed = key !== "0";
      steer(plot, key);
    };
    const buttons = element(
      "span",
      { class: "buttons" },
      button("+", "zoom in", zoom("+")),
      button("−", "zoom out", zoom("-")),
      button("all", "show all", zoom("0")),
      button("PNG", "save as PNG", () => pictureOf(panel, drawn.get(panel.id).plot).toBlob((blob) => Report.download(`${name}.png`, blob))),
      button("CSV", "save as CSV", () => Report.download(`${name}.csv`, Report.csv(rowsOf(panel)), "text/csv")),
    );
    const note = notesOf(panel);
    const card = element("figure", { class: "card panel", id: `panel-${panel.id}`, style: "margin:0" },
      element("header", {}, element("h3", {}, panel.title), buttons), box, note ? element("p", { class: "quiet hint" }, note) : null);
    return { card, box };
  };

  const notesOf = (panel) => {
    const thin = panel.series.map((series) => Report.data.tables[series.table]).filter((table) => table && table.rows > table.step.length);
    const text = thin.length ? `${thin[0].step.length} of ${thin[0].rows} rows are drawn: of each interval the first, the smallest and the largest. ` : "";
    return text + (panel.note ?? "");
  };

  const hasStrain = () => Report.data.tables.some((table) => table.strain.some((value) => value !== null));

  Report.drawCurves = () => {
    const { panels } = Report.data;
    byId("curves").hidden = panels.length === 0;
    drawn.forEach((state) => state.plot?.destroy());
    drawn.clear();
    byId("panels").replaceChildren();
    byId("clock-choice").hidden = !panels.some(isClock) || !hasStrain();
    if (!hasStrain()) {
      byId("clock").value = "time";
    }
    for (const group of new Set(panels.map((panel) => panel.group))) {
      const grid = element("div", { class: "grid" });
      byId("panels").append(element("h3", { class: "group" }, group), grid);
      for (const panel of panels.filter((own) => own.group === group)) {
        const { card, box } = panelCard(panel);
        grid.append(card);
        drawn.set(panel.id, Report.drawPanel(panel, box));
      }
    }
  };
  /** New numbers in the same panels: what is enlarged stays so. */
  Report.updateCurves = () => {
    Report.data.panels.forEach((panel) => {
      const state = drawn.get(panel.id);
      Object.keys(state.panel).forEach((key) => delete state.panel[key]);
      Object.assign(state.panel, panel);
      state.draw();
    });
  };
  const redraw = () => drawn.forEach((state) => state.draw());
  byId("clock").addEventListener("change", redraw);
  Report.onTheme(() => drawn.forEach((state) => state.plot.redraw()));
  let width = window.innerWidth;
  window.addEventListener("resize", () => {
    if (window.innerWidth !== width) {
      width = window.innerWidth;
      redraw();
    }
  });
})();
