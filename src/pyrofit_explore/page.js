// The page: sliders on the left, plots on the right. One request is under way at a time, and the
// next one takes the newest state, so that any number of slider events does no harm.
const data = JSON.parse(document.getElementById("data").textContent);
const token = new URLSearchParams(location.search).get("token");
const byId = id => document.getElementById(id);
const page = { values: {}, effects: new Set(), ticked: new Set(), undo: [], plots: {}, rows: {}, delays: [] };
const WAITING = "The study is read and simulated. The first simulation may compile the solver, which takes a minute.";
let study, source, wanted = 0, busy = false, fitting = null, last = "";

async function ask(name, body, signal) {
  return fetch("/" + name, { method: "POST", body: JSON.stringify(body), headers: { "X-Token": token, "Content-Type": "application/json" }, signal });
}

async function answer(name, body) {
  const found = await (await ask(name, body)).json();
  if (found.error) throw new Error(found.error);
  return found;
}

function bytes(text) {
  const raw = atob(text), found = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) found[i] = raw.charCodeAt(i);
  return found.buffer;
}

function unpacked(text) {
  const all = new Float32Array(bytes(text));
  const curves = {};
  let at = 0;
  for (const s of study.signals) { curves[s.id] = all.subarray(at, at + s.x.length); at += s.x.length; }
  return curves;
}

const live = async state => {
  const found = await answer("curves", state);
  return { ...found, curves: unpacked(found.curves) };
};

// Without a server: linear between the sets that the page holds, over one or two sliders.
function held(grid) {
  const all = new Uint16Array(bytes(grid.curves));
  const size = study.signals.reduce((n, s) => n + s.x.length, 0);
  const place = (at, v) => {
    const i = Math.min(Math.max(at.findLastIndex(a => a <= v), 0), at.length - 2);
    const u = Math.min(Math.max((v - at[i]) / (at[i + 1] - at[i]), 0), 1);
    return [[i, 1 - u], [i + 1, u]];
  };
  return async state => {
    let corners = [[0, 1]];
    grid.names.forEach((name, k) => {
      corners = corners.flatMap(([i, w]) => place(grid.at[k], state.values[name]).map(([j, v]) => [i * grid.at[k].length + j, w * v]));
    });
    const curves = {};
    let from = 0;
    study.signals.forEach((s, n) => {
      const [low, step] = grid.scales[n], curve = new Float32Array(s.x.length);
      for (const [i, w] of corners) if (w) for (let j = 0; j < curve.length; j++) {
        const code = all[i * size + from + j];
        curve[j] += w * (code === 65535 ? NaN : low + step * code);
      }
      curves[s.id] = curve; from += s.x.length;
    });
    return { curves, numbers: null, failed: {} };
  };
}

// Numbers of effects that are switched off stay with the page.
function stateOf() {
  const effects = [...page.effects], of = study.effects.filter(e => page.effects.has(e.name)).flatMap(e => e.numbers);
  const names = [...study.parameters, ...of].map(p => p.name);
  return { values: Object.fromEntries(names.map(n => [n, page.values[n]])), effects };
}

function snapshot() { return JSON.stringify({ v: page.values, e: [...page.effects], t: [...page.ticked] }); }

function restore(text) {
  const old = JSON.parse(text);
  page.values = { ...study.middle, ...old.v }; page.effects = new Set(old.e); page.ticked = new Set(old.t);
  showState(); refresh();
}

// Called after a change is complete: undo brings back the state before, and the link leads here.
function settled() {
  const now = snapshot();
  if (now === last) return;
  if (last) page.undo.push(last);
  last = now;
  history.replaceState(null, "", location.pathname + location.search + "#" + encodeURIComponent(now));
}

function undo() {
  if (!page.undo.length) return;
  last = "";
  restore(page.undo.pop());
  settled();
}

function refresh() { wanted = performance.now(); if (!busy) draw(); }

