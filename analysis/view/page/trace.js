"use strict";
// The trace at any time: the bodies' poses, their contacts and motors, and the colliders' places. Nothing here draws.
// A row is a frame's place among the frames of the page, from 0 on; a frame's number is the trace's own.

const kRounding_s = 1e-9;  // of the difference of two times

/** The skin of one person, and what happens to it. */
class Person {
  constructor(number, arrays, scene) {
    const info = scene.head.people[number];
    this.info = info;
    this.body = scene.head.bodies[info.body];
    this.scene = scene;
    this.who = this.prefix();
    for (const prefix of [`body_${info.body + 1}/`, `person_${number + 1}/`])
      for (const [name, values] of Object.entries(arrays))
        if (name.startsWith(prefix)) this[name.slice(prefix.length)] = values;
    this.palette = new Float32Array(this.body.joints * 16);
    for (let joint = 0; joint < this.body.joints; ++joint) this.palette[joint * 16 + 15] = 1;
    this.root = [0, 0, 0];
    this.changes = this.changesByActuator();
  }

  /** What goes before the names of actuators: the side, if there are two, and the person, if there are several. */
  prefix() {
    const {sides, bodies} = this.scene.head;
    const parts = [];
    if (sides.length > 1) parts.push(sides[this.info.side]);
    if (bodies.length > 1) parts.push(this.info.name);
    return parts.map((part) => `${part}: `).join("");
  }

  /** Rows and duties of each actuator's changes. */
  changesByActuator() {
    const changes = this.info.actuators.map(() => ({row: [], duty: []}));
    for (let i = 0; i < this.duty.length; ++i) {
      const of = changes[this.duty_actuator[i]];
      of.row.push(this.duty_row[i]);
      of.duty.push(this.duty[i]);
    }
    return changes;
  }

  /** The duty of an actuator, counted from 0: 0 to 255. */
  dutyAt(actuator, row) {
    const changes = this.changes[actuator];
    const last = lastUpTo(changes.row, row);
    return last < 0 ? 0 : changes.duty[last];
  }

  get hasPoses() { return this.pose_row.length > 0; }

  /** Moves the palette and the root to a time, between the two poses that the page holds around it. */
  pose(time_s) {
    if (!this.hasPoses) return;
    const rows = this.pose_row;
    const before = Math.max(0, lastUpTo(rows, this.scene.rowAt(time_s)));
    const after = before + 1 < rows.length && !this.pose_begins[before + 1] ? before + 1 : before;
    const from_s = this.scene.time_s[rows[before]];
    const span_s = this.scene.time_s[rows[after]] - from_s;
    const part = span_s > 0 ? Math.min(1, Math.max(0, (time_s - from_s) / span_s)) : 0;
    for (let axis = 0; axis < 3; ++axis) {
      const [a, b] = [this.pose_root[before * 3 + axis], this.pose_root[after * 3 + axis]];
      this.root[axis] = (a + (b - a) * part) * this.scene.unit_m;
    }
    const size = this.body.joints * 12;
    for (let i = 0; i < size; ++i) {
      const [a, b] = [this.pose_matrix[before * size + i], this.pose_matrix[after * size + i]];
      const column = Math.floor(i / 3);
      const step = this.body.matrix_step[2 * (column >> 2) + (column % 4 === 3 ? 1 : 0)];
      this.palette[column * 4 + (i % 3)] = (a + (b - a) * part) * step;
    }
  }

  /** Adds `share` times the place of a vertex under the pose to `out`, in metres from the scene's origin. */
  addVertex(vertex, share, out) {
    const [x, y, z] = this.position_bind.subarray(vertex * 3, vertex * 3 + 3);
    for (let k = 0; k < 4; ++k) {
      const weight = share * this.weight[vertex * 4 + k] / 65535;
      if (weight === 0) continue;
      const m = this.joint[vertex * 4 + k] * 16;
      const p = this.palette;
      out[0] += weight * (p[m] * x + p[m + 4] * y + p[m + 8] * z + p[m + 12] + this.root[0]);
      out[1] += weight * (p[m + 1] * x + p[m + 5] * y + p[m + 9] * z + p[m + 13] + this.root[1]);
      out[2] += weight * (p[m + 2] * x + p[m + 6] * y + p[m + 10] * z + p[m + 14] + this.root[2]);
    }
  }

