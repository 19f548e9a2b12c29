// The apparatus from above: plate, springs, mass, slip velocity, friction force inside its limit.
//
// Drawn in the frame of the spring's far end. X, the drive direction, points to the right; the axes
// x and y of the spring lie at -phi to it. Elongations are magnified, each axis by a round factor
// that the picture states.

import { BLUE, FLOOR, GREEN, GREY, INK, Layers, ORANGE, PURPLE, RED, SERIF, SOFT, arrow, line, symbols, text } from "./drawing.js";
import { plain, quantity, unrounded } from "./quantity.js";

const BLOCK = 27; // half side of the mass, px
const PIXEL = 0.0254 / 96; // m, of CSS
const SLOWEST = 1e-12; // m/s: slower is rest, and rounding
const NARROW = 600; // px: in a narrower scene the spring across lies below the words, not behind them
const WORDS = 50; // px, what they take from the height then
const BESIDE = 500; // px: in a narrower scene two texts of the lowest line would overlap

export class Scene {
  constructor(canvas) {
    this.layers = new Layers(canvas, () => {}, (...a) => this.moving(...a));
  }

  show(scene, track) {
    this.scene = scene;
    this.track = track;
    const { width, height } = this.layers;
    this.lengths = { x: track.largest("u_x"), y: track.largest("u_y") };
    this.size = { width, height };
    this.largestSlip = track.largest("slip_x") + track.largest("slip_y");
  }

  // Magnifications, so that the largest elongations fit; nearly equal ones are made equal.
  magnification(width, height) {
    const c = Math.abs(Math.cos(this.scene.phi)), n = Math.abs(Math.sin(this.scene.phi)), found = {};
    const along = (c, n) => Math.min((0.2 * width) / Math.max(c, 1e-9), (0.17 * height) / Math.max(n, 1e-9));
    const room = { x: along(c, n), y: along(n, c) };
    for (const axis of ["x", "y"]) found[axis] = rounded((room[axis] / (this.lengths[axis] || room[axis])) * PIXEL) / PIXEL;
    if (Math.max(found.x, found.y) < 12 * Math.min(found.x, found.y)) found.x = found.y = Math.min(found.x, found.y);
    return found;
  }

  moving(context, width, height, now) {
    if (!this.scene || !now.state) return;
    const top = width < NARROW ? WORDS : 0, tall = height - top;
    const s = now.state, { scene } = this, M = this.magnification(width, tall);
    const c = Math.cos(scene.phi), n = Math.sin(scene.phi);
    const turn = (x, y) => [x * c + y * n, -(-x * n + y * c)]; // to the screen, y downwards
    const home = [0.43 * width, top + 0.56 * tall];
    const [dx, dy] = turn(-M.x * s.u_x, -M.y * s.u_y);
    const mass = [home[0] + dx, home[1] + dy];
    this.floor(context, width, height, s, M);
    this.springs(context, width, height, top, home, mass, turn, M);
    this.dampers(context, tall, home, mass, turn);
    this.forces(context, height, tall, mass, s, turn);
    this.block(context, mass, turn, s);
    this.words(context, width, height, s, M);
  }

  // The plate below the mass: it moves against X.
  floor(context, width, height, s, M) {
    context.fillStyle = FLOOR;
    context.fillRect(0, 0, width, height);
    const travel = this.travel(s), step = 46;
    const shift = ((-M.x * travel) % step + step) % step;
    context.fillStyle = "#d9d5c8";
    for (let x = shift - step, i = 0; x < width + step; x += step, i++) {
      for (let y = 12; y < height; y += step) {
        context.beginPath();
        context.arc(x, y, 2, 0, 2 * Math.PI);
        context.fill();
      }
    }
  }

  travel(s) { // of the drive: X plus the elongation along it
    const c = Math.cos(this.scene.phi), n = Math.sin(this.scene.phi);
    return s.X + s.u_x * c + s.u_y * n;
  }

