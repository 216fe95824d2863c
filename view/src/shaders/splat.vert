#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in float known;
layout(location = 4) in float radius;
uniform mat4 view, projection;
uniform float pixels_per_unit;  // at depth 1
uniform float reach;            // of a disc, in its radii
uniform bool skip_hidden;       // second pass: leave out discs that lie behind what the first one drew
uniform sampler2D winners;
flat out vec3 centre, disc_normal;
flat out vec2 map_uv;
flat out float map_known, disc_radius;

// Whether the front layer covers the disc at its centre and towards its corners.
bool is_hidden(vec4 clip, float depth, float size) {
  ivec2 limit = textureSize(winners, 0);
  vec2 pixel = (0.5 + 0.5 * clip.xy / clip.w) * vec2(limit);
  for (int k = 0; k < 5; ++k) {
    vec2 corner = k == 0 ? vec2(0.0) : vec2(k < 3 ? -0.35 : 0.35, k % 2 == 0 ? -0.35 : 0.35);
    ivec2 p = clamp(ivec2(pixel + size * corner), ivec2(0), limit - 1);
    float front = texelFetch(winners, p, 0).w;
    if (front <= 0.0 || depth - front < 4.0 * disc_radius) return false;
  }
  return true;
}

void main() {
  vec4 p = view * vec4(position, 1.0);
  float depth = max(-p.z, 1e-6);
  float size = max(2.0 * reach * radius * pixels_per_unit / depth, 2.0);
  vec3 n = mat3(view) * normal;
  n = dot(n, n) > 0.0 ? normalize(n) : vec3(0.0, 0.0, 1.0);
  centre = p.xyz;
  disc_normal = dot(n, p.xyz) > 0.0 ? -n : n;
  disc_radius = 0.5 * size * depth / pixels_per_unit;
  map_uv = uv;
  map_known = known;
  gl_PointSize = size;
  gl_Position = projection * p;
  if (skip_hidden && is_hidden(gl_Position, depth, size)) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside: not drawn
}
