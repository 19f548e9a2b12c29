// The time series of Fig. 3: strips over a common time, each curve as what a column of pixels holds.

import { linearAxis, logAxis, padded } from "./axis.js";
import { BLUE, GREEN, GREY, INK, Layers, ORANGE, PURPLE, RED, SKY, SOFT, curve, frame, line, offsets, rest, symbols, text } from "./drawing.js";
import { quantity } from "./quantity.js";

const LEFT = 62, RIGHT = 12, TOP = 22, BOTTOM = 34, GAP = 5;
const PALE = 0.3; // of what reaches down to rest
const STRIPS = [
  { name: "force", unit: "N", share: 1.5, curves: [["spring_y", ORANGE, "k_y u_y"], ["spring_x", RED, "k_x u_x"]] },
  { name: "F", unit: "N", share: 0.8, curves: [["friction", PURPLE, "F"]] },
  { name: "ψ", unit: "deg", share: 0.9, curves: [["psi", BLUE, "ψ"]] },
  { name: "X", unit: "m", share: 0.9, least: 1e-12, curves: [["X", INK, "X"]] },
  { name: "slip", unit: "m/s", share: 1.1, log: true, curves: [["slip_speed", GREEN, "slip speed"]] },
];

export class Series {
  constructor(canvas, hooks) {
    this.hooks = hooks;
    this.layers = new Layers(canvas, (...a) => this.still(...a), (...a) => this.moving(...a));
    this.layers.onresize = () => hooks.resized?.();
    this.listen(canvas);
  }

  get columns() {
    return Math.max(Math.round((this.layers.width - LEFT - RIGHT) * this.layers.ratio), 64);
  }

  // Show curves: those of the run (b), of the pinned one (a), and measured ones.
  show(part, answer) {
    this[part] = answer;
    this.layers.refresh();
  }

  get window() { return this.b?.window ?? [0, 1]; }

  still(context, width, height) {
    if (!this.b) return;
    const inner = width - LEFT - RIGHT, [low, high] = this.window;
    const strips = this.strips(), total = strips.reduce((sum, each) => sum + each.share, 0);
    const room = height - TOP - BOTTOM - GAP * (strips.length - 1);
    const time = linearAxis(low, high, Math.max(2, inner / 90), "");
    let top = TOP;
    this.boxes = [];
    strips.forEach((strip, i) => {
      const box = { left: LEFT, top, width: inner, height: (room * strip.share) / total };
      const last = i === strips.length - 1;
      const axis = this.range(strip, box);
      this.shade(context, box);
      const xs = last ? time : { ...time, ticks: time.ticks.map(([at]) => [at, ""]) };
      const { x, y } = frame(context, box, xs, axis);
      context.save();
      context.beginPath();
      context.rect(box.left, box.top, box.width, box.height);
      context.clip();
      this.curves(context, strip, x, y);
      context.restore();
      offsets(context, box, {}, axis);
      this.words(context, strip, axis, box);
      this.boxes.push({ box, x });
      top += box.height + GAP;
    });
    this.legend(context, width);
    text(context, "time t (s)", LEFT + inner / 2, height - 8, { align: "center", color: SOFT });
  }

  strips() {
    const found = STRIPS.slice(), load = this.b.arrays.normal_load;
    if (load && extent([load]).span > 1e-9 * Math.abs(load[0])) {
      found.push({ name: "W", unit: "N", share: 0.7, curves: [["normal_load", GREY, "W"]] });
    }
    return found;
  }

  parts() {
    return [["measured", this.measured], ["a", this.a], ["b", this.b]].filter(([, each]) => each && same(each.window, this.window));
  }

  range(strip, box) {
    const arrays = this.parts().flatMap(([, part]) => strip.curves.map(([name]) => part.arrays[name])).filter(Boolean);
    let { low, high, least } = extent(arrays);
    if (high - low < strip.least) [low, high] = [low - strip.least, high + strip.least]; // rounding
    if (strip.log) {
      const top = 10 ** Math.ceil(Math.log10(Math.max(high, 1e-12)) + 0.02);
      return logAxis(Math.max(Math.min(10 ** Math.floor(Math.log10(least || top)), top / 100), top * 1e-8), top, strip.unit, box.height / 16);
    }
    return linearAxis(...padded(low, high, 0.06), box.height / 22, strip.unit);
  }

  // Shade each column by the share of its time in which the mass is at rest.
  shade(context, box) {
    const share = this.b.arrays.stuck;
    if (!share) return;
    const step = box.width / share.length;
    for (let i = 0; i < share.length; i++) {
      if (!(share[i] > 0.002)) continue;
      context.fillStyle = rest(share[i]);
      context.fillRect(box.left + i * step, box.top, step + 0.5, box.height);
    }
  }

