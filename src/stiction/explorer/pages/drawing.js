// Drawing on canvases: sizes in CSS pixels, sharp on any screen; colours for any colour vision.

// Okabe & Ito, "Color Universal Design" (2008), as in the package's figures
export const INK = "#16191d", SOFT = "#5a6068", PALE = "#e9e9e9", BLUE = "#0072b2", RED = "#d55e00",
  GREEN = "#009e73", ORANGE = "#e69f00", SKY = "#56b4e9", PURPLE = "#b05a8a", GREY = "#6e6e6e",
  FLOOR = "#f5f4f0", UNSTABLE = "#f9e3c5";
// The shade of a share of the time at rest: curves over it keep their contrast.
export const rest = (share = 1) => `rgba(110,110,110,${(0.15 * Math.sqrt(share)).toFixed(3)})`;
// Letters need more contrast than curves: 4.5 : 1 on the floor (WCAG 2.2, 1.4.3).
export const LETTERS = { [RED]: "#b34d00", [GREEN]: "#00714f", [ORANGE]: "#8f5f00", [PURPLE]: "#99487a" };
export const FONT = '12px system-ui, "Segoe UI", "DejaVu Sans", sans-serif';
const DIGIT = 9; // px, the height of its digits
export const SERIF = 'italic 14px "STIX Two Text", "DejaVu Serif", Georgia, serif';

// In a dark page a colour is as light as its negative on a ground of 8 %, and keeps its hue.
const DARK = matchMedia("(prefers-color-scheme: dark)");
const shades = new Map();
let dark = DARK.matches; // who asks it between a change and its event takes the event away
DARK.addEventListener("change", (event) => { dark = event.matches; });

export function shade(color) {
  if (!dark || typeof color !== "string") return color; // a pattern has colours of its own
  if (!shades.has(color)) shades.set(color, negative(color));
  return shades.get(color);
}

function negative(color) {
  const parts = color.startsWith("#")
    ? (color.length < 7 ? color.match(/\w/g).map((each) => each + each) : color.match(/\w\w/g)).map((each) => parseInt(each, 16))
    : color.match(/[\d.]+/g).map(Number);
  const [red, green, blue, alpha = 1] = parts;
  const lightness = 0.213 * red + 0.715 * green + 0.072 * blue;
  const turned = [red, green, blue].map((each) => Math.round(0.92 * 255 + 0.84 * (each - 2 * lightness)));
  return `rgba(${turned.join(",")},${alpha})`;
}

// The context of a canvas whose colours are as light or dark as the page.
export function contextOf(canvas) {
  const context = canvas.getContext("2d");
  for (const name of ["fillStyle", "strokeStyle"]) {
    const { get, set } = Object.getOwnPropertyDescriptor(CanvasRenderingContext2D.prototype, name);
    Object.defineProperty(context, name, { get, set(color) { set.call(this, shade(color)); } });
  }
  return context;
}

// Two canvases, one over the other: what changes with the run below, and what moves.
export class Layers {
  constructor(canvas, still, moving) {
    Object.assign(this, { canvas, still, moving });
    this.context = contextOf(canvas);
    this.back = document.createElement("canvas");
    this.below = contextOf(this.back);
    this.back.id = canvas.id && `${canvas.id}-still`;
    this.back.ariaHidden = "true";
    this.place = document.createElement("div");
    this.place.className = "layers";
    canvas.replaceWith(this.place);
    this.place.append(this.back, canvas);
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(this.place);
    DARK.addEventListener("change", () => this.refresh());
    this.resize();
  }

  resize() {
    const ratio = window.devicePixelRatio || 1;
    const box = this.place.getBoundingClientRect();
    this.width = Math.max(box.width - 2, 10);
    this.height = Math.max(box.height - 2, 10);
    this.ratio = ratio;
    for (const each of [this.canvas, this.back]) {
      each.width = Math.round(this.width * ratio);
      each.height = Math.round(this.height * ratio);
    }
    this.onresize?.();
    this.refresh();
  }

  // Draw both layers anew, at the next frame.
  refresh() { this.stale = true; }

  // Draw the layer that moves, after the other if it is stale; nothing, if nothing has changed.
  draw(now, key) {
    if (!this.stale && key === this.key) return;
    this.key = key;
    if (this.stale) {
      prepare(this.below, this);
      this.still(this.below, this.width, this.height);
      this.stale = false;
      this.drawn = (this.drawn ?? 0) + 1;
    }
    prepare(this.context, this);
    this.moving?.(this.context, this.width, this.height, now);
  }
}

function prepare(context, layers) {
  context.setTransform(layers.ratio, 0, 0, layers.ratio, 0, 0);
  context.clearRect(0, 0, layers.width, layers.height);
  context.font = FONT;
  context.lineJoin = "bevel"; // round ones take most of the time
  context.textBaseline = "middle";
  context.textAlign = "left";
  context.globalAlpha = 1;
  context.setLineDash([]);
}

