// Files that are part of the library: shaders, the page, three.js.
#pragma once

#include <string_view>

namespace ahm::view::resources {

extern const std::string_view palette, mesh_vertex, mesh_fragment, splat_vertex, splat_fragment, blend_fragment;
extern const std::string_view shade_vertex, shade_fragment;
extern const std::string_view page, viewer;
/// Empty if the library was built without three.js.
extern const std::string_view three, orbit_controls;

}  // namespace ahm::view::resources
