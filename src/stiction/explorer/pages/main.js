// The page: it asks for a run when a parameter changes, and draws the answers frame by frame.

import { Form, element, onChoice } from "./form.js";
import { Link } from "./link.js";
import { Microscope, spanText } from "./microscope.js";
import { Player, SPEEDS, speedText } from "./player.js";
import { clock, setUnits } from "./quantity.js";
import { Scene } from "./scene.js";
import { Series } from "./series.js";
import { Sound } from "./sound.js";
import { State, decodeState } from "./state.js";
import { Track } from "./track.js";
import { Panel } from "./views.js";

const COMPUTING = "computing …";
const $ = (id) => document.getElementById(id);
const data = {}; // of the run that is shown, for the views
const page = {
  data, micro: null, wide: null, drawn: 0,
  get t() { return player.t; },
  get settled() { // all that was asked for is shown, at both scales
    return !patience && this.shown?.asked === this.asked && !this.shown.quick && (!data.track || Boolean(this.micro?.holds(this.t)));
  },
};
window.stictionPage = page; // what is shown, for tests and measurements
let state, form, series, scene, microscope, panels = [], view = null, patience = 0;

const player = new Player((what) => {
  $("play").textContent = player.playing ? "❚❚" : "▶";
  $("play").setAttribute("aria-label", player.playing ? "Pause" : "Play");
  if (player.playing) sound.play(player.t, player.slow);
  else sound.stop();
  tellSilence();
  if (what !== "again") lookCloser();
});
const sound = new Sound();
const link = new Link((now) => {
  if (now === "open") link.ask({ do: "start" }, begin, failed);
  else say(now, true);
});
Object.assign(page, { sound, link, window: null });

function say(words, bad = false) {
  $("status").textContent = $("status").title = words;
  $("status").classList.toggle("bad", bad);
}

// While what was asked for takes long, what stands is of the parameters before.
const awaited = new Set();
let late;

function expect(what) {
  awaited.add(what);
  late ??= setTimeout(() => {
    document.body.classList.add("stale");
    if (page.shown) say(COMPUTING);
  }, 300);
}

function arrived(what) {
  if (!awaited.delete(what) || awaited.size) return;
  clearTimeout(late);
  late = undefined;
  document.body.classList.remove("stale");
  if ($("status").textContent === COMPUTING) tellRun();
}

function tellRun() {
  const [words, bad] = data.summary;
  say(words + (state.address === "" ? "; too large for a link" : ""), bad);
}

function failed(answer) {
  if (answer.faults) form?.setFaults(answer.faults);
  say(reason(answer), true);
}

function reason({ faults, error }) { return faults ? `${faults[0].path}: ${faults[0].message}` : error; }

function begin(answer) {
  setUnits(answer.units);
  data.study = answer.study ? { ...answer.study, arrays: answer.arrays } : null;
  data.origin = answer.origin;
  for (const { name, shows } of answer.presets) $("preset").append(element("option", { value: name, textContent: name, title: shows }));
  for (const slow of SPEEDS) $("speed").append(element("option", { value: slow, textContent: speedText(slow) }));
  const linked = decodeState(location.hash);
  state = new State({ tables: answer.tables, origin: answer.preset }, changed);
  state.written = () => state.address === "" && !awaited.size && data.summary && tellRun();
  if (linked) [state.tables, state.origin] = [linked.tables, linked.origin];
  player.t = NaN;
  resume(linked);
  form = new Form($("parameters"), answer.form, {
    change: (tables, done) => state.set(tables, done),
    law: (name) => replace({ do: "law", name, tables: state.tables }),
    protocol: (table, name) => replace({ do: "protocol", table, name, tables: state.tables }),
    protocols: answer.protocols,
  });
  scene = new Scene($("scene"));
  microscope = new Microscope($("microscope").querySelector("canvas"), { seek: (t) => player.seek(t) });
  series = new Series($("series"), { seek: (t) => player.seek(t), now: () => player.t, window: zoom, resized: () => state && later() });
  const hooks = { needs: () => panels.length && askViews(), place, pick: (at) => open({ do: "pick", at }, at) };
  const first = linked?.views ?? (data.study ? ["study", "phase"] : ["stability", "phase"]);
  panels = [new Panel($("panel-a"), data, first[0], hooks), new Panel($("panel-b"), data, first[1], hooks)];
  listen();
  changed();
  requestAnimationFrame(frame);
}

