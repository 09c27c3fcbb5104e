"use strict";
// One plot: measured points, up to two simulated curves, residuals below; hover, drag to zoom,
// double click to see all. Colours differ for all kinds of colour vision, curves by dashes as well.
const INK = { point: "#555", error: "#c9ced2", first: "#0072b2", second: "#d55e00", axis: "#4a5258", band: "#cfe3f2" };

// The least of 1, 2, 5, 10, 20, ... of which about that many fill a range.
function nice(range, about) {
  const raw = range / about, power = 10 ** Math.floor(Math.log10(raw));
  return [1, 2, 5, 10].map(f => f * power).find(s => s >= raw) || raw;
}

function ticks(low, high, about) {
  const step = nice(high - low, about), found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) found.push(i * step);
  return found;
}

const inUnit = unit => ["-", "–"].includes(unit) ? "" : " " + unit;

const shown = v => Number.isFinite(v) ? String(Number(v.toPrecision(4))) : "–";

class Plot {
  constructor(signal, parent) {
    this.signal = signal;
    this.first = this.second = null;
    this.figure = add(parent, "figure", { id: "plot-" + signal.id, className: signal.fitted ? "" : "out" });
    add(this.figure, "figcaption", { textContent: signal.title });
    this.note = add(this.figure, "div", { className: "note" });
    this.canvas = add(this.figure, "canvas");
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", `${signal.title}: ${signal.quantity}`);
    this.tip = add(this.figure, "div", { className: "tip", hidden: true });
    this.back = document.createElement("canvas");
    this.all = [Math.min(...signal.x), Math.max(...signal.x)];
    this.span = null;
    this.canvas.addEventListener("pointermove", e => this.hover(e));
    this.canvas.addEventListener("pointerleave", () => { this.tip.hidden = true; });
    this.canvas.addEventListener("pointerdown", e => { this.from = this.at(e); });
    this.canvas.addEventListener("pointerup", e => this.zoom(this.at(e)));
    this.canvas.addEventListener("dblclick", () => { this.span = null; this.draw(); });
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  at(event) {
    const place = event.clientX - this.canvas.getBoundingClientRect().left;
    return this.x0 + (place - this.left) / this.width * (this.x1 - this.x0);
  }

  zoom(to) {
    const [a, b] = [this.from, to].sort((p, q) => p - q);
    const inside = this.signal.x.filter(x => x >= a && x <= b).length;
    if (b - a > 0.03 * (this.x1 - this.x0) && inside > 2) { this.span = [a, b]; this.draw(); }
  }

  hover(event) {
    const s = this.signal, x = this.at(event);
    let i = 0;
    s.x.forEach((v, k) => { if (Math.abs(v - x) < Math.abs(s.x[i] - x)) i = k; });
    const lines = [`${s.abscissa.split(" [")[0]} ${shown(s.x[i])} ${s.abscissa.match(/\[(.*)\]/)[1]}`];
    const error = s.sd ? ` ± ${shown(s.sd[i])}` : "";
    lines.push(`measured ${shown(s.measured[i])}${error}${inUnit(s.unit)}`);
    if (this.first) lines.push(`simulated ${shown(this.first[i])}${inUnit(s.unit)}`);
    if (this.second) lines.push(`compared ${shown(this.second[i])}${inUnit(s.unit)}`);
    this.tip.textContent = lines.join("\n");
    this.tip.hidden = false;
    const half = this.figure.clientWidth / 2;
    this.tip.style.left = event.offsetX > half ? "" : event.offsetX + 24 + "px";
    this.tip.style.right = event.offsetX > half ? this.figure.clientWidth - event.offsetX + 8 + "px" : "";
    this.tip.style.top = event.offsetY + 30 + "px";
  }

  // New curves; one that is undefined stays. A plot whose curves did not move is not drawn.
  show(first, second) {
    const moved = (there, now) => now !== undefined && !equal(there, now);
    if (!moved(this.first, first) && !moved(this.second, second)) return;
    if (first !== undefined) this.first = first;
    if (second !== undefined) this.second = second;
    this.draw();
  }

  draw() {
    const box = this.canvas, ratio = window.devicePixelRatio || 1;
    const wide = box.clientWidth, high = box.clientHeight;
    if (!wide) return;
    const s = this.signal, curves = [this.second, this.first].filter(Boolean);
    [this.x0, this.x1] = this.span || this.all;
    this.left = 52; this.width = wide - 60;
    const frame = [wide, high, ratio, this.x0, this.x1].join();
    if (frame !== this.frame) this.place(frame);
    const off = curves.map(c => c.map((y, i) => y - s.measured[i]));
    const above = { top: 14, height: high - 116, residual: false, limits: this.limits([s.measured, ...(s.band || []), ...curves], 0.05, 4) };
    const below = { top: high - 82, height: 48, residual: true, limits: symmetric(this.limits(off, 0, 0)) };
    const back = [frame, above.limits, below.limits].join();
    const pen = box.getContext("2d");
    if (back !== this.back.of) {
      if (box.width !== Math.round(wide * ratio)) { box.width = Math.round(wide * ratio); box.height = Math.round(high * ratio); }
      this.drawBack(ratio, above, below);
      this.back.of = back;
    }
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, box.width, box.height);
    pen.drawImage(this.back, 0, 0);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    for (const [panel, series] of [[above, curves], [below, off]]) this.curves(pen, panel, series);
  }

