"use strict";
// Without WebGL: a picture of one frame, whose triangles are painted one after the other, the farthest first.

class Still {
  constructor(canvas, trace) {
    // A canvas that was asked for WebGL gives no other context.
    this.canvas = canvas.cloneNode();
    canvas.replaceWith(this.canvas);
    this.trace = trace;
  }

  /** Returns the vertices of a person, seen from one side: right, up, towards the eye. */
  project(person, angle) {
    const count = person.position_bind.length / 3;
    const points = new Float32Array(count * 3);
    for (let i = 0; i < count; ++i) {
      const place = [0, 0, 0];
      person.addVertex(i, 1, place);
      points.set(this.turned(place, angle), i * 3);
    }
    return points;
  }

  turned([x, y, z], angle) {
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    return [x * c - z * s, y, x * s + z * c];
  }

  /** The colour of a triangle by the actuator at its middle, brighter where it faces the eye. */
  colourOf(person, triangle, row, facing) {
    const map = person.info.map;
    const at = (k, axis) => person.texture_coordinate[person.triangle[triangle * 3 + k] * 2 + axis];
    const middle = (axis) => { const m = (at(0, axis) + at(1, axis) + at(2, axis)) / 3; return m - Math.floor(m); };
    const texel = map.by_triangle ? triangle
      : Math.floor(middle(1) * map.height) * map.width + Math.floor(middle(0) * map.width);
    const number = person.map_actuator[texel];
    const duty = number === 0 ? 0 : person.dutyAt(number - 1, row) / 255;
    const text = number === 0 ? person.info.unmapped : person.info.actuators[number - 1].colour;
    const colour = parseInt(text.slice(1), 16);
    const mix = (shift, motor) => Math.round(((colour >> shift & 255) * (1 - duty) + motor * duty) * (0.45 + 0.55 * facing));
    return `rgb(${mix(16, 255)},${mix(8, 212)},${mix(0, 0)})`;
  }

  draw(time_s, view) {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    this.canvas.width = width;
    this.canvas.height = height;
    const context = this.canvas.getContext("2d");
    const angle = (kViews[view] + this.trace.people[0].body.facing_deg) * Math.PI / 180;
    const people = this.trace.sides[0].filter(({hasPoses}) => hasPoses).map((person) => {
      person.pose(time_s);
      return {person, points: this.project(person, angle)};
    });
    const toPage = this.fit(people, width, height);
    for (const body of people) this.paintBody(context, body, toPage, time_s);
    this.paintDots(context, toPage, angle, time_s);
  }

  fit(people, width, height) {
    const low = [Infinity, Infinity];
    const high = [-Infinity, -Infinity];
    for (const {points} of people)
      for (let i = 0; i < points.length; ++i)
        if (i % 3 < 2) {
          low[i % 3] = Math.min(low[i % 3], points[i]);
          high[i % 3] = Math.max(high[i % 3], points[i]);
        }
    const scale = 0.85 * Math.min(width / (high[0] - low[0]), height / (high[1] - low[1]));
    return (x, y) => [width / 2 + (x - (low[0] + high[0]) / 2) * scale, height / 2 - (y - (low[1] + high[1]) / 2) * scale];
  }

  paintBody(context, {person, points}, toPage, time_s) {
    const row = this.trace.rowAt(time_s);
    const corner = (triangle, k, axis) => points[person.triangle[triangle * 3 + k] * 3 + axis];
    const far = Float32Array.from({length: person.triangle.length / 3},
                                  (_, i) => corner(i, 0, 2) + corner(i, 1, 2) + corner(i, 2, 2));
    const order = Uint32Array.from(far, (_, i) => i).sort((a, b) => far[a] - far[b]);
    for (const triangle of order) {
      const [a, b, c] = [0, 1, 2].map((k) => [0, 1, 2].map((axis) => corner(triangle, k, axis)));
      const [u, v] = [b, c].map((end) => end.map((x, i) => x - a[i]));
      const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      const facing = normal[2] / (Math.hypot(...normal) || 1);
      if (facing <= 0) continue;
      context.fillStyle = context.strokeStyle = this.colourOf(person, triangle, row, facing);
      context.beginPath();
      for (const point of [a, b, c]) context.lineTo(...toPage(point[0], point[1]));
      context.closePath();
      context.fill();
      context.stroke();
    }
  }

  paintDots(context, toPage, angle, time_s) {
    const place = [0, 0, 0, 0];
    context.fillStyle = "#8a94a0";
    const dot = (at, size) => {
      const [x, y] = this.turned(at, angle);
      context.beginPath();
      context.arc(...toPage(x, y), size, 0, 2 * Math.PI);
      context.fill();
      context.stroke();
    };
    context.strokeStyle = "#ffffff";
    for (let i = 0; i < this.trace.colliders.id.length; ++i)
      if (this.trace.colliders.place(i, time_s, place)) dot(place, 3);
    context.fillStyle = "#ffffff";
    context.strokeStyle = "#000000";
    for (const person of this.trace.sides[0]) {
      const [first, end] = person.contactsOf(this.trace.rowAt(time_s));
      for (let i = first; i < end; ++i) dot(person.contactPlace(i), 4);
    }
  }
}
