"use strict";
// Charts to zoom and read off, and modes in motion. No library, nothing loaded.
(() => {
  const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer;
  const floats = text => new Float32Array(bytes(text));
  const NS = "http://www.w3.org/2000/svg";
  const make = (name, attributes, parent) => {
    const made = document.createElementNS(NS, name);
    for (const key in attributes) made.setAttribute(key, attributes[key]);
    if (parent) parent.append(made);
    return made;
  };
  const shown = x => {
    if (x === 0) return "0";
    const size = Math.abs(x);
    return size >= 1e6 || size < 1e-3 ? x.toExponential(4).replace(/\.?0+e/, "e") : String(+x.toPrecision(5));
  };

  // ticks: as many digits as tell neighbours apart
  const told = values => {
    const step = Math.min(...values.slice(1).map((v, k) => Math.abs(v - values[k])));
    const largest = Math.max(...values.map(Math.abs));
    const digits = step > 0 && largest > 0 ? Math.min(12, Math.ceil(Math.log10(largest / step)) + 1) : 5;
    return values.map(v => digits > 5 && largest < 1e6 && largest >= 1e-3 ? String(+v.toPrecision(digits)) : shown(v));
  };

  // ---- axes: from values to [0, 1] and back, and ticks
  const forward = (axis, x) => axis.log ? Math.log10(x) : x;
  const back = (axis, u) => axis.log ? 10 ** u : u;
  const linear = (low, high, count) => {
    const raw = (high - low) / Math.max(count, 1), power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map(k => k * power).find(s => s >= raw) || raw;
    const found = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step && found.length < 50; k++) found.push(k * step);
    return found;
  };
  const ticks = (axis, low, high, count) => {
    if (!axis.log) return linear(low, high, count);
    if (high - low < 1) return linear(10 ** low, 10 ** high, count).filter(v => v > 0).map(Math.log10);
    const found = [], every = Math.max(1, Math.ceil((high - low) / count));
    for (let k = Math.ceil(low - 1e-9); k <= high + 1e-9; k++) if (k % every === 0) found.push(k);
    return found;
  };

  const chart = figure => {
    const given = JSON.parse(figure.querySelector("script").textContent);
    const box = figure.querySelector(".plot");
    const read_curves = (held, grids = held.grids.map(floats)) =>
      held.curves.map((c, k) => ({name: c.name, x: grids[c.x], on: true,
        y: c.base ? Float64Array.from(floats(c.y), v => v + c.base) : floats(c.y),
        beside: c.beside !== undefined, colour: `var(--c${(c.beside ?? k) % 7})`}));
    const curves = read_curves(given);
    const usable = (axis, v) => Number.isFinite(v) && (!axis.log || v > 0);
    const whole = () => {
      let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
      for (const c of curves) if (c.on) for (let i = 0; i < c.x.length; i++) {
        if (!usable(given.x, c.x[i]) || !usable(given.y, c.y[i])) continue;
        const u = forward(given.x, c.x[i]), v = forward(given.y, c.y[i]);
        x0 = Math.min(x0, u); x1 = Math.max(x1, u); y0 = Math.min(y0, v); y1 = Math.max(y1, v);
      }
      if (!(x1 >= x0)) [x0, x1, y0, y1] = [0, 1, 0, 1];
      if (x1 === x0) { x0 -= 0.5; x1 += 0.5; }
      if (y1 === y0) { const d = Math.abs(y0) * 0.1 || 0.5; y0 -= d; y1 += d; }
      const d = 0.04 * (y1 - y0);
      return [x0, x1, y0 - d, y1 + d];
    };
    let view = whole(), start = null, here = null;
    const legend = document.createElement("div");
    legend.className = "legend";
    box.before(legend);
    const readout = document.createElement("p");
    readout.className = "readout";
    readout.setAttribute("aria-live", "polite");
    box.after(readout);
    curves.forEach(c => {
      const button = document.createElement("button");
      button.type = "button";
      button.setAttribute("aria-pressed", "true");
      const mark = document.createElement("i");
      mark.style.background = c.colour;
      button.append(mark, c.name);
      button.addEventListener("click", () => { c.on = !c.on; button.setAttribute("aria-pressed", c.on); draw(); });
      if (curves.length > 1) legend.append(button);
    });
    const reset = document.createElement("button");
    reset.type = "button"; reset.textContent = "whole"; reset.className = "reset"; reset.hidden = true;
    reset.addEventListener("click", () => { view = whole(); draw(); });
    legend.append(reset);

    let area = null, overlay = null;
    // where the pointer is, or what it drags over: drawn without the curves anew
    const mark = () => {
      overlay.replaceChildren();
      const {top, h} = area;
      if (start !== null && here !== null) make("rect", {x: Math.min(start, here), y: top, width: Math.abs(here - start), height: h, class: "zoom"}, overlay);
      else if (here !== null) make("line", {x1: here, x2: here, y1: top, y2: top + h, class: "cursor"}, overlay);
    };
    const draw = () => {
      const width = Math.max(box.clientWidth, 200), height = Math.round(Math.min(360, Math.max(220, width * 0.45)));
      const [x0, x1, y0, y1] = view, left = 52, right = 10, top = 22, bottom = 40;
      const w = width - left - right, h = height - top - bottom;
      area = {left, top, w, h};
      const X = u => left + (u - x0) / (x1 - x0) * w, Y = v => top + (y1 - v) / (y1 - y0) * h;
      const svg = make("svg", {width, height, viewBox: `0 0 ${width} ${height}`, "aria-hidden": "true"});
      const across = ticks(given.x, x0, x1, w / 80), names = told(across.map(u => back(given.x, u)));
      for (const [k, u] of across.entries()) {
        make("line", {x1: X(u), x2: X(u), y1: top, y2: top + h, class: "grid"}, svg);
        make("text", {x: X(u), y: top + h + 15, "text-anchor": X(u) > left + w - 20 ? "end" : "middle"}, svg).textContent = names[k];
      }
      const up = ticks(given.y, y0, y1, h / 40), heights = told(up.map(v => back(given.y, v)));
      for (const [k, v] of up.entries()) {
        make("line", {x1: left, x2: left + w, y1: Y(v), y2: Y(v), class: "grid"}, svg);
        make("text", {x: left - 5, y: Y(v) + 4, "text-anchor": "end"}, svg).textContent = heights[k];
      }
      make("rect", {x: left, y: top, width: w, height: h, class: "frame"}, svg);
      const clip = make("svg", {x: left, y: top, width: w, height: h, viewBox: `${left} ${top} ${w} ${h}`}, svg);
      for (const c of curves) if (c.on) {
        let d = "", lone = "", pen = false, at = null, low = 0, high = 0, last = 0, x = "";
        const rest = () => pen && low < high ? `L${x} ${low.toFixed(1)}L${x} ${high.toFixed(1)}L${x} ${last.toFixed(1)}` : "";
        for (let i = 0; i < c.x.length; i++) {
          if (!usable(given.x, c.x[i]) || !usable(given.y, c.y[i])) { d += rest(); pen = false; continue; }
          const u = forward(given.x, c.x[i]);
          const in_view = u >= x0 - (x1 - x0) && u <= x1 + (x1 - x0);
          if (!in_view) { d += rest(); pen = false; continue; }
          const p = X(u), q = Y(forward(given.y, c.y[i]));
          if (given.dots || c.x.length === 1) { d += `M${p.toFixed(1)} ${q.toFixed(1)}h.01`; continue; }
          const beside = [i - 1, i + 1].some(k => usable(given.x, c.x[k]) && usable(given.y, c.y[k]));
          if (!beside) { d += rest(); pen = false; lone += `M${p.toFixed(1)} ${q.toFixed(1)}h.01`; continue; }
          const column = Math.floor(2 * p);
          if (pen && column === at) {  // of what falls into half a pixel, its lowest, highest and last
            low = Math.min(low, q); high = Math.max(high, q); last = q;
            continue;
          }
          d += rest();
          d += `${pen ? "L" : "M"}${p.toFixed(1)} ${q.toFixed(1)}`;
          pen = true; at = column; low = high = last = q; x = p.toFixed(1);
        }
        d += rest();
        make("path", {d, class: given.dots || c.x.length === 1 ? "dots" : c.beside ? "curve beside" : "curve", style: `stroke:${c.colour}`}, clip);
        if (lone) make("path", {d: lone, class: "dots", style: `stroke:${c.colour}`}, clip);
      }
      make("text", {x: left + w / 2, y: height - 6, "text-anchor": "middle", class: "label"}, svg).textContent = given.x.label;
      make("text", {x: left, y: 13, class: "label"}, svg).textContent = given.y.label;
      overlay = make("g", {}, svg);
      mark();
      box.replaceChildren(svg);
      const all = whole();
      reset.hidden = view.every((v, k) => Math.abs(v - all[k]) <= 1e-9 * (Math.abs(v) + 1));
    };
    const value = px => back(given.x, view[0] + (px - area.left) / area.w * (view[1] - view[0]));
    const read = px => {
      const at = value(px), said = [];
      let x = at;
      for (const c of curves) if (c.on && c.x.length) {
        let low = 0, high = c.x.length - 1;
        while (high - low > 1) { const mid = (low + high) >> 1; if (c.x[mid] < at) low = mid; else high = mid; }
        const k = Math.abs(c.x[low] - at) < Math.abs(c.x[high] - at) ? low : high;
        x = c.x[k];
        said.push(`${c.name} ${shown(c.y[k])}`);
      }
      readout.textContent = `${shown(x)}: ${said.join("; ")}`;
    };
    const inside = event => {
      const px = event.clientX - box.getBoundingClientRect().left;
      return Math.min(Math.max(px, area.left), area.left + area.w);
    };
    const zoom = (a, b) => {
      const u = [forward(given.x, value(a)), forward(given.x, value(b))].sort((p, q) => p - q);
      let [y0, y1] = [Infinity, -Infinity];
      for (const c of curves) if (c.on) for (let i = 0; i < c.x.length; i++) {
        if (!usable(given.x, c.x[i]) || !usable(given.y, c.y[i])) continue;
        const at = forward(given.x, c.x[i]);
        if (at < u[0] || at > u[1]) continue;
        const v = forward(given.y, c.y[i]);
        y0 = Math.min(y0, v); y1 = Math.max(y1, v);
      }
      if (!(y1 > y0)) [y0, y1] = [view[2], view[3]];
      const d = 0.04 * (y1 - y0);
      view = [u[0], u[1], y0 - d, y1 + d];
    };
    box.addEventListener("pointerdown", event => { start = here = inside(event); box.setPointerCapture(event.pointerId); });
    box.addEventListener("pointermove", event => { here = inside(event); read(here); mark(); });
    box.addEventListener("pointerup", event => {
      if (start !== null && Math.abs(inside(event) - start) > 6) zoom(start, inside(event));
      start = null; draw();
    });
    box.addEventListener("pointerleave", () => { start = here = null; mark(); });
    box.addEventListener("dblclick", () => { view = whole(); draw(); });
    box.addEventListener("keydown", event => {
      const step = {ArrowLeft: -1, ArrowRight: 1}[event.key];
      if (event.key === "Escape") { view = whole(); draw(); }
      if (!step) return;
      event.preventDefault();
      here = Math.min(Math.max((here ?? area.left) + 4 * step, area.left), area.left + area.w);
      read(here); mark();
    });
    draw();
    // other numbers of the same curves: what was zoomed stays so, and what was put out
    figure.redraw = held => {
      const zoomed = !reset.hidden;
      read_curves(held).forEach((c, k) => Object.assign(curves[k], {x: c.x, y: c.y}));
      if (!zoomed) view = whole();
      draw();
    };
    let width = box.clientWidth;
    new ResizeObserver(() => { if (box.clientWidth !== width) { width = box.clientWidth; draw(); } }).observe(box);
    window.addEventListener("beforeprint", draw);
  };

  // ---- modes: surfaces far to near, coloured by how far they move
  const shapes = figure => {
    const given = JSON.parse(figure.querySelector("script").textContent);
    const canvas = figure.querySelector("canvas"), pen = canvas.getContext("2d");
    const P = floats(given.points), F = new Uint16Array(bytes(given.faces)), n = P.length / 3;
    const modes = given.modes.map(m => ({re: new Int16Array(bytes(m.re)), im: m.im ? new Int16Array(bytes(m.im)) : null}));
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < n; i++) for (let k = 0; k < 3; k++) {
      low[k] = Math.min(low[k], P[3 * i + k]); high[k] = Math.max(high[k], P[3 * i + k]);
    }
    const middle = low.map((v, k) => (v + high[k]) / 2), size = Math.max(...high.map((v, k) => v - low[k])) || 1;
    const radius = 0.5 * Math.hypot(...high.map((v, k) => v - low[k])) + 0.08 * size;
    let turn = -0.9, tilt = 0.35, mode = given.first || 0, moving = !matchMedia("(prefers-reduced-motion: reduce)").matches, clock = 0, last = null;
    const U = new Float32Array(2 * n), depth = new Float32Array(n), level = new Float32Array(n);
    const order = Array.from({length: F.length / 3}, (_, k) => k), far = new Float32Array(F.length / 3);
    const amplitudes = () => {
      const {re, im} = modes[mode];
      for (let i = 0; i < n; i++) {
        let s = 0;
        for (let k = 0; k < 3; k++) s += re[3 * i + k] ** 2 + (im ? im[3 * i + k] ** 2 : 0);
        level[i] = Math.min(1, Math.sqrt(s) / 32767);
      }
    };
    const draw = () => {
      const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
      if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
        canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio);
      }
      pen.setTransform(ratio, 0, 0, ratio, 0, 0);
      pen.clearRect(0, 0, width, height);
      const scale = 0.5 * Math.min(width / radius, height / (0.75 * radius));
      const {re, im} = modes[mode], swing = 0.08 * size / 32767, c = Math.cos(clock) * swing, s = Math.sin(clock) * swing;
      const [ct, st, cl, sl] = [Math.cos(turn), Math.sin(turn), Math.cos(tilt), Math.sin(tilt)];
      for (let i = 0; i < n; i++) {
        const q = k => P[3 * i + k] - middle[k] + c * re[3 * i + k] - (im ? s * im[3 * i + k] : 0);
        const x = q(0), y = q(1), z = q(2);
        const a = ct * x - st * z, b = st * x + ct * z;
        U[2 * i] = width / 2 + scale * a; U[2 * i + 1] = height / 2 - scale * (cl * y - sl * b);
        depth[i] = sl * y + cl * b;
      }
      for (let k = 0; k < far.length; k++) far[k] = depth[F[3 * k]] + depth[F[3 * k + 1]] + depth[F[3 * k + 2]];
      order.sort((a, b) => far[a] - far[b]);
      for (const k of order) {
        const [i, j, l] = [F[3 * k], F[3 * k + 1], F[3 * k + 2]];
        const ax = U[2 * j] - U[2 * i], ay = U[2 * j + 1] - U[2 * i + 1], bx = U[2 * l] - U[2 * i], by = U[2 * l + 1] - U[2 * i + 1];
        const az = (depth[j] - depth[i]) * scale, bz = (depth[l] - depth[i]) * scale;
        const nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
        const light = 0.55 + 0.45 * Math.abs(0.3 * nx - 0.5 * ny + 0.8 * nz) / (Math.hypot(nx, ny, nz) || 1);
        const t = (level[i] + level[j] + level[l]) / 3;
        // pale yellow at rest, through orange to dark red
        const colour = `rgb(${Math.round(light * (255 - 85 * t * t))} ${Math.round(light * (240 - 215 * t))} ${Math.round(light * (185 - 150 * Math.min(1, 1.5 * t)))})`;
        pen.fillStyle = pen.strokeStyle = colour;
        pen.beginPath();
        pen.moveTo(U[2 * i], U[2 * i + 1]); pen.lineTo(U[2 * j], U[2 * j + 1]); pen.lineTo(U[2 * l], U[2 * l + 1]);
        pen.closePath(); pen.fill(); pen.lineWidth = 0.4; pen.stroke();
      }
    };
    let seen = true, wanted = false;
    const frame = now => {
      wanted = false;
      if (moving && last !== null) clock += (now - last) / 1000 * Math.PI;
      last = now;
      draw();
      if (moving && seen) ask(); else last = null;
    };
    const ask = () => { if (!wanted) { wanted = true; requestAnimationFrame(frame); } };
    const buttons = [...figure.querySelectorAll("button:not(.play)")], play = figure.querySelector(".play");
    buttons.forEach((button, k) => button.addEventListener("click", () => {
      mode = k; amplitudes();
      buttons.forEach((b, j) => b.setAttribute("aria-pressed", j === k));
      ask();
    }));
    play.setAttribute("aria-pressed", moving);
    play.addEventListener("click", () => { moving = !moving; play.setAttribute("aria-pressed", moving); ask(); });
    let from = null;
    canvas.addEventListener("pointerdown", event => { from = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
    canvas.addEventListener("pointerup", () => { from = null; });
    canvas.addEventListener("pointermove", event => {
      if (!from) return;
      turn += (event.clientX - from[0]) * 0.01;
      tilt = Math.min(Math.max(tilt + (event.clientY - from[1]) * 0.01, -1.57), 1.57);
      from = [event.clientX, event.clientY];
      ask();
    });
    canvas.addEventListener("keydown", event => {
      const step = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1]}[event.key];
      if (!step) return;
      event.preventDefault();
      turn += step[0]; tilt = Math.min(Math.max(tilt + step[1], -1.57), 1.57);
      ask();
    });
    new IntersectionObserver(entries => { seen = entries[0].isIntersecting; if (seen) ask(); }).observe(canvas);
    new ResizeObserver(ask).observe(canvas);
    amplitudes(); draw(); ask();
  };

  // what is seen first, then the rest while the page can be read already
  const waiting = [...document.querySelectorAll("figure.chart, figure.shapes")];
  const next = () => {
    const began = performance.now();
    while (waiting.length && performance.now() - began < 30) {
      const figure = waiting.shift();
      (figure.classList.contains("chart") ? chart : shapes)(figure);
    }
    if (waiting.length) setTimeout(next, 0); else document.documentElement.dataset.drawn = "yes";
  };
  window.addEventListener("beforeprint", () => { while (waiting.length) next(); });
  next();
})();
