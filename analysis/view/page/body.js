"use strict";
// Draws one person: the skinned mesh, its regions in the figures' colours, which turn to the colour of a running motor.

const kBodyVertexShader = `
attribute vec2 place;
varying vec2 vPlace;
varying vec3 vNormal;
#include <skinning_pars_vertex>
void main() {
  #include <skinbase_vertex>
  vec3 objectNormal = normal;
  #include <skinnormal_vertex>
  vec3 transformed = position;
  #include <skinning_vertex>
  vPlace = place;
  vNormal = normalMatrix * objectNormal;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(transformed, 1.0);
}`;

// The map's texel says the actuator: its low byte in r, its high byte in a. The row of colours says the colour, and in
// a how strongly the motor runs. A colour is darkest where the skin turns away from the eye.
const kBodyFragmentShader = `
uniform sampler2D regions;
uniform sampler2D colours;
uniform float colourRows;
uniform float showRegions;
uniform float showMotors;
uniform vec3 motorColour;
varying vec2 vPlace;
varying vec3 vNormal;
void main() {
  vec4 texel = texture2D(regions, fract(vPlace));
  float low = floor(texel.r * 255.0 + 0.5);
  float high = floor(texel.a * 255.0 + 0.5);
  vec4 region = texture2D(colours, vec2((low + 0.5) / 256.0, (high + 0.5) / colourRows));
  vec4 bare = texture2D(colours, vec2(0.5 / 256.0, 0.5 / colourRows));
  float facing = abs(normalize(vNormal).z);
  vec3 colour = mix(bare.rgb, region.rgb, showRegions) * (0.45 + 0.55 * facing);
  float duty = region.a * showMotors;
  gl_FragColor = vec4(mix(colour, motorColour * (0.8 + 0.2 * facing), duty), 1.0);
}`;

/** Normals for the bind pose. Vertices in one place share one, so that seams of the texture do not show. */
function weldedNormals(position, triangles) {
  const places = new Map();
  const placeOf = new Uint32Array(position.length / 3);
  for (let i = 0; i < placeOf.length; ++i) {
    const key = `${position[i * 3]},${position[i * 3 + 1]},${position[i * 3 + 2]}`;
    if (!places.has(key)) places.set(key, places.size);
    placeOf[i] = places.get(key);
  }
  const sums = new Float32Array(places.size * 3);
  const corner = [0, 1, 2].map(() => new THREE.Vector3());
  for (let i = 0; i < triangles.length; i += 3) {
    corner.forEach((point, k) => point.fromArray(position, triangles[i + k] * 3));
    const normal = corner[1].sub(corner[0]).cross(corner[2].sub(corner[0]));  // as long as the triangle is large
    for (let k = 0; k < 3; ++k) {
      const at = placeOf[triangles[i + k]] * 3;
      sums[at] += normal.x;
      sums[at + 1] += normal.y;
      sums[at + 2] += normal.z;
    }
  }
  const normals = new Float32Array(position.length);
  const one = new THREE.Vector3();
  placeOf.forEach((place, i) => one.fromArray(sums, place * 3).normalize().toArray(normals, i * 3));
  return normals;
}

/** Where each vertex looks into the map. Of a map by triangle, all corners of a triangle look at the triangle's texel. */
function placesInMap(person, corners) {
  const map = person.info.map;
  if (!map.by_triangle) return person.texture_coordinate;
  const places = new Float32Array(corners * 2);
  for (let i = 0; i < corners; ++i) {
    const triangle = Math.floor(i / 3);
    places[i * 2] = (triangle % map.width + 0.5) / map.width;
    places[i * 2 + 1] = (Math.floor(triangle / map.width) + 0.5) / map.height;
  }
  return places;
}

/** Repeats the numbers of each corner's vertex, so that no triangles share a vertex. */
function spread(values, size, triangles) {
  const out = new values.constructor(triangles.length * size);
  triangles.forEach((vertex, i) => out.set(values.subarray(vertex * size, (vertex + 1) * size), i * size));
  return out;
}

function bodyGeometry(person) {
  const triangles = person.triangle;
  const apart = person.info.map.by_triangle;
  const take = (values, size) => (apart ? spread(values, size, triangles) : values);
  const geometry = new THREE.BufferGeometry();
  const add = (name, values, size, normalized) =>
    geometry.setAttribute(name, new THREE.BufferAttribute(values, size, normalized));
  add("position", take(person.position_bind, 3), 3, false);
  add("normal", take(weldedNormals(person.position_bind, triangles), 3), 3, false);
  add("skinIndex", take(person.joint, 4), 4, false);
  add("skinWeight", take(person.weight, 4), 4, true);
  add("place", placesInMap(person, triangles.length), 2, false);
  if (!apart) geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
  return geometry;
}

/** A texture whose texels are taken as they are. */
function dataTexture(bytes, width, height, format) {
  const texture = new THREE.DataTexture(bytes, width, height, format);
  texture.unpackAlignment = 1;
  texture.needsUpdate = true;
  return texture;
}

class Body {
  constructor(person) {
    this.person = person;
    const info = person.info;
    this.colourRows = Math.ceil((info.actuators.length + 1) / 256);
    this.colours = new Uint8Array(this.colourRows * 1024);
    [info.unmapped, ...info.actuators.map((actuator) => actuator.colour)].forEach((text, number) => {
      const colour = parseInt(text.slice(1), 16);
      this.colours.set([colour >> 16, (colour >> 8) & 255, colour & 255, 0], number * 4);
    });
    this.colourTexture = dataTexture(this.colours, 256, this.colourRows, THREE.RGBAFormat);
    const texels = new Uint8Array(person.map_actuator.slice().buffer);
    this.material = new THREE.ShaderMaterial({
      vertexShader: kBodyVertexShader, fragmentShader: kBodyFragmentShader, skinning: true, side: THREE.DoubleSide,
      uniforms: {
        regions: {value: dataTexture(texels, info.map.width, info.map.height, THREE.LuminanceAlphaFormat)},
        colours: {value: this.colourTexture},
        colourRows: {value: this.colourRows},
        showRegions: {value: 1},
        showMotors: {value: 1},
        motorColour: {value: new THREE.Color(0xffd400)},
      },
    });
    this.mesh = new THREE.SkinnedMesh(bodyGeometry(person), this.material);
    this.mesh.frustumCulled = false;
    this.bindPalette();
  }

  /** The trace says where each joint's skin goes, so three.js has no bones to multiply: only their number matters. */
  bindPalette() {
    const bones = Array.from({length: this.person.body.joints}, () => new THREE.Bone());
    const skeleton = new THREE.Skeleton(bones, bones.map(() => new THREE.Matrix4()));
    skeleton.update = () => {
      skeleton.boneMatrices.set(this.person.palette);
      if (skeleton.boneTexture !== undefined) skeleton.boneTexture.needsUpdate = true;
    };
    this.mesh.bindMode = "detached";  // otherwise the mesh's own place would be taken off again
    this.mesh.bind(skeleton, new THREE.Matrix4());
  }

  update(row) {
    this.mesh.position.fromArray(this.person.root);
    this.person.info.actuators.forEach((_, i) => { this.colours[(i + 1) * 4 + 3] = this.person.dutyAt(i, row); });
    this.colourTexture.needsUpdate = true;
  }
}
