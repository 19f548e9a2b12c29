// The views at the side: numbers, phase portrait, damping diagram, spectrogram, stability map, study.

import { barAxis, cellAxis, linearAxis, logAxis, padded, power } from "./axis.js";
import { signChange } from "./contour.js";
import { GREEN, GREY, INK, Layers, PURPLE, RED, SOFT, UNSTABLE, contextOf, curve, frame, line, note, offsets, symbols, text, widthOf } from "./drawing.js";
import { element } from "./form.js";
import { plain, quantity } from "./quantity.js";

const BOX = (width, height) => ({ left: 56, top: 8, width: width - 68, height: height - 44 });

function below(context, width, height, words) {
  symbols(context, words, 56 + (width - 68) / 2, height - 10, { align: "center", color: SOFT });
}

function beside(context, height, words) {
  context.save();
  context.translate(9, height / 2 - 14);
  context.rotate(-Math.PI / 2);
  symbols(context, words, 0, 0, { align: "center", color: SOFT });
  context.restore();
}

function dot(context, x, y, color = INK, radius = 5) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = color;
  context.fill();
  context.strokeStyle = "#fff";
  context.lineWidth = 1.5;
  context.stroke();
}

// Two ends in words, for whoever does not see the view.
function span([low, high], unit) {
  const least = 1e-6 * Math.max(Math.abs(low), Math.abs(high)); // less is rounding
  return [low, high].map((each) => quantity(Math.abs(each) < least ? 0 : each, unit, 3)).join(" to ");
}

class PhasePortrait {
  static title = "Phase";

  describe() {
    if (!this.ends) return "computing";
    const [forces, speeds] = this.ends;
    return `velocity X′, ${span(speeds, "m/s")}, over spring force k_x u_x, ${span(forces, "N")}`;
  }

  still(context, width, height, data) {
    if (!data.track) return;
    const box = BOX(width, height), k = data.scene.k[0];
    const parts = [[data.pinned, "#444b53", 0.5], [data, GREEN, 1]].filter(([each]) => each?.track);
    const ends = parts.flatMap(([each]) => [extent(each.track.columns.u_x).map((u) => u * each.scene.k[0]), extent(each.track.columns.V_X)]);
    const xs = [0, 2].flatMap((i) => ends[i] ?? []), ys = [1, 3].flatMap((i) => ends[i] ?? []);
    this.ends = ends.slice(-2); // of this run, which is drawn over a pinned one
    const around = (ends) => padded(Math.min(...ends), Math.max(...ends), 0.05);
    this.axes = { xs: linearAxis(...around(xs), 5, "N"), ys: linearAxis(...around(ys), 5, "m/s") };
    this.to = frame(context, box, this.axes.xs, this.axes.ys);
    for (const [each, color, alpha] of parts) {
      const { u_x: u, V_X: v } = each.track.columns, stiff = each.scene.k[0];
      context.globalAlpha = alpha;
      context.setLineDash(each === data ? [] : [5, 3]); // as in the time series
      curve(context, u.length, (i) => [this.to.x(stiff * u[i]), this.to.y(v[i])], color);
      context.setLineDash([]);
      context.globalAlpha = 1;
    }
    if (parts.length > 1) text(context, "A dashed, B now", box.left + box.width - 8, box.top + 12, { align: "right", halo: true });
    offsets(context, box, this.axes.xs, this.axes.ys);
    below(context, width, height, `spring force k_x u_x (${this.axes.xs.unit})`);
    beside(context, height, `velocity X′ (${this.axes.ys.unit})`);
    this.k = k;
  }

  moving(context, width, height, now) {
    if (this.to && now.state) dot(context, this.to.x(this.k * now.state.u_x), this.to.y(now.state.V_X), RED);
  }
}

class Damping {
  static title = "Damping";

  describe(data) {
    if (!this.to) return "damping number A is not finite";
    const degrees = (angle) => (angle * 180) / Math.PI, last = degrees(Math.abs(data.scene.phi));
    const edge = this.A > 1 ? degrees(Math.asin(this.A ** (-1 / 3))) : 90;
    const turns = edge > last ? `ζ falls below 1 at ${plain(edge, 3)} deg` : "ζ stays above 1";
    return `A = ${plain(this.A, 4)}; friction turns from 90 deg to ${plain(last, 3)} deg; ${turns}`;
  }

