// The package in Node: known maps, errors, and the maps of the native program (AHM_PROGRAM).
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {test} from 'node:test';
import * as libahm from 'libahm';

const ahm = await libahm.load();

/** A flat square of side x side points, or a surface of the same triangles with the given heights. */
function square(side, height = () => 0) {
  const positions = [], triangles = [];
  for (let i = 0; i < side; ++i)
    for (let j = 0; j < side; ++j) {
      const x = i / (side - 1), y = j / (side - 1);
      positions.push([x, y, height(x, y)]);
      if (i + 1 < side && j + 1 < side) {
        const a = i * side + j;
        triangles.push([a, a + side, a + side + 1], [a, a + side + 1, a + 1]);
      }
    }
  return {positions, triangles};
}

const near = (found, expected, tolerance, text) => assert.ok(Math.abs(found - expected) <= tolerance, `${text}: ${found}, ${expected}`);

function expectPlane(map, positions, source, tolerance) {
  positions.forEach(([x, y], i) => {
    near(map.u[i], x - positions[source][0], tolerance, `u of ${i}`);
    near(map.v[i], y - positions[source][1], tolerance, `v of ${i}`);
    near(map.distance[i], Math.hypot(map.u[i], map.v[i]), tolerance, `distance of ${i}`);
    assert.equal(libahm.statusNames[map.status[i]], 'ok');
  });
}

test('the module has the version of the package', () => {
  assert.equal(ahm.version, JSON.parse(readFileSync('node_modules/libahm/package.json', 'utf8')).version);
});

test('maps of a flat square are its coordinates, by every method', () => {
  const {positions, triangles} = square(21);
  const mesh = ahm.triangleMesh(positions, triangles);
  assert.equal(mesh.rows, 441);
  for (const method of ['polar', 'heat', 'exact']) {
    const solver = ahm.solver(mesh, {method});
    assert.equal(solver.method, method);
    expectPlane(solver.logMap(220, {uAxis: [1, 0, 0]}), positions, 220, 1e-9);
    solver.free();
  }
});

test('typed arrays and arrays of arrays are the same input', () => {
  const {positions, triangles} = square(9, (x, y) => 0.3 * x * y);
  const nested = ahm.solver(ahm.triangleMesh(positions, triangles)).logMap(7);
  const typed = ahm.solver(ahm.triangleMesh(Float64Array.from(positions.flat()), Uint32Array.from(triangles.flat()))).logMap(7);
  assert.deepEqual(typed, nested);
});

test('polygons and clouds have maps', () => {
  const {positions} = square(21);
  const faces = [];
  for (let i = 0; i < 20; ++i) for (let j = 0; j < 20; ++j) faces.push([21 * i + j, 21 * i + j + 21, 21 * i + j + 22, 21 * i + j + 1]);
  const polygons = ahm.solver(ahm.polygonMesh(positions, faces)).logMap(220, {uAxis: [1, 0, 0]});
  expectPlane(polygons, positions, 220, 1e-9);
  const normals = positions.map(() => [0, 0, 1]);
  const cloud = ahm.solver(ahm.pointCloud(positions, {normals})).logMap(220, {uAxis: [1, 0, 0], quality: true});
  expectPlane(cloud, positions, 220, 1e-9);
  assert.ok(cloud.quality.every((q) => q > 0.5));
});

test('welded meshes have the maps of the mesh without repeated vertices', () => {
  const {positions, triangles} = square(11, (x, y) => 0.2 * x * y);
  const whole = ahm.solver(ahm.triangleMesh(positions, triangles)).logMap(60, {uAxis: [1, 0, 0]});
  const origin = triangles.flat(), corners = origin.map((_, k) => k);  // each triangle has its own vertices
  const apart = origin.map((row, k) => positions[row].map((x, c) => x + (c < 2 ? 1e-6 * Math.sin(k) : 0)));
  corners.push(0, 1, 1);  // without area
  const faces = [...corners.keys()].filter((k) => k % 3 === 0).map((k) => corners.slice(k, k + 3));
  const source = origin.indexOf(60);
  for (const [points, weld, tolerance] of [[origin.map((row) => positions[row]), 0, 1e-12], [apart, 1e-5, 1e-4]])
    for (const surface of [ahm.triangleMesh(points, corners, {weld}), ahm.polygonMesh(points, faces, {weld})]) {
      const map = ahm.solver(surface).logMap(source, {uAxis: [1, 0, 0]});
      assert.equal(map.u.length, origin.length);
      origin.forEach((row, k) => near(map.distance[k], whole.distance[row], tolerance, `distance of ${k}`));
    }
  const points = origin.map((row) => positions[row]), end = [0, 0, 1];
  const solver = ahm.solver(ahm.triangleMesh(points, [0, 1, 1, ...corners], {weld: 0}));  // face 0 has no area
  near(solver.distance({face: 1, weights: end})[2], 0, 1e-12, 'the last corner of face 1');
  assert.throws(() => solver.distance({face: 0, weights: end}), /face 0/);
  assert.throws(() => ahm.triangleMesh(points, corners, {weld: -1}), libahm.InvalidArgument);
});

