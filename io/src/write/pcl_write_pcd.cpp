// PCL writes PCD: the header from its PCDWriter, the points in the layout of its PCLPointCloud2. This file must not be
// compiled with -march flags: PCL's Eigen types cross the border.
#include <pcl/PCLPointCloud2.h>
#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "read/pcl_quiet.hpp"
#include "write/writers.hpp"

namespace ahm::io {
namespace {

using pcl::PCLPointField;

/// Whether every coordinate is a float already, as most clouds are stored.
bool fits_float(std::span<const Vec3> points) {
  return std::ranges::all_of(points, [](const Vec3& p) {
    return std::ranges::all_of(
        p, [](double c) { return !std::isfinite(c) || static_cast<double>(static_cast<float>(c)) == c; });
  });
}

void add_fields(pcl::PCLPointCloud2& cloud, std::initializer_list<const char*> names, std::uint8_t type) {
  for (const char* name : names) {
    PCLPointField field;
    field.name = name;
    field.offset = cloud.point_step;
    field.datatype = type;
    field.count = 1;
    cloud.point_step += static_cast<std::uint32_t>(pcl::getFieldSize(type));
    cloud.fields.push_back(field);
  }
}

template <class T>
void append(std::string& bytes, T value) {
  const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  bytes.append(raw.data(), raw.size());
}

void append_real(std::string& bytes, double value, bool as_float) {
  if (as_float) {
    append(bytes, static_cast<float>(value));
  } else {
    append(bytes, value);
  }
}

std::string header_of(const pcl::PCLPointCloud2& cloud) {
  const PclQuiet quiet;
  std::string header =
      pcl::PCDWriter().generateHeaderBinary(cloud, Eigen::Vector4f::Zero(), Eigen::Quaternionf::Identity());
  return header + "DATA binary\n";
}

}  // namespace

bool has_pcd() noexcept { return true; }

void write_pcd(AtomicFile& file, const Table& table) {
  const bool floats = fits_float(table.points);
  pcl::PCLPointCloud2 cloud;
  cloud.width = static_cast<std::uint32_t>(table.points.size());
  cloud.height = 1;
  cloud.point_step = 0;
  add_fields(cloud, {"x", "y", "z"}, floats ? PCLPointField::FLOAT32 : PCLPointField::FLOAT64);
  if (!table.normals.empty()) add_fields(cloud, {"normal_x", "normal_y", "normal_z"}, PCLPointField::FLOAT32);
  const std::vector<Column> columns = map_columns(table);
  for (const Column& column : columns) add_fields(cloud, {column.name.c_str()}, PCLPointField::FLOAT64);
  add_fields(cloud, {"status"}, PCLPointField::UINT8);
  for (const Column& column : table.further) add_fields(cloud, {column.name.c_str()}, PCLPointField::FLOAT64);
  file.write(header_of(cloud));

  std::string row;
  for (std::size_t i = 0; i < table.points.size(); ++i) {
    row.clear();
    for (double coordinate : table.points[i]) append_real(row, coordinate, floats);
    if (!table.normals.empty()) {
      for (double coordinate : table.normals[i]) append_real(row, coordinate, true);
    }
    for (const Column& column : columns) append(row, value_of(table, column, i));
    append(row, static_cast<std::uint8_t>(table.status[i]));
    for (const Column& column : table.further) append(row, value_of(table, column, i));
    file.write(row);
  }
}

}  // namespace ahm::io
