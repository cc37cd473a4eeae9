"use strict";
// The page: what the buttons and keys do, and the numbers of the frame. Names come from files, so they are only ever set
// as text, never as HTML.

const kSpeeds = [[1 / 200, "1/200"], [1 / 100, "1/100"], [1 / 50, "1/50"], [1 / 20, "1/20"], [1 / 10, "1/10"],
                 [1 / 5, "1/5"], [1 / 2, "1/2"], [1, "1"], [2, "2"], [4, "4"]];
const kLayers = [["body", "Body", "B"], ["regions", "Regions", "G"], ["motors", "Motors", "M"], ["colliders", "Colliders", "C"],
                 ["trails", "Trails", "T"], ["contacts", "Contacts", "X"], ["floor", "Floor", "O"]];
const kMostListed = 50;  // rows of a table

const byId = (id) => document.getElementById(id);

/** Returns an element with this text. */
function element(tag, text = "", className = "") {
  const made = document.createElement(tag);
  made.textContent = text;
  made.className = className;
  return made;
}

function tableRow(tag, cells) {
  const row = document.createElement("tr");
  for (const [text, className] of cells) row.append(element(tag, text, className));
  return row;
}

class Player {
  constructor(trace) {
    this.trace = trace;
    this.time_s = trace.first_s;
    this.row = 0;  // of the frame shown: several may have the same time
    this.isPlaying = false;
    this.scene = null;  // null: no WebGL
    this.raster = new Raster(byId("raster"), trace, (time_s) => this.seek(time_s));
    this.shownRow = -1;
  }

  start() {
    this.describe();
    this.fillChoices();
    const renderer = webglRenderer();
    if (renderer === null) {
      this.showStills();
    } else {
      this.scene = new Scene(byId("scene"), this.trace, renderer);
      this.scene.orbit.addEventListener("change", () => this.redraw());
    }
    this.connect();
    this.resize();
    if (this.scene) this.look("front");
    if (!window.matchMedia("(prefers-reduced-motion: reduce)").matches && this.scene !== null) this.play();
  }

  describe() {
    const {head, rows, people, colliders} = this.trace;
    const contacts = this.trace.sides.map((side) => side.reduce((sum, person) => sum + person.contact_row.length, 0));
    const inWords = (count) => count.toLocaleString("en");
    const alone = people.reduce((sum, person) => sum + person.alone.reduce((a, b) => a + b, 0), 0);
    byId("sides").append(...head.sides.map((title) => element("span", title)));
    const named = (count, noun) => `${inWords(count)} ${noun}${count === 1 ? "" : "s"}`;
    byId("about").textContent = [
      named(rows, "frame"), named(colliders.id.length, "collider"),
      head.sides.length > 1 ? `${contacts.map(inWords).join(" and ")} contacts, ${inWords(alone)} on one side alone`
        : named(contacts[0], "contact"),
      ...head.about].join(" · ");
    byId("precision").textContent =
      "Contacts and duties are exact. Poses and the paths of colliders are thinned for the picture: skin is at most " +
      `${head.error_mm.skin} mm from its place, and colliders are at most ${head.error_mm.colliders} mm from theirs.`;
    for (const warning of head.warnings) byId("warnings").append(element("li", warning));
    byId("warnings").hidden = head.warnings.length === 0;
    this.showTotals();
  }

  showTotals() {
    const rows = [];
    for (const total of this.trace.people.flatMap((person) => person.totals())) {
      const [by, title] = this.mostlyBy(total);
      const cells = [[total.name, ""], [total.on_s.toFixed(3), "n"], [`${total.contacts}`, "n"], [by, "n"]];
      cells.title = title;
      rows.push(cells);
    }
    byId("totals-title").hidden = rows.length === 0;
    this.fillTable("totals", [["Actuator", ""], ["On, s", "n"], ["Contacts", "n"], ["Mostly by", "n"]], rows, rows.length);
  }