  still(context, width, height, data) {
    if (!data.scene) return;
    const A = data.scene.damping;
    this.A = A;
    this.to = null;
    if (!(A > 0)) return note(context, width, height, "A is not finite:\nno misalignment, or no steady drive");
    const box = BOX(width, height), middle = Math.log10(A);
    const low = 10 ** Math.min(-1, Math.floor(middle - 1)), high = 10 ** Math.max(5, Math.ceil(middle + 1));
    const show = (value) => plain(value);
    const xs = logAxis(low, high, "", 6), ys = logAxis(0.5, 90, "", 9, show);
    ys.ticks = [0.5, 1, 2, 5, 10, 20, 45, 90].map((value) => [value, `${value}`]);
    this.shade(context, box, low, high);
    this.to = frame(context, box, xs, ys);
    this.words = [];
    for (const n of [0, 1, -1, 2, -2, 3, -3, 4, -4, 5, -5, 6, -6, -7]) this.contour(context, box, n);
    const path = [90, Math.max((Math.abs(data.scene.phi) * 180) / Math.PI, 0.5)];
    line(context, path.map((angle) => [this.to.x(A), this.to.y(angle)]), PURPLE, 2, [5, 3]);
    below(context, width, height, "damping number A (1)");
    beside(context, height, "friction angle θ (deg)");
  }

  // Pale orange where the slow motion is underdamped, pale blue where it creeps.
  shade(context, box, low, high) {
    for (let i = 0; i < box.width; i += 2) {
      const A = low * (high / low) ** (i / box.width);
      const edge = A > 1 ? (Math.asin(A ** (-1 / 3)) * 180) / Math.PI : 90;
      const place = 1 - Math.log(Math.max(edge, 0.5) / 0.5) / Math.log(180);
      context.fillStyle = "#dbe8f1";
      context.fillRect(box.left + i, box.top, 2, box.height * place);
      context.fillStyle = UNSTABLE;
      context.fillRect(box.left + i, box.top + box.height * place, 2, box.height * (1 - place));
    }
  }

  contour(context, box, n) {
    const points = [];
    for (let degrees = 0.5; degrees <= 90; degrees *= 1.03) {
      const A = 10 ** n / Math.sin((degrees * Math.PI) / 180) ** 3, x = this.to.x(A);
      if (x >= box.left && x <= box.left + box.width) points.push([x, this.to.y(degrees)]);
    }
    if (points.length < 2) return;
    line(context, points, n ? "#8f979e" : GREEN, n ? 0.7 : 2.2);
    const words = n ? power(n) : "ζ = 1", wide = context.measureText(words).width;
    const [x, y] = points[Math.floor(points.length * 0.62)], label = { left: x + 3, right: x + 3 + wide, y };
    // one over another, or over the frame, would be read as neither
    const inside = label.right < box.left + box.width && Math.abs(y - box.top - box.height / 2) < box.height / 2 - 8;
    if (!inside || this.words.some((each) => each.left < label.right + 4 && label.left < each.right + 4 && Math.abs(each.y - y) < 14)) return;
    this.words.push(label);
    text(context, words, label.left, y, { color: n ? SOFT : GREEN, halo: true });
  }

  moving(context, width, height, now) {
    if (!this.to || !now.state) return;
    let theta = Math.abs(now.state.theta) % 180;
    theta = theta > 90 ? 180 - theta : theta;
    if (theta === theta) dot(context, this.to.x(this.A), this.to.y(Math.max(theta, 0.5)), RED);
  }
}

class Spectrogram {
  static title = "Spectrum";
  static asks = "spectrogram";

  describe({ spectrogramError: error, spectrogram: found }) {
    if (!found || found.stale || error) return error ?? "computing";
    const { amplitude } = found.arrays, [rows, columns] = amplitude.shape, [low, high] = found.frequency;
    const row = Math.floor(amplitude.reduce((most, value, i) => (value > amplitude[most] ? i : most), 0) / columns);
    const strongest = quantity(low + ((row + 0.5) / rows) * (high - low), "Hz", 2);
    return `transverse rate v_y, ${span(found.frequency, "Hz")}, strongest at ${strongest}`;
  }

