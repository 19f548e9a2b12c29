// The samples of a run, and its state at any time between them.

const NAMES = ["u_x", "u_y", "slip_x", "slip_y", "friction", "theta", "X", "V_X", "normal_load", "v_x", "v_y", "sticking"];

export class Track {
  constructor(arrays, prefix = "") {
    this.time = arrays[`${prefix}time`];
    this.columns = Object.fromEntries(NAMES.map((name) => [name, arrays[prefix + name]]));
  }

  get start() { return this.time[0]; }

  get end() { return this.time[this.time.length - 1]; }

  holds(t) { return this.time.length > 1 && t >= this.start && t <= this.end; }

  // The last sample not after a time.
  index(t) {
    let low = 0, high = this.time.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.time[middle] <= t) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  at(t) {
    const i = this.index(t), j = Math.min(i + 1, this.time.length - 1);
    const step = this.time[j] - this.time[i], share = step > 0 ? Math.min(Math.max((t - this.time[i]) / step, 0), 1) : 0;
    const found = { t };
    for (const name of NAMES) {
      const column = this.columns[name];
      if (name === "sticking") found[name] = column[i] > 0 && column[j] > 0;
      else if (name === "theta") found[name] = between(column[i], column[j], share);
      else found[name] = column[i] + share * (column[j] - column[i]);
    }
    return found;
  }

  largest(name) {
    let found = 0;
    for (const value of this.columns[name]) if (Math.abs(value) > found) found = Math.abs(value);
    return found;
  }
}

// Between two angles (deg), the shorter way round.
function between(a, b, share) {
  if (a !== a) return b;
  if (b !== b) return a;
  const turn = ((b - a + 540) % 360) - 180;
  return a + share * turn;
}