  /** The collider with the most contacts, if it has more than any other; and the same at length. */
  mostlyBy({of, contacts}) {
    if (contacts === 0) return ["–", ""];
    const most = [...of.values()].reduce((a, b) => Math.max(a, b));
    const [collider, ...others] = [...of.keys()].filter((id) => of.get(id) === most);
    if (others.length > 0) return ["several", `${others.length + 1} colliders: ${most} of ${contacts} contacts each`];
    return [`${collider} (${most})`, `collider ${collider}: ${most} of ${contacts} contacts`];
  }

  fillChoices() {
    const add = (select, value, text) => {
      const option = element("option", text);
      option.value = value;
      select.append(option);
    };
    for (const [speed, text] of kSpeeds) add(byId("speed"), speed, text);
    byId("speed").value = 1;
    add(byId("of-collider"), "", "any");
    this.trace.colliders.id.forEach((id, i) => add(byId("of-collider"), i, id));
    add(byId("of-actuator"), "", "any");
    this.trace.people.forEach((person, k) => {
      person.info.actuators.forEach((_, i) => add(byId("of-actuator"), `${k} ${i + 1}`, person.who + person.actuatorName(i + 1)));
      add(byId("of-actuator"), `${k} 0`, person.who + person.actuatorName(0));
    });
    for (const [layer, text, key] of kLayers) this.addLayer(layer, text, key);
    const follow = this.addBox("follow", "Follow the person", "F", true, (on) => { if (this.scene) this.scene.follows = on; });
    follow.title = "Takes the camera along (F)";
    byId("scrubber").max = this.trace.rows - 1;
  }

  addLayer(layer, text, key) {
    this.addBox(`layer-${layer}`, text, key, true, (on) => {
      if (this.scene) this.scene.show(layer, on);
      this.redraw();
    });
  }

  addBox(id, text, key, checked, change) {
    const label = element("label");
    const box = document.createElement("input");
    box.type = "checkbox";
    box.id = id;
    box.checked = checked;
    box.addEventListener("change", () => change(box.checked));
    label.append(box, ` ${text}`);
    label.title = `Key ${key}`;
    byId("layers").append(label);
    return label;
  }

  /** Keys, each with its name, what it does as the help says it, and a function that does it. */
  keys() {
    const click = (id) => () => byId(id).click();
    const seekRow = (row) => () => this.seekRow(row());
    return new Map([
      [" ", ["Space", "play or pause", () => this.toggle()]],
      ["ArrowLeft", ["←", "one frame back; with shift, ten", (event) => this.step(event.shiftKey ? -10 : -1)]],
      ["ArrowRight", ["→", "one frame on; with shift, ten", (event) => this.step(event.shiftKey ? 10 : 1)]],
      ["Home", ["Home", "first frame", seekRow(() => 0)]],
      ["End", ["End", "last frame", seekRow(() => this.trace.rows - 1)]],
      ["n", ["N", "next contact", click("contact-after")]],
      ["p", ["P", "contact before", click("contact-before")]],
      ...(this.trace.head.sides.length > 1 ? [["d", ["D", "next contact on one side alone", () => this.toDifference()]]] : []),
      ["[", ["[", "slower", () => this.changeSpeed(-1)]],
      ["]", ["]", "faster", () => this.changeSpeed(1)]],
      ["+", ["+", "less time in the timeline", () => this.raster.zoom(1 / 2, this.time_s)]],
      ["-", ["-", "more time in the timeline", () => this.raster.zoom(2, this.time_s)]],
      ...Object.keys(kViews).map((view, i) => [`${i + 1}`, [`${i + 1}`, `from the ${view}`, () => this.look(view)]]),
      ["f", ["F", "follow the person", click("follow")]],
      ...kLayers.map(([layer, text, key]) =>
        [key.toLowerCase(), [key, `show or hide: ${text.toLowerCase()}`, click(`layer-${layer}`)]]),
      ["?", ["?", "this help", () => this.help()]],
    ]);
  }