  still(context, width, height, data) {
    const found = data.spectrogram;
    this.to = null;
    if (data.spectrogramError) return note(context, width, height, wrapped(data.spectrogramError));
    if (!found) return note(context, width, height, "computing …");
    const box = BOX(width, height), { amplitude } = found.arrays, [rows, columns] = amplitude.shape;
    context.drawImage(shaded(amplitude, rows, columns), box.left, box.top, box.width, box.height);
    const xs = linearAxis(...found.times, 4), ys = linearAxis(...found.frequency, 4, "Hz");
    this.to = frame(context, box, xs, ys);
    this.times = found.times;
    below(context, width, height, "time t (s), transverse rate v_y");
    beside(context, height, `frequency (${ys.unit})`);
  }

  moving(context, width, height, now) {
    if (!this.to || now.t < this.times[0] || now.t > this.times[1]) return;
    const x = this.to.x(now.t);
    line(context, [[x, 8], [x, height - 36]], "#fff", 2);
    line(context, [[x, 8], [x, height - 36]], INK, 1);
  }
}

class StabilityMap {
  static title = "Stability";
  static asks = "stability";

  describe({ stabilityError: error, stability: found, own }) {
    if (!this.axes || !own || found.stale) return error ?? "computing";
    const { growth } = found.arrays, [rows, columns] = growth.shape, { x, y } = this.place(own);
    const at = (share, count) => Math.min(Math.max(Math.floor(share * count), 0), count - 1);
    const j = at((x - this.box.left) / this.box.width, columns), i = at(1 - (y - this.box.top) / this.box.height, rows);
    const kind = growth[i * columns + j] > 0 ? "unstable" : "stable";
    return `steady sliding is ${kind} at φ = ${quantity(own.phi, "rad", 3)}, V = ${quantity(own.V, "m/s", 3)}; arrow keys move the point`;
  }

  still(context, width, height, data) {
    const found = data.stability, box = BOX(width, height);
    this.axes = null;
    if (data.stabilityError) return note(context, width, height, wrapped(data.stabilityError));
    if (!found) return note(context, width, height, "computing …");
    const { growth } = found.arrays, [rows, columns] = growth.shape;
    this.areas(context, box, growth, rows, columns);
    const xs = logAxis(...found.angles, "", 6, (value) => plain(value)), ys = logAxis(...found.speeds, "", 7);
    this.axes = { xs, ys };
    this.box = { ...box };
    this.to = frame(context, box, xs, ys);
    if (growth.some((rate) => rate > 0)) text(context, "steady sliding unstable", box.left + 10, box.top + box.height - 14, { color: "#8a5a00", halo: true });
    if (growth.some((rate) => rate <= 0)) text(context, "stable", box.left + box.width - 10, box.top + 14, { color: "#0a567f", align: "right", halo: true });
    below(context, width, height, "misalignment φ (deg): drag the point");
    beside(context, height, "drive velocity V (m/s)");
    this.own = data.own;
    if (data.pinned?.own) {
      const { x, y } = this.place(data.pinned.own);
      dot(context, x, y, "#8a9097");
      text(context, "A", x + 8, y, { color: "#444b53", halo: true });
    }
  }

  // Two areas, and a line between them, since their colours are of one lightness.
  areas(context, box, growth, rows, columns) {
    context.fillStyle = "#cfe3f0";
    context.fillRect(box.left, box.top, box.width, box.height);
    const wide = box.width / columns, high = box.height / rows;
    context.fillStyle = "#eee";
    growth.forEach((rate, k) => {
      if (rate === rate) return;
      context.fillRect(box.left + (k % columns) * wide, box.top + box.height - (Math.floor(k / columns) + 1) * high, wide + 0.6, high + 0.6);
    });
    const to = ([x, y]) => [box.left + x * box.width, box.top + (1 - y) * box.height];
    const { areas, lines } = signChange(growth, rows, columns);
    context.beginPath();
    for (const area of areas) area.forEach((point, k) => (k ? context.lineTo(...to(point)) : context.moveTo(...to(point))));
    context.fillStyle = UNSTABLE;
    context.fill();
    for (const ends of lines) line(context, ends.map(to), SOFT, 1.5);
  }