// Take time, speed and window from a link.
function resume(linked) {
  const numbers = (values) => values.every(Number.isFinite);
  player.slow = SPEEDS.includes(linked?.slow) ? linked.slow : 10;
  if (numbers([linked?.t])) player.t = linked.t;
  view = Array.isArray(linked?.window) && linked.window.length === 2 && numbers(linked.window) ? linked.window : null;
  page.window = view;
  page.wide = numbers([linked?.wide]) && linked.wide > 0 ? linked.wide : null;
  $("speed").value = player.slow;
}

function replace(request, origin = state.origin, before = () => {}) {
  link.ask(request, (answer) => {
    before();
    page.replaced = true;
    state.set(answer.tables, true, origin);
  }, (answer) => {
    failed(answer);
    form.shape = "";
    form.show(state.tables);
    tellName();
  });
}

// Show another system from its start, as nothing of the last one's time and widths suits it.
function open(request, origin) {
  replace(request, origin, () => {
    view = page.window = page.wide = null;
    page.opened = true;
  });
}

// Name the system that is shown; a changed preset can be chosen anew.
function tellName() {
  const { title, changed } = data.named, menu = $("preset"), preset = typeof state.origin === "string" ? state.origin : "";
  $("name").textContent = $("name").title = changed ? `${title}, changed` : title;
  document.title = `${$("name").textContent} · stiction explorer`;
  menu.options[0].textContent = preset && changed ? `${preset}, changed` : "choose …";
  menu.value = changed ? "" : preset;
}

// Something of the description has changed: compute it anew.
function changed() {
  form.show(state.tables);
  $("undo").disabled = !state.past.length;
  $("redo").disabled = !state.future.length;
  ask();
}

function later() {
  clearTimeout(patience);
  patience = setTimeout(() => { patience = 0; ask(); }, 150);
}

function ask() {
  page.asked = performance.now();
  const asked = page.asked;
  if (!page.shown) say("computing; the first run of a law may compile it, which takes some seconds");
  expect("run");
  link.ask({ do: "run", tables: state.tables, origin: state.origin, columns: series.columns }, (answer) => show(answer, asked), (answer) => {
    arrived("run");
    failed(answer);
  });
}

function show(answer, asked) {
  form.setFaults([]);
  form.setValues(answer.values);
  Object.assign(data, { facts: answer.facts, scene: answer.scene, named: answer, own: { phi: form.numberAt(["slider", "phi"]), V: form.numberAt(["drive", "velocity"]) ?? 0 } });
  if (answer.arrays.track_time) {
    data.track = new Track(answer.arrays, "track_");
    scene.show(answer.scene, data.track);
    if (!(player.t === player.t) || page.opened) player.t = data.track.start + 0.35 * (data.track.end - data.track.start);
    page.opened = false;
    player.span(data.track.start, data.track.end);
  }
  outdate();
  tellName();
  whole = answer;
  if (!view) series.show("b", answer);
  for (const panel of panels) panel.refresh();
  const sticks = answer.facts.find((each) => each.name === "stick intervals"), rest = answer.facts.find((each) => each.name === "time at rest");
  const counted = `${sticks.text} stick interval${sticks.text === "1" ? "" : "s"}, ${rest.text} at rest`;
  data.summary = [answer.ok ? answer.rested || counted : `ended early: ${answer.status}`, !answer.ok];
  tellRun();
  page.shown = { asked, quick: answer.quick, arrived: performance.now() };
  page.redraw = asked;
  if (view) zoom(view, false);
  arrived("run");
  if (answer.quick) return; // a slider may still be on its way
  compare();
  lookCloser(true);
  askViews();
  if (sound.on) askSound();
}
let whole;

