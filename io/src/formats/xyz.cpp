#include "formats/format.hpp"
#include "read/columns.hpp"

namespace ahm::io {
namespace {

Geometry read(const Input& in) { return read_columns(in, {.format = "XYZ text"}); }

}  // namespace

Format xyz_format() { return {.extensions = {".xyz", ".txt", ".asc"}, .read = read}; }

}  // namespace ahm::io
