// libahm in WebAssembly: a thin layer over the functions of web/src/abi.cpp. Types and documentation are in index.d.ts.

import {wasi} from './wasi.js';

export class AhmError extends Error {
  get name() {
    return this.constructor.name;
  }
}
export class InvalidArgument extends AhmError {}
export class InvalidGeometry extends AhmError {}
export class InvalidGraph extends AhmError {}
export class NotPositiveDefinite extends AhmError {}
export class ResourceExhausted extends AhmError {}
const errors = {AhmError, InvalidArgument, InvalidGeometry, InvalidGraph, NotPositiveDefinite, ResourceExhausted};

export const statusNames = Object.freeze(['ok', 'disconnected', 'beyond_radius', 'unreached', 'removed']);
const methods = ['automatic', 'polar', 'heat', 'exact'];

/** Memory and exported functions of one module. */
class Module {
  constructor(exports) {
    this.exports = exports;
  }

  /** A typed array in the memory. Pointers above 2 GiB are negative numbers in JavaScript. */
  array(Type, pointer, length) {
    return new Type(this.exports.memory.buffer, pointer >>> 0, length);
  }

  text(pointer) {
    const bytes = this.array(Uint8Array, pointer);
    return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
  }

  /** Throws the error of the last call if its result is 0. */
  checked(result) {
    if (result) return result;
    const kind = this.text(this.exports.ahm_error_kind());
    throw new errors[kind](this.text(this.exports.ahm_error_message()));
  }

  /** Calls body with pointers to copies of typed arrays; null becomes 0. */
  withArrays(arrays, body) {
    const pointers = [];
    try {
      for (const array of arrays)
        pointers.push(array === null ? 0 : this.checked(this.exports.ahm_allocate(Math.max(array.byteLength, 8))));
      arrays.forEach((array, k) => {  // after all allocations: these may replace the buffer
        if (array !== null) this.array(array.constructor, pointers[k], array.length).set(array);
      });
      return body(...pointers);
    } finally {
      for (const pointer of pointers) this.exports.ahm_free(pointer);
    }
  }

  column(k) {
    return this.array(Float64Array, this.exports.ahm_column(k), this.exports.ahm_column_length(k)).slice();
  }

  /** Calls a function that stores columns, and returns what read() makes of them. */
  columns(result, read) {
    this.checked(result);
    try {
      return read((k) => this.column(k));
    } finally {
      this.exports.ahm_forget_columns();
    }
  }
}

const registry = new FinalizationRegistry(({release, pointer}) => release(pointer));

/** An object in the memory of the module. */
class Handle {
  constructor(module, pointer, release) {
    this.module = module;
    this.pointer = pointer;
    this.release = release;
    registry.register(this, {release, pointer}, this);
  }

  get() {
    if (this.pointer === 0) throw new InvalidArgument('the object was freed; create a new one');
    return this.pointer;
  }

  free() {
    if (this.pointer === 0) return;
    registry.unregister(this);
    this.release(this.pointer);
    this.pointer = 0;
  }
}

/** Flat numbers from a flat array or from an array of arrays of `width` numbers. */
function flat(values, width, Type, name) {
  if (values instanceof Type && values.length % width === 0) return values;
  const list = ArrayBuffer.isView(values) ? values : Array.from(values ?? []);
  const nested = typeof list[0] === 'object';
  if (nested) {
    const bad = list.findIndex((entry) => entry?.length !== width);
    if (bad >= 0) throw new InvalidArgument(`${name}: entry ${bad} has ${list[bad]?.length ?? 'no'} numbers instead of ${width}`);
  }
  const numbers = nested ? list.flatMap((entry) => Array.from(entry)) : list;
  const odd = Array.isArray(numbers) ? numbers.findIndex((x) => typeof x !== 'number') : -1;
  if (odd >= 0) throw new InvalidArgument(`${name}: ${numbers[odd]} is not a number`);
  if (numbers.length % width !== 0)
    throw new InvalidArgument(`${name}: ${numbers.length} numbers are not a multiple of ${width}`);
  if (Type === Int32Array) checkIntegers(numbers, name);
  return Type.from(numbers);
}