  place({ phi, V }) {
    return { x: this.to.x((Math.abs(phi) * 180) / Math.PI), y: this.to.y(Math.abs(V)) };
  }

  moving(context, width, height, now) {
    if (!this.axes || !now.own) return;
    const { x, y } = this.place(now.own);
    dot(context, Math.min(Math.max(x, this.box.left), this.box.left + this.box.width), Math.min(Math.max(y, this.box.top), this.box.top + this.box.height), RED, 7);
  }

  // The parameters under the pointer.
  pick(x, y) {
    if (!this.axes) return null;
    const place = (value, start, size) => Math.min(Math.max((value - start) / size, 0), 1);
    return {
      phi: `${plain(this.axes.xs.value(place(x, this.box.left, this.box.width)), 3)} deg`,
      V: quantity(this.axes.ys.value(1 - place(y, this.box.top, this.box.height)), "m/s", 3),
    };
  }
}

class StudyMap {
  static title = "Study";

  describe({ study }) {
    if (!study) return "none";
    const sides = study.axes.map(({ dim, values }) => `${values.length} values of ${dim}`).join(" by ");
    return `${sides}: ${study.bar ? study.measure : study.kinds.map(([name]) => name).join(", ")}`;
  }

  still(context, width, height, data) {
    const study = data.study, box = BOX(width, height);
    if (!study) return note(context, width, height, "no study: stiction explore STUDY.zarr");
    const { axes, arrays } = study, [across, up] = [axes[0], axes[1] ?? null];
    const columns = across.values.length, rows = up ? up.values.length : 1;
    const gaps = arrays.map.some((value, i) => i % 4 === 3 && !value), stripes = hatching(context);
    const meanings = [...(study.kinds ?? []), ...(gaps ? [[study.missing, stripes]] : [])];
    const bar = study.bar && barAxis(study.bar.limits, study.bar.log);
    const wide = (words) => Math.max(...words.map((each) => context.measureText(each).width));
    if (bar) box.width -= 44 + wide(bar.ticks.map(([, label]) => label));
    else box.width -= 24 + wide(meanings.map(([words]) => words));
    if (bar && gaps) [box.top, box.height] = [box.top + 16, box.height - 16];
    for (let i = 0; i < columns; i++) {
      for (let j = 0; j < rows; j++) {
        const [red, green, blue, known] = arrays.map.subarray(4 * (i * rows + j));
        context.fillStyle = known ? `rgb(${red},${green},${blue})` : stripes;
        context.fillRect(box.left + (i * box.width) / columns, box.top + box.height * (1 - (j + 1) / rows), box.width / columns + 0.6, box.height / rows + 0.6);
      }
    }
    const xs = cellAxis(across.values, across.unit);
    const ys = up ? cellAxis(up.values, up.unit) : { place: (v) => v, ticks: [] };
    frame(context, box, xs, ys);
    if (bar) {
      colorBar(context, box, bar, arrays.bar, study.measure);
      if (gaps) swatch(context, box.left, 2, ...meanings[0]);
    } else meanings.forEach(([words, color], i) => swatch(context, box.left + box.width + 8, box.top + 2 + 17 * i, words, color));
    below(context, width, height, `${nameOf(across, xs.unit)}: click a run`);
    if (up) beside(context, height, nameOf(up, ys.unit));
    this.shape = { box, columns, rows, across, up };
    if (this.at) {
      const [i, j] = this.at;
      context.strokeStyle = INK;
      context.lineWidth = 2.5;
      context.strokeRect(box.left + (i * box.width) / columns, box.top + box.height * (1 - (j + 1) / rows), box.width / columns, box.height / rows);
    }
  }

  moving() {}

  cell(x, y) {
    if (!this.shape) return null;
    const { box, columns, rows, across, up } = this.shape;
    const i = Math.min(Math.max(Math.floor(((x - box.left) / box.width) * columns), 0), columns - 1);
    const j = Math.min(Math.max(Math.floor((1 - (y - box.top) / box.height) * rows), 0), rows - 1);
    this.at = [i, j];
    return up ? { [across.dim]: i, [up.dim]: j } : { [across.dim]: i };
  }
}

