// The session of `ahm view` in a worker. Messages to it: {wasm}, then {name, body}; body is text, or for the request "file"
// [name, bytes]. It answers each with {status, type, body}, in order; before that it may send {stage, fraction}. After an answer with
// `failed`, start a new worker.
import {wasi} from './wasi.js';

const most = 65536;  // pages of memory, 4 GB
const decoder = new TextDecoder(), encoder = new TextEncoder();
let ahm, shown = 0;

const bytesAt = (pointer, count) => new Uint8Array(ahm.memory.buffer, pointer >>> 0, count);  // pointers above 2 GB are negative
const textAt = (pointer, count) => decoder.decode(bytesAt(pointer, count));

/** Shows the progress, at most ten times a second. */
function progress(stage, count, fraction) {
  const now = performance.now();
  if (now - shown < 100) return;
  shown = now;
  postMessage({stage: textAt(stage, count), fraction});
}

async function start(wasm) {
  const imports = wasi(wasm, () => ahm.memory);
  imports.ahm = {progress};
  ahm = (await WebAssembly.instantiate(wasm, imports)).exports;
  ahm._initialize();
}

/** Calls use(pointer, count, ...) with copies of byte arrays. */
function withBytes(arrays, use) {
  const pointers = arrays.map((array) => ahm.ahm_allocate(Math.max(array.length, 1)));
  if (pointers.includes(0)) throw new RangeError('out of memory');
  arrays.forEach((array, k) => bytesAt(pointers[k], array.length).set(array));
  const result = use(...arrays.flatMap((array, k) => [pointers[k], array.length]));
  pointers.forEach((pointer) => ahm.ahm_free(pointer));
  return result;
}

function answer(name, body) {
  if (name === 'file') {
    if (!withBytes([encoder.encode(body[0]), body[1]], ahm.ahm_file)) throw new RangeError('out of memory');
    return {status: 200, type: 'application/json', body: new Uint8Array().buffer};
  }
  const status = withBytes([encoder.encode(name), encoder.encode(body ?? '')], ahm.ahm_request);
  const type = ahm.ahm_answer_type(), length = bytesAt(type, 100).indexOf(0);
  return {status, type: textAt(type, length), body: bytesAt(ahm.ahm_answer(), ahm.ahm_answer_bytes()).slice().buffer};
}

/** The answer to a request that the module did not survive. */
function failure(error) {
  const isMemory = error instanceof RangeError || ahm.memory.buffer.byteLength / 65536 > 0.9 * most;
  const text = isMemory ? "out of memory: a page has at most 4 GB; open a smaller file, or use 'ahm view', which has no such limit"
                        : `the computation failed: ${error.message}`;
  return {status: 503, type: 'application/json', body: encoder.encode(JSON.stringify({error: text})).buffer, failed: true};
}

let started;
onmessage = async ({data: {wasm, name, body}}) => {
  if (wasm) return void (started = start(wasm));
  await started;
  let result;
  try {
    result = answer(name, body);
  } catch (error) {
    result = failure(error);
  }
  postMessage(result, [result.body]);
};
