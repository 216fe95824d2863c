// The session of the site at the end of its memory. AHM_SITE in the environment is its folder.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {test} from 'node:test';

import {wasi} from '../package/wasi.js';

const most = 65536;  // pages of 64 KiB
const encoder = new TextEncoder(), decoder = new TextDecoder();

function session() {
  const compiled = new WebAssembly.Module(readFileSync(`${process.env.AHM_SITE}/ahm.wasm`));
  const imports = wasi(compiled, () => exports.memory);
  imports.ahm = {progress() {}};
  const {exports} = new WebAssembly.Instance(compiled, imports);
  exports._initialize();
  const copy = (text) => {
    const bytes = encoder.encode(text), pointer = exports.ahm_allocate(bytes.length) >>> 0;
    new Uint8Array(exports.memory.buffer, pointer, bytes.length).set(bytes);
    return [pointer, bytes.length];
  };
  const request = (name, body) => {
    const status = exports.ahm_request(...copy(name), ...copy(body));
    const bytes = new Uint8Array(exports.memory.buffer, exports.ahm_answer(), exports.ahm_answer_bytes());
    return {status, text: decoder.decode(bytes)};
  };
  return {exports, copy, request};
}

/** A square of n x n vertices as an OFF file. */
function square(n) {
  const lines = ['OFF', `${n * n} ${2 * (n - 1) * (n - 1)} 0`];
  for (let i = 0; i < n; ++i) for (let j = 0; j < n; ++j) lines.push(`${i} ${j} 0`);
  for (let i = 1; i < n; ++i)
    for (let j = 1; j < n; ++j) {
      const k = i * n + j;
      lines.push(`3 ${k - n - 1} ${k} ${k - 1}`, `3 ${k - n - 1} ${k - n} ${k}`);
    }
  return lines.join('\n');
}

test('the end of memory is an answer with a message', () => {
  const {exports, copy, request} = session();
  assert.equal(exports.ahm_file(...copy('square.off'), ...copy(square(100))), 1);
  exports.memory.grow(most - exports.memory.buffer.byteLength / 65536 - 20);  // 1.25 MB remain
  const answer = request('open', 'square.off');
  assert.equal(answer.status, 503);
  assert.match(answer.text, /memory/);
});
