// Files that are part of the library: the palette, the page, three.js.
#pragma once

#include <string_view>

namespace ahm::render::resources {

extern const std::string_view palette, page, style;
/// The scripts of the page, in the order in which they run.
extern const std::string_view data, pick, tear, coarse, paint, splats, marks, stage, panel, main;
/// Empty if the library was built without three.js.
extern const std::string_view three, orbit_controls;

}  // namespace ahm::render::resources
