// The form: a slider and a number with a unit for each parameter, made from the server's schema.

import { SYMBOLS, brief, quantity, symbol } from "./quantity.js";
import { scaleOf } from "./scale.js";

const TITLES = { slider: "Apparatus", friction: "Friction", drive: "Drive", load: "Load", initial: "Start", run: "Run" };
const MAIN = new Set(["duration", "velocity", "k_x", "k_y"]); // optional ones that everybody needs

export function element(name, properties = {}, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}

export class Form {
  constructor(place, form, hooks) {
    Object.assign(this, { place, form, hooks, rows: new Map(), open: new Set(), bases: {} });
    this.values = {};
  }

  // Build the form for tables; it stays as it is while it has the same rows, whatever their values:
  // one that is built anew takes the slider away from under the pointer.
  show(tables) {
    const pieces = ["drive", "load"].map((name) => (tables[name]?.program ?? []).map((each) => each.piece));
    const shape = JSON.stringify([tables.friction.law, pieces]);
    this.tables = tables;
    if (shape !== this.shape) {
      this.shape = shape;
      const focus = document.activeElement?.id, top = this.place.scrollTop;
      this.rows.clear();
      this.menus = [];
      this.place.replaceChildren(this.general(), ...this.groups(tables));
      this.place.scrollTop = top;
      const near = focus?.replace(/^(drive|load)-.*/, "$1-protocol"); // of a piece that is gone
      if (focus) (document.getElementById(focus) ?? document.getElementById(near))?.focus();
    }
    this.write();
  }

  write() {
    for (const each of [...this.rows.values(), ...this.menus]) each.write();
  }

  general() {
    this.message = element("p", { className: "fault", id: "faults" });
    this.message.setAttribute("role", "alert");
    return this.message;
  }

  groups(tables) {
    const { form } = this, made = [];
    made.push(this.group("slider", form.tables.slider));
    made.push(this.friction(tables.friction));
    for (const name of ["drive", "load"]) made.push(this.program(name, tables));
    made.push(this.group("run", form.tables.run));
    made.push(this.group("initial", form.tables.initial.filter((field) => field.kind !== "object")));
    return made;
  }

  // The fields of a table, after a menu; `also` are fields of tables in it, each with its place.
  group(name, fields, { menu, also = [] } = {}) {
    const set = element("fieldset", {}, element("legend", { textContent: TITLES[name] }));
    if (menu) set.append(element("div", { className: "choose" }, menu));
    fields = fields.filter((each) => each.kind !== "tables"); // written in the file alone
    const usual = fields.filter((each) => each.required || MAIN.has(each.key));
    const rare = fields.filter((each) => !usual.includes(each)).map((field) => [field, [name, field.key]]);
    set.append(...usual.map((field) => this.row(field, [name, field.key])));
    if (rare.length + also.length) set.append(this.more(name, [...rare, ...also]));
    return set;
  }

  // What few need: folded up, until one of it has a value.
  more(name, rare) {
    const summary = element("summary", { textContent: "more" }), more = element("details", {}, summary);
    summary.setAttribute("aria-label", `more: ${TITLES[name]}`);
    more.open = this.open.has(name);
    more.ontoggle = () => this.open[more.open ? "add" : "delete"](name);
    more.append(...rare.map(([field, path]) => this.row(field, path)));
    let before = false;
    this.menus.push({ write: () => {
      const now = rare.some(([, path]) => read(this.tables, path) !== undefined);
      if (now && !before) more.open = true;
      before = now;
    } });
    return more;
  }

  friction({ law }) {
    const { laws } = this.form, known = Object.hasOwn(laws, law);
    const menu = choice("law", known ? Object.keys(laws) : [law, ...Object.keys(laws)], law, "Friction law");
    onChoice(menu, () => this.hooks.law(menu.value));
    if (known) menu.title = laws[law].meaning;
    const also = this.form.anisotropy.map((field) => inner(field, "grain", ["friction", "anisotropy"]));
    return this.group("friction", known ? laws[law].fields : [], { menu, also });
  }

  program(name, tables) {
    const all = this.form.tables[name], pieces = tables[name]?.program ?? [];
    const fields = all.filter((field) => !["program", "wave"].includes(field.kind));
    const waves = all.filter((field) => field.kind === "wave");
    const also = waves.flatMap((wave) => wave.fields.map((field) => inner(field, wave.key, [name, wave.key])));
    const menu = choice(`${name}-protocol`, [], "", `${TITLES[name]}: protocol`);
    onChoice(menu, () => menu.value && this.hooks.protocol(name, menu.value));
    this.menus.push({ write: () => this.nameTest(name, waves, menu) });
    const set = this.group(name, fields, { menu, also });
    set.append(...pieces.map((piece, index) => this.piece(name, piece.piece, index)));
    const add = element("button", { type: "button", textContent: "add a piece", id: `${name}-add` });
    add.onclick = () => this.change((all) => {
      const own = (all[name] ??= {});
      const last = own.program?.at(-1);
      if (last && last.duration === undefined && last.piece !== "free") last.duration = "1 s";
      own.program = [...(own.program ?? []), { piece: "constant", duration: "1 s" }];
    });
    set.querySelector("details").append(add);
    return set;
  }

