// PCL writes PCD: the header from its PCDWriter, the points in the layout of its PCLPointCloud2. This file must not be
// compiled with -march flags: PCL's Eigen types cross the border.
#include "write/pcl_write_pcd.hpp"

#include <pcl/PCLPointCloud2.h>
#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <cmath>

#include "little_endian.hpp"
#include "read/pcl_quiet.hpp"

namespace ahm::io {
namespace {

using pcl::PCLPointField;

bool is(const Column& column, const std::vector<std::string>& names) { return column.names == names; }

/// Whether every number is a float already, as the coordinates of most clouds are stored.
bool fits_float(std::span<const double> values) {
  return std::ranges::all_of(
      values, [](double x) { return !std::isfinite(x) || static_cast<double>(static_cast<float>(x)) == x; });
}

std::uint8_t type_of(const Column& column) {
  if (std::holds_alternative<std::span<const Index>>(column.values)) return PCLPointField::INT32;
  const auto* numbers = std::get_if<std::span<const double>>(&column.values);
  if (numbers == nullptr) return PCLPointField::UINT8;
  const bool floats = is(column, {"nx", "ny", "nz"}) || (is(column, {"x", "y", "z"}) && fits_float(*numbers));
  return floats ? PCLPointField::FLOAT32 : PCLPointField::FLOAT64;
}

/// PCL's name for what others call nx, ny, nz.
std::string name_of(const Column& column, std::size_t k) {
  return is(column, {"nx", "ny", "nz"}) ? "normal_" + std::string(1, "xyz"[k]) : column.names[k];
}

void add_fields(pcl::PCLPointCloud2& cloud, const Column& column, std::uint8_t type) {
  for (std::size_t k = 0; k < column.names.size(); ++k) {
    PCLPointField field;
    field.name = name_of(column, k);
    field.offset = cloud.point_step;
    field.datatype = type;
    field.count = 1;
    cloud.point_step += static_cast<std::uint32_t>(pcl::getFieldSize(type));
    cloud.fields.push_back(field);
  }
}

std::string header_of(const pcl::PCLPointCloud2& cloud) {
  const PclQuiet quiet;
  std::string header =
      pcl::PCDWriter().generateHeaderBinary(cloud, Eigen::Vector4f::Zero(), Eigen::Quaternionf::Identity());
  return header + "DATA binary\n";
}

}  // namespace

void write_pcd(AtomicFile& file, const Table& table) {
  pcl::PCLPointCloud2 cloud;
  cloud.width = static_cast<std::uint32_t>(table.rows());
  cloud.height = 1;
  cloud.point_step = 0;
  std::vector<std::uint8_t> types;
  for (const Column& column : table.columns) add_fields(cloud, column, types.emplace_back(type_of(column)));
  file.write(header_of(cloud));

  std::string bytes;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    bytes.clear();
    for (std::size_t c = 0; c < types.size(); ++c)
      visit_row(table.columns[c], row, [&](auto value) {
        types[c] == PCLPointField::FLOAT32 ? append(bytes, static_cast<float>(value)) : append(bytes, value);
      });
    file.write(bytes);
  }
}

}  // namespace ahm::io