function checkIntegers(numbers, name) {
  const bad = numbers.findIndex((x) => !Number.isInteger(x) || Math.abs(x) > 0x7fffffff);
  if (bad >= 0) throw new InvalidArgument(`${name}: entry ${bad} is ${numbers[bad]}; expected an integer`);
}

/** The numbers of a place, as read_places in abi.cpp reads them. */
function placeNumbers(place) {
  if (typeof place === 'number') {
    if (!Number.isSafeInteger(place)) throw new InvalidArgument(`row ${place} is not an integer`);
    return [0, place];
  }
  if (place?.position?.length === 3) return [1, ...place.position];
  if (place?.weights?.length > 0) {
    checkIntegers([place.face], 'face');
    return [2, place.face, place.weights.length, ...place.weights];
  }
  throw new InvalidArgument('a place is a row number, {position: [x, y, z]} or {face, weights}');
}

const places = (list) => Float64Array.from(list.flatMap(placeNumbers));

function checkChoice(value, choices, name) {
  if (!choices.includes(value)) throw new InvalidArgument(`${name} is ${value}; choose one of ${choices.join(', ')}`);
  return value;
}

/** Options of meshes as arguments of the module: whether to split, and the distance of merged vertices (-1: none). */
function meshOptions({nonManifold = 'error', weld = null} = {}) {
  checkChoice(nonManifold, ['error', 'split'], 'nonManifold');
  if (weld !== null && !(typeof weld === 'number' && weld >= 0)) throw new InvalidArgument(`weld is ${weld}; expected a distance of 0 or more`);
  return [nonManifold === 'split' ? 1 : 0, weld ?? -1];
}

export class Surface {
  #handle;