async function draw() {
  busy = true;
  while (wanted) {
    const since = wanted;
    wanted = 0;
    try {
      const found = await source(stateOf());
      for (const s of study.signals) page.plots[s.id].show(found.curves[s.id]);
      tell(found);
      fail("");
      if (byId("message").textContent === WAITING) say("");
      page.delays.push(performance.now() - since);
    } catch (error) { fail(error.message); }
  }
  busy = false;
}

function fail(text) { byId("error").textContent = text; byId("error").hidden = !text; }

function rms(s, curve) {
  let sum = 0;
  s.measured.forEach((y, i) => { sum += (curve[i] - y) ** 2; });
  return Math.sqrt(sum / s.x.length);
}

function tell(found) {
  let chi2 = 0, points = 0, waits = false;
  for (const s of study.signals) {
    const plot = page.plots[s.id], why = found.failed[s.experiment];
    plot.note.className = why ? "note failed" : "note";
    if (why) { plot.note.textContent = "failed: " + why; continue; }
    if (!s.fitted) { plot.note.textContent = "held out"; continue; }
    const of = found.numbers ? found.numbers.signals[s.id] : { rms: rms(s, found.curves[s.id]), chi2: null };
    const released = found.numbers && found.numbers.mass[s.id];
    plot.note.textContent = `rms ${shown(of.rms)}${inUnit(s.difference)}` + (of.chi2 === null ? "" : `, χ²/n ${shown(of.chi2 / of.points)}`)
      + (released ? `, mass ${Number((100 * released[0] / released[1]).toPrecision(3))}\u00a0%` : "");
    plot.note.title = released ? `released mass: simulated ${shown(released[0])}, measured ${shown(released[1])} kg/m²` : "";
    if (of.chi2 === null) waits = true; else { chi2 += of.chi2; points += of.points; }
  }
  if (!found.numbers) return;
  byId("numbers").replaceChildren();
  const number = (name, value) => { const span = add(byId("numbers"), "span", { textContent: name + " " }); add(span, "b", { textContent: value }); };
  number("χ²", waits ? (found.noise || "follows: the noise of the signals is being estimated") : `${shown(chi2)} of ${points} points`);
  for (const [name, value] of Object.entries(found.numbers.costs)) number("cost " + name, value === null ? "–" : shown(value));
  if (waits && !found.noise) setTimeout(() => { if (!busy) refresh(); }, 2000);
}

function row(parent, p) {
  const made = add(parent, "div", { className: "row", id: "row-" + p.name });
  const name = add(made, "div", { className: "name" });
  const label = add(name, "span", { textContent: p.label, title: `${p.name}: ${p.label}` });
  if (!data.study) {
    const tick = document.createElement("input");
    Object.assign(tick, { type: "checkbox", title: "fit this parameter", checked: page.ticked.has(p.name) });
    tick.addEventListener("change", () => { page.ticked[tick.checked ? "add" : "delete"](p.name); settled(); });
    label.prepend(tick, " ");
    made.tick = tick;
  }
  add(name, "span", { className: "unit", textContent: `${shown(p.lower)} … ${shown(p.upper)}${inUnit(p.unit)}` });
  const set = add(made, "div", { className: "set" }), rail = add(set, "div", { className: "rail" });
  const slider = add(rail, "input", { type: "range", min: 0, max: 1000, step: "any" });
  slider.setAttribute("aria-label", p.label);
  const known = p.known ? p.known.value : null;
  if (known !== null) add(rail, "i", { className: "mark", title: `known: ${shown(known)} ± ${shown(p.known.sd)} ${p.unit}` }).style.left = `calc(8px + (100% - 16px) * ${(known - p.lower) / (p.upper - p.lower)})`;
  const field = add(set, "input", { type: "number", step: "any" });
  field.setAttribute("aria-label", `${p.label}, value`);
  const take = value => { page.values[p.name] = value; refresh(); };
  slider.addEventListener("input", () => { const v = p.lower + slider.value / 1000 * (p.upper - p.lower); field.value = Number(v.toPrecision(6)); take(v); });
  slider.addEventListener("change", settled);
  field.addEventListener("change", () => { if (field.value !== "") { take(Number(field.value)); showState(); settled(); } });
  made.show = () => {
    const v = page.values[p.name];
    slider.value = 1000 * (v - p.lower) / (p.upper - p.lower);
    field.value = Number(v.toPrecision(6));
    if (made.tick) made.tick.checked = page.ticked.has(p.name);
  };
  page.rows[p.name] = made;
}

