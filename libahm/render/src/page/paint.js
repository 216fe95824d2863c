"use strict";
// The shaders. One draws meshes: it computes the pattern at every pixel from interpolated (u, v). Two draw discs, which have the gradient
// of (u, v).
Ahm.fields = ["polar", "grid", "cells", "distance", "none", "spread", "quality", "normals", "colors"];

Ahm.make_uniforms = function (surface) {
  const blank = new THREE.DataTexture(new Uint8Array(4), 1, 1, THREE.RGBAFormat);
  blank.needsUpdate = true;
  return {
    pattern: { value: 4 }, sectors: { value: 24 }, ring_scale: { value: 1 }, largest_value: { value: 1 },
    pixel_size: { value: 1 }, hatch: { value: 1 }, largest_radius: { value: surface.largest_radius },
    pixels_per_unit: { value: 1 }, steepest: { value: 0 }, thin: { value: 1 },
    decal: { value: blank }, decal_frame: { value: new THREE.Vector4(0, 0, 0, 0) }  // cosine and sine divided by width and height
  };
};

(function () {
  // Values beyond 1e29 mean that there is no value.
  const common = () => document.getElementById("palette").textContent + `
    uniform int pattern;
    uniform float sectors, ring_scale, largest_value, pixel_size, hatch;
    uniform sampler2D decal;
    uniform vec4 decal_frame;
    vec3 to_srgb(vec3 linear) {
      return mix(12.92 * linear, 1.055 * pow(max(linear, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, linear));
    }
    vec3 from_srgb(vec3 tone) { return mix(tone / 12.92, pow((tone + 0.055) / 1.055, vec3(2.4)), step(0.04045, tone)); }
    vec3 with_decal(vec3 color, vec2 uv) {
      vec2 at = vec2(dot(uv, decal_frame.xy), dot(uv, decal_frame.zw)) + 0.5;
      if (decal_frame.xy == vec2(0.0) || !(abs(uv.x) < 1e29) || any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)))) return color;
      vec4 texel = texture2D(decal, at);
      return mix(color, from_srgb(texel.rgb), texel.a);
    }
    // uvw: (u, v, value). dx, dy: its changes over a pixel.
    vec3 paint(vec3 uvw, vec3 dx, vec3 dy, vec3 normal, vec3 own, float trust) {
      if (pattern == 4) return with_decal(plain_color(), uvw.xy);
      if (pattern == 7) return from_srgb(0.5 + 0.5 * normal);
      if (pattern == 8) return with_decal(from_srgb(own), uvw.xy);
      bool by_value = pattern == 3 || pattern == 5 || pattern == 6;
      if (!(abs(by_value ? uvw.z : uvw.x) < 1e29)) return unknown_color();
      vec3 color;
      if (pattern == 3) {
        color = distance_with_lines(vec2(uvw.z, 0.0) * ring_scale, vec2(dx.z, 0.0) * ring_scale, vec2(dy.z, 0.0) * ring_scale, largest_value * ring_scale);
      } else if (by_value) {
        color = distance_color(uvw.z / largest_value);
      } else {
        vec2 scale = vec2(pattern == 2 ? 1.0 : ring_scale, ring_scale);
        color = map_color(pattern, uvw.xy * scale, dx.xy * scale, dy.xy * scale, sectors, 1.0);
      }
      if (trust < 0.5 && hatch > 0.5 && !by_value)
        return low_quality_color(color, gl_FragCoord.xy * vec2(1.0, -1.0) * pixel_size, pixel_size);
      if (trust > 1.5 && hatch > 0.5) color = bounded_color(color, gl_FragCoord.xy * vec2(1.0, -1.0) * pixel_size, pixel_size);
      return with_decal(color, uvw.xy);
    }
    vec4 finish(vec3 color, vec3 n, vec3 p) {
      if (dot(n, p) > 0.0) n = -n;
      return vec4(to_srgb(clamp(lit(color, n, vec3(0.0, 0.0, 1.0)), 0.0, 1.0)), 1.0);
    }`;

  const attributes = `
    attribute vec4 disc;
    attribute vec2 map;
    attribute float value, trust;
    attribute vec3 own_color;
    varying vec3 own, normal_of;
    varying vec3 uvw;
    varying float map_trust;`;
  const pass_on = `
    own = own_color;
    normal_of = 2.0 * disc.xyz - 1.0;
    uvw = vec3(map, value);
    map_trust = trust;`;

  Ahm.surface_material = (uniforms) => new THREE.ShaderMaterial({
    uniforms: uniforms, side: THREE.DoubleSide, extensions: { derivatives: true },
    vertexShader: attributes + `
      varying vec3 view_position, view_normal;
      void main() {
        ${pass_on}
        vec4 p = modelViewMatrix * vec4(position, 1.0);
        view_position = p.xyz;
        view_normal = normalMatrix * normal_of;
        gl_Position = projectionMatrix * p;
      }`,
    fragmentShader: common() + `
      varying vec3 view_position, view_normal, own, normal_of, uvw;
      varying float map_trust;
      void main() {
        gl_FragColor = finish(paint(uvw, dFdx(uvw), dFdy(uvw), normalize(normal_of), own, map_trust), normalize(view_normal), view_position);
      }`
  });

  // A disc per point, tilted by its normal; of overlapping discs, the one with the nearest center is visible. The first pass stores only
  // the number of the disc, because many discs cover a pixel. Then `splat_material` colors each pixel once.
  const on_disc = `
    float rise_of(vec2 offset, vec3 n) { return -dot(n.xy, offset) / max(n.z, 0.25); }
    float depth_of(vec3 center, float rise, float t, float radius) {
      float z = center.z + rise - 0.5 * sqrt(t) * radius;
      return 0.5 - 0.5 * (projectionMatrix[2][2] * z + projectionMatrix[3][2]) / z;
    }
    vec3 facing(vec3 n, vec3 center) {
      n = dot(n, n) > 0.1 ? normalize(n) : vec3(0.0, 0.0, 1.0);
      return dot(n, center) > 0.0 ? -n : n;
    }
    float size_of(float radius, vec3 center) { return max(2.0 * radius * thin * pixels_per_unit / max(-center.z, 1e-6), 2.0); }`;

  Ahm.which_disc_material = (uniforms) => new THREE.ShaderMaterial({
    uniforms: uniforms, extensions: { fragDepth: true },
    vertexShader: `
      attribute vec4 disc;
      attribute float number;
      uniform float largest_radius, pixels_per_unit, thin;
      varying vec3 center, disc_normal, name;
      varying float disc_radius;
      ${on_disc.replace(/float depth_of[^]*?\n    }\n/, "")}
      void main() {
        vec4 p = modelViewMatrix * vec4(position, 1.0);
        float size = size_of(disc.w * largest_radius, p.xyz);
        center = p.xyz;
        disc_normal = facing(normalMatrix * (2.0 * disc.xyz - 1.0), center);
        disc_radius = 0.5 * size * max(-p.z, 1e-6) / pixels_per_unit;
        name = floor(mod(vec3(number, floor(number / 256.0), floor(number / 65536.0)), 256.0)) / 255.0;
        gl_PointSize = size;
        gl_Position = projectionMatrix * p;
      }`,
    fragmentShader: `
      uniform mat4 projectionMatrix;
      uniform float pixels_per_unit, thin;
      varying vec3 center, disc_normal, name;
      varying float disc_radius;
      ${on_disc}
      void main() {
        vec2 offset = (2.0 * gl_PointCoord - 1.0) * vec2(1.0, -1.0) * disc_radius;
        float rise = rise_of(offset, disc_normal), t = (dot(offset, offset) + rise * rise) / (disc_radius * disc_radius);
        if (t > 1.0) discard;
        #if defined(GL_EXT_frag_depth) || __VERSION__ >= 300
          gl_FragDepthEXT = depth_of(center, rise, t, disc_radius);
        #endif
        gl_FragColor = vec4(name, 1.0);
      }`
  });

  // The second pass covers the whole picture. Textures contain the data of the discs.
  Ahm.splat_material = (uniforms) => new THREE.ShaderMaterial({
    uniforms: uniforms, extensions: { fragDepth: true },
    vertexShader: "varying vec2 ndc; void main() { ndc = position.xy; gl_Position = vec4(position.xy, 0.0, 1.0); }",
    fragmentShader: common() + `
      uniform sampler2D which, centers, discs, values, slopes_u, slopes_v, colors;
      uniform vec2 table;  // columns and rows of the textures
      uniform mat4 projectionMatrix, view;
      uniform float steepest, largest_radius, pixels_per_unit, thin;
      varying vec2 ndc;
      ${on_disc}
      vec3 turned(vec3 v) { return (view * vec4(v, 0.0)).xyz; }
      void main() {
        vec4 name = texture2D(which, 0.5 * ndc + 0.5);
        if (name.a < 0.5) discard;
        vec3 digits = floor(255.0 * name.rgb + 0.5);
        float number = digits.r + 256.0 * digits.g + 65536.0 * digits.b, row = floor((number + 0.5) / table.x);
        vec2 at = (vec2(number - row * table.x, row) + 0.5) / table;
        vec4 disc = texture2D(discs, at), value = texture2D(values, at);
        vec3 normal = 2.0 * disc.xyz - 1.0, center = (view * vec4(texture2D(centers, at).xyz, 1.0)).xyz;
        vec3 disc_normal = facing(turned(normal), center);
        float disc_size = 0.5 * size_of(disc.w * largest_radius, center);
        float disc_radius = disc_size * max(-center.z, 1e-6) / pixels_per_unit;
        vec2 offset = ndc / vec2(projectionMatrix[0][0], projectionMatrix[1][1]) * -center.z - center.xy;
        float rise = rise_of(offset, disc_normal), t = min((dot(offset, offset) + rise * rise) / (disc_radius * disc_radius), 1.0);
        #if defined(GL_EXT_frag_depth) || __VERSION__ >= 300
          gl_FragDepthEXT = depth_of(center, rise, t, disc_radius);
        #endif
        vec3 change_u = steepest * turned(2.0 * texture2D(slopes_u, at).xyz - 254.0 / 255.0);
        vec3 change_v = steepest * turned(2.0 * texture2D(slopes_v, at).xyz - 254.0 / 255.0);
        vec3 uvw = value.xyz, along = vec3(offset, rise);
        bool is_known = abs(uvw.x) < 1e29;
        float r = max(length(uvw.xy), 1e-6);
        vec3 change_w = is_known && pattern == 3 ? (uvw.x * change_u + uvw.y * change_v) / r : vec3(0.0);  // gradient of the distance
        vec3 here = uvw + vec3(dot(change_u, along), dot(change_v, along), dot(change_w, along));
        vec2 tilt = -disc_normal.xy / max(disc_normal.z, 0.25);
        float pixel = disc_radius / disc_size;
        vec3 dx = pixel * vec3(change_u.x + tilt.x * change_u.z, change_v.x + tilt.x * change_v.z, change_w.x + tilt.x * change_w.z);
        vec3 dy = pixel * vec3(change_u.y + tilt.y * change_u.z, change_v.y + tilt.y * change_v.z, change_w.y + tilt.y * change_w.z);
        vec3 color = paint(is_known ? here : uvw, dx, dy, normalize(normal), texture2D(colors, at).rgb, value.w);
        gl_FragColor = finish(color, disc_normal, center);
      }`
  });

  // The legend in the lower left corner: the pattern as a wheel, or a color bar from 0 upwards.
  Ahm.legend_material = (uniforms) => new THREE.ShaderMaterial({
    uniforms: uniforms, transparent: true,
    vertexShader: "varying vec2 at; void main() { at = position.xy; gl_Position = vec4(position.xy, 0.0, 1.0); }",
    fragmentShader: common() + `
      varying vec2 at;
      uniform float pixel;
      void main() {
        if (pattern == 3 || pattern == 5 || pattern == 6) {
          float rings = pattern == 3 ? largest_value * ring_scale : 1.0;
          vec2 value = vec2((0.5 * at.y + 0.5) * rings, 0.0);
          vec3 bar = pattern == 3 ? distance_with_lines(value, vec2(0.0), vec2(0.5 * pixel * rings, 0.0), rings) : distance_color(value.x);
          gl_FragColor = vec4(to_srgb(bar), 1.0);
          return;
        }
        float cover = clamp((0.98 - length(at)) / pixel + 0.5, 0.0, 1.0);
        vec3 c = map_color(pattern, at * 4.0, vec2(4.0 * pixel, 0.0), vec2(0.0, 4.0 * pixel), sectors, 1.0);
        if (length(at) < 0.06) c = vec3(0.75, 0.007, 0.013);
        gl_FragColor = vec4(to_srgb(c), cover);
      }`
  });
})();