  curves(context, strip, x, y) {
    const [low, high] = this.window;
    for (const [part, answer] of this.parts()) {
      const places = answer.arrays.column, columns = this.columnsOf(answer);
      for (const [name, color] of strip.curves) {
        const values = answer.arrays[name];
        if (!values) continue;
        const at = (i) => x(low + ((places[i >> 2] + 0.5) / columns) * (high - low));
        const opaque = part === "a" ? 0.55 : 1, wide = part === "measured" ? 1.6 : 1.2;
        context.setLineDash(part === "a" ? [5, 3] : []);
        const shade = part === "b" ? color : part === "a" ? "#444b53" : SKY;
        context.globalAlpha = opaque * (strip.log ? PALE : 1);
        curve(context, 4 * places.length, (i) => [at(i), y(values[i])], shade, wide);
        context.globalAlpha = opaque; // of slips between rests, each column is full: a line has their largest
        if (strip.log) curve(context, places.length, (i) => [at(4 * i), y(values[4 * i + 2])], shade, wide);
        context.globalAlpha = 1;
        context.setLineDash([]);
      }
    }
  }

  columnsOf(answer) { return answer.arrays.stuck?.length ?? answer.columns ?? this.columns; }

  words(context, strip, axis, box) {
    const unit = axis.unit && axis.unit !== "1" ? ` (${axis.unit})` : "";
    context.save();
    context.translate(10, box.top + box.height / 2);
    context.rotate(-Math.PI / 2);
    text(context, `${strip.name}${unit}`, 0, 0, { color: SOFT, align: "center" });
    context.restore();
  }

  // What the colours mean, above the strips.
  legend(context, width) {
    let left = LEFT;
    const add = (words, color, { dash = [], band = false } = {}) => {
      if (band) {
        context.fillStyle = color;
        context.fillRect(left, 6, 18, 11);
      } else line(context, [[left, 11.5], [left + 18, 11.5]], color, 2, dash);
      left += 23 + symbols(context, words, left + 23, 11, { color: INK }) + 16;
    };
    for (const [, color, label] of [...STRIPS[0].curves].reverse()) add(label, color);
    const words = "at rest (paler: for a part of the time)";
    const narrow = left + 23 + 7 * words.length > width - RIGHT; // of letters some 6.5 px wide
    add(narrow ? "at rest" : words, rest(), { band: true });
    if (this.a) add("A", "#444b53", { dash: [5, 3] });
    if (this.measured) add(this.measured.origin, SKY);
  }

  moving(context, width, height, now) {
    if (!this.boxes?.length || !this.b) return;
    const at = this.boxes[0].x(now.t);
    if (now.micro && now.micro[1] > now.micro[0]) {
      const [a, b] = now.micro.map(this.boxes[0].x);
      context.fillStyle = "rgba(230,159,0,.25)";
      const wide = Math.max(b - a, 3);
      context.fillRect((a + b - wide) / 2, TOP, wide, height - TOP - BOTTOM);
    }
    if (at < LEFT - 1 || at > width - RIGHT + 1) return;
    line(context, [[at, TOP], [at, height - BOTTOM]], INK, 1.2);
    if (this.hover !== undefined) text(context, quantity(this.hover, "s", 6), at, height - 8, { align: "center" });
  }

  listen(canvas) {
    const timeAt = (event) => {
      const { left } = canvas.getBoundingClientRect(), [low, high] = this.window;
      const place = (event.clientX - left - 1 - LEFT) / (this.layers.width - LEFT - RIGHT);
      return low + Math.min(Math.max(place, 0), 1) * (high - low);
    };
    canvas.onpointerdown = (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.from = event.shiftKey ? timeAt(event) : undefined;
      if (this.from === undefined) this.hooks.seek(timeAt(event));
    };
    canvas.onpointermove = (event) => {
      if (event.buttons && this.from === undefined) this.hooks.seek(timeAt(event));
    };
    canvas.onpointerup = (event) => {
      if (this.from === undefined) return;
      const to = timeAt(event);
      if (to !== this.from) this.hooks.window([Math.min(this.from, to), Math.max(this.from, to)]);
      this.from = undefined;
    };
    canvas.ondblclick = () => this.hooks.window(null);
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(Math.sign(event.deltaY) * 0.35), timeAt(event));
    }, { passive: false });
    canvas.onkeydown = (event) => this.key(event);
  }

  zoom(factor, about) {
    const [low, high] = this.window;
    this.hooks.window([about - (about - low) * factor, about + (high - about) * factor]);
  }

  key(event) {
    const [low, high] = this.window, span = high - low;
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (step) this.hooks.seek(this.hooks.now() + (step * span) / (event.shiftKey ? 20 : 200));
    else if (event.key === "+" || event.key === "=") this.zoom(0.5, this.hooks.now());
    else if (event.key === "-") this.zoom(2, this.hooks.now());
    else if (event.key === "Home") this.hooks.window(null);
    else return;
    event.preventDefault();
  }
}

function same(a, b) {
  const span = b[1] - b[0];
  return Math.abs(a[0] - b[0]) < 1e-6 * span && Math.abs(a[1] - b[1]) < 1e-6 * span;
}

function extent(arrays) {
  let low = Infinity, high = -Infinity, least = Infinity;
  for (const values of arrays) {
    for (const value of values) {
      if (value < low) low = value;
      if (value > high) high = value;
      if (value > 0 && value < least) least = value;
    }
  }
  if (!(high >= low)) [low, high] = [0, 1];
  return { low, high, least: isFinite(least) ? least : 0, span: high - low };
}
