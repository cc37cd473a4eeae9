"use strict";
// The three-dimensional picture: bodies, colliders with their trails, and contact marks that fade.

const kTrail_s = 0.12;       // of the trace's time
const kTrailSteps = 8;
const kFade_s = 0.15;        // of the trace's time
const kMostMarks = 1024;     // the newest are drawn
const kPointRadius_m = 0.008;  // how a collider without a radius is drawn
const kViews = {front: 0, left: 90, back: 180, right: 270};  // degrees about +Y, from where the person looks

const kMarkVertexShader = `
attribute float age;
attribute float alone;
uniform float pixels;
varying float vAge;
varying float vAlone;
void main() {
  vAge = age;
  vAlone = alone;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_Position.z -= 0.002 * gl_Position.w;  // in front of the skin that it lies on
  gl_PointSize = pixels * (1.0 - 0.6 * age) * (1.0 + 0.5 * alone);
}`;

const kMarkFragmentShader = `
varying float vAge;
varying float vAlone;
void main() {
  float r = 2.0 * length(gl_PointCoord - 0.5);
  if (r > 1.0) discard;
  vec3 rim = mix(vec3(0.05), vec3(0.85, 0.0, 0.35), vAlone);
  gl_FragColor = vec4(r < 0.55 ? vec3(1.0) : rim, 1.0 - vAge);
}`;

const kTrailVertexShader = `
attribute float strength;
varying float vStrength;
void main() {
  vStrength = strength;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const kTrailFragmentShader = `
