// Files that are embedded in the library: the palette, the page, three.js.
#pragma once

#include <string_view>

namespace ahm::render::resources {

extern const std::string_view palette, page, style;
/// Scripts of the page, in the order of execution.
extern const std::string_view data, transport, pick, tear, coarse, paint, splats, marks, stage, panel, main;
/// three.js; not defined in builds without three.js.
extern const std::string_view three, orbit_controls;

}  // namespace ahm::render::resources
