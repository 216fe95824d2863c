#version 330 core
// Writes what `shade.frag` needs: the winner (u, v, known, depth), the weighted map (u, v, r, weight), the weighted
// normal and depth (n.x, n.y, depth, weight).
in vec3 view_position, view_normal;
in vec2 map_uv;
in float map_known;
layout(location = 0) out vec4 winner;
layout(location = 1) out vec4 map_sum;
layout(location = 2) out vec4 normal_sum;

void main() {
  float known = map_known > 0.999 ? 1.0 : 0.0;
  vec3 n = normalize(view_normal);
  if (dot(n, view_position) > 0.0) n = -n;
  winner = vec4(map_uv, known, -view_position.z);
  map_sum = vec4(map_uv, length(map_uv), 1.0) * known;
  normal_sum = vec4(n.xy, -view_position.z, 1.0);
}