uniform vec3 colour;
varying float vStrength;
void main() { gl_FragColor = vec4(colour, 0.6 * vStrength); }`;

/** A geometry whose numbers change with every picture. */
function movingGeometry(points, ...names) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points * 3), 3).setUsage(THREE.DynamicDrawUsage));
  for (const name of names)
    geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(points), 1).setUsage(THREE.DynamicDrawUsage));
  return geometry;
}

class ContactMarks {
  constructor(people) {
    this.people = people;
    this.material = new THREE.ShaderMaterial({
      vertexShader: kMarkVertexShader, fragmentShader: kMarkFragmentShader, transparent: true, depthWrite: false,
      uniforms: {pixels: {value: 12}},
    });
    this.mesh = new THREE.Points(movingGeometry(kMostMarks, "age", "alone"), this.material);
    this.mesh.frustumCulled = false;
  }

  update(trace, time_s) {
    const {position, age, alone} = this.mesh.geometry.attributes;
    let count = 0;
    for (const person of this.people) {
      const end = person.contactsOf(trace.rowAt(time_s))[1];
      for (let i = end - 1; i >= 0 && count < kMostMarks; --i) {
        const old = (time_s - trace.time_s[person.contact_row[i]]) / kFade_s;
        if (old > 1) break;
        position.array.set(person.contactPlace(i), count * 3);
        alone.array[count] = person.alone[i];
        age.array[count++] = old;
      }
    }
    position.needsUpdate = age.needsUpdate = alone.needsUpdate = true;
    this.mesh.geometry.setDrawRange(0, count);
  }
}

class ColliderShapes {
  constructor(colliders) {
    this.colliders = colliders;
    const count = colliders.id.length;
    const shape = new THREE.IcosahedronBufferGeometry(1, 1);
    this.balls = new THREE.InstancedMesh(shape, new THREE.MeshLambertMaterial({color: 0x8a94a0}), Math.max(1, count));
    this.trailMaterial = new THREE.ShaderMaterial({
      vertexShader: kTrailVertexShader, fragmentShader: kTrailFragmentShader, transparent: true, depthWrite: false,
      uniforms: {colour: {value: new THREE.Color(0x8a94a0)}},
    });
    this.trails = new THREE.LineSegments(movingGeometry(Math.max(1, count) * kTrailSteps * 2, "strength"), this.trailMaterial);
    this.balls.frustumCulled = this.trails.frustumCulled = false;
  }

  update(time_s) {
    const matrix = new THREE.Matrix4();
    const place = [0, 0, 0, 0];
    let shown = 0;
    for (let i = 0; i < this.colliders.id.length; ++i) {
      if (!this.colliders.place(i, time_s, place)) continue;
      const radius = place[3] > 0 ? place[3] : kPointRadius_m;
      matrix.makeScale(radius, radius, radius).setPosition(place[0], place[1], place[2]);
      this.balls.setMatrixAt(shown++, matrix);
    }
    this.balls.count = shown;
    this.balls.instanceMatrix.needsUpdate = true;
    if (this.trails.visible) this.updateTrails(time_s);
  }

  updateTrails(time_s) {
    const {position, strength} = this.trails.geometry.attributes;
    const [near, far] = [[0, 0, 0, 0], [0, 0, 0, 0]];
    let count = 0;
    for (let i = 0; i < this.colliders.id.length; ++i) {
      for (let step = 0; step < kTrailSteps; ++step) {
        const later_s = time_s - kTrail_s * step / kTrailSteps;
        const earlier_s = later_s - kTrail_s / kTrailSteps;
        if (!this.colliders.joined(i, earlier_s, later_s)) break;
        this.colliders.place(i, later_s, near);
        this.colliders.place(i, earlier_s, far);
        position.array.set(near.slice(0, 3), count * 3);
        position.array.set(far.slice(0, 3), count * 3 + 3);
        strength.array[count++] = 1 - step / kTrailSteps;
        strength.array[count++] = 1 - (step + 1) / kTrailSteps;
      }
    }
    position.needsUpdate = strength.needsUpdate = true;
    this.trails.geometry.setDrawRange(0, count);
  }
}

/** Returns what the browser draws with, as far as it tells: "" if it does not, null if it has no WebGL. */
function webglRenderer() {
  const context = document.createElement("canvas").getContext("webgl");
  if (context === null) return null;
  const info = context.getExtension("WEBGL_debug_renderer_info");
  return info === null ? "" : context.getParameter(info.UNMASKED_RENDERER_WEBGL);
}

class Scene {
  /** `renderer`: see `webglRenderer`. */
  constructor(canvas, trace, renderer) {
    this.trace = trace;
    this.canvas = canvas;
    // Without a GPU, smooth edges would cost a third of the pictures in a second.
    const inSoftware = /swiftshader|llvmpipe|software|basic render/i.test(renderer);
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: !inSoftware, alpha: true});
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.05, 500);
    this.orbit = new THREE.OrbitControls(this.camera, canvas);
    this.orbit.enableKeys = false;  // the page's own keys
    this.follows = true;
    this.sides = trace.sides.map((people) => this.makeSide(people));
    this.colliders = new ColliderShapes(trace.colliders);
    const light = new THREE.DirectionalLight(0xffffff, 0.6);
    this.camera.add(light);
    this.scene.add(this.camera, new THREE.AmbientLight(0xffffff, 0.6), this.colliders.balls, this.colliders.trails,
                   ...this.sides.map(({group}) => group));
    this.frameBodies();
    canvas.addEventListener("webglcontextrestored", () => this.resize());
  }

  /** What one side shows and the other does not. */
  makeSide(people) {
    const bodies = people.map((person) => new Body(person));
    const marks = new ContactMarks(people);
    const group = new THREE.Group();
    group.add(marks.mesh, ...bodies.map((body) => body.mesh));
    return {bodies, marks, group};
  }

  get bodies() { return this.sides.flatMap(({bodies}) => bodies); }

  /** Finds how large the people are and where they stand, in the first frame. */
  frameBodies() {
    const box = new THREE.Box3();
    for (const person of this.trace.people.filter(({hasPoses}) => hasPoses)) {
      person.pose(this.trace.first_s);
      const step = Math.max(1, Math.floor(person.position_bind.length / 3 / 2000));
      for (let vertex = 0; vertex < person.position_bind.length / 3; vertex += step) {
        const place = [0, 0, 0];
        person.addVertex(vertex, 1, place);
        box.expandByPoint(new THREE.Vector3(...place));
      }
    }
    if (box.isEmpty()) box.set(new THREE.Vector3(-1, 0, -1), new THREE.Vector3(1, 2, 1));
    const floor_m = box.min.y;
    this.middle = box.getCenter(new THREE.Vector3());
    this.size_m = Math.max(0.01, box.getSize(new THREE.Vector3()).length());
    this.root = new THREE.Vector3().fromArray(this.trace.people[0].root);
    this.middle.sub(this.root);
    const grid = new THREE.GridHelper(10, 20, 0x9aa3ad, 0xc3c9d0);
    grid.material.transparent = true;
    grid.material.opacity = 0.5;
    grid.position.set(this.root.x, floor_m, this.root.z);
    this.grid = grid;
    this.scene.add(grid);
  }

  /** Turns the camera: "front", "back", "left" or "right" of the first person. */
  look(view) {
    const angle = (kViews[view] + this.trace.people[0].body.facing_deg) * Math.PI / 180;
    const narrow = Math.min(1, this.camera.aspect);
    const away_m = this.size_m * 1.7 / Math.max(0.35, narrow);
    const target = this.middle.clone().add(this.root);
    this.orbit.target.copy(target);
    this.camera.position.set(target.x + away_m * Math.sin(angle), target.y + 0.08 * away_m, target.z + away_m * Math.cos(angle));
    this.camera.near = this.size_m / 100;
    this.camera.far = this.size_m * 200;
    this.camera.updateProjectionMatrix();
    this.orbit.update();
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    for (const {marks} of this.sides) marks.material.uniforms.pixels.value = 12 * ratio;
    this.camera.aspect = width / this.sides.length / Math.max(1, height);
    this.camera.updateProjectionMatrix();
  }

  show(layer, visible) {
    const parts = {body: this.bodies.map((body) => body.mesh), colliders: [this.colliders.balls], trails: [this.colliders.trails],
                   contacts: this.sides.map(({marks}) => marks.mesh), floor: [this.grid]};
    for (const part of parts[layer] || []) part.visible = visible;
    const uniforms = {regions: "showRegions", motors: "showMotors"};
    if (layer in uniforms) for (const body of this.bodies) body.material.uniforms[uniforms[layer]].value = visible ? 1 : 0;
  }

  draw(time_s) {
    const row = this.trace.rowAt(time_s);
    for (const body of this.bodies) {
      body.person.pose(time_s);
      body.update(row);
    }
    this.followRoot();
    this.colliders.update(time_s);
    for (const {marks} of this.sides) marks.update(this.trace, time_s);
    this.sides.forEach((_, i) => this.drawSide(i));
  }

  /** Draws one side in its part of the canvas. All see the same camera. */
  drawSide(shown) {
    const width = this.canvas.clientWidth / this.sides.length;
    this.sides.forEach(({group}, i) => { group.visible = i === shown; });
    this.renderer.setViewport(shown * width, 0, width, this.canvas.clientHeight);
    this.renderer.setScissor(shown * width, 0, width, this.canvas.clientHeight);
    this.renderer.setScissorTest(this.sides.length > 1);
    this.renderer.render(this.scene, this.camera);
  }

  /** Takes the camera along with the first person. */
  followRoot() {
    const root = new THREE.Vector3().fromArray(this.trace.people[0].root);
    if (this.follows) {
      const moved = root.clone().sub(this.root);
      this.camera.position.add(moved);
      this.orbit.target.add(moved);
    }
    this.root.copy(root);
  }
}