// What a colour means.
function swatch(context, left, top, words, color) {
  context.fillStyle = color;
  context.fillRect(left, top, 11, 11);
  context.strokeStyle = GREY;
  context.lineWidth = 0.6;
  context.strokeRect(left, top, 11, 11);
  text(context, words, left + 15, top + 6);
}

// Stripes, where there is nothing to show.
export function hatching(context) {
  const tile = document.createElement("canvas");
  tile.width = tile.height = 6;
  const inside = contextOf(tile);
  inside.fillStyle = "#fff";
  inside.fillRect(0, 0, 6, 6);
  for (const shift of [-6, 0, 6]) line(inside, [[shift - 1, 7], [shift + 7, -1]], "#767676", 1.5);
  return context.createPattern(tile, "repeat");
}

// The colours of a measure and their values, to the right of a box.
function colorBar(context, box, axis, colors, words) {
  const left = box.left + box.width + 8, count = colors.length / 4;
  for (let i = 0; i < count; i++) {
    context.fillStyle = `rgb(${colors.subarray(4 * i, 4 * i + 3).join(",")})`;
    context.fillRect(left, box.top + box.height * (1 - (i + 1) / count), 10, box.height / count + 0.6);
  }
  for (const [value, label] of axis.ticks) {
    const y = box.top + box.height * (1 - axis.place(value));
    line(context, [[left + 10, y], [left + 13, y]], GREY);
    text(context, label, left + 16, y, { color: SOFT });
  }
  context.save();
  context.translate(widthOf(context) - 7, box.top + box.height / 2);
  context.rotate(-Math.PI / 2);
  text(context, words, 0, 0, { color: SOFT, align: "center" });
  context.restore();
}

const nameOf = (axis, unit) => `${axis.dim}${unit ? ` (${unit})` : ""}`;

export const VIEWS = { stability: StabilityMap, phase: PhasePortrait, damping: Damping, spectrogram: Spectrogram, numbers: null, study: StudyMap };

// A place at the side with tabs, of which one view is shown.
export class Panel {
  constructor(place, data, first, hooks) {
    Object.assign(this, { place, data, hooks, tabs: {} });
    const list = element("div", { role: "tablist" });
    list.setAttribute("role", "tablist");
    for (const [name, View] of Object.entries(VIEWS)) {
      if (name === "study" && !data.study) continue;
      const tab = element("button", { type: "button", textContent: View?.title ?? "Numbers" });
      tab.setAttribute("role", "tab");
      tab.dataset.view = name;
      tab.onclick = () => this.choose(name);
      this.tabs[name] = tab;
      list.append(tab);
    }
    list.onkeydown = (event) => this.key(event);
    this.canvas = element("canvas", { tabIndex: 0 });
    this.canvas.setAttribute("role", "img");
    this.numbers = element("div", { className: "numbers" });
    this.room = element("div", {}, this.canvas, this.numbers);
    place.append(list, this.room);
    this.layers = new Layers(this.canvas, (c, w, h) => this.draw(c, w, h), (c, w, h, now) => this.view?.moving(c, w, h, now));
    this.canvas.onpointerdown = this.canvas.onpointermove = this.canvas.onpointerup = (event) => this.point(event);
    this.canvas.onkeydown = (event) => this.steer(event);
    this.choose(first);
  }

  choose(name) {
    if (!Object.hasOwn(this.tabs, name)) name = "numbers"; // of a link
    this.name = name;
    this.view = VIEWS[name] ? new VIEWS[name]() : null;
    this.numbers.hidden = Boolean(this.view);
    this.layers.place.hidden = !this.view;
    this.canvas.ariaLabel = VIEWS[name]?.title ?? "Numbers"; // until it is drawn
    for (const [each, tab] of Object.entries(this.tabs)) {
      tab.setAttribute("aria-selected", String(each === name));
      tab.tabIndex = each === name ? 0 : -1;
    }
    this.layers.resize();
    this.refresh();
    this.hooks.needs();
  }

  draw(context, width, height) {
    if (!this.view) return;
    this.view.still(context, width, height, this.data);
    this.canvas.ariaLabel = `${VIEWS[this.name].title}: ${this.view.describe(this.data)}`;
  }

