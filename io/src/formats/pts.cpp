// What laser scanners write, by no standard: the number of points, then x y z, perhaps intensity and red green blue.
#include "formats/format.hpp"
#include "read/columns.hpp"

namespace ahm::io {
namespace {

Geometry read(const Input& in) { return read_columns(in, {.format = "PTS text", .fourth_is_intensity = true}); }

}  // namespace

Format pts_format() { return {.extensions = {".pts"}, .read = read}; }

}  // namespace ahm::io