  /** The place of a contact on the skin as it is now: it stays with the skin. */
  contactPlace(contact) {
    const place = [0, 0, 0];
    const triangle = this.contact_triangle[contact] * 3;
    const u = this.contact_barycentric[contact * 2];
    const v = this.contact_barycentric[contact * 2 + 1];
    this.addVertex(this.triangle[triangle], 1 - u - v, place);
    this.addVertex(this.triangle[triangle + 1], u, place);
    this.addVertex(this.triangle[triangle + 2], v, place);
    return place;
  }

  /** Returns the first contact of a row and the one after its last. */
  contactsOf(row) {
    return [lastUpTo(this.contact_row, row - 1) + 1, lastUpTo(this.contact_row, row) + 1];
  }

  /** How long each actuator is on in the whole trace, and the contacts that it got, by collider; from most to least. */
  totals() {
    const {time_s, end_s} = this.scene;
    const totals = this.changes.map((changes, i) => {
      let on_s = 0;
      changes.row.forEach((row, k) => {
        const until_s = k + 1 < changes.row.length ? time_s[changes.row[k + 1]] : end_s;
        if (changes.duty[k] > 0) on_s += until_s - time_s[row];
      });
      return {name: this.who + this.actuatorName(i + 1), on_s, contacts: 0, of: new Map()};
    });
    this.contact_actuator.forEach((number, i) => {
      if (number === 0) return;
      const total = totals[number - 1];
      const collider = this.scene.colliders.id[this.contact_collider[i]];
      ++total.contacts;
      total.of.set(collider, (total.of.get(collider) || 0) + 1);
    });
    return totals.sort((a, b) => b.on_s - a.on_s || b.contacts - a.contacts);
  }

  actuatorName(number) {
    return number === 0 ? "no actuator" : this.info.actuators[number - 1].name;
  }
}

/** The colliders' ways, each a list of keys between which it moves in a straight line. */
class Colliders {
  constructor(arrays, scene) {
    this.scene = scene;
    this.id = arrays.collider_id;
    this.first = arrays.track_first;
    this.row = arrays.key_row;
    this.position = arrays.key_position;
    this.radius = arrays.key_radius;
    this.begins = arrays.key_begins;
  }

  /** Returns the key before a time, or -1 where the collider is absent. */
  keyAt(collider, time_s) {
    if (time_s < this.scene.first_s) return -1;
    const first = this.first[collider];
    const end = this.first[collider + 1];
    const row = this.scene.rowAt(time_s);
    const key = lastUpTo(this.row, row, first, end);
    if (key < first) return -1;
    const isLast = key + 1 === end || this.begins[key + 1];
    return isLast && row > this.row[key] ? -1 : key;
  }

  /** Whether the collider was there all the time between two times, and did not jump. */
  joined(collider, from_s, to_s) {
    let key = this.keyAt(collider, from_s);
    const last = this.keyAt(collider, to_s);
    if (key < 0 || last < 0) return false;
    while (key < last) if (this.begins[++key]) return false;
    return true;
  }

  /** Writes the place in metres from the scene's origin to `out`, and its radius. Returns whether the collider is there. */
  place(collider, time_s, out) {
    const key = this.keyAt(collider, time_s);
    if (key < 0) return false;
    const next = key + 1 < this.first[collider + 1] && !this.begins[key + 1] ? key + 1 : key;
    const from_s = this.scene.time_s[this.row[key]];
    const span_s = this.scene.time_s[this.row[next]] - from_s;
    const part = span_s > 0 ? (time_s - from_s) / span_s : 0;
    const mix = (a, b) => (a + (b - a) * part) * this.scene.unit_m;
    for (let axis = 0; axis < 3; ++axis) out[axis] = mix(this.position[key * 3 + axis], this.position[next * 3 + axis]);
    out[3] = mix(this.radius[key], this.radius[next]);
    return true;
  }
}