test('surfaces have warnings', () => {
  const {positions, triangles} = square(5);
  assert.deepEqual(ahm.triangleMesh(positions, triangles).warnings, []);
  const moved = positions.map(([x, y, z]) => [x + 3, y, z]);
  const twice = ahm.triangleMesh([...positions, ...moved], [...triangles, ...triangles.map((t) => t.map((v) => v + 25))]);
  assert.deepEqual(twice.warnings.map(({id}) => id), ['components']);
  assert.match(twice.warnings[0].text, /2 components/);
});

test('places, radius, distances and paths', () => {
  const {positions, triangles} = square(21);
  const solver = ahm.solver(ahm.triangleMesh(positions, triangles));
  const map = solver.logMap({position: [0.31, 0.52, 0]}, {radius: 0.2});
  assert.equal(libahm.statusNames[map.status[0]], 'beyond_radius');
  assert.ok(Number.isNaN(map.u[0]));
  near(map.distance[220], Math.hypot(0.19, 0.02), 1e-9, 'distance');
  const distance = solver.distance([0, {face: 799, weights: [0, 1, 0]}]);
  near(distance[440], 0, 1e-12, 'the last corner');
  near(distance[220], Math.SQRT1_2, 1e-9, 'the center');
  const path = solver.path(0, 440);
  near(path.length, Math.SQRT2, 1e-12, 'length');
  assert.equal(path.status, 'ok');
  assert.deepEqual([...path.points.slice(-3)], [1, 1, 0]);
  const trace = solver.trace(220, [1, 0, 0], 0.25);
  near(trace.points.at(-3), 0.75, 1e-12, 'end of the trace');
});

test('local maps are the log maps of each row within the radius', () => {
  const {positions, triangles} = square(21, (x, y) => 0.2 * x * y);
  const solver = ahm.solver(ahm.triangleMesh(positions, triangles), {method: 'polar'});
  const all = solver.localMaps({radius: 0.2});
  assert.equal(all.begin.length, 442);
  const row = 220, whole = solver.logMap(row, {radius: 0.2});
  const entries = [...Array(all.begin[row + 1] - all.begin[row]).keys()].map((k) => all.begin[row] + k);
  assert.equal(all.row[entries[0]], row);
  assert.deepEqual(entries.map((e) => all.row[e]).sort((a, b) => a - b), [...whole.status.keys()].filter((i) => whole.status[i] === 0));
  for (const e of entries) {
    near(all.u[e], whole.u[all.row[e]], 1e-9, 'u');
    near(all.v[e], whole.v[all.row[e]], 1e-9, 'v');
    near(all.distance[e], whole.distance[all.row[e]], 1e-9, 'distance');
    near(Math.hypot(all.cos[e], all.sin[e]), 1, 1e-9, 'transport');
  }
  const one = solver.localMaps({k: 7, sources: [row]});
  assert.deepEqual([...one.begin], [0, 7]);
  assert.deepEqual([...one.row], entries.slice(0, 7).map((e) => all.row[e]));
  assert.throws(() => solver.localMaps({radius: -1}), libahm.InvalidArgument);
});

