"use strict";
// Coarse meshes of large meshes, for a smooth display while the camera moves.

// Merges the vertices in each cell of a raster into the first one. Keeps triangles with corners in three cells, each triple once.
// @param cells  number of cells along the longest side of the bounding box
Ahm.coarse_triangles = function (surface, cells) {
  const p = surface.positions, t = surface.triangles, n = p.length / 3;
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let k = 0; k < p.length; ++k) {
    const x = p[k], c = k % 3;
    if (x < low[c]) low[c] = x;
    if (x > high[c]) high[c] = x;
  }
  const width = Math.max(high[0] - low[0], high[1] - low[1], high[2] - low[2]) / cells || 1;
  const first = new Map(), stands_for = new Uint32Array(n);
  for (let i = 0; i < n; ++i) {
    let cell = 0;
    for (let c = 0; c < 3; ++c) cell = cell * (cells + 1) + Math.floor((p[3 * i + c] - low[c]) / width);
    const found = first.get(cell);
    if (found === undefined) first.set(cell, i);
    stands_for[i] = found === undefined ? i : found;
  }
  const seen = new Set(), out = [];
  for (let k = 0; k < t.length; k += 3) {
    const a = stands_for[t[k]], b = stands_for[t[k + 1]], c = stands_for[t[k + 2]];
    if (a === b || b === c || c === a) continue;
    const key = [a, b, c].sort((x, y) => x - y).join();
    if (seen.has(key)) continue;
    seen.add(key);
    out.push(a, b, c);
  }
  return new Uint32Array(out);
};
