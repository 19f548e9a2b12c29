// A few periods of the fast oscillation about the present time: slip speed and direction of friction.

import { linearAxis, padded } from "./axis.js";
import { BLUE, GREEN, INK, Layers, SOFT, curve, frame, line, note, offsets, rest, text, textWidth } from "./drawing.js";
import { quantity } from "./quantity.js";

const SLOWEST = 1e-12; // m/s: slower is rest, and rounding
const LEFT = 66, RIGHT = 10, TOP = 4, BOTTOM = 22, GAP = 4;

export class Microscope {
  constructor(canvas, hooks) {
    this.layers = new Layers(canvas, (...a) => this.still(...a), (...a) => this.moving(...a));
    canvas.onpointerdown = canvas.onpointermove = (event) => {
      if (!this.track || (event.type === "pointermove" && !event.buttons)) return;
      const { left } = canvas.getBoundingClientRect();
      const place = (event.clientX - left - 1 - LEFT) / (this.layers.width - LEFT - RIGHT);
      hooks.seek(this.track.start + Math.min(Math.max(place, 0), 1) * (this.track.end - this.track.start));
    };
  }

  show(track) {
    this.track = track;
    this.words = undefined;
    this.layers.place.classList.remove("stale");
    this.layers.refresh();
  }

  // Mark what is shown as of the run before; of another system, take it away.
  outdate(another, words = "computing …") {
    if (another) this.track = undefined;
    if (another && this.words !== words) this.layers.refresh();
    this.words = words;
    this.layers.place.classList.toggle("stale", Boolean(this.track));
  }

  still(context, width, height) {
    if (!this.track) return note(context, width, height, this.words ?? "");
    const { time, columns } = this.track, inner = width - LEFT - RIGHT;
    const middle = 0.5 * (this.track.start + this.track.end);
    const room = (height - TOP - BOTTOM - GAP) / 2;
    const speeds = columns.slip_x.map((x, i) => Math.hypot(x, columns.slip_y[i]));
    const rows = [["slip", speeds, GREEN, "m/s", 0], ["θ", columns.theta, BLUE, "deg", null]];
    const t = linearAxis(this.track.start - middle, this.track.end - middle, 5, "s");
    rows.forEach(([name, values, color, unit, least], i) => {
      const box = { left: LEFT, top: TOP + i * (room + GAP), width: inner, height: room };
      let low = Infinity, high = -Infinity;
      for (const value of values) { if (value < low) low = value; if (value > high) high = value; }
      if (least !== null) [low, high] = [least, Math.max(high, SLOWEST)];
      const [under, over] = padded(low, high, 0.07), axis = linearAxis(least ?? under, over, room / 24, unit);
      this.rests(context, box);
      const { x, y } = frame(context, box, i ? t : { ...t, ticks: t.ticks.map(([at]) => [at, ""]) }, axis);
      curve(context, time.length, (k) => [x(time[k] - middle), y(values[k])], color, 1.4);
      offsets(context, box, {}, axis);
      const words = `${name} (${axis.unit})`, fits = Math.min(1, room / textWidth(words)); // not over those of the next
      context.save();
      context.translate(9, box.top + room / 2);
      context.rotate(-Math.PI / 2);
      context.scale(fits, fits);
      text(context, words, 0, 0, { color, align: "center" });
      context.restore();
    });
    const [[at, first]] = t.ticks, beside = LEFT + inner * t.place(at) - textWidth(first) / 2 - 4; // not over the first number
    text(context, t.unit, Math.min(LEFT - 6, beside), height - 12, { color: SOFT, align: "right" });
  }

  // Shade the rests.
  rests(context, box) {
    const { time, columns } = this.track, span = this.track.end - this.track.start;
    const x = (t) => box.left + (box.width * (t - this.track.start)) / span;
    context.fillStyle = rest();
    let from = -1;
    for (let k = 0; k <= time.length; k++) {
      const still = k < time.length && columns.sticking[k] > 0;
      if (still && from < 0) from = k;
      if (!still && from >= 0) {
        context.fillRect(x(time[from]), box.top, Math.max(x(time[k - 1]) - x(time[from]), 1), box.height);
        from = -1;
      }
    }
  }

  moving(context, width, height, now) {
    if (!this.track?.holds(now.t)) return;
    const place = (now.t - this.track.start) / (this.track.end - this.track.start);
    const at = LEFT + place * (width - LEFT - RIGHT);
    line(context, [[at, TOP], [at, height - BOTTOM]], INK, 1.2);
  }
}

export function spanText(width) {
  return `${quantity(width, "s", 3)} wide`;
}
