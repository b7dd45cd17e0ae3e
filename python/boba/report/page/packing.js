// SPDX-License-Identifier: GPL-3.0-or-later
// The packing in 3-D (three.js): colours, cross-section, time, one grain followed.
"use strict";
(() => {
  const { element, byId } = Report;
  const state = { packing: 0, frame: 0, colour: "grain", cut: "off", place: 0.5, followed: null, others: "shown", triangles: null };
  Report.viewer = state;
  let view = null; // what three.js draws with; null where there is no WebGL
  let parts = null; // elements of the page

  const packing = () => Report.data.packings[state.packing];
  const frame = () => packing().frames[state.frame];
  const quantity = () => packing().quantities.find((own) => own.key === state.colour) ?? packing().quantities[0];
  const axes = { x: 0, y: 1, z: 2 };

  /** Components of colours, from 0 to 255, as three.js adds them up. */
  const linear = new Float32Array(256).map((_, v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4));

  // --- three.js ------------------------------------------------------------------------------------------------------

  const makeView = (canvas) => {
    let renderer;
    try {
      renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    } catch {
      return null;
    }
    renderer.localClippingEnabled = true;
    const scene = new THREE.Scene();
    const camera = new THREE.PerspectiveCamera(32, 1, 0.1, 1e5);
    const light = new THREE.DirectionalLight(0xffffff, 1.9);
    light.position.set(-0.4, 0.8, 1);
    camera.add(light);
    scene.add(camera, new THREE.HemisphereLight(0xffffff, 0x8890a0, 1.5));
    const geometry = new THREE.BufferGeometry();
    const plane = new THREE.Plane();
    const outside = new THREE.MeshLambertMaterial({ vertexColors: true, flatShading: true });
    const flat = new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.DoubleSide });
    const section = new THREE.Mesh(new THREE.BufferGeometry(), flat);
    const rims = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0x202630 }));
    const meshes = [new THREE.Mesh(geometry, outside), section, rims];
    meshes.forEach((mesh) => (mesh.frustumCulled = false));
    const cell = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0x808a96 }));
    cell.frustumCulled = false;
    scene.add(...meshes, cell);
    const controls = new THREE.OrbitControls(camera, canvas);
    controls.enableDamping = false;
    controls.addEventListener("change", () => render());
    return { renderer, scene, camera, geometry, plane, outside, section, rims, meshes, cell, controls, ratio: Math.min(devicePixelRatio, 2), times: [] };
  };

  let pending = false;
  /** Draws once before the next picture of the browser. */
  const render = () => {
    if (!pending && view) {
      pending = true;
      requestAnimationFrame(() => {
        pending = false;
        renderNow();
      });
    }
  };

  const renderNow = () => {
    const begin = performance.now();
    const { renderer, scene, camera } = view;
    const { clientWidth: width, clientHeight: height } = renderer.domElement;
    if (width === 0 || height === 0) {
      return;
    }
    const wanted = [Math.round(width * view.ratio), Math.round(height * view.ratio)];
    if (renderer.domElement.width !== wanted[0] || renderer.domElement.height !== wanted[1]) {
      renderer.setPixelRatio(view.ratio);
      renderer.setSize(width, height, false);
      camera.aspect = width / height;
      camera.updateProjectionMatrix();
    }
    scene.background = new THREE.Color(Report.style("--back"));
    renderer.render(scene, camera);
    drawShape();
    paceAfter(performance.now() - begin);
  };
  Report.renderPacking = () => renderNow();

  /** Slow machines (software rendering) get fewer pixels. */
  const paceAfter = (milliseconds) => {
    view.times.push(milliseconds);
    if (view.times.length === 8) {
      const middle = [...view.times].sort((a, b) => a - b)[4];
      view.times.length = 0;
      if (middle > 45 && view.ratio > 0.6) {
        view.ratio = Math.max(view.ratio * 0.7, 0.6);
        render();
      }
    }
  };

  const resetCamera = () => {
    if (!view) {
      return;
    }
    const reach = packing().quantum * 32767;
    const upright = view.renderer.domElement.clientWidth < view.renderer.domElement.clientHeight;
    view.camera.position.set(0.5, 0.35, 1).setLength(reach * (upright ? 4.2 : 3.1));
    view.camera.near = reach / 100;
    view.camera.far = reach * 40;
    view.camera.updateProjectionMatrix();
    view.controls.target.set(0, 0, 0);
    view.controls.update();
    render();
  };

  /** Triangles and colours of the state's frame go to the graphics card. */
  const fill = async () => {
    const [asked, k] = [packing(), state.frame];
    const triangles = await Report.triangles(asked, k);
    if (asked !== packing() || k !== state.frame || !view) {
      return;
    }
    state.triangles = triangles;
    const { geometry } = view;
    if ((geometry.getAttribute("position")?.count ?? 0) < 3 * triangles.n) {
      for (const name of ["position", "color"]) {
        geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(9 * Math.ceil(1.1 * triangles.n)), 3));
      }
    }
    colour();
    view.cell.geometry.setAttribute("position", new THREE.BufferAttribute(Report.cellEdges(asked, asked.frames[k]), 3));
    cut();
    render();
  };

  /** Colours, and which triangles are drawn: hidden grains are left out. */
  const colour = () => {
    const { triangles } = state;
    if (!view || !triangles) {
      return;
    }
    const own = quantity();
    const ofGrain = own.kind === "triangle" ? null : Report.grainColours(packing(), state.frame, own);
    const [places, colours] = ["position", "color"].map((name) => view.geometry.getAttribute(name));
    const target = places.array;
    let n = 0;
    state.shownGrain = new Uint32Array(triangles.n);
    for (let t = 0; t < triangles.n; t += 1) {
      const grain = triangles.grain[t];
      const base = colourOfGrain(grain, ofGrain);
      if (!base) {
        continue;
      }
      const aside = state.followed !== null && grain !== state.followed && state.others !== "shown";
      const rgb = aside || ofGrain || !triangles.facet ? base : Report.classColour(own.classes, triangles.facet[t]);
      target.set(triangles.places.subarray(9 * t, 9 * t + 9), 9 * n);
      for (let corner = 0; corner < 3; corner += 1) {
        for (let c = 0; c < 3; c += 1) {
          colours.array[9 * n + 3 * corner + c] = linear[Math.round(rgb[c])];
        }
      }
      state.shownGrain[n] = grain;
      n += 1;
    }
    view.geometry.setDrawRange(0, 3 * n);
    places.needsUpdate = true;
    colours.needsUpdate = true;
    view.geometry.computeBoundingSphere();
    if (state.cut !== "off") {
      cut();
    }
  };

  /** Colour of a grain, [r, g, b] from 0 to 255, or null for one that is hidden. */
  const colourOfGrain = (grain, ofGrain) => {
    const aside = state.followed !== null && grain !== state.followed;
    if (aside && state.others !== "shown") {
      return state.others === "hidden" ? null : [170, 176, 184];
    }
    return ofGrain ? ofGrain[grain] : [150, 156, 164];
  };

  const fillSection = (axis, place, reach) => {
    if (!state.triangles) {
      return;
    }
    const own = quantity();
    const ofGrain = own.kind === "triangle" ? null : Report.grainColours(packing(), state.frame, own);
    const { faces, edges, grains } = Report.section(state.triangles, axis, place, reach * 2e-5);
    const seen = grains.map((grain) => colourOfGrain(grain, ofGrain));
    const places = [];
    const colours = [];
    state.sectionGrain = [];
    seen.forEach((rgb, t) => {
      if (rgb) {
        places.push(...faces.subarray(9 * t, 9 * t + 9));
        for (let corner = 0; corner < 3; corner += 1) {
          colours.push(...rgb.map((value) => linear[Math.round(value)]));
        }
        state.sectionGrain.push(grains[t]);
      }
    });
    view.section.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(places), 3));
    view.section.geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(colours), 3));
    view.section.geometry.computeBoundingSphere();
    view.rims.geometry.setAttribute("position", new THREE.BufferAttribute(state.others === "hidden" && state.followed !== null ? new Float32Array() : edges, 3));
  };

  const cut = () => {
    if (!view) {
      return;
    }
    const on = state.cut !== "off";
    const planes = on ? [view.plane] : [];
    view.section.visible = view.rims.visible = on;
    if (on) {
      const normal = [0, 0, 0];
      normal[axes[state.cut]] = -1;
      const reach = packing().quantum * 32767;
      view.plane.normal.set(...normal);
      view.plane.constant = (2 * state.place - 1) * reach;
      fillSection(axes[state.cut], view.plane.constant, reach);
    }
    if (view.outside.clippingPlanes?.length !== planes.length) {
      view.outside.needsUpdate = true;
    }
    view.outside.clippingPlanes = planes;
    render();
  };

  /** Grain under a place of the canvas, or null. */
  const grainAt = (event) => {
    const box = view.renderer.domElement.getBoundingClientRect();
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2), view.camera);
    const on = state.cut !== "off";
    const hits = ray.intersectObjects(on ? view.meshes.slice(0, 2) : [view.meshes[0]]);
    const nearest = hits.find((hit) => hit.object === view.section
      || (3 * hit.faceIndex < view.geometry.drawRange.count && (!on || view.plane.distanceToPoint(hit.point) >= 0)));
    return nearest ? (nearest.object === view.section ? state.sectionGrain : state.shownGrain)[nearest.faceIndex] : null;
  };

  // --- the grain that is followed ------------------------------------------------------------------------------------

  /** Outline of the followed grain in the direction of the main view: the faces of a convex body that look this way. */
  const drawShape = () => {
    const canvas = parts.shape;
    const { clientWidth: width, clientHeight: height } = canvas;
    const { triangles, followed } = state;
    if (followed === null || !triangles || width === 0) {
      return;
    }
    const scale = Math.min(devicePixelRatio, 2);
    canvas.width = width * scale;
    canvas.height = height * scale;
    const ctx = canvas.getContext("2d");
    const rows = view.camera.matrixWorldInverse.elements;
    const turned = (p) => [0, 1, 2].map((r) => rows[r] * p[0] + rows[r + 4] * p[1] + rows[r + 8] * p[2]);
    const corners = [];
    for (let t = triangles.first[followed]; t < triangles.first[followed + 1]; t += 1) {
      const p = triangles.places.subarray(9 * t, 9 * t + 9);
      corners.push({ facet: triangles.facet?.[t], points: [0, 3, 6].map((at) => turned(p.subarray(at, at + 3))) });
    }
    const all = corners.flatMap(({ points }) => points);
    const middle = [0, 1].map((c) => all.reduce((sum, p) => sum + p[c], 0) / all.length);
    const reach = Math.max(...all.map((p) => Math.hypot(p[0] - middle[0], p[1] - middle[1])));
    const size = (0.46 * Math.min(canvas.width, canvas.height)) / reach;
    const base = quantity().kind === "triangle" ? null : Report.grainColours(packing(), state.frame, quantity())[followed];
    for (const { facet, points } of corners) {
      const [a, b, c] = points;
      const u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
      const v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
      const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      const length = Math.hypot(...n);
      if (n[2] <= 0 || length === 0) {
        continue;
      }
      const shade = 0.45 + 0.55 * Math.max(0, (-0.35 * n[0] + 0.55 * n[1] + 0.76 * n[2]) / length);
      const rgb = (base ?? Report.classColour(quantity().classes, facet ?? 0)).map((value) => value * shade);
      ctx.fillStyle = ctx.strokeStyle = Report.css(rgb);
      ctx.beginPath();
      points.forEach((p) => ctx.lineTo(canvas.width / 2 + (p[0] - middle[0]) * size, canvas.height / 2 - (p[1] - middle[1]) * size));
      ctx.closePath();
      ctx.fill();
      ctx.stroke();
    }
  };

  const valueOf = (own, k, grain) => {
    if (own.key === "species") {
      return own.classes[packing().species[grain]];
    }
    const value = packing().frames[k].values[own.key]?.[grain];
    return own.kind === "class" ? own.classes[value] ?? "-" : Report.shown(value, 5);
  };

  const tellGrain = () => {
    const { followed } = state;
    parts.follow.hidden = followed === null;
    parts.number.value = followed === null ? "" : packing().grains[followed];
    if (followed === null) {
      return;
    }
    const told = packing().quantities.filter((own) => own.kind === "number" || own.kind === "class");
    parts.values.replaceChildren(...told.flatMap((own) => [element("dt", {}, own.label), element("dd", {}, valueOf(own, state.frame, followed))]));
  };

  let traces = [];
  const drawTraces = () => {
    traces.forEach((trace) => trace.destroy());
    traces = [];
    parts.traces.replaceChildren();
    if (state.followed === null) {
      return;
    }
    const xs = packing().frames.map((own) => own.time);
    for (const [key, label] of [["volume", "volume (d^3)"], ["asphericity", "asphericity"]]) {
      const ys = packing().frames.map((own) => own.values[key]?.[state.followed] ?? null);
      const ink = () => Report.style("--quiet");
      const grid = { stroke: () => Report.style("--grid"), width: 1 };
      const axis = { stroke: ink, grid, ticks: grid, font: "11px system-ui, sans-serif", labelFont: "11px system-ui, sans-serif", labelSize: 16 };
      traces.push(new uPlot({
        width: Math.max(parts.traces.clientWidth, 200), height: 120, legend: { show: false }, cursor: { show: false },
        scales: { x: { time: false } },
        axes: [{ ...axis, size: 24, label: "time (tau)" }, { ...axis, size: 48, label, values: (_, all) => all.map((v) => Report.shown(v, 4)) }],
        series: [{}, { stroke: () => Report.runColour(packing().run), width: 1.5, points: { show: xs.length < 40, size: 4 } }],
        hooks: { draw: [(plot) => {
          const at = plot.valToPos(frame().time, "x", true);
          plot.ctx.fillStyle = Report.style("--accent");
          plot.ctx.fillRect(at - 1, plot.bbox.top, 2, plot.bbox.height);
        }] },
      }, [xs, ys], parts.traces));
    }
  };

  const follow = (grain) => {
    state.followed = grain;
    if (grain !== null && state.others === "shown") {
      state.others = parts.others.value = "grey";
    }
    tellGrain();
    drawTraces();
    colour();
    render();
  };
  Report.follow = follow;

  // --- elements of the page ------------------------------------------------------------------------------------------

  const drawScale = () => {
    const own = quantity();
    const { scale } = parts;
    scale.replaceChildren(element("div", {}, own.label));
    if (own.kind === "number") {
      const range = Report.rangeOf(packing(), own.key);
      const stops = Array.from({ length: 11 }, (_, k) => Report.css(Report.viridis(k / 10)));
      scale.append(element("div", { class: "bar", style: `background:linear-gradient(to right,${stops.join(",")})` }),
        element("div", { class: "ends" }, ...range.map((value) => element("span", {}, Report.shown(value, 3)))));
    } else if (own.kind !== "index") {
      scale.append(element("ul", {}, own.classes.map((name, k) => element("li", {},
        element("span", { class: "swatch", style: `background:${Report.css(Report.classColour(own.classes, k))}` }), name))));
    }
  };

  const tellFrame = () => {
    const own = frame();
    parts.time.value = state.frame;
    const text = `step ${own.step}, time ${Report.shown(own.time, 5)} tau, strain ${Report.shown(own.strain, 4)}`;
    parts.when.textContent = text;
    parts.time.setAttribute("aria-valuetext", text);
    tellGrain();
    traces.forEach((trace) => trace.redraw(false));
  };

  const showFrame = (k) => {
    state.frame = Math.min(Math.max(k, 0), packing().frames.length - 1);
    tellFrame();
    return fill();
  };
  Report.showFrame = showFrame;

  let playing = null;
  const play = () => {
    if (playing) {
      clearInterval(playing);
      playing = null;
    } else {
      playing = setInterval(() => showFrame((state.frame + 1) % packing().frames.length), 350);
    }
    parts.play.textContent = playing ? "Pause" : "Play";
    parts.play.setAttribute("aria-pressed", String(Boolean(playing)));
  };

  const turn = (key) => {
    const offset = view.camera.position.clone().sub(view.controls.target);
    const ball = new THREE.Spherical().setFromVector3(offset);
    const turns = { ArrowLeft: [-0.12, 0], ArrowRight: [0.12, 0], ArrowUp: [0, -0.12], ArrowDown: [0, 0.12] };
    if (key in turns) {
      ball.theta += turns[key][0];
      ball.phi = Math.min(Math.max(ball.phi + turns[key][1], 0.05), Math.PI - 0.05);
    } else if (key === "+" || key === "=") {
      ball.radius *= 0.87;
    } else if (key === "-") {
      ball.radius *= 1.15;
    } else if (key === "0") {
      resetCamera();
      return true;
    } else if (key === "PageUp" || key === "PageDown") {
      showFrame(state.frame + (key === "PageUp" ? 1 : -1));
      return true;
    } else {
      return false;
    }
    view.camera.position.copy(view.controls.target).add(new THREE.Vector3().setFromSpherical(ball));
    view.controls.update();
    render();
    return true;
  };

  const select = (label, options, value, onchange) =>
    element("label", {}, label, element("select", { onchange: (event) => onchange(event.target.value) },
      options.map(([key, text]) => element("option", { value: key, selected: key === value }, text))));

  const listen = (canvas) => {
    let down = null;
    canvas.addEventListener("pointerdown", (event) => (down = [event.clientX, event.clientY]));
    canvas.addEventListener("pointerup", (event) => {
      if (down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4) {
        follow(grainAt(event));
      }
    });
    canvas.addEventListener("keydown", (event) => {
      if (!event.ctrlKey && !event.metaKey && !event.altKey && turn(event.key)) {
        event.preventDefault();
      }
    });
    new ResizeObserver(() => render()).observe(canvas);
  };

  const savePicture = () => {
    renderNow();
    view.renderer.domElement.toBlob((blob) => Report.download("packing.png", blob));
  };

  const build = () => {
    const own = packing();
    const canvas = element("canvas", { tabindex: 0, role: "img", id: "packing-canvas",
      "aria-label": "The packing in three dimensions. Arrow keys turn it, + and - zoom, Page Up and Page Down go through time, 0 resets the view." });
    parts = {
      canvas,
      quantities: own.quantities.length,
      scale: element("div", { class: "scale" }),
      time: element("input", { type: "range", id: "packing-time", min: 0, max: own.frames.length - 1, step: 1, "aria-label": "Frame",
        oninput: (event) => showFrame(Number(event.target.value)) }),
      when: element("output", { for: "packing-time" }),
      play: element("button", { type: "button", "aria-pressed": "false", onclick: play, disabled: own.frames.length < 2 }, "Play"),
      place: element("input", { type: "range", id: "packing-cut", min: 0, max: 1000, value: 1000 * state.place, "aria-label": "Place of the cross-section",
        oninput: (event) => {
          state.place = Number(event.target.value) / 1000;
          cut();
        } }),
      number: element("input", { type: "number", id: "packing-grain", min: Math.min(...own.grains), placeholder: "click on one",
        onchange: (event) => {
          const at = own.grains.indexOf(Number(event.target.value));
          follow(event.target.value === "" || at < 0 ? null : at);
        } }),
      shape: element("canvas", { class: "shape", role: "img", "aria-label": "Shape of the followed grain" }),
      values: element("dl"),
      traces: element("div", { class: "plot" }),
    };
    const others = select("Other grains", [["shown", "shown"], ["grey", "grey"], ["hidden", "hidden"]], state.others, (value) => {
      state.others = value;
      colour();
      render();
    });
    parts.others = others.querySelector("select");
    parts.follow = element("div", { class: "follow", hidden: true }, parts.shape, parts.values, parts.traces,
      element("button", { type: "button", onclick: () => follow(null) }, "Follow none"));
    const runs = Report.data.packings.length > 1
      ? select("Run", Report.data.packings.map((each, k) => [String(k), Report.data.runs[each.run].name]), String(state.packing), (value) => {
        state.packing = Number(value);
        state.frame = 0;
        state.followed = null;
        Report.drawPacking(packing().frames.length - 1);
      }) : null;
    const colours = select("Colour", own.quantities.map((each) => [each.key, each.label]), state.colour, (value) => {
      state.colour = value;
      drawScale();
      colour();
      render();
    });
    colours.querySelector("select").id = "packing-colour";
    const cuts = select("Cross-section", [["off", "none"], ["x", "across x"], ["y", "across y"], ["z", "across z"]], state.cut, (value) => {
      state.cut = value;
      parts.place.disabled = value === "off";
      cut();
    });
    cuts.querySelector("select").id = "packing-axis";
    parts.place.disabled = state.cut === "off";
    byId("viewer").replaceChildren(
      element("div", { class: "stage" }, canvas, parts.scale, element("div", { class: "timeline" }, parts.play, parts.time, parts.when)),
      element("div", { class: "controls" }, runs, colours,
        element("div", { class: "row" }, cuts, element("label", {}, "Place", parts.place)),
        element("div", { class: "row" }, element("label", {}, "Follow grain", parts.number), others),
        element("div", { class: "row" }, element("button", { type: "button", onclick: resetCamera }, "Reset view"),
          element("button", { type: "button", onclick: savePicture }, "PNG")),
        element("p", { class: "quiet hint" }, `${own.grains.length} grains, ${own.nodes} nodes; ${own.frames.length} frames. Outlines are convex hulls of the nodes, grown to the nodes' surface`
          + `${own.simplified ? ", simplified to be drawn quickly" : ""}; volume and asphericity are those of the whole hulls.`),
        parts.follow));
    return canvas;
  };

  /** Draws the viewer; starts at a frame (the last one without). */
  Report.drawPacking = (first) => {
    byId("packing").hidden = Report.data.packings.length === 0;
    if (Report.data.packings.length === 0) {
      return;
    }
    if (view) {
      view.controls.dispose();
      view.renderer.dispose();
      view.renderer.forceContextLoss();
    }
    state.triangles = null;
    state.packing = Math.min(state.packing, Report.data.packings.length - 1);
    if (!packing().quantities.some((own) => own.key === state.colour)) {
      state.colour = "grain";
    }
    const canvas = build();
    view = makeView(canvas);
    if (!view) {
      canvas.replaceWith(element("p", {}, "This browser shows no WebGL: the packing cannot be drawn."));
    } else {
      listen(canvas);
      resetCamera();
    }
    drawScale();
    showFrame(first ?? packing().frames.length - 1);
    follow(state.followed);
  };
  /** New frames: who looked at the last one goes on doing so, the view stays. */
  Report.updatePacking = () => {
    const has = Report.data.packings.length > 0;
    if (!parts || !has || packing().quantities.length !== parts.quantities) {
      Report.drawPacking();
      return;
    }
    const last = Number(parts.time.max);
    parts.time.max = packing().frames.length - 1;
    parts.play.disabled = packing().frames.length < 2;
    drawScale();
    drawTraces();
    showFrame(state.frame >= last ? packing().frames.length - 1 : state.frame);
  };
  Report.onTheme(() => {
    if (view && parts) {
      render();
      traces.forEach((trace) => trace.redraw());
    }
  });
})();
