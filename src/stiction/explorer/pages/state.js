// What the page shows, its history, and its address, which holds it all.

const MOST = 200;
const LONGEST = 1e6; // letters of an address; browsers take one to two million

export class State {
  // `first` has the tables that were opened, and their origin: a preset, a run of a study, or "".
  constructor(first, changed) {
    this.first = first;
    this.now = structuredClone(first);
    this.past = [];
    this.future = [];
    this.changed = changed;
    this.extra = {};
  }

  get now() { return { tables: this.tables, origin: this.origin }; }

  set now({ tables, origin }) { [this.tables, this.origin] = [tables, origin]; }

  // Change the tables; `steps` is whether one can go back to before this change.
  set(tables, steps = true, origin = this.origin) {
    if (steps && JSON.stringify({ tables, origin }) !== JSON.stringify(this.mark ?? this.now)) {
      this.past.push(structuredClone(this.mark ?? this.now));
      if (this.past.length > MOST) this.past.shift();
      this.future = [];
      this.mark = undefined;
    } else if (!steps) this.mark ??= structuredClone(this.now); // a slider on its way
    this.now = { tables, origin };
    this.write();
    this.changed(steps);
  }

  undo() { this.go(this.past, this.future); }

  redo() { this.go(this.future, this.past); }

  go(from, to) {
    if (!from.length) return;
    to.push(structuredClone(this.now));
    this.now = from.pop();
    this.mark = undefined;
    this.write();
    this.changed(true);
  }

  reset() { this.set(structuredClone(this.first.tables), true, this.first.origin); }

  write() {
    clearTimeout(this.timer); // browsers allow few changes of the address a second
    this.timer = setTimeout(() => {
      const address = encodeState({ ...this.now, ...this.extra });
      this.address = address.length > LONGEST ? "" : address;
      history.replaceState(null, "", `#${this.address}`);
      this.written?.();
    }, 250);
  }
}

export function encodeState(state) {
  const bytes = new TextEncoder().encode(JSON.stringify(state));
  return btoa(Array.from(bytes, (each) => String.fromCharCode(each)).join("")).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

export function decodeState(text) {
  try {
    const letters = atob(text.replace(/^#/, "").replaceAll("-", "+").replaceAll("_", "/"));
    const state = JSON.parse(new TextDecoder().decode(Uint8Array.from(letters, (x) => x.charCodeAt(0))));
    return isForm(state.tables) ? { ...state, origin: state.origin ?? "" } : null;
  } catch {
    return null;
  }
}

// Whether there are tables that a form can be made of, right or wrong.
function isForm(tables) {
  const isTable = (each) => Object.prototype.toString.call(each) === "[object Object]";
  const { slider, friction, drive, load = {} } = tables;
  const programs = [drive, load].map((each) => each.program ?? []);
  return [...Object.values(tables), slider, friction, drive].every(isTable) && typeof friction.law === "string"
    && programs.every((each) => Array.isArray(each) && each.every(isTable));
}
