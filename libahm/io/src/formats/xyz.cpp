#include "formats/format.hpp"
#include "read/columns.hpp"

namespace ahm::io {
namespace {

constexpr ColumnDialect dialect{.format = "XYZ text"};

Geometry read(const Input& in) { return read_columns(in, dialect); }

bool take_points(const ByteStream& file, const TakePoint& take) { return take_columns(file, dialect, take); }

}  // namespace

Format xyz_format() { return {.extensions = {".xyz", ".txt", ".asc"}, .read = read, .take_points = take_points}; }

}  // namespace ahm::io
