// What the page shows, its history, and its address, which holds it all.

const MOST = 200;

export class State {
  constructor(tables, changed) {
    this.tables = tables;
    this.first = structuredClone(tables);
    this.past = [];
    this.future = [];
    this.changed = changed;
    this.extra = {};
  }

  // Change the tables; `steps` is whether one can go back to before this change.
  set(tables, steps = true) {
    if (steps && JSON.stringify(tables) !== JSON.stringify(this.mark ?? this.tables)) {
      this.past.push(structuredClone(this.mark ?? this.tables));
      if (this.past.length > MOST) this.past.shift();
      this.future = [];
      this.mark = undefined;
    } else if (!steps) this.mark ??= structuredClone(this.tables); // a slider on its way
    this.tables = tables;
    this.write();
    this.changed(steps);
  }

  undo() { this.go(this.past, this.future); }

  redo() { this.go(this.future, this.past); }

  go(from, to) {
    if (!from.length) return;
    to.push(structuredClone(this.tables));
    this.tables = from.pop();
    this.mark = undefined;
    this.write();
    this.changed(true);
  }

  reset() { this.set(structuredClone(this.first)); }

  write() {
    clearTimeout(this.timer); // browsers allow few changes of the address a second
    this.timer = setTimeout(() => {
      this.address = encodeState({ tables: this.tables, ...this.extra });
      history.replaceState(null, "", `#${this.address}`);
    }, 250);
  }
}

export function encodeState(state) {
  const bytes = new TextEncoder().encode(JSON.stringify(state));
  return btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

export function decodeState(text) {
  try {
    const letters = atob(text.replace(/^#/, "").replaceAll("-", "+").replaceAll("_", "/"));
    return JSON.parse(new TextDecoder().decode(Uint8Array.from(letters, (x) => x.charCodeAt(0))));
  } catch {
    return null;
  }
}