// Stroke a curve: pairs of pixels from `point(i)`, NaN for a gap. Points that fall on the last one
// are left out, which covers the same pixels.
export function curve(context, count, point, color, width = 1) {
  context.beginPath();
  let x = NaN, y = NaN, drawing = false;
  for (let i = 0; i < count; i++) {
    const [u, v] = point(i);
    if (!(v === v)) { drawing = false; continue; }
    if (!drawing) context.moveTo(u, v);
    else if (i < count - 1 && Math.abs(u - x) < 0.4 && Math.abs(v - y) < 0.4) continue;
    else context.lineTo(u, v);
    drawing = true;
    x = u;
    y = v;
  }
  context.strokeStyle = color;
  context.lineWidth = width;
  context.stroke();
}

export function line(context, points, color, width = 1, dash = []) {
  context.beginPath();
  points.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.strokeStyle = color;
  context.lineWidth = width;
  context.setLineDash(dash);
  context.stroke();
  context.setLineDash([]);
}

export function arrow(context, [x0, y0], [x1, y1], color, width = 2.5) {
  const length = Math.hypot(x1 - x0, y1 - y0);
  if (length < 1) return;
  const head = Math.min(9 + width, length), c = (x1 - x0) / length, s = (y1 - y0) / length;
  line(context, [[x0, y0], [x1 - 0.8 * head * c, y1 - 0.8 * head * s]], color, width);
  context.beginPath();
  context.moveTo(x1, y1);
  context.lineTo(x1 - head * c + 0.42 * head * s, y1 - head * s - 0.42 * head * c);
  context.lineTo(x1 - head * c - 0.42 * head * s, y1 - head * s + 0.42 * head * c);
  context.closePath();
  context.fillStyle = color;
  context.fill();
}

export function text(context, words, x, y, { color = INK, align = "left", font = FONT, halo = false } = {}) {
  context.font = font;
  context.textAlign = align;
  if (halo) {
    context.strokeStyle = "rgba(255,255,255,.85)";
    context.lineWidth = 4;
    context.strokeText(words, x, y);
  }
  context.fillStyle = LETTERS[color] ?? color;
  context.fillText(words, x, y);
  context.font = FONT;
}

const ruler = document.createElement("canvas").getContext("2d");
ruler.font = FONT;

// The width of words in CSS pixels.
export const textWidth = (words) => ruler.measureText(words).width;

// Words in which an underscore begins an index: "k_x u_x".
export function symbols(context, words, x, y, { color = INK, align = "left", halo = false, size = 13 } = {}) {
  const parts = words.split(/(_\w+)/).filter(Boolean).map((part) => (part[0] === "_" ? [part.slice(1), true] : [part, false]));
  const font = (low) => `italic ${low ? 0.75 * size : size}px "STIX Two Text", "DejaVu Serif", Georgia, serif`;
  const widths = parts.map(([part, low]) => { context.font = font(low); return context.measureText(part).width; });
  const total = widths.reduce((a, b) => a + b, 0);
  let at = x - (align === "right" ? total : align === "center" ? total / 2 : 0);
  parts.forEach(([part, low], i) => {
    text(context, part, at, y + (low ? 0.28 * size : 0), { color, font: font(low), halo });
    at += widths[i];
  });
  return total;
}

// One view that waits, or has nothing to show, says so.
export function note(context, width, height, words) {
  const parts = words.split("\n");
  parts.forEach((each, i) => text(context, each, width / 2, height / 2 + 18 * (i - (parts.length - 1) / 2), { align: "center", color: SOFT }));
}

// The width of a canvas in CSS pixels.
export const widthOf = (context) => context.canvas.width / context.getTransform().a;

// Frame of a plot with ticks; returns the functions from values to pixels.
export function frame(context, box, xs, ys) {
  const { left, top, width, height } = box;
  context.strokeStyle = "#9aa0a6";
  context.lineWidth = 1;
  context.strokeRect(left + 0.5, top + 0.5, width - 1, height - 1);
  const x = (value) => left + width * xs.place(value), y = (value) => top + height * (1 - ys.place(value));
  for (const [value, label] of xs.ticks) {
    line(context, [[x(value), top + height], [x(value), top + height - 4]], GREY);
    const half = context.measureText(label).width / 2; // the last one may end before the frame does
    text(context, label, Math.min(x(value), widthOf(context) - half - 1), top + height + 9, { align: "center", color: SOFT });
  }
  const levels = ys.ticks.map(([value]) => y(value));
  ys.ticks.forEach(([, label], i) => {
    line(context, [[left, levels[i]], [left + 4, levels[i]]], GREY);
    const beside = Math.min(Math.max(levels[i], top + 6), top + height - 6); // not over another frame's
    const over = levels.some((level, j) => j !== i && Math.abs(level - beside) < DIGIT); // its neighbour
    if (!over) text(context, label, left - 4, beside, { align: "right", color: SOFT });
  });
  return { x, y };
}

// What the ticks of a frame are counted from, over its curves.
export function offsets(context, { left, top, width, height }, xs, ys) {
  if (ys.offset) text(context, ys.offset, left + 7, top + 9, { color: SOFT, halo: true });
  if (xs.offset) text(context, xs.offset, left + width - 7, top + height - 9, { align: "right", color: SOFT, halo: true });
}
