// SPDX-License-Identifier: GPL-3.0-or-later
// What every part of the page uses. Text goes into the page as text alone: nothing of a scene becomes markup.
"use strict";
const Report = {};
(() => {
  Report.data = JSON.parse(document.getElementById("data").textContent);

  /** An element with attributes, properties that begin with "on", and children (texts or elements). */
  Report.element = (tag, attributes = {}, ...children) => {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
      if (name.startsWith("on")) {
        made.addEventListener(name.slice(2), value);
      } else if (value === true) {
        made.setAttribute(name, "");
      } else if (value !== false && value !== null && value !== undefined) {
        made.setAttribute(name, value);
      }
    }
    for (const child of children.flat()) {
      if (child !== null && child !== undefined) {
        made.append(child);
      }
    }
    return made;
  };

  Report.byId = (id) => document.getElementById(id);

  /** A number for reading: six digits, without zeros at their end. */
  Report.shown = (value, digits = 6) => {
    if (value === null || value === undefined || !Number.isFinite(value)) {
      return "-";
    }
    const size = Math.abs(value);
    if (size !== 0 && (size < 1e-4 || size >= 1e7)) {
      return value.toExponential(Math.max(digits - 3, 1)).replace(/\.?0+e/, "e");
    }
    return String(Number(value.toPrecision(digits)));
  };

  /** A mean with its error, both to the error's second digit. */
  Report.withError = (cell) => {
    if (!cell) {
      return "";
    }
    if (cell.error === null || !(cell.error > 0)) {
      return Report.shown(cell.mean, 5);
    }
    const place = Math.floor(Math.log10(cell.error)) - 1;
    if (place < -9 || place > 5) {
      return `${cell.mean.toExponential(3)} ± ${cell.error.toExponential(1)}`;
    }
    const digits = Math.max(-place, 0);
    return `${cell.mean.toFixed(digits)} ± ${cell.error.toFixed(digits)}`;
  };

  /** Hands a file to the reader. */
  Report.download = (name, content, type) => {
    const blob = content instanceof Blob ? content : new Blob([content], { type });
    const link = Report.element("a", { href: URL.createObjectURL(blob), download: name });
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  };

  /** A field of a CSV file. */
  Report.field = (value) => {
    const text = value === null || value === undefined ? "" : String(value);
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  Report.csv = (rows) => rows.map((row) => row.map(Report.field).join(",")).join("\n") + "\n";

  Report.fileName = (text) => text.replace(/[^A-Za-z0-9._-]+/g, "_").slice(0, 80) || "boba";

  /** A colour of the style, such as "--text". */
  Report.style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  const system = window.matchMedia("(prefers-color-scheme: dark)");
  const listeners = [];
  let chosen = "auto";
  Report.onTheme = (listener) => listeners.push(listener);
  Report.applyTheme = (theme) => {
    const dark = theme === "dark" || (theme === "auto" && system.matches);
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    listeners.forEach((listener) => listener());
  };
  system.addEventListener("change", () => Report.applyTheme(chosen));
  Report.byId("theme").addEventListener("change", (event) => {
    chosen = event.target.value;
    Report.applyTheme(chosen);
  });
  Report.byId("print").addEventListener("click", () => window.print());
  window.addEventListener("beforeprint", () => Report.applyTheme("light"));
  window.addEventListener("afterprint", () => Report.applyTheme(chosen));
  Report.applyTheme(chosen);
})();