  constructor(handle) {
    this.#handle = handle;
  }
  get rows() {
    return this.#handle.module.exports.ahm_rows(this.#handle.get());
  }
  get warnings() {
    const {module} = this.#handle;
    const lines = module.text(module.checked(module.exports.ahm_warnings(this.#handle.get()))).split('\n').slice(0, -1);
    return lines.map((line) => {
      const [id, text] = line.split('\t');
      return {id, text};
    });
  }
  free() {
    this.#handle.free();
  }
  /** Used by Library.solver. */
  static handleOf(surface) {
    return surface.#handle;
  }
}

export class Solver {
  #handle;

  constructor(handle) {
    this.#handle = handle;
  }

  get method() {
    const {module} = this.#handle;
    return module.text(module.exports.ahm_method(this.#handle.get()));
  }

  logMap(source, {radius = Infinity, uAxis = null, quality = false} = {}) {
    const {module} = this.#handle;
    const axis = uAxis === null ? null : Float64Array.from(uAxis);
    if (axis !== null && axis.length !== 3) throw new InvalidArgument('uAxis: expected 3 numbers');
    return module.withArrays([places([source]), axis], (place, u) =>
      module.columns(module.exports.ahm_log_map(this.#handle.get(), place, u, radius, quality ? 1 : 0), (column) => {
        const [u, v, distance, angle, spread, errorEstimate, status] = [0, 1, 2, 3, 4, 5, 6].map(column);
        const map = {u, v, distance, angle, spread, status: Uint8Array.from(status)};
        if (errorEstimate.length > 0) map.errorEstimate = errorEstimate;
        if (quality) map.quality = column(7);
        return map;
      }),
    );
  }

  distance(sources, {radius = Infinity} = {}) {
    const {module} = this.#handle;
    const list = Array.isArray(sources) ? sources : [sources];
    if (list.length === 0) throw new InvalidArgument('sources: empty; expected a place or an array of places');
    return module.withArrays([places(list)], (pointer) =>
      module.columns(module.exports.ahm_distance(this.#handle.get(), pointer, list.length, radius), (column) => column(0)),
    );
  }

  path(start, end) {
    const {module} = this.#handle;
    return module.withArrays([places([start, end])], (pointer) =>
      module.columns(module.exports.ahm_path(this.#handle.get(), pointer), readPath),
    );
  }

  trace(start, direction, length) {
    const {module} = this.#handle;
    const [x, y, z] = direction;
    return module.withArrays([places([start])], (pointer) =>
      module.columns(module.exports.ahm_trace(this.#handle.get(), pointer, x, y, z, length), readPath),
    );
  }

  localMaps({radius = 0, k = 0, sources = null} = {}) {
    const {module} = this.#handle;
    checkIntegers([k], 'k');
    if (sources !== null && sources.length === 0) throw new InvalidArgument('sources: empty; leave it out for all rows');
    return module.withArrays([sources && places(sources)], (pointer) =>
      module.columns(module.exports.ahm_local_maps(this.#handle.get(), pointer, sources?.length ?? 0, radius, k), (column) => {
        const [u, v, distance, weight, cos, sin] = [2, 3, 4, 5, 6, 7].map(column);
        return {begin: Int32Array.from(column(0)), row: Int32Array.from(column(1)), u, v, distance, weight, cos, sin};
      }),
    );
  }

  free() {
    this.#handle.free();
  }
}

function readPath(column) {
  const [length, complete, status] = column(1);
  return {points: column(0), length, complete: complete === 1, status: statusNames[status]};
}

export class Library {
  #module;

  constructor(module) {
    this.#module = module;
  }

  get version() {
    return this.#module.text(this.#module.exports.ahm_version());
  }

  triangleMesh(positions, triangles, options) {
    const [split, weld] = meshOptions(options);
    const points = flat(positions, 3, Float64Array, 'positions');
    const corners = flat(triangles, 3, Int32Array, 'triangles');
    return this.#surface([points, corners], (p, c) =>
      this.#module.exports.ahm_triangle_mesh(p, points.length / 3, c, corners.length / 3, split, weld),
    );
  }

  polygonMesh(positions, faces, options) {
    const [split, weld] = meshOptions(options);
    const points = flat(positions, 3, Float64Array, 'positions');
    const bad = Array.from(faces).findIndex((face) => !(face?.length >= 0));
    if (bad >= 0) throw new InvalidArgument(`faces: entry ${bad} is ${faces[bad]}; expected an array of vertex numbers`);
    const begin = [0];
    for (const face of faces) begin.push(begin.at(-1) + face.length);
    const corners = flat(Array.from(faces).flatMap((face) => Array.from(face)), 1, Int32Array, 'faces');
    return this.#surface([points, Int32Array.from(begin), corners], (p, b, c) =>
      this.#module.exports.ahm_polygon_mesh(p, points.length / 3, b, faces.length, c, split, weld),
    );
  }

  pointCloud(positions, {normals = null} = {}) {
    const points = flat(positions, 3, Float64Array, 'positions');
    const directions = normals === null ? null : flat(normals, 3, Float64Array, 'normals');
    if (directions !== null && directions.length !== points.length)
      throw new InvalidArgument(`normals: ${directions.length / 3} for ${points.length / 3} points`);
    return this.#surface([points, directions], (p, d) =>
      this.#module.exports.ahm_point_cloud(p, points.length / 3, d),
    );
  }

  solver(surface, {method = 'automatic'} = {}) {
    const handle = Surface.handleOf(surface);
    const number = methods.indexOf(checkChoice(method, methods, 'method'));
    const pointer = this.#module.checked(this.#module.exports.ahm_solver(handle.get(), number));
    return new Solver(new Handle(this.#module, pointer, this.#module.exports.ahm_release_solver));
  }

  #surface(arrays, build) {
    const pointer = this.#module.withArrays(arrays, (...pointers) => this.#module.checked(build(...pointers)));
    return new Surface(new Handle(this.#module, pointer, this.#module.exports.ahm_release_surface));
  }
}

async function compile(source) {
  if (source instanceof WebAssembly.Module) return source;
  if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) return WebAssembly.compile(source);
  const url = new URL(source ?? './libahm.wasm', import.meta.url);
  if (url.protocol === 'file:') {
    const {readFile} = await import('node:fs/promises');
    return WebAssembly.compile(await readFile(url));
  }
  const response = await fetch(url);
  if (!response.ok) throw new AhmError(`${url}: status ${response.status}`);
  return WebAssembly.compile(await response.arrayBuffer());
}

export async function load(source) {
  const compiled = await compile(source);
  let memory;
  const {exports} = await WebAssembly.instantiate(compiled, wasi(compiled, () => memory));
  memory = exports.memory;
  exports._initialize();
  return new Library(new Module(exports));
}
