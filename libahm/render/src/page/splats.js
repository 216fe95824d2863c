"use strict";
// A cloud drawn as discs, in two passes: the first finds the visible disc at each pixel; the second computes its color once.
Ahm.Splats = class {
  constructor(surface, uniforms) {
    const n = surface.points.length;
    this.count = n;
    this.uniforms = uniforms;
    this.columns = Math.min(4096, Math.max(1, Math.ceil(Math.sqrt(n))));
    this.lines = Math.ceil(n / this.columns);
    this.target = new THREE.WebGLRenderTarget(1, 1, { minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter, stencilBuffer: false });
    this.values = new Float32Array(4 * this.columns * this.lines);
    Object.assign(uniforms, {
      which: { value: this.target.texture }, table: { value: new THREE.Vector2(this.columns, this.lines) }, view: { value: new THREE.Matrix4() },
      centers: { value: this.texture(this.spread(surface.positions, 3, Float32Array), THREE.FloatType) },
      discs: { value: this.texture(this.spread(surface.discs, 4, Uint8Array)) },
      values: { value: this.texture(this.values, THREE.FloatType) },
      colors: { value: this.texture(this.spread(surface.colors || new Uint8Array(4 * n), 4, Uint8Array)) },
      slopes_u: { value: null }, slopes_v: { value: null }
    });
    this.set_slopes(new Uint8Array(6 * n).fill(127));
    this.scene = new THREE.Scene();
    this.points = new THREE.Points(this.geometry(surface), Ahm.which_disc_material(uniforms));
    this.points.frustumCulled = false;
    this.scene.add(this.points);
    this.object = new THREE.Mesh(new THREE.PlaneBufferGeometry(2, 2), Ahm.splat_material(uniforms));
    this.object.frustumCulled = false;
  }

  geometry(surface) {
    const geometry = new THREE.BufferGeometry(), number = new Float32Array(this.count);  // floats are exact up to 2^24
    for (let k = 0; k < this.count; ++k) number[k] = k;
    geometry.setAttribute("position", new THREE.BufferAttribute(surface.positions, 3));
    geometry.setAttribute("disc", new THREE.BufferAttribute(surface.discs, 4, true));
    geometry.setAttribute("number", new THREE.BufferAttribute(number, 1));
    return geometry;
  }

  // Texels of four numbers, one texel per disc: `size` numbers of the array, from index `first` on with the given stride.
  spread(array, size, Type, stride, first) {
    const out = new Type(4 * this.columns * this.lines), step = stride || size, begin = first || 0;
    for (let k = 0; k < this.count; ++k)
      for (let c = 0; c < size; ++c) out[4 * k + c] = array[step * k + begin + c];
    return out;
  }

  texture(array, type) {
    const texture = new THREE.DataTexture(array, this.columns, this.lines, THREE.RGBAFormat, type || THREE.UnsignedByteType);
    texture.needsUpdate = true;
    return texture;
  }

  set_slopes(slopes) {
    for (const [name, first] of [["slopes_u", 0], ["slopes_v", 3]]) {
      if (this.uniforms[name].value) this.uniforms[name].value.dispose();
      this.uniforms[name].value = this.texture(this.spread(slopes, 3, Uint8Array, 6, first));
    }
  }

  set_values(map, value, trust) {
    for (let k = 0; k < this.count; ++k) {
      this.values[4 * k] = map[2 * k];
      this.values[4 * k + 1] = map[2 * k + 1];
      this.values[4 * k + 2] = value[k];
      this.values[4 * k + 3] = trust[k];
    }
    this.uniforms.values.value.needsUpdate = true;
  }

  // The first pass. @param share  part of the points that is drawn, in (0, 1]
  draw(renderer, camera, share) {
    const size = renderer.getDrawingBufferSize(new THREE.Vector2());
    if (this.target.width !== size.x || this.target.height !== size.y) this.target.setSize(size.x, size.y);
    this.points.geometry.setDrawRange(0, Math.max(1, Math.ceil(share * this.count)));
    camera.updateMatrixWorld();
    this.uniforms.view.value.copy(camera.matrixWorldInverse.getInverse(camera.matrixWorld));
    const color = renderer.getClearColor().getHex(), alpha = renderer.getClearAlpha();
    renderer.setRenderTarget(this.target);
    renderer.setClearColor(0, 0);
    renderer.clear();
    renderer.render(this.scene, camera);
    renderer.setRenderTarget(null);
    renderer.setClearColor(color, alpha);
  }
};
