"use strict";
// Picking: the first intersection of a ray from the eye with the surface. Tests all triangles or discs, which takes a few milliseconds
// for 200,000 triangles and requires no search structure.

// The first triangle that the ray hits: {triangle, weights, position}, or null.
Ahm.pick_triangle = function (surface, origin, direction) {
  const p = surface.positions, t = surface.triangles, [ox, oy, oz] = origin, [dx, dy, dz] = direction;
  let best = Infinity, found = -1, found_v = 0, found_w = 0;
  for (let k = 0; k < t.length; k += 3) {
    const a = 3 * t[k], b = 3 * t[k + 1], c = 3 * t[k + 2];
    const ax = p[a], ay = p[a + 1], az = p[a + 2];
    const ex = p[b] - ax, ey = p[b + 1] - ay, ez = p[b + 2] - az;
    const fx = p[c] - ax, fy = p[c + 1] - ay, fz = p[c + 2] - az;
    const hx = dy * fz - dz * fy, hy = dz * fx - dx * fz, hz = dx * fy - dy * fx;
    const det = ex * hx + ey * hy + ez * hz;
    if (det === 0) continue;
    const inverse = 1 / det, sx = ox - ax, sy = oy - ay, sz = oz - az;
    const v = inverse * (sx * hx + sy * hy + sz * hz);
    if (!(v >= -1e-9 && v <= 1 + 1e-9)) continue;
    const qx = sy * ez - sz * ey, qy = sz * ex - sx * ez, qz = sx * ey - sy * ex;
    const w = inverse * (dx * qx + dy * qy + dz * qz);
    if (!(w >= -1e-9 && v + w <= 1 + 1e-9)) continue;
    const far = inverse * (fx * qx + fy * qy + fz * qz);
    if (far > 1e-9 && far < best) best = far, found = k / 3, found_v = v, found_w = w;
  }
  if (found < 0) return null;
  // Weights are rounded to six digits, so that they can be read and copied.
  const short = (x) => Math.min(1, Math.max(0, Number(x.toFixed(6)))), v = short(found_v), w = Math.min(short(found_w), short(1 - v));
  return { triangle: found, weights: [short(1 - v - w), v, w], position: [ox + best * dx, oy + best * dy, oz + best * dz] };
};

// The disc that the ray hits: {point, position}, or null. Of the first disc and those shortly behind it, the one with the center nearest
// to the ray.
Ahm.pick_disc = function (surface, origin, direction) {
  const p = surface.positions, discs = surface.discs, unit = surface.largest_radius / 255;
  const [ox, oy, oz] = origin, [dx, dy, dz] = direction, length2 = dx * dx + dy * dy + dz * dz;
  const scan = (limit, by_distance) => {
    let best = Infinity, found = -1, depth = Infinity;
    for (let k = 0, n = p.length / 3; k < n; ++k) {
      const x = p[3 * k] - ox, y = p[3 * k + 1] - oy, z = p[3 * k + 2] - oz;
      const t = (x * dx + y * dy + z * dz) / length2;
      if (!(t > 0 && t < limit)) continue;
      const away = x * x + y * y + z * z - t * t * length2, radius = discs[4 * k + 3] * unit;
      if (away > radius * radius) continue;
      const score = by_distance ? away : t;
      if (score < best) best = score, found = k, depth = t;
    }
    return { found, depth };
  };
  const first = scan(Infinity, false);
  if (first.found < 0) return null;
  const behind = 2 * surface.largest_radius / Math.sqrt(length2);
  const point = scan(first.depth + behind, true).found;
  return { point: point, position: [p[3 * point], p[3 * point + 1], p[3 * point + 2]] };
};

// The surface point that a ray hits: {row, vertex, position, source}, or null. `row` is the nearest row; `source` is the source for the
// server and the command line.
Ahm.pick = function (surface, origin, direction) {
  if (!surface.is_mesh) {
    const hit = Ahm.pick_disc(surface, origin, direction);
    if (!hit) return null;
    const row = surface.points[hit.point];
    return { row: row, vertex: hit.point, position: hit.position, source: { row: row } };
  }
  const hit = Ahm.pick_triangle(surface, origin, direction);
  if (!hit) return null;
  const k = hit.triangle, w = hit.weights, corner = w[0] >= w[1] && w[0] >= w[2] ? 0 : w[1] >= w[2] ? 1 : 2;
  const vertex = surface.triangles[3 * k + corner], row = surface.points[vertex];
  if (surface.is_cloud) return { row: row, vertex: vertex, position: hit.position, source: { row: row } };
  const sides = surface.corners ? surface.corners[4 * k + 3] : 3;
  const weights = new Array(sides).fill(0);
  for (let c = 0; c < 3; ++c) weights[surface.corners ? surface.corners[4 * k + c] : c] = w[c];
  return { row: row, vertex: vertex, position: hit.position, source: { face: surface.faces[k], weights: weights } };
};
