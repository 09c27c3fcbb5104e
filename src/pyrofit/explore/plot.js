"use strict";
// One plot: measured points, up to two simulated curves, residuals below; hover, drag to zoom,
// double click to see all. Colours differ for all kinds of colour vision, curves by dashes as well.
const INK = { point: "#555", error: "#c9ced2", first: "#0072b2", second: "#d55e00", axis: "#4a5258", band: "#cfe3f2" };

function ticks(low, high, about) {
  const raw = (high - low) / about, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map(f => f * power).find(s => s >= raw) || raw;
  const found = [];
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

  draw() {
    const box = this.canvas, ratio = window.devicePixelRatio || 1;
    const wide = box.clientWidth, high = box.clientHeight;
    if (!wide) return;
    if (box.width !== Math.round(wide * ratio)) { box.width = Math.round(wide * ratio); box.height = Math.round(high * ratio); }
    const pen = this.pen = box.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, wide, high);
    pen.font = "11px system-ui, sans-serif";
    const s = this.signal, inside = [];
    [this.x0, this.x1] = this.span || [Math.min(...s.x), Math.max(...s.x)];
    s.x.forEach((x, i) => { if (x >= this.x0 && x <= this.x1) inside.push(i); });
    this.left = 52; this.width = wide - 60;
    const curves = [this.second, this.first].filter(Boolean);
    this.panel(14, high - 108, inside, [s.measured, ...curves], false, s.band || []);
    const off = curves.map(c => s.x.map((_, i) => c[i] - s.measured[i]));
    this.panel(high - 82, 48, inside, off, true);
  }

  panel(top, height, inside, series, residual, around = []) {
    const pen = this.pen, s = this.signal;
    let low = Infinity, high = -Infinity;
    for (const one of [...series, ...around]) for (const i of inside) if (Number.isFinite(one[i])) { low = Math.min(low, one[i]); high = Math.max(high, one[i]); }
    if (residual) { high = Math.max(high, -low, 0) || 1; low = -high; }
    if (!(high > low)) { low -= 1; high = low + 2; }
    const edge = 0.05 * (high - low); low -= edge; high += edge;
    const X = x => this.left + (x - this.x0) / (this.x1 - this.x0) * this.width;
    const Y = y => top + (high - y) / (high - low) * height;
    pen.strokeStyle = "#e6e9eb"; pen.fillStyle = INK.axis; pen.lineWidth = 1;
    pen.textAlign = "right"; pen.textBaseline = "middle";
    for (const y of ticks(low, high, residual ? 2 : 5)) { line(pen, [[this.left, Y(y)], [this.left + this.width, Y(y)]]); pen.fillText(shown(y), this.left - 4, Y(y)); }
    pen.textAlign = "center"; pen.textBaseline = "top";
    for (const x of ticks(this.x0, this.x1, 5)) { line(pen, [[X(x), top], [X(x), top + height]]); if (residual) pen.fillText(shown(x), X(x), top + height + 4); }
    pen.strokeStyle = "#9aa2a8"; pen.strokeRect(this.left, top, this.width, height);
    pen.textAlign = "left"; pen.textBaseline = "bottom";
    if (!residual) pen.fillText(`${s.quantity} [${s.unit}]`, this.left, top - 1);
    else { pen.fillText("simulated − measured", this.left, top - 1); pen.textAlign = "center"; pen.fillText(s.abscissa, this.left + this.width / 2, top + height + 32); }
    pen.save(); pen.beginPath(); pen.rect(this.left, top, this.width, height); pen.clip();
    if (!residual) { if (s.band) this.band(inside, X, Y); this.points(inside, X, Y); }
    else { pen.strokeStyle = "#9aa2a8"; line(pen, [[this.left, Y(0)], [this.left + this.width, Y(0)]]); }
    const drawn = residual ? series : series.slice(1);
    drawn.forEach((one, k) => {
      const isFirst = k === drawn.length - 1 && this.first;
      pen.strokeStyle = isFirst ? INK.first : INK.second; pen.lineWidth = residual ? 1.2 : 2;
      pen.setLineDash(isFirst ? [] : [6, 3]);
      line(pen, inside.filter(i => Number.isFinite(one[i])).map(i => [X(s.x[i]), Y(one[i])]));
    });
    pen.restore();
  }

  band(inside, X, Y) {
    const pen = this.pen, s = this.signal, [low, high] = s.band;
    pen.fillStyle = INK.band; pen.beginPath();
    for (const i of inside) pen.lineTo(X(s.x[i]), Y(low[i]));
    for (const i of [...inside].reverse()) pen.lineTo(X(s.x[i]), Y(high[i]));
    pen.fill();
  }

  points(inside, X, Y) {
    const pen = this.pen, s = this.signal;
    if (s.sd) { pen.strokeStyle = INK.error; for (const i of inside) line(pen, [[X(s.x[i]), Y(s.measured[i] - s.sd[i])], [X(s.x[i]), Y(s.measured[i] + s.sd[i])]]); }
    pen.fillStyle = INK.point;
    for (const i of inside) pen.fillRect(X(s.x[i]) - 1, Y(s.measured[i]) - 1, 2, 2);
  }
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