  connect() {
    const keys = this.keys();
    for (const [name, what] of keys.values()) byId("keys").append(tableRow("td", [[name, ""], [what, ""]]));
    document.addEventListener("keydown", (event) => this.press(event, keys));
    const on = (id, act) => byId(id).addEventListener("click", act);
    on("play", () => this.toggle());
    on("step-back", () => this.step(-1));
    on("step-on", () => this.step(1));
    on("contact-before", () => this.toContact(-1));
    on("contact-after", () => this.toContact(1));
    on("help-button", () => this.help());
    on("timeline-wider", () => this.raster.zoom(2, this.time_s));
    on("timeline-closer", () => this.raster.zoom(1 / 2, this.time_s));
    for (const button of document.querySelectorAll("[data-view]"))
      button.addEventListener("click", () => this.look(button.dataset.view));
    byId("scrubber").addEventListener("input", () => this.seekRow(Number(byId("scrubber").value)));
    for (const select of document.querySelectorAll("select")) select.addEventListener("change", () => select.blur());
    window.addEventListener("resize", () => this.resize());
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.resize());
  }

  /** Keys that an element with the focus needs itself stay its own. */
  press(event, keys) {
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const needs = {SELECT: () => true, BUTTON: () => key === " ", INPUT: () => key === " " && event.target.type === "checkbox"};
    const own = needs[event.target.tagName];
    const written = event.getModifierState("AltGraph");  // as "[" is on some keyboards
    if (((event.ctrlKey || event.altKey) && !written) || event.metaKey || byId("help").open || !keys.has(key) || (own && own())) return;
    event.preventDefault();
    keys.get(key)[2](event);
  }

  help() { byId("help").showModal(); }

  look(view) {
    if (this.scene) this.scene.look(view);
    else this.stillView = view;
    this.redraw();
  }

  changeSpeed(by) {
    const select = byId("speed");
    select.selectedIndex = Math.min(kSpeeds.length - 1, Math.max(0, select.selectedIndex + by));
  }

  toggle() {
    if (this.isPlaying) this.pause();
    else this.play();
  }

  play() {
    if (this.time_s >= this.trace.last_s) this.moveTo(this.trace.first_s);
    this.isPlaying = true;
    byId("play").textContent = "Pause";
    let before_ms = null;
    const tick = (now_ms) => {
      if (before_ms !== null) this.advance((now_ms - before_ms) / 1000);
      before_ms = now_ms;
      if (this.isPlaying) this.ticking = requestAnimationFrame(tick);
    };
    this.ticking = requestAnimationFrame(tick);
  }

  /** `passed_s` of the reader's time have passed. A page that was hidden does not jump. */
  advance(passed_s) {
    this.moveTo(this.time_s + Math.min(0.25, passed_s) * Number(byId("speed").value));
    this.draw();
    if (this.time_s >= this.trace.last_s) this.pause();
  }

  pause() {
    if (!this.isPlaying) return;
    cancelAnimationFrame(this.ticking);
    this.isPlaying = false;
    byId("play").textContent = "Play";
    this.redraw();
  }

  moveTo(time_s) {
    this.time_s = Math.min(this.trace.last_s, Math.max(this.trace.first_s, time_s));
    this.row = this.trace.rowAt(this.time_s);
  }

  seek(time_s) {
    this.moveTo(time_s);
    this.redraw();
  }

  seekRow(row) {
    this.row = Math.min(this.trace.rows - 1, Math.max(0, row));
    this.time_s = this.trace.time_s[this.row];
    this.redraw();
  }

  step(frames) {
    this.pause();
    this.seekRow(this.row + frames);
  }

  toContact(direction) {
    this.pause();
    const [collider, actuator] = [byId("of-collider").value, byId("of-actuator").value];
    const [person, number] = actuator.split(" ").map(Number);
    const row = this.trace.rowOfContact(this.row, direction, (of, i) =>
      (collider === "" || of.contact_collider[i] === Number(collider)) &&
      (actuator === "" || (of === this.trace.people[person] && of.contact_actuator[i] === number)));
    if (row !== null) this.seekRow(row);
  }

  toDifference() {
    this.pause();
    const row = this.trace.rowOfContact(this.row, 1, (person, i) => person.alone[i]);
    if (row !== null) this.seekRow(row);
  }

  resize() {
    if (this.scene) this.scene.resize();
    this.raster.resize();
    this.redraw();
  }

  /** Draws once before the next picture of the screen, however often it is called until then. */
  redraw() {
    if (this.isWaiting || this.isPlaying) return;
    this.isWaiting = true;
    requestAnimationFrame(() => {
      this.isWaiting = false;
      this.draw();
    });
  }

  draw() {
    if (this.scene) this.scene.draw(this.time_s);
    else if (this.drawStill) this.drawStill();
    this.raster.draw(this.time_s);
    byId("time").textContent = `${this.time_s.toFixed(4)} s`;
    if (this.row === this.shownRow) return;
    this.shownRow = this.row;
    this.showNumbers(this.row);
  }

  showNumbers(row) {
    byId("frame").textContent = `${this.trace.frame[row]}`;
    byId("scrubber").value = row;
    byId("scrubber").setAttribute("aria-valuetext", `frame ${this.trace.frame[row]}`);
    const contacts = [];
    let count = 0;
    for (const alone of [1, 0])  // first what one side alone has, which the table must not cut off
      for (const person of this.trace.people) {
        const [first, end] = person.contactsOf(row);
        for (let i = first; i < end; ++i) {
          if (person.alone[i] !== alone) continue;
          ++count;
          if (contacts.length < kMostListed) contacts.push(this.contactCells(person, i));
        }
      }
    byId("count").textContent = `${count}`;
    this.fillTable("contacts", [["Collider", "n"], ["Triangle", "n"], ["t", "n"], ["Actuator", ""]], contacts, count);
    this.showMotors(row);
  }

  contactCells(person, i) {
    const cells = [[`${this.trace.colliders.id[person.contact_collider[i]]}`, "n"], [`${person.contact_triangle[i]}`, "n"],
                   [person.contact_t[i].toFixed(3), "n"], [person.who + person.actuatorName(person.contact_actuator[i]), ""]];
    const at = [...person.contact_position_m.subarray(i * 3, i * 3 + 3)].join(", ");
    cells.alone = person.alone[i] === 1;
    cells.title = `t ${person.contact_t[i]}, at ${at} m, side ${person.contact_side[i]}`;
    return cells;
  }

  fillTable(id, heads, rows, count) {
    byId(id).replaceChildren();
    if (rows.length === 0) return;
    const table = document.createElement("table");
    table.append(tableRow("th", heads));
    for (const cells of rows) {
      const row = tableRow("td", cells);
      if (cells.title) row.title = cells.title;
      if (cells.alone) row.className = "alone";
      table.append(row);
    }
    byId(id).append(table);
    if (count > rows.length) byId(id).append(element("p", `and ${count - rows.length} more`, "soft"));
  }

  showMotors(row) {
    const list = [];
    let count = 0;
    for (const person of this.trace.people) {
      person.info.actuators.forEach((actuator, i) => {
        const duty = person.dutyAt(i, row);
        if (duty === 0) return;
        ++count;
        if (list.length < kMostListed) list.push([[`${duty}`, "n"], [person.who + actuator.name, ""]]);
      });
    }
    this.fillTable("motors", [["Duty of 255", "n"], ["Actuator", ""]], list, count);
    if (count === 0) byId("motors").append(element("p", "none runs", "soft"));
  }

  showStills() {
    byId("failure").textContent =
      "This browser does not draw in three dimensions: it has no WebGL, or it is switched off in the browser's settings. " +
      "So here is a still picture of each frame; the timeline and all numbers work.";
    byId("failure").hidden = false;
    const still = new Still(byId("scene"), this.trace);
    byId("sides").replaceChildren();  // a still shows the first side
    this.drawStill = () => still.draw(this.time_s, this.stillView || "front");
  }
}

readPage().then((page) => {
  const player = new Player(new Trace(page));
  window.vestige = player;  // for tests, and for those who look around
  player.start();
}).catch((error) => {
  byId("failure").textContent = error.message;
  byId("failure").hidden = false;
});