function showState() {
  for (const row of Object.values(page.rows)) row.show();
  for (const effect of study.effects) {
    const box = byId("effect-" + effect.name), on = page.effects.has(effect.name);
    box.querySelector("input").checked = on;
    box.querySelector(".numbers").hidden = !on;
  }
}

function effectBox(parent, effect) {
  const box = add(parent, "div", { className: "effect", id: "effect-" + effect.name });
  const label = add(box, "label", { title: `${effect.name}, of the ${effect.family}` });
  const toggle = add(label, "input", { type: "checkbox" });
  label.append(" " + effect.title);
  add(box, "div", { className: "equation", textContent: effect.equation });
  const numbers = add(box, "div", { className: "numbers", hidden: true });
  for (const n of effect.numbers) {
    page.values[n.name] = n.start;
    row(numbers, { ...n, label: `${n.symbol}: ${n.label}`, known: null });
  }
  toggle.addEventListener("change", () => {
    page.effects[toggle.checked ? "add" : "delete"](effect.name);
    for (const n of effect.numbers) page.ticked[toggle.checked && n.strength ? "add" : "delete"](n.name);
    showState(); refresh(); settled();
  });
}

function choice(parent, id, words, labels, act) {
  const label = add(parent, "label", { textContent: words + " " });
  const select = add(label, "select", { id });
  for (const [value, text, disabled] of labels) add(select, "option", { value, textContent: text, disabled: !!disabled });
  select.addEventListener("change", () => act(select.value));
}

function button(parent, id, text, act, title) {
  return add(parent, "button", { id, textContent: text, onclick: act, title: title || "" });
}

const say = text => { byId("message").textContent = text; };

function valuesOf(label, alone) {
  const found = { ...(alone ? study.middle : page.values), ...(label ? study.sets[label] : study.middle) };
  return alone ? Object.fromEntries(study.parameters.map(p => [p.name, found[p.name]])) : found;
}

// Parameters for which a published material has no number keep their values.
function startAt(name) {
  const { values, said } = study.starts[name];
  Object.assign(page.values, values);
  showState(); refresh(); settled(); say(said);
}

function start(label) {
  if (label.startsWith("published:")) return startAt(label.slice(10));
  page.values = valuesOf(label);
  showState(); refresh(); settled();
}

async function compare(label) {
  try {
    const found = label === "" ? null : label === "keep"
      ? { curves: Object.fromEntries(study.signals.map(s => [s.id, page.plots[s.id].first])) }
      : label.startsWith("set:") ? await source({ values: valuesOf(label.slice(4), true), effects: [] })
        : await answer("published", { ...stateOf(), name: label.slice(10) }).then(f => ({ curves: unpacked(f.curves) }));
    for (const s of study.signals) page.plots[s.id].show(undefined, found && found.curves[s.id]);
  } catch (error) { fail(error.message); }
}

async function fit() {
  if (fitting) return;
  fitting = new AbortController();
  byId("fit").disabled = true; byId("cancel").disabled = false;
  settled();
  try {
    const reader = (await ask("fit", { ...stateOf(), estimate: [...page.ticked] }, fitting.signal)).body.getReader();
    const decoder = new TextDecoder();
    let text = "";
    for (;;) {
      const { done, value } = await reader.read();
      if (done) break;
      const lines = (text + decoder.decode(value, { stream: true })).split("\n");
      text = lines.pop();
      for (const one of lines) {
        const found = JSON.parse(one);
        if (found.error) throw new Error(found.error);
        say(found.said);
        if (found.values) { Object.assign(page.values, found.values); showState(); refresh(); }
      }
    }
  } catch (error) {
    if (error.name === "AbortError") say("The fit was cancelled; the best values so far stay. Undo leads back.");
    else { say(""); fail(error.message); }
  }
  fitting = null;
  byId("fit").disabled = false; byId("cancel").disabled = true;
  settled();
}

