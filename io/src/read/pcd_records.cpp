#include "read/pcd_records.hpp"

#include <algorithm>
#include <string>

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

std::optional<std::size_t> axis_of(const PcdField& field) {
  const auto axis = std::string("xyz").find(field.name);
  return field.name.size() == 1 && axis != std::string::npos ? std::optional(axis) : std::nullopt;
}

bool has_normals(const PcdHeader& header) {
  return std::ranges::count_if(header.fields, [](const PcdField& field) {
           return field.name.size() == 8 && field.name.starts_with("normal_");
         }) == 3;
}

PointRecords records_of(const Input& in, const PcdHeader& header) {
  PointRecords records{.begin = header.body, .count = header.points, .has_normals = has_normals(header)};
  records.is_swapped = std::endian::native == std::endian::big;
  for (const PcdField& field : header.fields) {
    if (const auto axis = axis_of(field)) {
      const auto type = type_of(field);
      if (!type) fail(in, "its coordinates are whole numbers of 8 bytes; make them real ones");
      records.at[*axis] = records.stride;
      records.type[*axis] = *type;
    }
    records.stride += field.size * field.count;
  }
  return records;
}

std::optional<PointRecords> pcd_records(const Input& in) {
  const PcdHeader header = parse_pcd_header(in);
  if (header.data != PcdData::binary) return std::nullopt;
  check_pcd_size(in, header);
  return records_of(in, header);
}

}  // namespace ahm::io
