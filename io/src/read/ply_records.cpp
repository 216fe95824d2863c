#include <algorithm>
#include <string>

#include "ahm/error.hpp"
#include "read/point_records.hpp"

namespace ahm::io {
namespace {

void find_coordinates(const Input& in, const PlyElement& vertex, PointRecords& records) {
  const auto offset_of = [&](std::size_t property) {
    std::size_t offset = 0;
    for (std::size_t p = 0; p < property; ++p) offset += size_of(vertex.properties[p].type);
    return offset;
  };
  records.count = vertex.count;
  records.stride = vertex.fixed_size();
  constexpr std::array names{"x", "y", "z"}, normals{"nx", "ny", "nz"};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto property = vertex.find(names[c]);
    if (!property) fail(in, std::string("its vertices have no property '") + names[c] + "'");
    records.at[c] = offset_of(*property);
    records.type[c] = vertex.properties[*property].type;
  }
  records.has_normals = std::ranges::all_of(normals, [&](const char* name) { return vertex.find(name).has_value(); });
}

}  // namespace

std::optional<PointRecords> ply_records(const Input& in) {
  const PlyHeader header = parse_ply_header(in);
  PointRecords records{.begin = header.body};
  records.is_swapped = is_swapped(header.format);
  for (const PlyElement& element : header.elements)
    if ((element.name == "face" || element.name == "tristrips") && element.count > 0)
      throw IoError("no_cloud", "cannot read " + quoted_path(in.path) + ": it has faces",
                    "only clouds of points can be streamed");
  if (header.format == PlyFormat::ascii) return std::nullopt;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      if (element.has_list()) fail(in, "its vertices have lists, so that points cannot be found without reading all");
      find_coordinates(in, element, records);
      return records;
    }
    if (element.has_list()) fail(in, "lists of element '" + element.name + "' stand before its vertices");
    records.begin += element.count * element.fixed_size();
  }
  fail(in, "it has no element 'vertex'");
}

}  // namespace ahm::io
