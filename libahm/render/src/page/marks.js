"use strict";
// Marks on the surface: the source with its axes, dots, and curves as ribbons of constant width on the screen.

// The source: a red sphere, and an arrow along each axis.
Ahm.make_source = function (axes, ink) {
  const group = new THREE.Group();
  const red = new THREE.MeshBasicMaterial({ color: 0xe1141e });
  group.add(new THREE.Mesh(new THREE.SphereBufferGeometry(0.9, 32, 24), red));
  for (const axis of axes) {
    const arrow = new THREE.Group();
    const shaft = new THREE.Mesh(new THREE.CylinderBufferGeometry(0.17, 0.17, 6, 16), ink);
    const head = new THREE.Mesh(new THREE.CylinderBufferGeometry(0, 0.6, 1.6, 24), ink);
    shaft.position.y = 3;
    head.position.y = 6.6;
    arrow.add(shaft, head);
    arrow.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), new THREE.Vector3().fromArray(axis));
    group.add(arrow);
  }
  return group;
};

Ahm.ribbon_material = (viewport, color) => new THREE.ShaderMaterial({
  uniforms: { viewport: viewport, width: { value: 3 } }, side: THREE.DoubleSide,
  vertexShader: `
    attribute vec3 other;
    attribute float side;
    uniform vec2 viewport;
    uniform float width;
    void main() {
      // Slightly nearer to the camera, so that a convex surface does not hide the curve.
      vec4 a = projectionMatrix * vec4(0.995 * (modelViewMatrix * vec4(position, 1.0)).xyz, 1.0);
      vec4 b = projectionMatrix * vec4(0.995 * (modelViewMatrix * vec4(other, 1.0)).xyz, 1.0);
      vec2 way = (b.xy / b.w - a.xy / a.w) * viewport;
      way = dot(way, way) > 0.0 ? normalize(way) : vec2(1.0, 0.0);
      a.xy += side * width * vec2(-way.y, way.x) / viewport * a.w;
      gl_Position = a;
    }`,
  fragmentShader: "void main() { gl_FragColor = vec4(" + color + ", 1.0); }"
});

// A curve. `points`: positions; `pieces`: index of the first point of each piece.
Ahm.make_ribbon = function (points, pieces, material) {
  const segments = [];
  pieces.forEach((begin, k) => {
    const end = k + 1 < pieces.length ? pieces[k + 1] : points.length;
    for (let i = begin; i + 1 < end; ++i) segments.push([points[i], points[i + 1]]);
  });
  const position = new Float32Array(12 * segments.length), other = new Float32Array(12 * segments.length);
  const side = new Float32Array(4 * segments.length), index = new Uint32Array(6 * segments.length);
  segments.forEach(([a, b], k) => {
    const ends = [a, a, b, b], others = [b, b, a, a], sides = [1, -1, -1, 1];
    for (let c = 0; c < 4; ++c) {
      position.set(ends[c], 12 * k + 3 * c);
      other.set(others[c], 12 * k + 3 * c);
      side[4 * k + c] = sides[c];
    }
    index.set([0, 1, 2, 2, 1, 3].map((c) => 4 * k + c), 6 * k);
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
  geometry.setAttribute("other", new THREE.BufferAttribute(other, 3));
  geometry.setAttribute("side", new THREE.BufferAttribute(side, 1));
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
};
