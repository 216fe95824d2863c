"use strict";
// Decoding of bundles (ahm/render/page.hpp), and formatting of numbers.
const Ahm = {};

Ahm.decode = function (buffer) {
  const view = new DataView(buffer);
  if (buffer.byteLength < 8 || view.getUint32(0, true) !== 0x314d4841) throw new Error("the data is not a bundle of ahm");
  const begin = 8 + view.getUint32(4, true);
  const result = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, begin - 8)));
  const types = { f32: Float32Array, u8: Uint8Array, u16: Uint16Array, i32: Int32Array, u32: Uint32Array };
  for (const name in result.arrays) {
    const array = result.arrays[name];
    result[name] = new types[array.type](buffer, begin + array.at, array.count);
  }
  return result;
};

// The bundle embedded in the page; null in a page from a server.
Ahm.embedded = function (id) {
  const element = document.getElementById(id);
  const text = atob(element.textContent.trim());
  element.textContent = "";  // free the memory
  if (!text) return null;
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return Ahm.decode(bytes.buffer);
};

Ahm.number = (x, digits) => (Number.isFinite(x) ? String(Number(x.toPrecision(digits || 6))) : "–");

Ahm.statuses = ["ok", "disconnected", "beyond_radius", "unreached", "removed"];
