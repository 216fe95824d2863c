#version 330 core
// An oriented disc per point; the nearest disc wins. Writes (u, v, known, depth).
flat in vec3 centre, disc_normal;
flat in vec2 map_uv;
flat in float map_known, disc_radius;
uniform mat4 projection;
layout(location = 0) out vec4 winner;

void main() {
  vec2 offset = (2.0 * gl_PointCoord - 1.0) * vec2(1.0, -1.0) * disc_radius;
  float rise = -dot(disc_normal.xy, offset) / max(disc_normal.z, 0.25);
  float t = (dot(offset, offset) + rise * rise) / (disc_radius * disc_radius);
  if (t > 1.0) discard;
  float z = centre.z + rise - 0.3 * sqrt(t) * disc_radius;  // a slight cone: among overlapping discs the nearest centre wins
  float depth = clamp(-(projection[2][2] * z + projection[3][2]) / z, -1.0, 1.0);
  gl_FragDepth = 0.5 + 0.5 * depth;
  winner = vec4(map_uv, map_known, -(centre.z + rise));
}
