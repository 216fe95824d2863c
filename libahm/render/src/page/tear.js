"use strict";
// Maps jump where shortest paths arrive from two sides: at the cut locus, and between cells. Interpolation over a triangle would draw a
// bundle of stripes. Such triangles are split: each corner keeps its direction up to the middle of the triangle.
(function () {
  // Whether the map jumps between two corners: their coordinates are much farther apart than the corners and, around a source, in
  // different directions.
  function is_torn(map, p, a, b, pattern) {
    const au = map[2 * a], av = map[2 * a + 1], bu = map[2 * b], bv = map[2 * b + 1];
    if (pattern === "cells") return au !== bu;
    const square_a = au * au + av * av, square_b = bu * bu + bv * bv;
    const turns = pattern === "grid" || au * bu + av * bv < 0.94 * Math.sqrt(square_a * square_b);
    if (!turns) return false;
    const x = p[3 * a] - p[3 * b], y = p[3 * a + 1] - p[3 * b + 1], z = p[3 * a + 2] - p[3 * b + 2];
    const du = au - bu, dv = av - bv;
    return du * du + dv * dv > 9 * (x * x + y * y + z * z);
  }

  // Indices of the torn triangles. `map`: coordinates by vertex, 1e30 for vertices without coordinates.
  Ahm.torn = function (surface, map, pattern) {
    const t = surface.triangles, p = surface.positions, out = [];
    for (let k = 0; k < t.length; k += 3) {
      const a = t[k], b = t[k + 1], c = t[k + 2];
      if (!(map[2 * a] < 1e29 && map[2 * b] < 1e29 && map[2 * c] < 1e29)) continue;
      if (is_torn(map, p, a, b, pattern) || is_torn(map, p, b, c, pattern) || is_torn(map, p, c, a, pattern))
        out.push(k / 3);
    }
    return out;
  };

  // The distance, which is continuous where the map jumps.
  const distance = (uv, pattern) => pattern === "polar" ? Math.hypot(uv[0], uv[1]) : pattern === "grid" ? Math.abs(uv[1]) : uv[1];
  function with_distance(uv, d, pattern) {
    if (pattern !== "polar") return [uv[0], pattern === "grid" ? (uv[1] < 0 ? -d : d) : d];
    const length = Math.hypot(uv[0], uv[1]) || 1;
    return [uv[0] / length * d, uv[1] / length * d];
  }

  // Splits each torn triangle into six. Returns arrays of attributes by vertex. `attributes`: name -> {array, size}.
  Ahm.torn_pieces = function (surface, torn, attributes, pattern) {
    const t = surface.triangles, out = {}, count = 18 * torn.length;
    for (const name in attributes) out[name] = new attributes[name].array.constructor(count * attributes[name].size);
    let next = 0;
    const put = (vertices, uv) => {
      for (const name in attributes) {
        const { array, size } = attributes[name];
        for (let c = 0; c < size; ++c) {
          let sum = 0;
          for (const v of vertices) sum += array[v * size + c];
          out[name][next * size + c] = name === "map" ? uv[c] : sum / vertices.length;
        }
      }
      ++next;
    };
    const map = attributes.map.array, uv_at = (v) => [map[2 * v], map[2 * v + 1]];
    for (const k of torn) {
      const corners = [t[3 * k], t[3 * k + 1], t[3 * k + 2]];
      for (let c = 0; c < 3; ++c) {
        const own = corners[c], uv = uv_at(own);
        const part = (vertices) => {
          const mean = vertices.reduce((sum, v) => sum + distance(uv_at(v), pattern), 0) / vertices.length;
          put(vertices, with_distance(uv, mean, pattern));
          if (attributes.trust) out.trust[next - 1] = attributes.trust.array[own];
        };
        const ahead = [own, corners[(c + 1) % 3]], behind = [own, corners[(c + 2) % 3]];
        put([own], uv), part(ahead), part(corners);
        put([own], uv), part(corners), part(behind);
      }
    }
    return out;
  };
})();