// The width of the microscope: that which was chosen, else some periods of the transverse
// oscillation; without one, no less than what a fiftieth of the run shows.
function width() {
  const duration = player.end - player.start, least = data.track.largest("u_y") > 0 ? 0 : duration / 50;
  return page.wide ?? Math.min(Math.max(4 / data.scene.frequencies[1], least), duration);
}

// Mark what stands from the run before as that; of another system it is taken away.
function outdate() {
  page.micro = null;
  if (page.replaced) [data.stability, data.spectrogram] = [null, null];
  microscope.outdate(page.replaced);
  page.replaced = false;
  const keys = { stability: mapKey(), spectrogram: JSON.stringify(state.tables) };
  for (const [name, key] of Object.entries(keys)) {
    if (data[name]) data[name].stale = data[name].key !== key;
    if (page[name] !== key) data[`${name}Error`] = null;
  }
}

// Show a part of the run; null is all of it.
function zoom(window, write = true) {
  const [start, end] = whole.window;
  if (window) {
    const span = Math.min(Math.max(window[1] - window[0], 1e-9 * (end - start), 1e-7), end - start);
    const low = Math.min(Math.max(window[0], start), end - span);
    view = span > 0.999 * (end - start) ? null : [low, low + span];
  } else view = null;
  page.window = view;
  if (view) {
    expect("zoom");
    link.ask({ do: "zoom", tables: state.tables, window: view, columns: series.columns }, (answer) => {
      if (!view) return; // all is shown again
      series.show("b", answer);
      arrived("zoom");
      compare();
    }, (answer) => {
      arrived("zoom");
      failed(answer);
    });
  } else {
    series.show("b", whole);
    arrived("zoom");
  }
  if (write) remember();
  compare();
}

// Draw the pinned run and the measured one over the same time.
function compare() {
  const window = view ?? whole.window, columns = series.columns;
  const clear = (part) => series[part] && series.show(part, undefined);
  if (data.pinned) link.ask({ do: "zoom", lane: 1, tables: data.pinned.tables, window, columns }, (answer) => series.show("a", answer), () => clear("a"));
  else clear("a");
  if (data.origin) link.ask({ do: "measured", window, run: whole.window, columns }, (answer) => series.show("measured", answer));
}

// What the views at the side need beyond the run; the map, only if something else than its axes changed.
function askViews() {
  if (!state) return;
  const wanted = panels.map((panel) => panel.asks);
  askView("spectrogram", wanted, JSON.stringify(state.tables));
  askView("stability", wanted, mapKey());
}

function askView(name, wanted, key) {
  if (!wanted.includes(name) || page[name] === key) return;
  page[name] = key;
  data[`${name}Error`] = null;
  link.ask({ do: name, tables: state.tables }, (answer) => { data[name] = { ...answer, key }; refresh(); }, (answer) => {
    data[`${name}Error`] = reason(answer);
    page[name] = null;
    refresh();
  });
}

// The description as far as the map depends on it: its axes are the misalignment and the velocity.
function mapKey() {
  const rest = structuredClone(state.tables), V = data.own?.V ?? 0;
  delete rest.slider.phi;
  delete rest.run;
  rest.drive.velocity = Math.round(Math.log10(Math.abs(V) || 1e-3)) * Math.sign(V);
  if (data.stability) { // the range stays while the point is inside it
    const [low, high] = data.stability.speeds;
    if (Math.abs(V) >= low && Math.abs(V) <= high) rest.drive.velocity = JSON.parse(data.stability.key).drive.velocity;
  }
  return JSON.stringify(rest);
}

function refresh() { for (const panel of panels) panel.refresh(); }

function place({ phi, V }, done) {
  const tables = structuredClone(state.tables);
  tables.slider.phi = (data.own.phi < 0 ? "-" : "") + phi;
  tables.drive.velocity = (data.own.V < 0 ? "-" : "") + V;
  state.set(tables, done);
}

