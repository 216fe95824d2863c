"use strict";
(function () {
  const element = (id) => document.getElementById(id);
  const meta = JSON.parse(element("meta").textContent);

  function bytes(id) {
    const text = atob(element(id).textContent);
    const out = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) out[i] = text.charCodeAt(i);
    element(id).textContent = "";  // the text is not needed twice
    return out.buffer;
  }

  // Shared by both shaders below; coordinates are in ring widths, those beyond 1e29 stand for "none". Of cells, the first
  // one is a colour.
  const common = element("palette").textContent + `
    uniform int pattern;
    uniform float sectors, ring_scale, rings, pixel_size;
    vec3 to_srgb(vec3 linear) {
      return mix(12.92 * linear, 1.055 * pow(max(linear, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, linear));
    }
    vec3 paint(vec2 uv, vec2 dx, vec2 dy, float trust) {
      if (!(abs(uv.x) < 1e29)) return pattern == 4 ? plain_colour() : unknown_colour();
      vec2 scale = vec2(pattern == 2 ? 1.0 : ring_scale, ring_scale);
      vec3 colour = map_colour(pattern, uv * scale, dx * scale, dy * scale, sectors, rings * ring_scale);
      return trust < 0.5 && pattern != 4 ? untrusted_colour(colour, gl_FragCoord.xy * vec2(1.0, -1.0) * pixel_size, pixel_size) : colour;
    }
    vec4 finish(vec3 colour, vec3 n, vec3 p) {
      if (dot(n, p) > 0.0) n = -n;
      return vec4(to_srgb(clamp(lit(colour, n, vec3(0.0, 0.0, 1.0)), 0.0, 1.0)), 1.0);
    }`;
  const pattern = ["polar", "grid", "cells", "distance", "none"].indexOf(meta.pattern);
  const uniforms = {
    pattern: { value: pattern }, sectors: { value: meta.sectors }, ring_scale: { value: 1 }, largest_radius: { value: meta.largest_radius },
    pixels_per_unit: { value: 1 }, rings: { value: meta.rings }, pixel_size: { value: 1 }, steepest: { value: meta.steepest }
  };

  function surface_material() {
    return new THREE.ShaderMaterial({
      uniforms: uniforms, side: THREE.DoubleSide, extensions: { derivatives: true },
      vertexShader: `
        attribute vec4 disc;
        attribute vec2 map;
        attribute float trust;
        varying vec3 view_position, view_normal;
        varying vec2 uv_map;
        varying float map_trust;
        void main() {
          map_trust = trust;
          vec4 p = modelViewMatrix * vec4(position, 1.0);
          view_position = p.xyz;
          view_normal = normalMatrix * (2.0 * disc.xyz - 1.0);
          uv_map = map;
          gl_Position = projectionMatrix * p;
        }`,
      fragmentShader: common + `
        varying vec3 view_position, view_normal;
        varying vec2 uv_map;
        varying float map_trust;
        void main() {
          gl_FragColor = finish(paint(uv_map, dFdx(uv_map), dFdy(uv_map), map_trust), normalize(view_normal), view_position);
        }`
    });
  }

  // A disc per point, tilted by its normal; where discs overlap, the nearest centre wins.
  function splat_material() {
    return new THREE.ShaderMaterial({
      uniforms: uniforms, extensions: { fragDepth: true },
      vertexShader: `
        attribute vec4 disc;
        attribute vec2 map;
        attribute float trust;
        attribute vec3 slope_u, slope_v;  // of the map along the disc
        uniform float largest_radius, pixels_per_unit, steepest;
        varying vec3 centre, disc_normal, change_u, change_v;
        varying vec2 uv_map;
        varying float disc_radius, disc_size, map_trust;
        void main() {
          map_trust = trust;
          change_u = steepest * (normalMatrix * (2.0 * slope_u - 254.0 / 255.0));
          change_v = steepest * (normalMatrix * (2.0 * slope_v - 254.0 / 255.0));
          vec4 p = modelViewMatrix * vec4(position, 1.0);
          float size = max(2.0 * disc.w * largest_radius * pixels_per_unit / max(-p.z, 1e-6), 2.0);
          vec3 n = normalMatrix * (2.0 * disc.xyz - 1.0);
          n = dot(n, n) > 0.1 ? normalize(n) : vec3(0.0, 0.0, 1.0);
          centre = p.xyz;
          disc_normal = dot(n, p.xyz) > 0.0 ? -n : n;
          disc_radius = 0.5 * size * max(-p.z, 1e-6) / pixels_per_unit;
          disc_size = 0.5 * size;
          uv_map = map;
          gl_PointSize = size;
          gl_Position = projectionMatrix * p;
        }`,
      fragmentShader: common + `
        uniform mat4 projectionMatrix;
        varying vec3 centre, disc_normal, change_u, change_v;
        varying vec2 uv_map;
        varying float disc_radius, disc_size, map_trust;
        void main() {
          vec2 offset = (2.0 * gl_PointCoord - 1.0) * vec2(1.0, -1.0) * disc_radius;
          float rise = -dot(disc_normal.xy, offset) / max(disc_normal.z, 0.25);
          float t = (dot(offset, offset) + rise * rise) / (disc_radius * disc_radius);
          if (t > 1.0) discard;
          float z = centre.z + rise - 0.5 * sqrt(t) * disc_radius;
          #if defined(GL_EXT_frag_depth) || __VERSION__ >= 300
            gl_FragDepthEXT = 0.5 - 0.5 * (projectionMatrix[2][2] * z + projectionMatrix[3][2]) / z;
          #endif
          vec3 along = vec3(offset, rise);
          vec2 uv = uv_map + vec2(dot(change_u, along), dot(change_v, along));
          vec2 tilt = -disc_normal.xy / max(disc_normal.z, 0.25);
          float pixel = disc_radius / disc_size;
          vec2 dx = pixel * vec2(change_u.x + tilt.x * change_u.z, change_v.x + tilt.x * change_v.z);
          vec2 dy = pixel * vec2(change_u.y + tilt.y * change_u.z, change_v.y + tilt.y * change_v.z);
          gl_FragColor = finish(paint(uv_map.x < 1e29 ? uv : uv_map, dx, dy, map_trust), disc_normal, centre);
        }`
    });
  }

  function make_object() {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(bytes("positions")), 3));
    geometry.setAttribute("map", new THREE.BufferAttribute(new Float32Array(bytes("coordinates")), 2));
    geometry.setAttribute("disc", new THREE.BufferAttribute(new Uint8Array(bytes("discs")), 4, true));
    geometry.setAttribute("trust", new THREE.BufferAttribute(new Uint8Array(bytes("trust")), 1, true));
    if (!meta.is_mesh) {
      const slopes = new THREE.InterleavedBuffer(new Uint8Array(bytes("slopes")), 6);
      geometry.setAttribute("slope_u", new THREE.InterleavedBufferAttribute(slopes, 3, 0, true));
      geometry.setAttribute("slope_v", new THREE.InterleavedBufferAttribute(slopes, 3, 3, true));
    }
    if (meta.is_mesh) geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(bytes("triangles")), 1));
    const object = meta.is_mesh ? new THREE.Mesh(geometry, surface_material()) : new THREE.Points(geometry, splat_material());
    object.frustumCulled = false;
    return object;
  }

  // A red ball at the source and an arrow along each axis, of constant size on the screen.
  function make_source() {
    const group = new THREE.Group();
    const red = new THREE.MeshBasicMaterial({ color: 0xe1141e }), ink = new THREE.MeshBasicMaterial({ color: 0x19191e });
    group.add(new THREE.Mesh(new THREE.SphereBufferGeometry(0.9, 32, 24), red));
    for (const axis of meta.axes) {
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
  }

  // The curve as a thin tube, the further dots as balls; `scale` is the radius.
  function make_marks(scale) {
    const group = new THREE.Group(), red = new THREE.MeshBasicMaterial({ color: 0xe1141e });
    const at = (triple) => new THREE.Vector3().fromArray(triple);
    meta.curve_pieces.forEach((begin, piece) => {
      const end = piece + 1 < meta.curve_pieces.length ? meta.curve_pieces[piece + 1] : meta.curve.length;
      if (end - begin < 2) return;
      const path = new THREE.CurvePath();
      for (let k = begin; k + 1 < end; ++k) path.add(new THREE.LineCurve3(at(meta.curve[k]), at(meta.curve[k + 1])));
      const steps = Math.min(2000, 2 * (end - begin));
      group.add(new THREE.Mesh(new THREE.TubeBufferGeometry(path, steps, scale, 8), red));
    });
    const ball = new THREE.SphereBufferGeometry(3 * scale, 24, 16);
    for (const dot of meta.dots) {
      const mesh = new THREE.Mesh(ball, red);
      mesh.position.copy(at(dot));
      group.add(mesh);
    }
    return group;
  }

  // The pattern by itself, drawn in the lower left corner: a wheel, or a bar from distance 0 upwards.
  const bar = { left: 28, bottom: 24, width: 20, height: 240 };
  function make_legend() {
    const scene = new THREE.Scene();
    const legend_uniforms = Object.assign({ pixel: { value: 0.05 } }, uniforms);
    scene.add(new THREE.Mesh(new THREE.PlaneBufferGeometry(2, 2), new THREE.ShaderMaterial({
      uniforms: legend_uniforms, transparent: true,
      vertexShader: "varying vec2 at; void main() { at = position.xy; gl_Position = vec4(position.xy, 0.0, 1.0); }",
      fragmentShader: common + `
        varying vec2 at;
        uniform float pixel;
        void main() {
          if (pattern == 3) {
            float shown = rings * ring_scale;
            vec3 colour = map_colour(pattern, vec2((0.5 * at.y + 0.5) * shown, 0.0), vec2(0.0), vec2(0.5 * pixel * shown, 0.0), sectors, shown);
            gl_FragColor = vec4(to_srgb(colour), 1.0);
            return;
          }
          float cover = clamp((0.98 - length(at)) / pixel + 0.5, 0.0, 1.0);
          vec3 c = map_colour(pattern, at * 4.0, vec2(4.0 * pixel, 0.0), vec2(0.0, 4.0 * pixel), sectors, 1.0);
          if (length(at) < 0.06) c = vec3(0.75, 0.007, 0.013);
          gl_FragColor = vec4(to_srgb(c), cover);
        }`
    })));
    return { scene: scene, camera: new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1), uniforms: legend_uniforms };
  }

  // About five numbers beside the bar, at its lines.
  function label_bar(factor) {
    const rings = meta.rings / factor, every = Math.max(1, Math.ceil(rings / 6)), numbers = element("bar");
    numbers.textContent = "";
    for (let ring = 0; ring <= rings; ring += every) {
      const label = document.createElement("div");
      label.textContent = Number((ring * meta.ring_width * factor).toPrecision(4));
      label.style.bottom = bar.bottom + bar.height * ring / rings + "px";
      label.style.left = bar.left + bar.width + "px";
      numbers.appendChild(label);
    }
  }

  function start() {
    const renderer = new THREE.WebGLRenderer({ antialias: true });
    renderer.setPixelRatio(window.devicePixelRatio);
    renderer.setClearColor(0xffffff);
    renderer.autoClear = false;
    document.body.insertBefore(renderer.domElement, document.body.firstChild);

    const scene = new THREE.Scene(), source = make_source(), legend = make_legend();
    scene.add(make_object(), source, make_marks(0.004));
    const camera = new THREE.PerspectiveCamera(meta.field_of_view, 1, 0.01, 1000);
    camera.up.fromArray(meta.up);
    const controls = new THREE.OrbitControls(camera, renderer.domElement);
    const source_position = new THREE.Vector3().fromArray(meta.source);
    const has_wheel = meta.is_mapped && pattern < 2, has_bar = meta.is_mapped && pattern === 3 && meta.rings > 0;
    let pending = false;

    function draw() {
      pending = false;
      const width = window.innerWidth, height = window.innerHeight;
      const distance = camera.position.distanceTo(controls.target);
      camera.near = 0.02 * distance;
      camera.far = Math.max(meta.far, 4 * distance);
      camera.updateProjectionMatrix();
      uniforms.pixel_size.value = 1200 / (Math.min(width, height) * renderer.getPixelRatio());
      uniforms.pixels_per_unit.value =
          0.5 * height * renderer.getPixelRatio() / Math.tan(0.5 * meta.field_of_view * Math.PI / 180);
      const to_eye = camera.position.clone().sub(source_position);
      const scale = 0.0085 * to_eye.length() * 2 * Math.tan(0.5 * meta.field_of_view * Math.PI / 180);
      source.scale.setScalar(scale);
      // A little nearer than it is, or a bulging surface would swallow the arrows.
      source.position.copy(source_position).addScaledVector(to_eye.normalize(), 2 * scale);
      renderer.setViewport(0, 0, width, height);
      renderer.clear();
      renderer.render(scene, camera);
      if (!has_wheel && !has_bar) return;
      const box = has_bar ? bar : { left: 20, bottom: 20, width: 140, height: 140 };
      renderer.clearDepth();
      renderer.setViewport(box.left, box.bottom, box.width, box.height);
      legend.uniforms.pixel.value = 2 / (box.height * renderer.getPixelRatio());
      renderer.render(legend.scene, legend.camera);
    }
    function redraw() {
      if (!pending) { pending = true; requestAnimationFrame(draw); }
    }
    function reset() {
      controls.target.fromArray(meta.target);
      const away = new THREE.Vector3().fromArray(meta.eye).sub(controls.target);
      // The stored distance fits the stored shape of picture; a narrower window must step back.
      away.multiplyScalar(Math.max(1, meta.aspect * window.innerHeight / window.innerWidth));
      camera.position.copy(controls.target).add(away);
      controls.update();
      redraw();
    }
    function resize() {
      renderer.setSize(window.innerWidth, window.innerHeight, false);
      camera.aspect = window.innerWidth / window.innerHeight;
      redraw();
    }
    function set_ring() {
      const factor = Math.pow(2, Number(element("ring").value));
      uniforms.ring_scale.value = 1 / factor;
      element("ring_text").textContent = Number((meta.ring_width * factor).toPrecision(4));
      if (has_bar) label_bar(factor);
      redraw();
    }
    controls.addEventListener("change", redraw);
    window.addEventListener("resize", resize);
    window.addEventListener("keydown", (event) => { if (event.key === "r" || event.key === "R") reset(); });
    element("reset").addEventListener("click", reset);
    element("ring").addEventListener("input", set_ring);
    element("ring_name").textContent = meta.pattern === "grid" ? "square width" : "ring width";
    if (!has_wheel) for (const id of ["axis_u", "axis_v"]) element(id).style.display = "none";
    resize();
    set_ring();
    reset();
  }

  try {
    start();
  } catch (error) {
    for (const id of ["axis_u", "axis_v", "panel"]) element(id).style.display = "none";
    element("message").textContent = "This page needs WebGL: " + error.message;
  }
})();