  springs(context, width, height, top, home, mass, turn, M) {
    // as long as the picture has room, however far the springs are turned
    const axes = { x: turn(1, 0), y: turn(0, 1) }, across = { x: axes.y, y: axes.x }, ends = {}, reaches = {};
    const room = { left: 0.06 * width, right: 0.94 * width, top: top + 16, bottom: height - 26 };
    for (const [axis, other] of [["x", "y"], ["y", "x"]]) {
      const reach = M[other] * this.lengths[other] + 22;
      const way = across[axis], most = [-1, 1].map((side) => 0.8 * distance(home, times(way, side), room));
      reaches[axis] = [-Math.min(reach, most[0]), Math.min(0.6 * reach, most[1])];
      const from = [0, ...reaches[axis]].map((far) => distance(add(home, times(way, far)), axes[axis], room));
      ends[axis] = add(home, times(axes[axis], Math.min(...from)));
    }
    for (const axis of ["x", "y"]) {
      const wall = ends[axis], way = across[axis];
      const start = add(mass, axis === "x" ? turn(BLOCK, 0) : turn(0, BLOCK));
      // the far end slides along its wall: a spring pulls along its own axis alone
      const offset = project(sub(mass, home), way);
      const end = add(wall, times(way, offset));
      line(context, reaches[axis].map((far) => add(wall, times(way, far))), GREY, 5);
      zigzag(context, start, end, axis === "x" ? 11 : 8, axis === "x" ? RED : ORANGE, axis === "x" ? 2 : 3.5);
      const label = mix(start, end, 0.5);
      const beside = axis === "x" ? add(label, [0, -22]) : add(label, [22, 0]);
      symbols(context, `k_${axis}`, ...beside, { size: 15, color: axis === "x" ? RED : ORANGE, halo: true });
    }
    context.setLineDash([3, 4]);
    context.strokeStyle = GREY;
    context.strokeRect(home[0] - BLOCK, home[1] - BLOCK, 2 * BLOCK, 2 * BLOCK);
    context.setLineDash([]);
  }

  // Dampers with axes of their own, away from the springs; the far end moves with theirs.
  dampers(context, tall, home, mass, turn) {
    for (const [name, angle] of this.scene.dampers) {
      const away = Math.cos(angle) + Math.sin(angle) > 0 ? -1 : 1, far = 0.36 * tall;
      const way = turn(away * Math.cos(angle), away * Math.sin(angle)), across = [-way[1], way[0]];
      const wall = add(home, [far * way[0], far * way[1]]);
      line(context, [-14, 14].map((side) => add(wall, [side * across[0], side * across[1]])), GREY, 5);
      dashpot(context, mass, wall);
      symbols(context, name, ...add(wall, [16 * way[0] - 6, 16 * way[1]]), { size: 15, halo: true });
    }
  }

  block(context, mass, turn, s) {
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => add(mass, turn(BLOCK * x, BLOCK * y)));
    context.beginPath();
    corners.forEach((p, i) => (i ? context.lineTo(...p) : context.moveTo(...p)));
    context.closePath();
    context.fillStyle = s.sticking ? "rgba(70,74,80,.62)" : "rgba(205,208,212,.62)";
    context.fill();
    context.strokeStyle = INK;
    context.lineWidth = 1.4;
    context.stroke();
  }

  // The limit of friction about the mass, the force in it, the slip velocity.
  forces(context, height, tall, mass, s, turn) {
    const { limit, ellipse: [ratio, angle] } = this.scene;
    const load = s.normal_load, radius = 0.3 * tall;
    const largest = limit * this.track.largest("normal_load") * Math.max(ratio, 1) || 1;
    const scale = radius / largest;
    context.beginPath();
    for (let i = 0; i <= 90; i++) {
      const a = (i / 90) * 2 * Math.PI;
      const [p, q] = [limit * load * Math.cos(a), ratio * limit * load * Math.sin(a)];
      const X = p * Math.cos(angle) - q * Math.sin(angle), Y = p * Math.sin(angle) + q * Math.cos(angle);
      const at = add(mass, [scale * X, -scale * Y]);
      if (i) context.lineTo(...at);
      else context.moveTo(...at);
    }
    context.fillStyle = "rgba(176,90,138,.09)";
    context.fill();
    context.strokeStyle = PURPLE;
    context.lineWidth = 1.3;
    context.stroke();
    if (s.theta === s.theta) {
      const theta = (s.theta * Math.PI) / 180;
      const tip = turn(-scale * s.friction * Math.cos(theta), -scale * s.friction * Math.sin(theta));
      const end = add(mass, tip);
      arrow(context, mass, end, PURPLE, 4);
      const [across, down] = add(mass, [1.13 * tip[0], 1.13 * tip[1]]);
      const low = height - 46; // below are words: there the name stands beside the arrow
      text(context, "F", across + (down > low ? 16 : 0), Math.min(Math.max(down, 10), low), { font: SERIF, color: PURPLE, align: "center", halo: true });
    }
    const speed = Math.hypot(s.slip_x, s.slip_y);
    if (speed > SLOWEST && !s.sticking) {
      const long = BLOCK + (0.24 * tall) * Math.min(1, 0.25 * Math.max(0, Math.log10(speed / (this.largestSlip || speed)) + 4));
      const way = turn(s.slip_x / speed, s.slip_y / speed), end = add(mass, [long * way[0], long * way[1]]);
      arrow(context, mass, end, GREEN, 3);
      text(context, "slip", ...add(end, [14 * way[0], 14 * way[1] - 3]), { color: GREEN, align: "center", halo: true });
    }
  }

  // Which way plate and drive move, over what reaches there.
  ways(context, height) {
    const base = height - 16;
    arrow(context, [206, base], [160, base], GREY, 1.6);
    text(context, "plate", 212, base, { color: GREY, halo: true });
    arrow(context, [14, base], [60, base], BLUE, 1.6);
    text(context, "X, drive", 66, base, { color: BLUE, halo: true });
  }

  words(context, width, height, s, M) {
    this.ways(context, height);
    const speed = Math.hypot(s.slip_x, s.slip_y), u = unrounded(s.u_x, this.lengths.x);
    const psi = unrounded(s.theta - (this.scene.phi * 180) / Math.PI, 180);
    const rows = [
      ["slip speed", s.sticking ? "0 (at rest)" : quantity(speed, "m/s"), GREEN],
      ["friction F", `${quantity(s.friction, "N")}, ψ = ${plain(psi, 4)}°`, PURPLE],
      ["k_x u_x", quantity(this.scene.k[0] * u, "N"), RED],
    ];
    context.fillStyle = FLOOR; // a wall may be there
    context.globalAlpha = 0.85;
    context.fillRect(6, 5, 86 + Math.max(...rows.map(([, value]) => context.measureText(value).width)), 56);
    context.globalAlpha = 1;
    rows.forEach(([name, value, color], i) => {
      symbols(context, name, 12, 15 + 18 * i, { color, halo: true });
      text(context, value, 88, 15 + 18 * i, { color: INK, halo: true });
    });
    const lines = [this.factors(M), "slip arrow: logarithmic"], rest = { color: SOFT, align: "right", halo: true };
    if (width >= BESIDE) symbols(context, lines.join(";  "), width - 10, height - 16, rest);
    else lines.forEach((words, i) => symbols(context, words, width - 10, height - 52 + 18 * i, rest)); // not over the ways
    text(context, `φ = ${plain((this.scene.phi * 180) / Math.PI, 4)}°`, width - 10, 15, { color: INK, align: "right", halo: true });
  }

  // What the elongations are magnified by; one that stays zero is not.
  factors(M) {
    const moved = ["x", "y"].filter((axis) => this.lengths[axis] > 0);
    if (moved.length === 2 && M.x === M.y) return `elongations × ${count(M.x * PIXEL)}`;
    return moved.map((axis) => `u_${axis} × ${count(M[axis] * PIXEL)}`).join(",  ") || "nothing moves";
  }
}

