"use strict";
// The picture: the surface with its map, marks, camera and legend. It is drawn only after changes.
Ahm.Stage = class {
  constructor(canvas, surface) {
    this.canvas = canvas;
    this.surface = surface;
    this.map = null;
    this.field = "none";
    this.is_dark = false;
    this.quality = 1;  // part of the points, or of the pixels, drawn while the camera moves
    this.renderer = new THREE.WebGLRenderer({ canvas: canvas, antialias: surface.is_mesh, preserveDrawingBuffer: true });
    this.renderer.autoClear = false;
    this.uniforms = Ahm.make_uniforms(surface);
    this.viewport = { value: new THREE.Vector2(1, 1) };
    this.scene = new THREE.Scene();
    this.object = this.make_object();
    this.pieces = null;  // parts of torn triangles
    this.coarse = null;  // coarse mesh that is drawn while the camera moves
    this.ink = new THREE.MeshBasicMaterial({ color: 0x19191e });
    this.ribbons = Ahm.ribbon_material(this.viewport, "0.88, 0.08, 0.12");
    this.link_ribbons = Ahm.ribbon_material(this.viewport, "0.08, 0.35, 0.9");
    this.marks = new THREE.Group();
    this.source = new THREE.Group();
    this.source_position = null;
    this.scene.add(this.object, this.marks, this.source);
    this.legend = this.make_legend();
    this.make_camera();
    this.resize();
    this.reset();
  }

  make_object() {
    const s = this.surface, n = s.points.length;
    this.values = { map: new Float32Array(2 * n).fill(1e30), value: new Float32Array(n).fill(1e30), trust: new Float32Array(n).fill(1) };
    if (!s.is_mesh) {
      this.splats = new Ahm.Splats(s, this.uniforms);
      return this.splats.object;
    }
    const geometry = new THREE.BufferGeometry();
    const add = (name, array, size, normalized) => geometry.setAttribute(name, new THREE.BufferAttribute(array, size, normalized));
    add("position", s.positions, 3);
    add("disc", s.discs, 4, true);
    add("map", this.values.map, 2);
    add("value", this.values.value, 1);
    add("trust", this.values.trust, 1);
    if (s.colors) {
      const colors = new THREE.InterleavedBuffer(s.colors, 4);
      geometry.setAttribute("own_color", new THREE.InterleavedBufferAttribute(colors, 3, 0, true));
    }
    geometry.setIndex(new THREE.BufferAttribute(s.triangles, 1));
    const object = new THREE.Mesh(geometry, Ahm.surface_material(this.uniforms));
    object.frustumCulled = false;
    return object;
  }

  upload() {
    const { map, value, trust } = this.values;
    if (this.splats) return this.splats.set_values(map, value, trust);
    for (const name of ["map", "value", "trust"]) this.object.geometry.attributes[name].needsUpdate = true;
  }

  make_legend() {
    const uniforms = Object.assign({ pixel: { value: 0.05 } }, this.uniforms), scene = new THREE.Scene();
    scene.add(new THREE.Mesh(new THREE.PlaneBufferGeometry(2, 2), Ahm.legend_material(uniforms)));
    return { scene: scene, camera: new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1), uniforms: uniforms };
  }

  make_camera() {
    const s = this.surface;
    this.camera = new THREE.PerspectiveCamera(s.field_of_view, 1, 0.01, 1000);
    this.camera.up.fromArray(s.up);
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.controls.enableKeys = false;
    this.controls.addEventListener("change", () => this.moved());
  }

  // Called when the camera moves. Slow machines draw a coarser picture during the movement, and the full picture afterwards.
  moved() {
    this.is_moving = true;
    clearTimeout(this.rest);
    this.rest = setTimeout(() => {
      this.is_moving = false;
      this.redraw();
    }, 220);
    this.redraw();
  }

  // Sets the map. `map` has values by row, and must not change afterwards.
  set_map(map) {
    this.map = map;
    this.uniforms.sectors.value = map.sectors;
    this.uniforms.steepest.value = map.steepest;
    const points = this.surface.points, n = points.length, { map: uv, trust } = this.values;
    for (let k = 0; k < n; ++k) {
      const row = points[k], u = map.uv ? map.uv[2 * row] : NaN, known = u === u;
      uv[2 * k] = known ? u : 1e30;
      uv[2 * k + 1] = known ? map.uv[2 * row + 1] : 1e30;
      const q = map.quality ? map.quality[row] : 1;
      trust[k] = q === q ? q : 1;
      if (map.bounded && map.bounded[row] === 1 && !(trust[k] < 0.5)) trust[k] = 2;
    }
    if (map.slopes) this.splats.set_slopes(map.slopes);
    this.set_marks(map);
    this.set_source(map.source, map.axes);
    this.set_field(this.field);
  }

  value_by_row() {
    const map = this.map;
    if (!map) return null;
    if (this.field === "spread") return map.spread;
    if (this.field === "quality") return map.quality;
    return map.distance || null;
  }

  set_field(name) {
    this.field = name;
    this.uniforms.pattern.value = Ahm.fields.indexOf(name);
    const values = this.value_by_row(), map = this.map, points = this.surface.points;
    const target = this.values.value;
    let largest = 0;
    for (let k = 0; k < points.length; ++k) {
      const row = points[k];
      let x = values ? values[row] : map && map.uv ? Math.hypot(map.uv[2 * row], map.uv[2 * row + 1]) : NaN;
      if (x !== x) x = 1e30;
      else if (x > largest) largest = x;
      target[k] = x;
    }
    this.upload();
    this.uniforms.largest_value.value = name === "quality" ? 1 : largest || 1;
    this.cut();
    this.redraw();
  }

  // Replaces torn triangles by their parts.
  cut() {
    if (!this.surface.is_mesh || !this.map) return;
    const geometry = this.object.geometry, a = geometry.attributes;
    const torn = ["polar", "grid", "cells"].includes(this.field) ? Ahm.torn(this.surface, this.values.map, this.field) : [];
    if (this.pieces) {
      this.scene.remove(this.pieces);
      this.pieces.geometry.dispose();
      this.pieces = null;
    }
    const whole = this.surface.triangles;
    if (torn.length > 0 || geometry.index.array !== whole) {
      const index = torn.length > 0 ? whole.slice() : whole;
      for (const k of torn) index[3 * k + 1] = index[3 * k + 2] = index[3 * k];
      geometry.setIndex(new THREE.BufferAttribute(index, 1));
    }
    if (torn.length === 0) return;
    const given = { position: { array: this.surface.positions, size: 3 }, disc: { array: this.surface.discs, size: 4 } };
    for (const [name, size] of [["map", 2], ["value", 1], ["trust", 1]]) given[name] = { array: a[name].array, size: size };
    const made = Ahm.torn_pieces(this.surface, torn, given, this.field), pieces = new THREE.BufferGeometry();
    for (const name in made) pieces.setAttribute(name, new THREE.BufferAttribute(made[name], given[name].size, name === "disc"));
    this.pieces = new THREE.Mesh(pieces, this.object.material);
    this.pieces.frustumCulled = false;
    this.scene.add(this.pieces);
  }

  set_source(position, axes) {
    this.scene.remove(this.source);
    this.source_position = position ? new THREE.Vector3().fromArray(position) : null;
    this.source = position ? Ahm.make_source(axes || [], this.ink) : new THREE.Group();
    this.scene.add(this.source);
    this.redraw();
  }

  set_marks(given) {
    for (const child of this.marks.children) child.geometry.dispose();
    this.marks.remove(...this.marks.children);
    this.dots = [];
    if (given.curve && given.curve.length > 1) this.marks.add(Ahm.make_ribbon(given.curve, given.pieces || [0], this.ribbons));
    if (given.links) this.marks.add(Ahm.make_ribbon(given.links.points, given.links.pieces, this.link_ribbons));
    for (const dot of given.dots || []) {
      const ball = Ahm.make_source([], this.ink).children[0];
      ball.position.fromArray(dot);
      this.marks.add(ball);
      this.dots.push(ball);
    }
    this.redraw();
  }

  // Draws an image on the map. `width` in units of the surface, `turn` in radians. No image if `texture` is null.
  set_decal(texture, width, turn) {
    const frame = this.uniforms.decal_frame.value;
    if (!texture) {
      frame.set(0, 0, 0, 0);
    } else {
      const height = width * texture.image.height / texture.image.width, c = Math.cos(turn), s = Math.sin(turn);
      frame.set(c / width, s / width, -s / height, c / height);
      this.uniforms.decal.value = texture;
    }
    this.redraw();
  }

  set_ring(width) {
    this.ring_width = width;
    this.uniforms.ring_scale.value = 1 / width;
    this.redraw();
  }

  set_dark(is_dark) {
    this.is_dark = is_dark;
    this.renderer.setClearColor(is_dark ? 0x16181c : 0xffffff);
    this.redraw();
  }

  has_wheel() { return this.map !== null && (this.field === "polar" || this.field === "grid"); }
  has_bar() { return this.map !== null && ["distance", "spread", "quality"].includes(this.field); }

  redraw() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame((time) => {
      if (this.was_moving && this.is_moving && this.last) this.adapt(time - this.last);
      this.last = time;
      this.was_moving = this.is_moving;
      this.draw();
      this.pending = false;
      if (this.on_draw) this.on_draw();
    });
  }

  adapt(milliseconds) {
    if (milliseconds > 200 && this.surface.is_mesh && this.surface.triangles.length > 9e5) this.make_coarse();
    if (milliseconds > 70) this.quality = Math.max(this.surface.is_mesh ? 1 / 16 : 1 / 64, this.quality / (milliseconds > 200 ? 4 : 2));
    else if (milliseconds < 24) this.quality = Math.min(1, this.quality * 1.5);
  }

  // The coarse mesh shares everything except the triangles.
  make_coarse() {
    if (this.coarse) return;
    const geometry = new THREE.BufferGeometry(), whole = this.object.geometry;
    for (const name in whole.attributes) geometry.setAttribute(name, whole.attributes[name]);
    geometry.setIndex(new THREE.BufferAttribute(Ahm.coarse_triangles(this.surface, 96), 1));
    this.coarse = new THREE.Mesh(geometry, this.object.material);
    this.coarse.frustumCulled = false;
    this.scene.add(this.coarse);
  }

  // Reduces the quality while the camera moves: fewer pixels; for clouds, fewer and larger discs.
  apply_quality() {
    const share = this.is_moving ? this.quality : 1;
    const ratio = window.devicePixelRatio * Math.max(0.25, Math.sqrt(share));
    this.uniforms.thin.value = Math.min(2, Math.sqrt(1 / share));
    this.share = share;
    if (this.coarse) {
      this.coarse.visible = this.is_moving;
      for (const whole of [this.object, this.pieces]) if (whole) whole.visible = !this.is_moving;
    }
    if (Math.abs(ratio - this.renderer.getPixelRatio()) > 1e-9) this.renderer.setPixelRatio(ratio);
  }

  draw() {
    this.apply_quality();
    const width = this.width, height = this.height, ratio = this.renderer.getPixelRatio(), camera = this.camera;
    const distance = camera.position.distanceTo(this.controls.target), half = Math.tan(0.5 * camera.fov * Math.PI / 180);
    camera.near = 0.02 * distance;
    camera.far = Math.max(this.surface.far, 4 * distance);
    camera.updateProjectionMatrix();
    this.uniforms.pixel_size.value = 1200 / (Math.min(width, height) * ratio);
    this.uniforms.pixels_per_unit.value = 0.5 * height * ratio / half;
    this.viewport.value.set(width, height);
    if (this.source_position) this.place(this.source, this.source_position, 0.0085, half);
    for (const dot of this.dots || []) dot.scale.setScalar(0.006 * camera.position.distanceTo(dot.position) * 2 * half);
    if (this.splats) this.splats.draw(this.renderer, camera, this.share);
    this.renderer.setViewport(0, 0, width, height);
    this.renderer.clear();
    this.renderer.render(this.scene, camera);
    this.draw_legend();
  }

  // Constant size on the screen. Slightly nearer to the camera, so that a convex surface does not hide the arrows.
  place(object, position, size, half) {
    const to_eye = this.camera.position.clone().sub(position), scale = size * to_eye.length() * 2 * half;
    object.scale.setScalar(scale);
    object.position.copy(position).addScaledVector(to_eye.normalize(), 2 * scale);
  }

  draw_legend() {
    if (!this.has_wheel() && !this.has_bar()) return;
    const box = this.has_bar() ? Ahm.bar : { left: 16, bottom: 14, width: this.wheel, height: this.wheel };
    this.renderer.clearDepth();
    this.renderer.setViewport(box.left, box.bottom, box.width, box.height);
    this.legend.uniforms.pixel.value = 2 / (box.height * this.renderer.getPixelRatio());
    this.renderer.render(this.legend.scene, this.legend.camera);
  }

  resize() {
    const box = this.canvas.parentElement;
    this.width = Math.max(1, box.clientWidth);
    this.height = Math.max(1, box.clientHeight);
    this.wheel = Math.min(128, Math.round(0.22 * Math.min(this.width, this.height)));
    box.style.setProperty("--wheel", this.wheel + "px");
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setSize(this.width, this.height, false);
    this.camera.aspect = this.width / this.height;
    this.redraw();
  }

  reset() {
    const s = this.surface;
    this.controls.target.fromArray(s.target);
    const away = new THREE.Vector3().fromArray(s.eye).sub(this.controls.target);
    // The stored distance fits the stored aspect ratio. In a narrower window, the camera must be farther away.
    away.multiplyScalar(Math.max(1, s.aspect * this.height / this.width));
    this.camera.position.copy(this.controls.target).add(away);
    this.controls.update();
    this.redraw();
  }

  // Rotates the camera around the target. Angles in radians, to the left and up.
  turn(left, up) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const to_y = new THREE.Quaternion().setFromUnitVectors(this.camera.up, new THREE.Vector3(0, 1, 0));
    const at = new THREE.Spherical().setFromVector3(offset.applyQuaternion(to_y));
    at.theta += left;
    at.phi -= up;
    at.makeSafe();
    offset.setFromSpherical(at).applyQuaternion(to_y.inverse());
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.moved();
  }

  zoom(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.moved();
  }

  // The ray through a pixel: [origin, direction]. Pixels are relative to the corner of the canvas.
  ray(x, y) {
    this.camera.updateMatrixWorld();
    const end = new THREE.Vector3(2 * x / this.width - 1, 1 - 2 * y / this.height, 0.5).unproject(this.camera);
    return [this.camera.position.toArray(), end.sub(this.camera.position).toArray()];
  }

  // The pixel of a position, relative to the corner of the canvas.
  pixel(position) {
    this.camera.updateMatrixWorld();
    const p = new THREE.Vector3().fromArray(position).project(this.camera);
    return [(0.5 + 0.5 * p.x) * this.width, (0.5 - 0.5 * p.y) * this.height];
  }

  pick(x, y) { return Ahm.pick(this.surface, ...this.ray(x, y)); }
};

Ahm.bar = { left: 22, bottom: 22, width: 18, height: 220 };
