#version 330 core
// Paints the picture from what the first passes left per pixel. `palette.glsl` is inserted after the version line.
uniform sampler2D winners, map_sums, normal_sums;
uniform int pattern;
uniform float sectors, pixels_per_unit;
uniform float spacing, gap;  // of points, in ring widths and in scene units; 0: not a cloud
uniform float detail;        // radius of fine shading in pixels
uniform vec3 legend;                                      // centre and radius in pixels; radius 0: none
uniform float legend_rings;
out vec4 colour;

ivec2 limit(ivec2 p) { return clamp(p, ivec2(0), textureSize(winners, 0) - 1); }

// 0 where there is nothing.
float depth_at(ivec2 p) {
  vec4 sum = texelFetch(normal_sums, limit(p), 0);
  return sum.w > 0.0 ? sum.z / sum.w : 0.0;
}

// The pixel itself; or a neighbour, where chance left a pinhole between points: all around something is much nearer.
ivec2 without_pinholes(ivec2 p) {
  if (gap <= 0.0) return p;
  float depth = depth_at(p);
  ivec2 found = p;
  int nearer = 0;
  for (int k = 0; k < 8; ++k) {
    float angle = 0.785398 * float(k);
    ivec2 q = limit(p + ivec2(round(3.0 * vec2(cos(angle), sin(angle)))));
    float other = depth_at(q);
    if (other <= 0.0 || (depth > 0.0 && depth - other < gap)) continue;
    ++nearer;
    found = q;
  }
  return nearer >= 7 ? found : p;
}

// uv and whether there is one.
vec3 map_at(ivec2 p) {
  p = limit(p);
  vec4 sum = texelFetch(map_sums, p, 0);
  float all = texelFetch(normal_sums, p, 0).w;
  if (sum.w <= 0.5 * all || sum.w <= 0.0) return vec3(0.0);
  vec2 uv = sum.xy / sum.w;
  float r = sum.z / sum.w;
  vec3 nearest = texelFetch(winners, p, 0).xyz;
  if (pattern == 2) return nearest.z > 0.5 ? vec3(nearest.x, uv.y, 1.0) : vec3(0.0);  // colours have no mean
  // Points beyond a cut were averaged: the nearest one then says where to.
  if (pattern == 1 && spacing > 0.0 && length(uv - nearest.xy) > 3.0 * spacing && nearest.z > 0.5) uv = nearest.xy;
  // As directions that cancel far from the source.
  if (pattern == 0 && spacing > 0.0 && r > 3.0 * spacing && length(uv) < 0.9 * r && nearest.z > 0.5)
    uv = normalize(nearest.xy) * r;
  return vec3(uv, 1.0);
}

// Change of uv per pixel, on the side where it is smaller: the other one may lie across an edge or a cut.
vec2 change(vec2 uv, vec3 before, vec3 after) {
  vec2 a = before.z > 0.0 ? uv - before.xy : vec2(1e6), b = after.z > 0.0 ? after.xy - uv : vec2(1e6);
  return dot(a, a) < dot(b, b) ? a : b;
}

// Darkens what lies behind its surroundings (Boucheny's eye-dome lighting), at a fine and a coarse radius.
float crevices(ivec2 p, float depth) {
  float sum = 0.0;
  for (int scale = 0; scale < 2; ++scale) {
    float radius = detail * (scale == 0 ? 1.0 : 3.0);
    for (int k = 0; k < 8; ++k) {
      float angle = 0.785398 * (float(k) + 0.5 * float(scale));
      float other = depth_at(p + ivec2(round(radius * vec2(cos(angle), sin(angle)))));
      if (other > 0.0) sum += clamp((depth - other) * pixels_per_unit / depth / radius - 1.0, 0.0, 4.0);
    }
  }
  return exp(-0.05 * sum);
}

void main() {
  ivec2 p = without_pinholes(ivec2(gl_FragCoord.xy));
  vec2 from_legend = gl_FragCoord.xy - legend.xy;
  float rim = length(from_legend) - legend.z;
  vec4 sum = texelFetch(normal_sums, p, 0);
  vec3 linear = vec3(1.0);
  if (sum.w > 0.0) {
    vec2 tilt = sum.xy / sum.w;
    vec3 n = normalize(vec3(tilt, sqrt(max(0.0, 1.0 - dot(tilt, tilt)))));
    vec3 map = map_at(p);
    vec3 base = unknown_colour();
    if (map.z > 0.0) {
      vec2 dx = change(map.xy, map_at(p - ivec2(1, 0)), map_at(p + ivec2(1, 0)));
      vec2 dy = change(map.xy, map_at(p - ivec2(0, 1)), map_at(p + ivec2(0, 1)));
      base = map_colour(pattern, map.xy, dx, dy, sectors);
    }
    linear = lit(base, n, vec3(0.0, 0.0, 1.0)) * crevices(p, depth_at(p));
  }
  if (legend.z > 0.0 && rim < 0.12 * legend.z) linear = mix(linear, vec3(1.0), 0.85);
  if (legend.z > 0.0 && rim < 0.0) {
    float step = legend_rings / legend.z;
    linear = map_colour(pattern, from_legend * step, vec2(step, 0.0), vec2(0.0, step), sectors);
  }
  colour = vec4(to_srgb(clamp(linear, 0.0, 1.0)), 1.0);
}
