"use strict";
// What the page carries: a JSON head, and one deflated block with the bytes of all arrays. analysis/view/page_data.hpp
// says how an array is stored and what each one means.

const kArrayTypes = {
  u8: Uint8Array, i8: Int8Array, u16: Uint16Array, i16: Int16Array, u32: Uint32Array, i32: Int32Array,
  f32: Float32Array, f64: Float64Array,
};

/** Puts the bytes of each number side by side again, and turns differences back into values. */
function readArray(bytes, entry) {
  const values = new kArrayTypes[entry.type](entry.count);
  const size = values.BYTES_PER_ELEMENT;
  const target = new Uint8Array(values.buffer);
  for (let place = 0; place < size; ++place) {
    const from = entry.at + place * entry.count;
    for (let i = 0; i < entry.count; ++i) target[i * size + place] = bytes[from + i];
  }
  if (entry.delta) for (let i = entry.delta; i < entry.count; ++i) values[i] += values[i - entry.delta];
  return values;
}

function bytesOfBase64(text) {
  const letters = atob(text.trim());
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

/** Returns the head, and the arrays by their names. */
async function readPage() {
  const head = JSON.parse(document.getElementById("head").textContent);
  if (typeof DecompressionStream === "undefined" || !Element.prototype.replaceChildren)
    throw new Error("This browser is too old for the page: use Chromium 86, Firefox 113, Safari 16.4 or later.");
  const packed = new Blob([bytesOfBase64(document.getElementById("data").textContent)]);
  const stream = packed.stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  if (bytes.length !== head.bytes) throw new Error("The page's data is not complete: write the page again.");
  const arrays = {};
  for (const [name, entry] of Object.entries(head.arrays)) arrays[name] = readArray(bytes, entry);
  return {head, arrays};
}

/** Returns the index of the last of `values`, ascending from `first` to `end`, that is at most `value`; first - 1 if none is. */
function lastUpTo(values, value, first = 0, end = values.length) {
  while (first < end) {
    const middle = (first + end) >> 1;
    if (values[middle] <= value) first = middle + 1;
    else end = middle;
  }
  return first - 1;
}