async function save() {
  try {
    const found = await answer("save", { ...stateOf(), estimate: [...page.ticked], name: byId("name").value });
    say(found.said);
  } catch (error) { say(""); fail(error.message); }
}

function build() {
  document.title = `${study.name} – pyrofit explore`;
  const side = byId("side"), head = byId("head");
  head.replaceChildren();
  add(side, "h1", { textContent: study.title });
  for (const [heading, text] of study.notes || []) {
    const held = add(side, "details");
    add(held, "summary", { textContent: heading });
    add(held, "p", { textContent: text });
  }
  const sets = Object.keys(study.sets || {});
  if (!data.study) {
    const origin = [["", "middle of limits, known values"], ...sets.map(s => [s, s])];
    const materials = study.published.map(s => [s, Object.keys(study.starts[s].values).length === 0])
      .map(([s, none]) => ["published:" + s, "MaCFP: " + s + (none ? ": nothing to take" : ""), none]);
    choice(side, "start", "Start from", [...origin, ...materials], start);
    const others = [["", "nothing"], ["keep", "the present curves"], ["set:", origin[0][1]], ...sets.map(s => ["set:" + s, s]), ...study.published.map(s => ["published:" + s, "MaCFP: " + s])];
    choice(side, "compare", "Compare with", others, compare);
    const tools = add(side, "div");
    button(tools, "fit", "Fit from here", fit, "least squares over the ticked parameters");
    button(tools, "cancel", "Cancel", () => fitting && fitting.abort()).disabled = true;
    button(tools, "undo", "Undo", undo);
    add(tools, "input", { type: "text", id: "name", value: study.name + "_explored", size: 18 }).setAttribute("aria-label", "name of the saved study");
    button(tools, "save", "Save", save, "write a study and a set into the folder of the command");
  } else button(side, "reset", "Back to the start", () => start(""));
  for (const group of [...new Set(study.parameters.map(p => p.group))]) {
    const own = study.parameters.filter(p => p.group === group);
    const folded = add(side, "details", { open: own.length <= 12 });
    add(folded, "summary", { textContent: `${group} (${own.length})` });
    for (const p of own) row(folded, p);
  }
  if (study.effects.length) {
    const folded = add(side, "details", { open: true, id: "effects" });
    add(folded, "summary", { textContent: `effects (${study.effects.length})` });
    for (const effect of study.effects) effectBox(folded, effect);
  }
  const key = add(head, "div", { className: "key" });
  add(key, "span", { textContent: "· measured" });
  const lines = [["border-color:" + INK.first, "simulated"], ["border-top-style:dashed;border-color:" + INK.second, "compared"]];
  for (const [style, text] of data.study ? lines.slice(0, 1) : lines) { add(key, "i").style.cssText = style; key.append(text); }
  if (study.signals.some(s => s.band)) { add(key, "i").style.cssText = `height:9px;border:0;background:${INK.band}`; key.append("95 % of the posterior"); }
  add(head, "div", { className: "unit", textContent: "Dashed frame: held out, counts in no number. Drag: zoom; double click: all." });
  add(head, "div", { id: "numbers", className: "numbers" });
  add(head, "div", { id: "message" }).setAttribute("aria-live", "polite");
  for (const s of study.signals) page.plots[s.id] = new Plot(s, byId("plots"));
  say(study.remarks && study.remarks.length ? "Left out: " + study.remarks.join("; ") : WAITING);
}

(async () => {
  byId("head").textContent = WAITING;
  try {
    study = data.study || await answer("describe", {});
  } catch (error) { byId("head").textContent = ""; fail(error.message); return; }
  page.values = { ...study.middle };
  page.ticked = new Set(study.estimate || []);
  source = data.study ? held(data.grid) : live;
  build();
  showState();
  const given = location.hash.slice(1);
  try { if (given) { restore(decodeURIComponent(given)); } } catch (error) { fail("The link holds no state of this page."); }
  if (!given) refresh();
  settled();
  page.ready = true;
})();