  // The first test is what a table without pieces and harmonics is; another program is no entry.
  nameTest(name, waves, menu) {
    const tests = this.hooks.protocols[name], table = this.tables[name] ?? {}, count = table.program?.length ?? 0;
    const shaken = waves.some((wave) => table[wave.key]), plain = !count && !shaken;
    const words = (count ? `program of ${count} piece${count > 1 ? "s" : ""}` : tests[0]) + (shaken ? ", with a harmonic" : "");
    if (menu.words !== words) {
      menu.words = words;
      menu.replaceChildren(...options(plain ? tests : ["", ...tests]));
      if (!plain) menu.options[0].textContent = words;
    }
    menu.value = plain ? tests[0] : "";
  }

  piece(name, kind, index) {
    const kinds = this.form.pieces[name];
    const menu = choice(`${name}-${index}`, Object.keys(kinds), kind, `Piece ${index + 1}`);
    menu.onchange = () => this.change((all) => {
      const piece = all[name].program[index], next = { piece: menu.value };
      for (const field of kinds[menu.value] ?? []) {
        if (field.key in piece) next[field.key] = piece[field.key];
        else if (field.required) next[field.key] = usual(field, name, this.tables);
      }
      all[name].program[index] = next;
    });
    const away = element("button", { type: "button", textContent: "×", title: "Remove this piece", id: `${name}-${index}-away` });
    away.setAttribute("aria-label", `Remove piece ${index + 1}`);
    away.onclick = () => this.change((all) => {
      all[name].program.splice(index, 1);
      if (!all[name].program.length) delete all[name].program;
      if (name === "load" && !Object.keys(all.load).length) delete all.load;
    });
    const box = element("div", { className: "piece" }, element("div", { className: "choose" }, menu, away));
    for (const field of kinds[kind] ?? []) {
      if (field.key === "duration" && kind === "free") continue;
      box.append(this.row(field, [name, "program", index, field.key]));
    }
    return box;
  }

  row(field, path) {
    const id = `field-${path.join("-")}`, named = serverPath(path);
    const label = labelOf(field, id);
    const box = element("div", { className: "row" }, label);
    box.dataset.path = named;
    const fault = element("p", { className: "fault", id: `${id}-fault` });
    const write = this.control(field, path, id, box);
    box.append(fault);
    this.rows.set(named, { box, fault, write });
    return box;
  }

  // Add what a parameter is changed with; return what shows its value.
  control(field, path, id, box) {
    const value = () => read(this.tables, path);
    if (field.kind === "choice" || field.kind === "boolean") {
      const known = field.options ?? ["false", "true"], first = String(field.default ?? known[0]);
      const menu = choice(id, known, first, field.meaning.replaceAll("`", ""));
      menu.onchange = () => this.put(path, field.kind === "boolean" ? menu.value === "true" : menu.value);
      box.append(menu);
      return () => { menu.value = String(value() ?? first); };
    }
    const text = element("input", { type: "text", id, spellcheck: false, placeholder: placeholder(field) });
    text.setAttribute("aria-describedby", `${id}-fault`);
    text.oninput = () => { text.edited = true; };
    text.onchange = () => {
      text.edited = false;
      this.put(path, entered(field, text.value));
    };
    text.onkeydown = (event) => {
      if (event.key === "Enter") { event.preventDefault(); text.onchange(); }
    };
    box.append(text);
    const slides = field.kind === "number";
    const slider = slides && element("input", { type: "range", min: 0, max: 1000, step: 1, id: `${id}-slider` });
    if (slider) {
      slider.setAttribute("aria-label", `${field.label ?? field.key}, slider`);
      slider.dataset.slider = serverPath(path);
      slider.oninput = () => this.slide(field, path, slider, text, false);
      slider.onchange = () => this.slide(field, path, slider, text, true);
      box.append(slider);
    }
    const fill = () => {
      const words = shown(value()), here = document.activeElement === text, visible = here ? words : brief(words);
      text.title = visible === words ? "" : words;
      if (text.value !== visible && !(text.edited && here)) text.value = visible; // nobody's words are taken away
    };
    text.onfocus = text.onblur = fill;
    return () => {
      const its = value();
      fill();
      if (!slider) return;
      const spoken = text.value || placeholder(field);
      if (slider.ariaValueText !== spoken) slider.ariaValueText = spoken;
      const known = this.numberAt(path), key = this.scaleKey(path);
      if (known === null && its !== undefined) return; // the server has not read it yet
      const number = known ?? (typeof field.default === "number" ? field.default : 0);
      if (!this.bases[key] || !this.bases[key].holds(number)) this.bases[key] = scaleOf(field, number);
      const at = this.bases[key].place(number);
      if (at !== slider.at && (document.activeElement !== slider || !this.sliding)) slider.value = slider.at = at;
    };
  }

