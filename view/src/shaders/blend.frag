#version 330 core
// Second pass over the discs: those that lie in the front layer are summed, so that map and normal become continuous
// between points. Writes what `mesh.frag` does, weighted.
flat in vec3 centre, disc_normal;
flat in vec2 map_uv;
flat in float map_known, disc_radius;
uniform sampler2D winners;
uniform float reach;
layout(location = 0) out vec4 map_sum;
layout(location = 1) out vec4 normal_sum;

void main() {
  vec2 offset = (2.0 * gl_PointCoord - 1.0) * vec2(1.0, -1.0) * disc_radius;
  float rise = -dot(disc_normal.xy, offset) / max(disc_normal.z, 0.25);
  float t = (dot(offset, offset) + rise * rise) / (disc_radius * disc_radius);
  float front = texelFetch(winners, ivec2(gl_FragCoord.xy), 0).w;
  float depth = -(centre.z + rise);
  if (t > 1.0 || front <= 0.0 || abs(depth - front) > disc_radius / reach) discard;
  float weight = (1.0 - t) * (1.0 - t) + 1e-4;
  map_sum = vec4(map_uv, length(map_uv), 1.0) * map_known * weight;
  normal_sum = vec4(disc_normal.xy, depth, 1.0) * weight;
}