test('errors are of the class of the library, with its message', () => {
  const {positions, triangles} = square(5);
  const mesh = ahm.triangleMesh(positions, triangles);
  const solver = ahm.solver(mesh);
  const refused = (body, kind, text) =>
    assert.throws(body, (error) => error instanceof kind && error instanceof libahm.AhmError && error instanceof Error && text.test(error.message));
  refused(() => solver.logMap(25), libahm.InvalidArgument, /row 25/);
  refused(() => solver.logMap(1.5), libahm.InvalidArgument, /1\.5/);
  refused(() => solver.logMap([1, 2, 3]), libahm.InvalidArgument, /place/);
  refused(() => solver.logMap(0, {radius: -1}), libahm.InvalidArgument, /radius/);
  refused(() => ahm.triangleMesh(positions, [[0, 1, 99]]), libahm.InvalidGeometry, /99/);
  refused(() => ahm.triangleMesh(positions, [[0, 1]]), libahm.InvalidArgument, /triangles/);
  refused(() => ahm.triangleMesh(positions, triangles, {weld: true}), libahm.InvalidArgument, /weld is true/);
  refused(() => ahm.triangleMesh([null, ...positions.slice(1)], triangles), libahm.InvalidArgument, /positions: entry 0 has no numbers/);
  refused(() => ahm.pointCloud([0, null, 2]), libahm.InvalidArgument, /positions: null is not a number/);
  refused(() => solver.distance([]), libahm.InvalidArgument, /sources/);
  refused(() => ahm.polygonMesh(positions, [0, 1, 2]), libahm.InvalidArgument, /faces: entry 0/);
  refused(() => ahm.pointCloud([[0, 0, 0], [1, 0, 0]]), libahm.InvalidGeometry, /point/);
  refused(() => ahm.solver(mesh, {method: 'best'}), libahm.InvalidArgument, /method/);
  refused(() => ahm.solver(ahm.pointCloud(positions), {method: 'exact'}).logMap(0), libahm.InvalidArgument, /./);
  mesh.free();
  mesh.free();
  assert.equal(solver.logMap(0).u.length, 25);  // the solver keeps the surface
  refused(() => mesh.rows, libahm.InvalidArgument, /freed/);
});

test('freed memory is used again', () => {
  const {positions, triangles} = square(41);
  const once = () => {
    const mesh = ahm.triangleMesh(positions, triangles), solver = ahm.solver(mesh, {method: 'heat'});
    solver.logMap(0);
    solver.free();
    mesh.free();
  };
  const before = process.memoryUsage().arrayBuffers;
  for (let k = 0; k < 30; ++k) once();
  assert.ok(process.memoryUsage().arrayBuffers - before < 100e6);
});

test('memory above 2 GiB is used', async () => {
  const {instantiate} = WebAssembly;
  let instance;
  WebAssembly.instantiate = async (...sources) => (instance = await instantiate(...sources));
  const high = await libahm.load().finally(() => (WebAssembly.instantiate = instantiate));
  high.triangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).free();  // the first allocation takes all memory up to here
  instance.exports.memory.grow(33000);  // 2.01 GiB
  const {positions, triangles} = square(101);
  const map = high.solver(high.triangleMesh(positions, triangles)).logMap(0, {uAxis: [1, 0, 0]});
  near(map.u.at(-1), 1, 1e-9, 'u of the opposite corner');
  assert.throws(() => high.triangleMesh(positions, [[0, 1, 99999]]), /99999/);
});

test('maps are those of the native program', {skip: !process.env.AHM_PROGRAM && 'AHM_PROGRAM is not set'}, () => {
  const folder = mkdtempSync(join(tmpdir(), 'libahm-'));
  try {
    const {positions, triangles} = square(61, (x, y) => 0.3 * Math.sin(5 * x + 2 * y) * Math.cos(4 * y - x));
    const file = join(folder, 'mesh.obj');
    writeFileSync(file, positions.map((p) => `v ${p.join(' ')}\n`).join('') + triangles.map((t) => `f ${t.map((v) => v + 1).join(' ')}\n`).join(''));
    for (const method of ['polar', 'heat', 'exact']) {
      const output = join(folder, `${method}.csv`);
      execFileSync(process.env.AHM_PROGRAM, ['logmap', file, '--source', '1000', '--method', method, '-o', output]);
      const [header, ...lines] = readFileSync(output, 'utf8').trim().split('\n').map((line) => line.split(','));
      const map = ahm.solver(ahm.triangleMesh(positions, triangles), {method}).logMap(1000);
      for (const name of ['u', 'v', 'distance']) {
        const column = header.indexOf(name);
        assert.ok(column >= 0, name);
        lines.forEach((line, i) => near(map[name][i], Number(line[column]), 1e-9, `${method}: ${name} of row ${i}`));
      }
    }
  } finally {
    rmSync(folder, {recursive: true});
  }
});
