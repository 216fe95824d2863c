// Reads PCD files with PCL. PCL does not check the header and reads "1,5" as 1, so check_pcd checks the file first. PCL then parses
// the header and text that check_pcd returned, or the same binary data in memory; it does not open the file.
// Do not compile this file with -march flags: its interface to PCL contains Eigen types.
#include "read/pcl_read_pcd.hpp"

#include <pcl/PCLPointCloud2.h>
#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <span>
#include <sstream>
#include <string>
#include <utility>

#include "ahm/util/text.hpp"
#include "read/columns.hpp"
#include "read/pcd_header.hpp"

namespace ahm::io {

/// Disables PCL's console output during its lifetime. The level is global, so only one thread may change it at a time.
class PclQuiet {
 public:
  PclQuiet() : lock_(mutex()), level_(pcl::console::getVerbosityLevel()) {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  }
  ~PclQuiet() { pcl::console::setVerbosityLevel(level_); }
  PclQuiet(const PclQuiet&) = delete;
  PclQuiet& operator=(const PclQuiet&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::lock_guard<std::mutex> lock_;
  pcl::console::VERBOSITY_LEVEL level_;
};

namespace {

using pcl::PCLPointCloud2;
using pcl::PCLPointField;

const PCLPointField* find(const PCLPointCloud2& cloud, const char* name) {
  const auto found = std::ranges::find(cloud.fields, name, &PCLPointField::name);
  return found == cloud.fields.end() ? nullptr : &*found;
}

template <class T>
double load_as(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double load_value(const Input& in, const PCLPointField& field, const std::uint8_t* point) {
  const std::uint8_t* bytes = point + field.offset;
  switch (field.datatype) {
    case PCLPointField::INT8:
      return load_as<std::int8_t>(bytes);
    case PCLPointField::UINT8:
      return load_as<std::uint8_t>(bytes);
    case PCLPointField::INT16:
      return load_as<std::int16_t>(bytes);
    case PCLPointField::UINT16:
      return load_as<std::uint16_t>(bytes);
    case PCLPointField::INT32:
      return load_as<std::int32_t>(bytes);
    case PCLPointField::UINT32:
      return load_as<std::uint32_t>(bytes);
    case PCLPointField::INT64:
      return load_as<std::int64_t>(bytes);
    case PCLPointField::UINT64:
      return load_as<std::uint64_t>(bytes);
    case PCLPointField::FLOAT32:
      return load_as<float>(bytes);
    case PCLPointField::FLOAT64:
      return load_as<double>(bytes);
    default:
      fail(in, "field '" + field.name + "' has a type that PCL does not support");
  }
}

/// @param text  the points of a text file; moved from
PCLPointCloud2 read_with_pcl(const Input& in, const PcdHeader& header, std::string&& text) {
  const PclQuiet quiet;
  pcl::PCDReader reader;
  PCLPointCloud2 cloud;
  Eigen::Vector4f origin;
  Eigen::Quaternionf orientation;
  int version = 0;
  int data = 0;
  unsigned int position = 0;
  std::istringstream head(full_header(header));
  int error = reader.readHeader(head, cloud, origin, orientation, version, data, position);
  // PCL's sizes must match those of check_pcd before PCL copies so many bytes.
  if (error == 0 && (cloud.point_step != header.point_size || cloud.data.size() != header.points * header.point_size))
    error = -1;
  if (error == 0 && header.data == PcdData::ascii) {
    std::istringstream body(std::move(text));
    body.imbue(std::locale::classic());
    error = reader.readBodyASCII(body, cloud, version);
  } else if (error == 0) {
    const auto* body = reinterpret_cast<const unsigned char*>(in.bytes.data() + header.body);
    error = reader.readBodyBinary(body, cloud, version, header.data == PcdData::compressed, 0);
  }
  if (error != 0) fail(in, "PCL cannot read the data; the file is damaged");
  return cloud;
}

/// Checks that the cloud from PCL matches the header.
void check_result(const Input& in, const PcdHeader& header, const PCLPointCloud2& cloud) {
  const std::uint64_t points = std::uint64_t{cloud.width} * cloud.height;
  bool inside = points == header.points && cloud.data.size() >= points * cloud.point_step &&
                cloud.fields.size() == header.fields.size();
  for (const PCLPointField& field : cloud.fields) {
    const std::uint64_t size = static_cast<std::uint64_t>(std::max(0, pcl::getFieldSize(field.datatype)));
    inside = inside && size > 0 && field.offset + size * field.count <= cloud.point_step;
  }
  if (!inside)
    fail(in, "PCL read " + std::to_string(points) + " of " + detail::counted(header.points, "point") +
                 "; the file is damaged");
}

void read_vectors(const Input& in, const PCLPointCloud2& cloud, std::array<const char*, 3> names,
                  std::vector<Vec3>& result) {
  std::array<const PCLPointField*, 3> fields{};
  for (std::size_t k = 0; k < 3; ++k) fields[k] = find(cloud, names[k]);
  if (std::ranges::count(fields, nullptr) > 0) return;
  result.resize(std::size_t{cloud.width} * cloud.height);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const std::uint8_t* point = cloud.data.data() + i * cloud.point_step;
    for (std::size_t k = 0; k < 3; ++k) result[i][k] = load_value(in, *fields[k], point);
  }
}

bool has_a_role(const PCLPointField& field) {
  constexpr std::string_view roles[] = {"x", "y", "z", "normal_x", "normal_y", "normal_z", "rgb", "rgba"};
  return std::ranges::find(roles, field.name) != std::end(roles);
}

/// Whether doubles represent all values exactly; integers of 64 bits may be too large.
bool exact(const PCLPointField& field, std::span<const double> values) {
  constexpr double largest = 9007199254740992;  // 2^53
  const bool wide = field.datatype == PCLPointField::INT64 || field.datatype == PCLPointField::UINT64;
  return !wide || std::ranges::all_of(values, [](double x) { return std::abs(x) < largest; });
}

/// @param header  its fields are those of the cloud, except for the names of padding
void read_properties(const Input& in, const PcdHeader& header, const PCLPointCloud2& cloud, Geometry& g) {
  constexpr std::size_t most_columns = 4096;  // limits the time of the search for equal names
  std::size_t columns = 0;
  for (std::size_t f = 0; f < cloud.fields.size(); ++f) {
    const PCLPointField& field = cloud.fields[f];
    if (has_a_role(field) || header.fields[f].name == "_") continue;
    PCLPointField value = field;
    for (std::uint32_t c = 0; c < field.count; ++c, value.offset += pcl::getFieldSize(field.datatype)) {
      const std::string name = field.count == 1 ? field.name : field.name + "_" + std::to_string(c);
      std::vector<double> values(columns < most_columns ? g.points.size() : 0);
      for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = load_value(in, value, cloud.data.data() + i * cloud.point_step);
      if (++columns > most_columns || !exact(field, values)) {
        g.warnings.push_back({"element_ignored", {}, {}, field.name});
        break;
      }
      add_property(g, name, std::move(values));
    }
  }
}

/// Reads colors, which PCL packs into four bytes as 0xAARRGGBB; the type of the field may be float.
void read_colors(const PCLPointCloud2& cloud, Geometry& g) {
  const PCLPointField* field = find(cloud, "rgb") ? find(cloud, "rgb") : find(cloud, "rgba");
  if (field == nullptr) return;
  if (pcl::getFieldSize(field->datatype) != 4) {
    g.warnings.push_back({"colors_not_packed", {}, {}});
    return;
  }
  g.colors.resize(g.points.size());
  for (std::size_t i = 0; i < g.colors.size(); ++i) {
    std::uint32_t packed = 0;
    std::memcpy(&packed, cloud.data.data() + i * cloud.point_step + field->offset, sizeof packed);
    g.colors[i] = {static_cast<std::uint8_t>(packed >> 16), static_cast<std::uint8_t>(packed >> 8),
                   static_cast<std::uint8_t>(packed)};
  }
}

}  // namespace

Geometry read_pcd(const Input& in) {
  auto [header, text] = check_pcd(in);
  Geometry g;
  g.format = header.data == PcdData::ascii    ? "PCD text"
             : header.data == PcdData::binary ? "PCD binary"
                                              : "PCD compressed";
  const auto& from = header.viewpoint;
  g.acquisition = {header.width, header.height, {from[0], from[1], from[2]}, {from[3], from[4], from[5], from[6]}};
  if (header.points == 0) return g;
  const PCLPointCloud2 cloud = read_with_pcl(in, header, std::move(text));
  check_result(in, header, cloud);
  read_vectors(in, cloud, {"x", "y", "z"}, g.points);
  read_vectors(in, cloud, {"normal_x", "normal_y", "normal_z"}, g.normals);
  read_colors(cloud, g);
  read_properties(in, header, cloud, g);
  header.skipped.report(g.warnings);
  return g;
}

}  // namespace ahm::io