  slide(field, path, slider, text, done) {
    const scale = this.bases[this.scaleKey(path)];
    if (!scale) return;
    const value = scale.value(Number(slider.value));
    text.value = quantity(value, field.unit, 3);
    slider.ariaValueText = text.value;
    slider.at = undefined;
    this.sliding = !done;
    this.put(path, text.value, done);
  }

  put(path, value, done = true) {
    this.change((all) => write(all, path, value), done);
  }

  change(edit, done = true) {
    const tables = structuredClone(this.tables);
    edit(tables);
    this.tables = tables;
    this.hooks.change(tables, done);
  }

  // The value of a parameter in SI, as the server last read it.
  numberAt(path) {
    const found = read(this.values, path);
    if (typeof found === "number") return found;
    const angle = /^([-\d.e+]+) (deg|rad)$/.exec(found ?? "");
    return angle ? Number(angle[1]) * (angle[2] === "deg" ? Math.PI / 180 : 1) : null;
  }

  // Laws share names of parameters, but not their bounds.
  scaleKey(path) {
    return path[0] === "friction" ? `${this.tables.friction.law} ${path.join(".")}` : path.join(".");
  }

  setValues(values) {
    this.values = values;
    this.write();
  }

  setFaults(faults) {
    if (!faults.length && !this.faulty) return;
    this.faulty = faults.length > 0;
    for (const { box, fault } of this.rows.values()) {
      box.classList.remove("faulty");
      box.querySelector("input, select").ariaInvalid = null;
      fault.textContent = "";
    }
    const rest = [];
    for (const { path, message } of faults) {
      const row = this.rows.get(path);
      if (!row) { rest.push(path ? `${path}: ${message}` : message); continue; }
      row.box.classList.add("faulty");
      row.box.querySelector("input, select").ariaInvalid = "true";
      row.fault.textContent = message;
      const details = row.box.closest("details");
      if (details) details.open = true;
    }
    if (this.message) this.message.textContent = rest.join("; ");
  }
}

function labelOf(field, id) {
  const label = element("label", { htmlFor: id, title: field.meaning.replaceAll("`", "") });
  const own = field.label ? null : symbol(SYMBOLS[field.key] ?? field.key);
  if (own) {
    label.append(element("i", { textContent: own.head }));
    if (own.index) label.append(element("sub", { textContent: own.index }));
  } else {
    label.className = "word";
    label.textContent = field.label ?? field.key.replaceAll("_", " ");
  }
  return label;
}

const options = (entries) => entries.map((each) => element("option", { value: each, textContent: each }));

function choice(id, entries, value, label) {
  const menu = element("select", { id });
  menu.append(...options(entries));
  menu.value = value;
  menu.setAttribute("aria-label", label);
  menu.title = label;
  return menu;
}

// The path of a parameter as the server names it in a fault; lists count from 1.
function serverPath(path) {
  return path.map((key) => (typeof key === "number" ? key + 1 : key)).join(".");
}

function read(tables, path) {
  return path.reduce((part, key) => part?.[key], tables);
}

function write(tables, path, value) {
  const keys = [...path], last = keys.pop();
  let part = tables;
  for (const key of keys) part = part[key] ??= {};
  if (value === undefined) delete part[last];
  else part[last] = value;
  const [table, inner] = path; // an empty table is left out
  if (keys.length > 1 && !Object.keys(part).length && !Array.isArray(tables[table][inner])) delete tables[table][inner];
  if (["load", "initial"].includes(table) && !Object.keys(tables[table]).length) delete tables[table];
}

function entered(field, text) {
  const clean = text.trim();
  if (!clean) return undefined;
  if (field.kind === "integer") return Number.isInteger(Number(clean)) ? Number(clean) : clean;
  if (field.kind === "array") return clean.replace(/^\[|\]$/g, "").split(",").map((each) => each.trim());
  if (!field.unit && Number.isFinite(Number(clean))) return Number(clean);
  return clean;
}

function shown(value) {
  if (value === undefined || value === null) return "";
  if (Array.isArray(value)) return value.join(", ");
  return String(value);
}

function placeholder(field) {
  if (field.default === 0 || typeof field.default === "number") return quantity(field.default, field.unit);
  return field.default === null ? "none" : "";
}

function usual(field, name, tables) {
  if (field.key === "duration") return "1 s";
  if (field.key === "frequency") return "10 Hz";
  return name === "drive" ? tables.drive?.velocity ?? "1 mm/s" : tables.slider?.normal_load ?? "10 N";
}

// A field of a table inside another, with its place.
function inner(field, word, path) {
  return [{ ...field, required: false, label: `${word} ${field.key}` }, [...path, field.key]];
}

// Act on what is chosen from a menu. In one that is closed, browsers take each arrow key for a
// choice; here it opens the menu.
export function onChoice(menu, act) {
  menu.onchange = act;
  menu.onkeydown = (event) => {
    const moves = /^(Arrow|Page)|^(Home|End|[^ ])$/.test(event.key) && !event.altKey && !event.ctrlKey && !event.metaKey;
    if (!moves || !menu.showPicker) return;
    event.preventDefault();
    menu.showPicker();
  };
}
