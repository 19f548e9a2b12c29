// The scale of a slider: logarithmic where the quantity has decades, through zero where it may be.

const STEPS = 1000;
const SPANS = { // of what is zero at first, SI
  "N*s/m": [1e-3, 1e3], Hz: [1, 1e6], "m/s": [1e-6, 1], "s/m": [1e-3, 1e3], m: [1e-9, 1e-2],
  s: [1e-3, 1e3], kg: [1e-6, 1e3], N: [1e-3, 1e4], "N/m": [1, 1e9], "": [1e-3, 1e1],
};

export function scaleOf(field, base) {
  if (field.unit === "rad") return crossing((0.02 * Math.PI) / 180, Math.PI / 2);
  if (field.low > 0 && field.high > 0) return logarithmic(field.low, field.high, 1);
  const zero = field.low === 0 && field.low_allowed;
  if (!field.unit && zero && base > 0 && base < 0.05) return fromZero(1e-4, 1);
  if (!field.unit && (zero || field.low === undefined) && Math.abs(base) <= 1) {
    return linear(zero ? 0 : -1, 1);
  }
  if (base !== 0 && isFinite(base)) {
    const size = Math.abs(base), decades = field.unit === "s" ? 1.5 : 2;
    const low = 10 ** (Math.floor(Math.log10(size)) - decades);
    const high = 10 ** (Math.ceil(Math.log10(size)) + decades);
    return logarithmic(Math.max(low, field.low ?? 0), high, Math.sign(base));
  }
  const [low, high] = SPANS[field.unit] ?? [1e-3, 1e3];
  if (zero) return fromZero(low, high);
  return field.low >= 0 ? logarithmic(Math.max(low, field.low), high, 1) : crossing(low, high);
}

function linear(low, high) {
  return {
    place: (value) => (STEPS * (value - low)) / (high - low),
    value: (place) => low + ((high - low) * place) / STEPS,
    holds: (value) => value >= low && value <= high,
  };
}

function logarithmic(low, high, sign) {
  const range = Math.log(high / low);
  return {
    place: (value) => (sign * value > low ? (STEPS * Math.log((sign * value) / low)) / range : 0),
    value: (place) => sign * low * Math.exp((range * place) / STEPS),
    holds: (value) => sign * value >= low && sign * value <= high,
  };
}

function fromZero(low, high) {
  const range = Math.log(high / low);
  return {
    place: (value) => (value <= 0 ? 0 : Math.max(1, (STEPS * Math.log(value / low)) / range)),
    value: (place) => (place <= 0 ? 0 : low * Math.exp((range * place) / STEPS)),
    holds: (value) => value >= 0 && value <= high,
  };
}

function crossing(small, large) {
  const top = Math.asinh(large / small);
  return {
    place: (value) => STEPS * (0.5 + (0.5 * Math.asinh(value / small)) / top),
    value: (place) => small * Math.sinh(top * ((2 * place) / STEPS - 1)),
    holds: (value) => Math.abs(value) <= large,
  };
}