  // Points inside the span, and their places on the canvas.
  place(frame) {
    const s = this.signal;
    this.frame = frame;
    this.inside = [];
    s.x.forEach((x, i) => { if (x >= this.x0 && x <= this.x1) this.inside.push(i); });
    this.X = x => this.left + (x - this.x0) / (this.x1 - this.x0) * this.width;
    this.places = Float32Array.from(s.x, this.X);
  }

  // Ends of all series. They lie on a raster, so that the axes stay while a curve moves a little.
  limits(series, edge, raster) {
    let low = Infinity, high = -Infinity;
    for (const one of series) for (const i of this.inside) { const y = one[i]; if (y < low) low = y; if (y > high) high = y; }
    if (!(high > low)) { low = Number.isFinite(low) ? low - 1 : -1; high = low + 2; }
    if (!raster) return [low, high];
    const room = edge * (high - low), step = nice(high - low, 5) / raster;
    return [Math.floor((low - room) / step) * step, Math.ceil((high + room) / step) * step];
  }

  // All that stays while the curves move: grid, labels, measured points.
  drawBack(ratio, above, below) {
    this.back.width = this.canvas.width; this.back.height = this.canvas.height;
    const pen = this.back.getContext("2d"), s = this.signal;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.font = "11px system-ui, sans-serif";
    for (const panel of [above, below]) this.axes(pen, panel);
    pen.textBaseline = "bottom";
    pen.textAlign = "left";
    const title = `${s.quantity} [${s.unit}]`, most = this.left + this.width + 8;
    pen.fillText(title, Math.max(Math.min(this.left, most - pen.measureText(title).width), 0), above.top - 1, most);
    pen.fillText(`simulated − measured [${s.difference}]`, this.left, below.top - 1);
    pen.textAlign = "center";
    pen.fillText(s.abscissa, this.left + this.width / 2, below.top + below.height + 33);
    this.clipped(pen, above, Y => { if (s.band) this.band(pen, Y); this.points(pen, Y); });
    this.clipped(pen, below, Y => { pen.strokeStyle = "#9aa2a8"; line(pen, [[this.left, Y(0)], [this.left + this.width, Y(0)]]); });
  }

  axes(pen, { top, height, limits: [low, high], residual }) {
    const Y = y => top + (high - y) / (high - low) * height;
    pen.strokeStyle = "#e6e9eb"; pen.fillStyle = INK.axis; pen.lineWidth = 1;
    pen.textAlign = "right"; pen.textBaseline = "middle";
    for (const y of residual ? [low, 0, high] : ticks(low, high, 5)) { line(pen, [[this.left, Y(y)], [this.left + this.width, Y(y)]]); pen.fillText(shown(y), this.left - 4, Y(y)); }
    pen.textAlign = "center"; pen.textBaseline = "top";
    for (const x of ticks(this.x0, this.x1, 5)) { line(pen, [[this.X(x), top], [this.X(x), top + height]]); if (residual) pen.fillText(shown(x), Math.min(this.X(x), this.left + this.width + 8 - pen.measureText(shown(x)).width / 2), top + height + 4); }
    pen.strokeStyle = "#9aa2a8"; pen.strokeRect(this.left, top, this.width, height);
  }

  clipped(pen, { top, height, limits: [low, high] }, act) {
    pen.save(); pen.beginPath(); pen.rect(this.left, top, this.width, height); pen.clip();
    act(y => top + (high - y) / (high - low) * height);
    pen.restore();
  }

  curves(pen, panel, series) {
    this.clipped(pen, panel, Y => series.forEach((one, k) => {
      const isFirst = k === series.length - 1 && this.first;
      pen.strokeStyle = isFirst ? INK.first : INK.second; pen.lineWidth = panel.residual ? 1.2 : 2;
      pen.setLineDash(isFirst ? [] : [6, 3]);
      pen.beginPath();
      for (const i of this.inside) if (Number.isFinite(one[i])) pen.lineTo(this.places[i], Y(one[i]));
      pen.stroke();
    }));
  }

  band(pen, Y) {
    const [low, high] = this.signal.band;
    pen.fillStyle = INK.band; pen.beginPath();
    for (const i of this.inside) pen.lineTo(this.places[i], Y(low[i]));
    for (const i of [...this.inside].reverse()) pen.lineTo(this.places[i], Y(high[i]));
    pen.fill();
  }

  points(pen, Y) {
    const s = this.signal, at = this.places;
    if (s.sd) {
      pen.strokeStyle = INK.error; pen.beginPath();
      for (const i of this.inside) { pen.moveTo(at[i], Y(s.measured[i] - s.sd[i])); pen.lineTo(at[i], Y(s.measured[i] + s.sd[i])); }
      pen.stroke();
    }
    pen.fillStyle = INK.point;
    for (const i of this.inside) pen.fillRect(at[i] - 1, Y(s.measured[i]) - 1, 2, 2);
  }
}

const equal = (a, b) => a === b || (!!a && !!b && a.length === b.length && a.every((v, i) => Object.is(v, b[i])));

// Limits of residuals: as far below zero as above, at a round number.
function symmetric([low, high]) {
  const far = nice(Math.max(high, -low) || 1, 1);
  return [-far, far];
}

function line(pen, points) {
  pen.beginPath();
  points.forEach(([x, y], k) => k ? pen.lineTo(x, y) : pen.moveTo(x, y));
  pen.stroke();
}

function add(parent, tag, properties) {
  const made = Object.assign(document.createElement(tag), properties || {});
  parent.append(made);
  return made;
}
