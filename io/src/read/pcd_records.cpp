#include <algorithm>
#include <optional>
#include <string>

#include "read/pcd_header.hpp"
#include "read/point_records.hpp"

namespace ahm::io {
namespace {

/// None for whole numbers of 8 bytes.
std::optional<PlyType> type_of(const PcdField& field) {
  constexpr PlyType whole[] = {PlyType::int8, PlyType::int16, PlyType::int32},
                    natural[] = {PlyType::uint8, PlyType::uint16, PlyType::uint32};
  if (field.type == 'F') return field.size == 4 ? PlyType::float32 : PlyType::float64;
  if (field.size == 8) return std::nullopt;
  return (field.type == 'I' ? whole : natural)[field.size / 2];
}

}  // namespace

PointRecords pcd_records(const Input& in) {
  const PcdHeader header = parse_pcd_header(in);
  if (header.data == PcdData::ascii) fail(in, "it is a text file, of which only the whole can be read; make it binary");
  if (header.data == PcdData::compressed) fail(in, "its points are compressed; save it as binary");
  check_pcd_size(in, header);
  PointRecords records{.begin = header.body, .count = header.points};
  records.is_swapped = std::endian::native == std::endian::big;
  int normals = 0;
  for (const PcdField& field : header.fields) {
    const auto axis = std::string("xyz").find(field.name);
    if (field.name.size() == 1 && axis != std::string::npos) {
      const auto type = type_of(field);
      if (!type) fail(in, "its coordinates are whole numbers of 8 bytes; make them real ones");
      records.at[axis] = records.stride;
      records.type[axis] = *type;
    }
    normals += field.name.size() == 8 && field.name.starts_with("normal_") ? 1 : 0;
    records.stride += field.size * field.count;
  }
  records.has_normals = normals == 3;
  return records;
}

}  // namespace ahm::io