  key(event) {
    const names = Object.keys(this.tabs), step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    const next = names[(names.indexOf(this.name) + step + names.length) % names.length];
    this.choose(next);
    this.tabs[next].focus();
    event.preventDefault();
  }

  get asks() { return VIEWS[this.name]?.asks; }

  refresh() {
    this.layers.place.classList.toggle("stale", Boolean(this.data[this.asks]?.stale));
    if (this.view) this.layers.refresh();
    else this.list();
  }

  list() {
    const rows = (this.data.facts ?? []).map(({ name, text: words, value }) => {
      const cell = element("td", { textContent: words });
      cell.dataset.value = String(value);
      cell.dataset.name = name.trim();
      const before = this.data.pinned?.facts?.find((each) => each.name === name);
      return element("tr", {}, element("th", { textContent: name }), ...(before ? [element("td", { textContent: before.text })] : []), cell);
    });
    const head = this.data.pinned ? [element("tr", {}, element("th"), element("td", { textContent: "A" }), element("td", { textContent: "B, now" }))] : [];
    this.numbers.replaceChildren(element("table", {}, ...head, ...rows));
  }

  point(event) {
    const box = this.canvas.getBoundingClientRect(), x = event.clientX - box.left - 1, y = event.clientY - box.top - 1;
    if (event.type === "pointerdown") this.canvas.setPointerCapture(event.pointerId);
    if (this.view instanceof StabilityMap && (event.buttons || event.type === "pointerup")) {
      const found = this.view.pick(x, y);
      if (found) this.hooks.place(found, event.type === "pointerup");
    }
    if (this.view instanceof StudyMap && event.type === "pointerdown") {
      const at = this.view.cell(x, y);
      if (at) this.hooks.pick(at);
      this.refresh();
    }
  }

  // The arrow keys move the point of the stability map.
  steer(event) {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!way || !(this.view instanceof StabilityMap) || !this.view.axes || !this.data.own) return;
    const { x, y } = this.view.place(this.data.own), step = event.shiftKey ? 12 : 3;
    this.hooks.place(this.view.pick(x + step * way[0], y + step * way[1]), true);
    event.preventDefault();
  }
}

function extent(values) {
  let low = Infinity, high = -Infinity;
  for (const value of values) { if (value < low) low = value; if (value > high) high = value; }
  return [low, high];
}

// matplotlib's viridis at 17 equal steps, as in the figure of a spectrogram
const VIRIDIS = [
  [68, 1, 84], [71, 24, 106], [71, 44, 123], [66, 64, 133], [58, 82, 139], [50, 98, 141],
  [44, 114, 142], [38, 129, 142], [32, 144, 140], [30, 159, 136], [40, 174, 127], [62, 188, 115],
  [94, 201, 97], [131, 211, 75], [173, 220, 48], [215, 226, 25], [253, 231, 36],
];

function viridis(share) {
  const place = share * (VIRIDIS.length - 1), i = Math.min(Math.floor(place), VIRIDIS.length - 2);
  return VIRIDIS[i].map((a, k) => Math.round(a + (place - i) * (VIRIDIS[i + 1][k] - a)));
}

// Amplitudes as an image: 70 dB from the strongest down.
function shaded(amplitude, rows, columns) {
  const image = document.createElement("canvas");
  image.width = columns;
  image.height = rows;
  const context = image.getContext("2d"), pixels = context.createImageData(columns, rows);
  let most = 0;
  for (const value of amplitude) if (value > most) most = value;
  const colors = Array.from({ length: 256 }, (_, i) => viridis(i / 255));
  for (let i = 0; i < rows; i++) {
    for (let j = 0; j < columns; j++) {
      const level = 1 + Math.log10(Math.max(amplitude[i * columns + j], 1e-30) / (most || 1)) / 3.5;
      const color = colors[Math.round(255 * Math.min(Math.max(level, 0), 1))];
      pixels.data.set([...color, 255], 4 * ((rows - 1 - i) * columns + j));
    }
  }
  context.putImageData(pixels, 0, 0);
  return image;
}

function wrapped(words) {
  return words.replace(/(.{1,42})(\s|$)/g, "$1\n").trim();
}