// A magnification in words: those of a film (stiction.media.scene).
export function count(value) {
  return value >= 1e6 ? `${count(value / 1e6)} million` : Number(value.toPrecision(2)).toLocaleString("en", { maximumSignificantDigits: 2 });
}

// How far it is from a point along a unit vector to the edge of a room.
function distance([x, y], [dx, dy], { left, right, top, bottom }) {
  const across = dx > 0 ? right - x : x - left, down = dy > 0 ? bottom - y : y - top;
  return Math.min(across / Math.max(Math.abs(dx), 1e-9), down / Math.max(Math.abs(dy), 1e-9));
}

// A magnification as a round number, not above it.
function rounded(value) {
  const unit = 10 ** Math.floor(Math.log10(value));
  const best = [5, 2, 1].find((each) => each * unit <= value) ?? 1;
  return best * unit;
}

function zigzag(context, from, to, wide, color, width) {
  const way = sub(to, from), length = Math.hypot(...way) || 1, normal = [-way[1] / length, way[0] / length];
  const turns = 7, points = [from];
  for (let i = 0; i < 2 * turns; i++) {
    const along = 0.12 + (0.76 * (i + 0.5)) / (2 * turns), side = wide * (i % 2 ? 1 : -1);
    points.push([from[0] + way[0] * along + normal[0] * side, from[1] + way[1] * along + normal[1] * side]);
  }
  points.splice(1, 0, mix(from, to, 0.12));
  points.push(mix(from, to, 0.88), to);
  line(context, points, color, width);
}

// A damper from one point to another: a cup, and a piston in it.
function dashpot(context, from, to) {
  const way = sub(to, from), length = Math.hypot(...way) || 1, normal = [(-way[1] / length) * 9, (way[0] / length) * 9];
  const at = ([along, side]) => add(mix(from, to, along), [side * normal[0], side * normal[1]]);
  for (const part of [[[0, 0], [0.55, 0], [0.55, 1], [0.75, 1]], [[0.55, 0], [0.55, -1], [0.75, -1]], [[0.66, 0.7], [0.66, -0.7]], [[0.66, 0], [1, 0]]]) {
    line(context, part.map(at), INK, 1.6);
  }
}

const add = ([a, b], [c, d]) => [a + c, b + d];
const sub = ([a, b], [c, d]) => [a - c, b - d];
const times = ([a, b], c) => [a * c, b * c];
const mix = (a, b, share) => [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
const project = ([a, b], [c, d]) => a * c + b * d;