class Trace {
  constructor({head, arrays}) {
    this.head = head;
    this.unit_m = head.unit_m;
    this.frame = arrays.frame_index;
    this.time_s = Float64Array.from(arrays.time_ns, (ns) => ns / 1e9);
    this.colliders = new Colliders(arrays, this);
    this.people = head.people.map((_, i) => new Person(i, arrays, this));
    for (const person of this.people) person.alone = this.contactsAlone(person);
  }

  /** The sides of the page, each a list of people. */
  get sides() { return Array.from({length: Math.max(1, this.head.sides.length)}, (_, i) => this.people.filter((p) => p.info.side === i)); }

  /**
   * Whether each contact of a person is found, or felt, on that person's side alone. Contacts of the two sides make
   * pairs: of the same collider in the same frame, and what is left over within `same_contact_s`. Alone is a contact
   * without a partner, and one with an actuator whose partner has none.
   */
  contactsAlone(person) {
    const alone = new Uint8Array(person.contact_row.length);
    const other = this.people.find(({info}) => info.body === person.info.body && info.side !== person.info.side);
    if (other === undefined) return alone;
    const its = this.byCollider(other);
    const partner = new Map();
    for (const [collider, mine] of this.byCollider(person))
      for (const [i, k] of this.pairs(person, mine, other, its.get(collider) || [])) partner.set(i, k);
    for (let i = 0; i < alone.length; ++i) {
      const felt = person.contact_actuator[i] > 0;
      alone[i] = !partner.has(i) || (felt && other.contact_actuator[partner.get(i)] === 0);
    }
    return alone;
  }

  /** The contacts of each collider, in the order of time. */
  byCollider(person) {
    const of = new Map();
    person.contact_collider.forEach((collider, i) => {
      if (!of.has(collider)) of.set(collider, []);
      of.get(collider).push(i);
    });
    return of;
  }

  /** Pairs of contacts of one collider. */
  pairs(person, mine, other, its) {
    const found = [];
    const rows = new Map(its.map((i) => [other.contact_row[i], i]));
    const left = mine.filter((i) => {
      const same = rows.get(person.contact_row[i]);
      if (same !== undefined) found.push([i, same]);
      return same === undefined;
    });
    const taken = new Set(found.map(([, i]) => i));
    const rest = its.filter((i) => !taken.has(i));
    for (let a = 0, b = 0; a < left.length && b < rest.length;) {
      const later_s = this.time_s[person.contact_row[left[a]]] - this.time_s[other.contact_row[rest[b]]];
      if (Math.abs(later_s) <= this.head.same_contact_s + kRounding_s) found.push([left[a++], rest[b++]]);
      else if (later_s < 0) ++a;
      else ++b;
    }
    return found;
  }

  get rows() { return this.frame.length; }
  get first_s() { return this.time_s[0]; }
  get last_s() { return this.time_s[this.rows - 1]; }

  /** The last frame lasts as long as the one before it. */
  get end_s() { return this.rows > 1 ? 2 * this.last_s - this.time_s[this.rows - 2] : this.last_s; }

  /** The frame that is valid at a time: the last that is not later. */
  rowAt(time_s) { return Math.max(0, lastUpTo(this.time_s, time_s)); }

  /**
   * Returns the nearest row before (-1) or after (+1) `row` with a contact for which `fits(person, contact)` holds, or null.
   */
  rowOfContact(row, direction, fits) {
    let best = null;
    for (const person of this.people) {
      const [first, end] = person.contactsOf(row);
      for (let i = direction > 0 ? end : first - 1; i >= 0 && i < person.contact_row.length; i += direction) {
        if (!fits(person, i)) continue;
        const found = person.contact_row[i];
        if (best === null || (found - best) * direction < 0) best = found;
        break;
      }
    }
    return best;
  }
}
