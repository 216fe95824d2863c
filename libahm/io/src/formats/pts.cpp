// PTS files of laser scanners. The format has no standard: the number of points, then x y z, optionally intensity and red green blue.
#include "formats/format.hpp"
#include "read/columns.hpp"

namespace ahm::io {
namespace {

constexpr ColumnDialect dialect{.format = "PTS text", .fourth_is_intensity = true};

Geometry read(const Input& in) { return read_columns(in, dialect); }

bool take_points(const ByteStream& file, const TakePoint& take) { return take_columns(file, dialect, take); }

}  // namespace

Format pts_format() { return {.extensions = {".pts"}, .read = read, .take_points = take_points}; }

}  // namespace ahm::io
