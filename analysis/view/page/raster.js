"use strict";
// The timeline: a row for each motor with its duty, a tick for each contact, and a cursor at the time shown.

const kMostHeight_px = 240;
const kRowHeight_px = 15;
const kLeastLabelled_px = 10;

class Raster {
  /** Calls `seek(time_s)` while the reader drags. */
  constructor(canvas, trace, seek) {
    this.canvas = canvas;
    this.trace = trace;
    this.picture = document.createElement("canvas");
    this.from_s = trace.first_s;
    this.to_s = Math.max(trace.last_s, trace.first_s + 1e-6);
    this.lines = this.makeLines();
    const drag = (event) => seek(this.timeAt(event.clientX - canvas.getBoundingClientRect().left));
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      drag(event);
    });
    canvas.addEventListener("pointermove", (event) => { if (canvas.hasPointerCapture(event.pointerId)) drag(event); });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      if (event.deltaX !== 0) this.pan(event.deltaX);
      else this.zoom(Math.exp(event.deltaY / 400), this.timeAt(event.offsetX));
    }, {passive: false});
  }

  /** One line for each person's actuators, and one for skin without any, where it was touched. */
  makeLines() {
    const lines = [];
    for (const person of this.trace.people) {
      person.info.actuators.forEach((actuator, i) =>
        lines.push({name: person.who + actuator.name, colour: actuator.colour, person, number: i + 1}));
      if (person.contact_actuator.includes(0))
        lines.push({name: person.who + person.actuatorName(0), colour: person.info.unmapped, person, number: 0});
    }
    return lines;
  }

  resize() {
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    this.width = this.canvas.clientWidth;
    const lines = Math.max(1, this.lines.length);
    this.line_px = Math.min(kRowHeight_px, kMostHeight_px / lines);
    this.height = Math.ceil(this.line_px * lines) + 2;
    const label_px = this.trace.head.sides.length > 1 ? 250 : 170;
    this.left = this.line_px >= kLeastLabelled_px ? Math.min(label_px, Math.round(this.width * 0.3)) : 8;
    this.canvas.style.height = `${this.height}px`;
    for (const canvas of [this.canvas, this.picture]) {
      canvas.width = this.width * ratio;
      canvas.height = this.height * ratio;
      canvas.getContext("2d").setTransform(ratio, 0, 0, ratio, 0, 0);
    }
    this.paint();
  }

  xAt(time_s) { return this.left + (time_s - this.from_s) / (this.to_s - this.from_s) * (this.width - this.left - 4); }

  timeAt(x) {
    const share = (x - this.left) / (this.width - this.left - 4);
    return this.from_s + Math.min(1, Math.max(0, share)) * (this.to_s - this.from_s);
  }

  /** Makes the time shown `factor` times as long, with `time_s` in its place. */
  zoom(factor, time_s) {
    const {first_s, last_s} = this.trace;
    const whole_s = Math.max(last_s - first_s, 1e-6);
    const span_s = Math.min(whole_s, Math.max(whole_s * 1e-4, (this.to_s - this.from_s) * factor));
    const share = (time_s - this.from_s) / (this.to_s - this.from_s);
    this.show(time_s - share * span_s, span_s);
  }

  /** Moves the time shown by a number of pixels. */
  pan(by_px) {
    const span_s = this.to_s - this.from_s;
    this.show(this.from_s + by_px / (this.width - this.left - 4) * span_s, span_s);
  }

  /** Shows `span_s` from `from_s` on, or from the nearest time at which the trace lasts as long. */
  show(from_s, span_s) {
    this.from_s = Math.min(this.trace.last_s - span_s, Math.max(this.trace.first_s, from_s));
    this.to_s = this.from_s + span_s;
    this.paint();
    this.drawCursor();
  }

  paint() {
    const context = this.picture.getContext("2d");
    const style = getComputedStyle(document.documentElement);
    context.clearRect(0, 0, this.width, this.height);
    context.font = "11px system-ui, sans-serif";
    context.textBaseline = "middle";
    this.lines.forEach((line, i) => {
      const top = 1 + i * this.line_px;
      context.fillStyle = style.getPropertyValue("--line");
      context.fillRect(this.left, top + this.line_px - 1, this.width - this.left - 4, Math.min(1, this.line_px / 4));
      if (this.line_px >= kLeastLabelled_px) this.paintLabel(context, line, top, style.getPropertyValue("--ink"));
      if (line.number > 0) this.paintDuty(context, line, top);
    });
    this.paintContacts(context, style);
  }

  paintLabel(context, line, top, ink) {
    context.save();
    context.beginPath();
    context.rect(0, top, this.left - 4, this.line_px);
    context.clip();
    context.fillStyle = line.colour;
    context.fillRect(3, top + 3, 8, this.line_px - 6);
    context.fillStyle = ink;
    context.fillText(line.name, 15, top + this.line_px / 2);
    context.restore();
  }

  paintDuty(context, line, top) {
    const {row, duty} = line.person.changes[line.number - 1];
    context.fillStyle = line.colour;
    for (let i = 0; i < row.length; ++i) {
      if (duty[i] === 0) continue;
      const from = Math.max(this.left, this.xAt(this.trace.time_s[row[i]]));
      const end_s = i + 1 < row.length ? this.trace.time_s[row[i + 1]] : this.trace.last_s;
      const to = Math.min(this.width - 4, this.xAt(end_s));
      context.globalAlpha = duty[i] / 255;
      if (to >= from) context.fillRect(from, top + this.line_px * 0.1, Math.max(1, to - from), this.line_px * 0.7);
    }
    context.globalAlpha = 1;
  }

  /** At most one tick for each pixel of a line. */
  paintContacts(context, style) {
    for (const alone of [0, 1]) this.paintTicks(context, alone, style.getPropertyValue(alone ? "--alone" : "--ink"));
  }

  paintTicks(context, alone, colour) {
    context.fillStyle = colour;
    for (const person of this.trace.people) {
      const lineOf = new Map(this.lines.map((line, i) => [line.person === person ? line.number : -1, i]));
      const painted = new Map();
      for (let i = 0; i < person.contact_row.length; ++i) {
        if (person.alone[i] !== alone) continue;
        const x = Math.round(this.xAt(this.trace.time_s[person.contact_row[i]]));
        const line = lineOf.get(person.contact_actuator[i]);
        if (x < this.left || x > this.width - 4 || painted.get(line) === x) continue;
        painted.set(line, x);
        context.fillRect(x, 1 + line * this.line_px + this.line_px * 0.55, 1, this.line_px * 0.4);
      }
    }
  }

  /** Moves the cursor. One that leaves the time shown takes it along. */
  draw(time_s) {
    const moved = time_s !== this.shown_s;
    this.shown_s = time_s;
    const span_s = this.to_s - this.from_s;
    if (moved && (time_s < this.from_s || time_s > this.to_s)) this.show(time_s - 0.1 * span_s, span_s);
    else this.drawCursor();
  }

  drawCursor() {
    const context = this.canvas.getContext("2d");
    context.clearRect(0, 0, this.width, this.height);
    context.drawImage(this.picture, 0, 0, this.width, this.height);
    context.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--accent");
    const x = Math.round(this.xAt(this.shown_s));
    if (x >= this.left) context.fillRect(x - 1, 0, 2, this.height);
  }
}
