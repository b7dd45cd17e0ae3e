// SPDX-License-Identifier: GPL-3.0-or-later
// What was run and how it went, the sweep, the table of means, scenes and logs.
"use strict";
(() => {
  const { element, byId } = Report;
  const marks = { good: "held", warn: "warning", bad: "error", info: "note" };

  const runCard = (run, k) => {
    const several = Report.data.runs.length > 1;
    const facts = run.facts.filter(([, value]) => value !== "");
    const warnings = run.checks.filter((check) => check.level === "warn" || check.level === "bad").length;
    const card = element("article", { class: "card run" },
      element("header", {},
        several ? element("span", { class: "swatch", style: `background:${Report.runColour(k)}`, "data-run": k }) : null,
        element("h3", {}, run.name),
        element("span", { class: `chip ${run.status.state.split(" ")[0]}` }, run.status.state),
        element("span", { class: `chip ${warnings ? "warn" : "good"}` }, warnings ? `${warnings} warning${warnings > 1 ? "s" : ""}` : "no warnings")),
      run.title ? element("p", {}, run.title) : null,
      element("p", { class: "quiet" }, run.status.text),
      run.grains.length ? element("ul", { class: "steps" }, run.grains.map((text) => element("li", {}, text))) : null,
      run.stages.length ? element("ol", { class: "steps", start: 0 }, run.stages.map(stageLine)) : null,
      run.overrides.length ? element("p", {}, "Changed by --set: ", element("code", {}, run.overrides.join("; "))) : null,
      run.checks.length ? element("ul", { class: "checks" }, run.checks.map((check) =>
        element("li", { class: check.level }, element("b", {}, marks[check.level]), check.text))) : null,
      facts.length || run.folder ? element("dl", {}, [...facts, ["Folder", run.folder]].flatMap(([name, value]) =>
        [element("dt", {}, name), element("dd", {}, value)])) : null);
    return card;
  };
  const stageLine = (stage) =>
    element("li", {}, `${stage.label.replace(/^stage\.\d+ /, "")}: ${stage.what}`, stage.given ? element("code", {}, ` (${stage.given})`) : null);

  const tableOf = (headings, rows) =>
    element("table", {}, element("thead", {}, element("tr", {}, headings.map((text) => element("th", { scope: "col" }, text)))),
      element("tbody", {}, rows.map((cells) => element("tr", {}, cells.map((text, k) =>
        element(k === 0 ? "th" : "td", k === 0 ? { scope: "row" } : {}, text))))));

  const drawMeans = () => {
    const { means, runs } = Report.data;
    byId("means").hidden = means.rows.length === 0;
    const several = runs.length > 1;
    byId("means-note").textContent = means.rows.some((row) => row.run)
      ? "Means over the second half of each stage's time, with standard errors by blocking (Lee et al. 2011); without an error: one row."
      : "";
    const first = several ? ["run, stage"] : ["stage"];
    byId("means-table").replaceChildren(tableOf([...first, ...means.headings], means.rows.map((row) =>
      [several ? `${row.run}, ${row.stage}` : row.stage, ...row.cells.map(Report.withError)])));
  };
  Report.meansRows = () => {
    const { means } = Report.data;
    const headings = means.headings.flatMap((name) => [name, `${name}: error`, `${name}: rows`]);
    return [["run", "stage", ...headings], ...means.rows.map((row) =>
      [row.run, row.stage, ...row.cells.flatMap((cell) => (cell ? [cell.mean, cell.error, cell.rows] : ["", "", ""]))])];
  };
  byId("means-csv").addEventListener("click", () => Report.download("means.csv", Report.csv(Report.meansRows()), "text/csv"));

  const drawSweep = () => {
    const { sweep } = Report.data;
    byId("sweep").hidden = !sweep;
    if (!sweep) {
      return;
    }
    const words = (value) => (value === null ? "" : typeof value === "number" ? Report.shown(value) : String(value));
    byId("sweep-table").replaceChildren(tableOf(["run", ...sweep.settings, "stage", ...sweep.headings], sweep.rows.map((row) =>
      [row.run, ...row.settings.map(words), row.stage, ...row.cells.map(Report.withError)])));
    drawSweepPlot(sweep);
  };

  /** Numbers of the sweep by name: settings that are numbers, and means. */
  const sweepColumns = (sweep) => {
    const columns = new Map();
    sweep.settings.forEach((name, k) => {
      const values = sweep.rows.map((row) => row.settings[k]);
      if (values.filter((value) => typeof value === "number").length > 1) {
        columns.set(name, values.map((value) => (typeof value === "number" ? { mean: value, error: null } : null)));
      }
    });
    sweep.headings.forEach((name, k) => columns.set(name, sweep.rows.map((row) => row.cells[k])));
    return columns;
  };

  let sweepState = null;
  const drawSweepPlot = (sweep) => {
    const columns = sweepColumns(sweep);
    const names = [...columns.keys()].filter((name) => columns.get(name).some((cell) => cell));
    const box = byId("sweep-plot");
    sweepState?.plot?.destroy();
    sweepState = null;
    box.hidden = names.length < 2;
    if (box.hidden) {
      return;
    }
    const setting = sweep.settings.find((name) => columns.has(name));
    const chosen = { x: setting ?? (names.includes("I") ? "I" : names[0]) };
    chosen.y = names.includes("mu") && chosen.x !== "mu" ? "mu" : names.find((name) => name !== chosen.x && !sweep.settings.includes(name)) ?? names[1];
    const plot = element("div", { class: "plot" });
    const choice = (which, text) => element("label", {}, text, element("select", { onchange: (event) => {
      chosen[which] = event.target.value;
      draw();
    } }, names.map((name) => element("option", { selected: name === chosen[which] }, name))));
    const draw = () => {
      sweepState?.plot?.destroy();
      plot.replaceChildren();
      const points = columns.get(chosen.x).map((x, k) => ({ x, y: columns.get(chosen.y)[k] })).filter(({ x, y }) => x && y);
      points.sort((a, b) => a.x.mean - b.x.mean);
      const xs = points.map(({ x }) => x.mean);
      const log = xs.length > 1 && xs[0] > 0 && xs[xs.length - 1] / xs[0] > 8;
      const series = { run: 0, label: "last stage of each run", style: points.length > 1 ? "solid" : "none", points: true, xs,
        ys: points.map(({ y }) => y.mean), errors: points.map(({ y }) => y.error), plain: true };
      sweepState = Report.drawPanel({ id: "sweep", title: "Sweep", x: chosen.x, y: chosen.y, log: false, log_x: log, series: [series] }, plot);
    };
    box.replaceChildren(element("div", { class: "heading" }, choice("y", "Mean "), choice("x", "Against ")), plot);
    draw();
  };
  Report.onTheme(() => sweepState?.plot?.redraw());

  const drawTexts = () => {
    const part = (name, text) => (text ? element("details", {}, element("summary", {}, name), element("pre", { tabindex: 0 }, text)) : null);
    const texts = Report.data.runs.flatMap((run) => [part(`${run.name}: scene.toml`, run.scene), part(`${run.name}: run.log`, run.log)]);
    byId("sources").hidden = texts.every((text) => text === null);
    byId("texts").replaceChildren(...texts.filter(Boolean));
  };

  const drawNames = () => {
    const all = Report.data.runs;
    const title = all.length === 1 ? all[0].title || all[0].name : `${all.length} runs`;
    byId("title").textContent = title;
    document.title = `${title} - Boba`;
    byId("subtitle").textContent = all.length === 1 ? all[0].folder : all.map((run) => run.name).join(", ");
    byId("made").textContent = `Made by boba ${Report.data.version} at ${Report.data.made}. Lengths in d, times in tau, forces in k d, pressures in k/d. Curves: uPlot 1.6.32, 3-D: three.js 0.187.0, both under the MIT licence.`;
    const links = [...document.querySelectorAll("main > section")].filter((section) => !section.hidden).map((section) =>
      element("a", { href: `#${section.id}` }, section.querySelector("h2").textContent));
    byId("sections").replaceChildren(...links);
  };

  Report.drawOverview = () => {
    byId("runs").replaceChildren(...Report.data.runs.map(runCard));
    drawSweep();
    drawMeans();
    drawTexts();
  };
  Report.drawNames = drawNames;
  Report.onTheme(() => document.querySelectorAll("[data-run]").forEach((mark) => {
    mark.style.background = Report.runColour(Number(mark.dataset.run));
  }));
})();
