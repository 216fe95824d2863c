#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in float known;
uniform mat4 view, projection;
out vec3 view_position, view_normal;
out vec2 map_uv;
out float map_known;

void main() {
  vec4 p = view * vec4(position, 1.0);
  view_position = p.xyz;
  view_normal = mat3(view) * normal;
  map_uv = uv;
  map_known = known;
  gl_Position = projection * p;
}
