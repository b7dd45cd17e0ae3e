// SPDX-License-Identifier: GPL-3.0-or-later
// Draws the equations of a page with KaTeX.
document.addEventListener("DOMContentLoaded", () => {
  for (const place of document.querySelectorAll(".equation")) {
    katex.render(place.textContent, place, { displayMode: place.classList.contains("displayed"), throwOnError: false });
  }
});
