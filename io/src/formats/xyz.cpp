#include "formats/format.hpp"
#include "read/columns.hpp"

namespace ahm::io {

Format xyz_format() { return {.extensions = {".xyz", ".txt"}, .read = read_blank_separated}; }

}  // namespace ahm::io