// Ask for the samples about the present time, unless those at hand will do.
function lookCloser(anew = false) {
  if (!data.track) return;
  const micro = page.micro, t = player.t, wide = width();
  change($("micro-span"), "textContent", spanText(wide));
  const inside = micro && !anew && micro.holds(t) && Math.abs(micro.end - micro.start - wide) < 1e-3 * wide;
  if (inside && !(player.playing && ahead(micro) < 0.2 * wide)) return;
  if (player.playing && wide * player.slow < 0.3) { // it passes too fast to be seen
    if (!micro) microscope.outdate(true, "too fast to be followed:\npause, or choose a lower speed");
    return;
  }
  if (page.looking && !anew && performance.now() - page.looking < 3000 && player.playing) return;
  page.looking = performance.now();
  const about = player.playing ? Math.min(t + 0.4 * wide, player.end) : t;
  link.ask({ do: "fine", tables: state.tables, time: about, width: wide }, (answer) => {
    page.looking = 0;
    page.micro = new Track(answer.arrays);
    page.at = answer.at;
    microscope.show(page.micro);
  }, (answer) => { page.looking = 0; failed(answer); });
}

const ahead = (micro) => (micro.end >= player.end - 1e-12 ? Infinity : micro.end - player.t);

// Write what is another value than the last: otherwise the page at rest is laid out in each frame.
function change(element, property, value) {
  if (element[property] !== String(value)) element[property] = value;
}

function frame(time) {
  player.frame(time, player.playing ? sound.now() : null);
  if (player.playing) lookCloser();
  const { t } = player, fine = page.micro?.holds(t) ? page.micro : data.track;
  const now = { t, own: data.own, state: fine?.at(t), micro: page.micro && [page.micro.start, page.micro.end] };
  const key = `${t} ${now.own?.phi} ${now.own?.V} ${now.micro} ${page.shown?.arrived}`;
  for (const each of [scene, series, microscope, ...panels]) if (each.view !== null) each.layers.draw(now, key);
  if (document.activeElement !== $("macro") || player.playing) change($("macro"), "value", Math.round((1e5 * (t - player.start)) / (player.end - player.start || 1)));
  if (page.micro) change($("micro"), "value", Math.round((4000 * (t - page.micro.start)) / (page.micro.end - page.micro.start || 1)));
  const words = clock(t, player.end, player.slow >= 100 ? 6 : 4);
  change($("clock"), "textContent", words);
  if (!player.playing) for (const id of ["macro", "micro"]) change($(id), "ariaValueText", words); // else it is spoken on and on
  page.frames = player.frames.length;
  page.drawn = (page.drawn ?? 0) + 1;
  if (page.redraw) { // when the curves of a request have been drawn
    page.latency = { asked: page.redraw, drawn: performance.now() };
    page.redraw = 0;
  }
  requestAnimationFrame(frame);
}

function remember() {
  state.extra = { slow: player.slow, t: Number(player.t.toPrecision(9)), window: view, wide: page.wide, views: panels.map((panel) => panel.name) };
  state.write();
}

function listen() {
  $("undo").onclick = () => state.undo();
  $("redo").onclick = () => state.redo();
  $("reset").onclick = () => state.reset();
  onChoice($("preset"), () => {
    const name = $("preset").value;
    if (name) open({ do: "preset", name }, name);
    else tellName();
  });
  onChoice($("export"), () => {
    takeAway($("export").value);
    $("export").value = "";
  });
  $("pin").onclick = pin;
  $("swap").onclick = () => {
    const { tables, origin } = data.pinned;
    pin(true);
    state.set(tables, true, origin);
  };
  $("play").onclick = () => player.toggle();
  $("speed").onchange = () => {
    player.slow = Number($("speed").value);
    player.toggle(player.playing);
    remember();
  };
  $("macro").oninput = () => player.seek(player.start + (Number($("macro").value) / 1e5) * (player.end - player.start));
  $("micro").oninput = () => page.micro && player.seek(page.micro.start + (Number($("micro").value) / 4000) * (page.micro.end - page.micro.start));
  $("macro").onchange = $("micro").onchange = remember;
  $("micro-wider").onclick = () => widen(2);
  $("micro-closer").onclick = () => widen(0.5);
  $("sound").onclick = listenTo;
  addEventListener("keydown", key);
  addEventListener("hashchange", () => {
    const linked = decodeState(location.hash);
    if (!linked || location.hash.slice(1) === state.address) return;
    resume(linked);
    linked.views?.forEach?.((name, i) => panels[i]?.choose(name));
    state.set(linked.tables, true, linked.origin);
  });
}

