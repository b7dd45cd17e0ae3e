// SPDX-License-Identifier: GPL-3.0-or-later
// Draws the page, and under `boba watch` draws it again as the run goes on.
"use strict";
(() => {
  const drawAll = () => {
    Report.drawOverview();
    Report.drawCurves();
    Report.drawPacking();
    Report.drawNames();
    document.body.dataset.drawn = "yes";
  };
  drawAll();

  // --- boba watch ----------------------------------------------------------------------------------------------------

  const marks = new Map();
  /** The answer at an address, or null where it is what it was. */
  const changed = async (address) => {
    const headers = marks.has(address) ? { "If-None-Match": marks.get(address) } : {};
    const answer = await fetch(address, { headers, cache: "no-store" });
    if (answer.status === 304) {
      return null;
    }
    if (!answer.ok) {
      throw new Error(await answer.text());
    }
    marks.set(address, answer.headers.get("ETag"));
    return answer.json();
  };

  const say = (text) => {
    const line = Report.byId("live");
    line.hidden = false;
    if (line.textContent !== text) {
      line.textContent = text;
    }
  };

  const refresh = async () => {
    const rest = await changed("/rest");
    const packings = await changed("/packings");
    if (rest) {
      const ids = (data) => data.panels.map((panel) => panel.id).join();
      const same = ids(rest) === ids(Report.data);
      Report.data = { ...rest, packings: Report.data.packings };
      Report.drawOverview();
      if (same) {
        Report.updateCurves();
      } else {
        Report.drawCurves();
      }
    }
    if (packings) {
      Report.data.packings = packings;
      Report.updatePacking();
    }
    if (rest || packings) {
      Report.drawNames();
    }
    const running = Report.data.runs.some((run) => run.status.state === "running");
    say(`${running ? "In progress" : "No process writes here now"}; last change seen at ${Report.data.made}.`);
    document.body.dataset.refreshed = String(Number(document.body.dataset.refreshed ?? 0) + 1);
  };

  const goOn = async () => {
    try {
      await refresh();
    } catch (error) {
      say(error instanceof TypeError ? "boba watch has stopped; this is what it showed last." : String(error.message));
    }
    setTimeout(goOn, 2000);
  };
  if (document.body.dataset.live) {
    goOn();
  }
})();
