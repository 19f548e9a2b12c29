// Axes of plots: linear and logarithmic, with their ticks.

import { textWidth } from "./drawing.js";
import { hasPrefixes, plain, prefixed, ticks } from "./quantity.js";

const ROUNDING = 1e-13; // of values: what differs by less is the same, but for rounding
const FAR = 20; // ranges from zero: there an axis has an offset
const WIDEST = 38; // px of a number at a tick, as narrow as beside the narrowest plot

// The ends of values with a margin on both sides, a share of their range.
export function padded(low, high, share) {
  const size = Math.max(Math.abs(low), Math.abs(high)), same = !(high - low > ROUNDING * size);
  const margin = same ? share * size || 1 : share * (high - low);
  return [low - margin, high + margin];
}

// Linear axis from low to high (SI), shown with the prefix that suits it. Numbers too wide for their
// place, or with too many digits, are counted from an offset.
export function linearAxis(low, high, count, unit = "") {
  if (!(high > low)) [low, high] = [low - 0.5 * (Math.abs(low) || 1), low + 0.5 * (Math.abs(low) || 1)];
  const named = unit && unit !== "1";
  const [factor, prefix] = named && unit !== "deg" ? prefixed(Math.max(Math.abs(low), Math.abs(high))) : [1, ""];
  const axis = { low, high, place: (value) => (value - low) / (high - low), factor, unit: prefix + unit, offset: "", ticks: labelled(low, high, count, factor, 0) };
  const wide = axis.ticks.some(([, label]) => label.includes("e") || textWidth(label) > WIDEST);
  return wide && named ? { ...axis, ...shifted(low, high, count, unit, factor, prefix) } : axis;
}

function labelled(low, high, count, factor, offset) {
  return ticks((low - offset) * factor, (high - offset) * factor, count).map(([value, label]) => [offset + value / factor, label]);
}

// Ticks from a value in the middle on that has few digits; from zero on, if that is not far.
function shifted(low, high, count, unit, outer, prefix) {
  const span = high - low, far = Math.max(Math.abs(low), Math.abs(high)) > FAR * span;
  const exponent = Math.floor(Math.log10(0.5 * span * outer)), digit = 10 ** exponent;
  const words = (Math.round((0.5 * (low + high) * outer) / digit) * digit).toFixed(Math.min(Math.max(0, -exponent), 99));
  const offset = far ? Number(words) / outer : 0, reach = Math.max(high - offset, offset - low);
  const [factor, own] = reach > 0.05 && unit === "deg" ? [1, ""] : prefixed(reach);
  return { factor, unit: own + unit, offset: far ? `0 = ${words.replace("-", "−")} ${prefix}${unit}` : "", ticks: labelled(low, high, count, factor, offset) };
}

// Axis of cells of equal width, one for each value (SI).
export function cellAxis(values, unit = "", most = 5) {
  const count = values.length, every = Math.max(1, Math.ceil(count / most)), found = [];
  const [factor, prefix] = hasPrefixes(unit) && unit !== "kg" ? prefixed(Math.max(...values.map(Math.abs))) : [1, ""];
  for (let i = 0; i < count; i += every) found.push([i, plain(values[i] * factor, 2)]);
  return { unit: prefix + unit, place: (i) => (i + 0.5) / count, ticks: found };
}

const UPPER = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

export function power(exponent) {
  return "10" + [...String(exponent)].map((letter) => UPPER[letter]).join("");
}

// Logarithmic axis between positive values, with a tick at decades.
export function logAxis(low, high, unit = "", most = 6, show = null) {
  const range = Math.log10(high / low), every = Math.max(1, Math.ceil(range / most));
  const found = [];
  for (let n = Math.ceil(Math.log10(low) - 1e-9); n <= Math.log10(high) + 1e-9; n++) {
    if (n % every === 0) found.push([10 ** n, show ? show(10 ** n) : power(n)]);
  }
  return {
    low, high, unit, factor: 1,
    place: (value) => Math.log10(Math.max(value, low * 1e-3) / low) / range,
    value: (place) => low * (high / low) ** place,
    ticks: found,
  };
}

// Axis of a colour bar, in the unit of its values; logarithmic over few decades with plain numbers.
export function barAxis([low, high], log) {
  if (!log) return linearAxis(low, high, 5);
  const axis = logAxis(low, high, "", 5);
  if (high >= 1e3 * low) return axis;
  const first = Math.floor(Math.log10(low)), last = Math.floor(Math.log10(high));
  const decades = Array.from({ length: last - first + 1 }, (_, i) => first + i);
  const values = decades.flatMap((n) => [1, 2, 5].map((digit) => Number(`${digit}e${n}`)));
  return { ...axis, ticks: values.filter((value) => value >= low && value <= high).map((value) => [value, plain(value)]) };
}