function widen(factor) {
  page.wide = Math.min(Math.max(width() * factor, 1e-7), player.end - player.start);
  lookCloser(true);
  remember();
}

function pin(keep = false) {
  const on = keep === true || !data.pinned;
  data.pinned = on ? { tables: structuredClone(state.tables), origin: state.origin, track: data.track, scene: data.scene, facts: data.facts, own: data.own } : null;
  $("pin").setAttribute("aria-pressed", String(on));
  $("pin").textContent = on ? "A pinned" : "Pin as A";
  $("swap").hidden = !on;
  compare();
  refresh();
  series.layers.refresh();
}

function listenTo() {
  sound.on = !sound.on;
  $("sound").setAttribute("aria-pressed", String(sound.on));
  if (sound.on) askSound();
  else sound.stop();
}

function askSound() {
  link.ask({ do: "sound", tables: state.tables }, (answer) => {
    sound.load(answer);
    if (player.playing) sound.play(player.t, player.slow);
    tellSilence();
  }, (answer) => {
    sound.stop();
    sound.buffer = undefined; // of the run before
    failed(answer);
  });
}

let silence = "";

// Say why nothing is heard, where it was asked for.
function tellSilence() {
  const why = sound.on && sound.buffer ? sound.silent(player.t, player.slow) : "";
  if (why) say(`no sound: ${why}`, true);
  else if (silence) tellRun();
  silence = why;
}

function takeAway(kind) {
  if (!kind) return;
  say(`writing ${kind} …`);
  link.ask({ do: "export", kind, tables: state.tables }, ({ name, arrays }) => {
    say(`wrote ${name}`);
    if (kind === "python" || kind === "toml") return tell(name, new TextDecoder().decode(arrays.content));
    keep(name, arrays.content);
  }, failed);
}

function keep(name, content) {
  const address = URL.createObjectURL(new Blob([content]));
  const away = element("a", { href: address, download: name });
  document.body.append(away);
  away.click();
  away.remove();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

function tell(name, words) {
  const box = element("dialog", {}, element("h2", { textContent: name }), element("pre", { textContent: words }));
  const copy = element("button", { textContent: "Copy" }), save = element("button", { textContent: "Save" }), close = element("button", { textContent: "Close" });
  copy.onclick = () => navigator.clipboard.writeText(words);
  save.onclick = () => keep(name, new TextEncoder().encode(words));
  close.onclick = () => box.close();
  box.onclose = () => box.remove();
  box.setAttribute("aria-label", name);
  box.append(copy, " ", save, " ", close);
  document.body.append(box);
  box.showModal();
}

function key(event) {
  const inField = /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName) && event.target.type !== "range";
  if (event.ctrlKey || event.metaKey) {
    const undo = event.key === "z" && !event.shiftKey, redo = event.key === "y" || (event.key.toLowerCase() === "z" && event.shiftKey);
    if ((undo || redo) && !inField) {
      state[undo ? "undo" : "redo"]();
      event.preventDefault();
    }
    return;
  }
  if (inField || event.altKey) return;
  if (event.key === " " && event.target.tagName !== "BUTTON" && event.target.tagName !== "SUMMARY") player.toggle();
  else if (event.key === "p") pin();
  else if (event.key === "s") listenTo();
  else return;
  event.preventDefault();
}
