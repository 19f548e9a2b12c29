// Numbers with units: texts as descriptions have them, symbols, ticks.

const PREFIX = { "-12": "p", "-9": "n", "-6": "µ", "-3": "m", 0: "", 3: "k", 6: "M" };
let known = {}; // of each unit in SI, those in which values are written: names and sizes, largest first

// Take the units from the server, which writes descriptions in them.
export function setUnits(units) { known = units; }

export const hasPrefixes = (unit) => unit in known;

// Plain digits without an exponent or trailing zeros, where that is short.
export function plain(value, digits = 4) {
  const rounded = Number(value.toPrecision(digits));
  const text = String(rounded);
  return text.includes("e") ? text.replace("e+", "e") : text;
}

// A value without its rounding error: zero, beside the size of others.
export const unrounded = (value, size) => (Math.abs(value) < 1e-9 * size ? 0 : value);

// A quantity in words, with no more digits than a field has room for.
export function brief(words) {
  const [, number, unit] = /^([-+]?[\d.]+(?:e[-+]?\d+)?)([^\d,]*)$/i.exec(words) ?? [];
  return number?.replace(/\D/g, "").length > 6 ? plain(Number(number), 6) + unit : words;
}

export function quantity(value, unit, digits = 4) {
  if (unit === "rad") return `${plain((value * 180) / Math.PI, digits)} deg`;
  if (!hasPrefixes(unit)) return `${plain(value, digits)} ${unit}`.trim();
  if (value === 0) return `0 ${unit.replace("*", " ")}`;
  const units = known[unit], most = Math.abs(Number(value.toPrecision(digits)));
  const [name, size] = units.find((each) => each[1] <= most * (1 + 1e-12)) ?? units.at(-1);
  if (most < 1e-3 * size) return `< 0.001 ${name}`; // rounding, mostly
  return `${plain(value / size, digits)} ${name}`;
}

const GREEK = {
  mu: "μ", phi: "φ", epsilon: "ε", theta: "θ", psi: "ψ", sigma: "σ", alpha: "α", beta: "β",
  gamma: "γ", eta: "η", inf: "∞",
};

// The parts of a symbol: "mu_inf" is μ with the index ∞; null for a word.
export function symbol(key) {
  const parts = key.split("_");
  const head = GREEK[parts[0]] ?? parts[0];
  if (head.length > 2 || parts.length > 2) return null;
  const index = parts.length > 1 ? GREEK[parts[1]] ?? parts[1] : "";
  if (index.length > 6) return null;
  return { head, index };
}

export const SYMBOLS = { mass: "m", normal_load: "W", velocity: "V", duration: "duration" };

// Values at which an axis has ticks, with the digits that their step needs.
export function ticks(low, high, count) {
  const rough = (high - low) / Math.max(count, 1);
  if (!(rough > 0) || !isFinite(rough)) return [];
  const unit = 10 ** Math.floor(Math.log10(rough));
  const far = (each) => Math.abs(Math.log(each / rough));
  const steps = [1, 2, 5, 10].map((each) => each * unit).sort((a, b) => far(a) - far(b));
  const all = steps.map((step) => multiples(low, high, step));
  return all.find((each) => each.length > 1) ?? all[0]; // a single number tells no scale
}

function multiples(low, high, step) {
  const found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) found.push([i * step, tickText(i * step, step)]);
  return found;
}

function tickText(value, step) {
  if (step < 1e-9) return value === 0 ? "0" : value.toExponential(0).replace("-", "−");
  const places = Math.max(0, Math.min(9, -Math.floor(Math.log10(step) + 1e-9)));
  const text = value.toFixed(places);
  return (Number(text) === 0 ? (0).toFixed(places) : text).replace("-", "−");
}

// A time of a run, to the same place throughout: the longer the run, the fewer decimals.
export function clock(t, end, decimals) {
  if (!isFinite(t)) return "t = …";
  const whole = Math.max(0, Math.floor(Math.log10(Math.max(Math.abs(end) || 1, 1))));
  return `t = ${t.toFixed(Math.max(0, decimals - whole))} s`;
}

// The factor and the prefix that bring values of a size to 0.2 to 200.
export function prefixed(size) {
  if (!(size > 0) || !isFinite(size)) return [1, ""];
  const power = Math.min(Math.max(Math.floor(Math.log10(5 * size) / 3) * 3, -12), 6);
  return [10 ** -power, PREFIX[power]];
}
