// Axes of plots: linear and logarithmic, with their ticks.

import { RANGES, plain, prefixed, tickText, ticks } from "./quantity.js";

// Linear axis from low to high (SI), shown with the prefix that suits it.
export function linearAxis(low, high, count, unit = "") {
  if (!(high > low)) [low, high] = [low - 0.5 * (Math.abs(low) || 1), low + 0.5 * (Math.abs(low) || 1)];
  const [factor, prefix] = unit && unit !== "deg" && unit !== "1" ? prefixed(Math.max(Math.abs(low), Math.abs(high))) : [1, ""];
  const values = ticks(low * factor, high * factor, count);
  return {
    low, high, factor, unit: prefix + unit,
    place: (value) => (value - low) / (high - low),
    ticks: values.map((value) => [value / factor, tickText(value, values)]),
  };
}

// Axis of cells of equal width, one for each value (SI).
export function cellAxis(values, unit = "", most = 5) {
  const count = values.length, every = Math.max(1, Math.ceil(count / most)), found = [];
  const [factor, prefix] = unit in RANGES && unit !== "kg" ? prefixed(Math.max(...values.map(Math.abs))) : [1, ""];
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
