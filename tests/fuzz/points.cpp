// A stream of points, on any bytes: of what can be read whole it hands over the same points, packed with gzip or not.
#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "ahm/io/point_stream.hpp"
#include "ahm/io/temporary_folder.hpp"
#include "bytes.hpp"
#include "formats/format.hpp"
#include "read/gunzip.hpp"

namespace ahm::fuzz {
namespace {

struct Points {
  std::vector<Vec3> points;
  bool have_normals;
};

Points stream(const std::filesystem::path& path) {
  io::PointStream file(path, path.parent_path());
  Points all{std::vector<Vec3>(std::min<std::uint64_t>(file.size(), 100000)), file.has_normals()};
  // In two parts, and again from the beginning.
  const std::span<Vec3> room(all.points);
  std::size_t count = file.read(room.first(room.size() / 2));
  count += file.read(room.subspan(count));
  require(count == room.size(), "as many points as were said");
  std::vector<Vec3> first(std::min<std::size_t>(2, count));
  file.rewind();
  require(file.read(first) == first.size(), "as many points again");
  require(first.empty() || std::memcmp(first.data(), all.points.data(), first.size() * sizeof(Vec3)) == 0,
          "the same points again");
  return all;
}

void check(const io::Format& format, const std::string& bytes) {
  const io::TemporaryFolder scratch("ahm_fuzz_");
  const std::filesystem::path path = scratch.directory() / ("file" + format.extensions.front());
  std::ofstream(path, std::ios::binary) << bytes;
  std::optional<io::Geometry> whole;
  io::Input in{"/nowhere/file" + format.extensions.front(), bytes};
  if (format.read != nullptr)
    allow_refusals([&] {
      if (io::is_gzip(in)) io::gunzip(in);
      whole = format.read(in);
    });
  std::optional<Points> parts;
  allow_refusals([&] { parts = stream(path); });
  if (!whole || !parts || whole->points.size() > 100000) return;
  require(parts->points.size() == whole->points.size(), "as many points as read whole");
  require(std::equal(parts->points.begin(), parts->points.end(), whole->points.begin(),
                     [](const Vec3& a, const Vec3& b) {
                       for (int c = 0; c < 3; ++c)
                         if (!(a[c] == b[c] || (std::isnan(a[c]) && std::isnan(b[c])))) return false;
                       return true;
                     }),
          "the same points as read whole");
}

}  // namespace
}  // namespace ahm::fuzz

/// The first byte says which format.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ahm;
  if (size == 0) return 0;
  constexpr std::array extensions{".csv", ".las", ".pcd", ".ply", ".pts", ".xyz"};
  const io::Format& format = *io::find_format(extensions[*data % extensions.size()]);
  fuzz::check(format, std::string(reinterpret_cast<const char*>(data) + 1, size - 1));
  return 0;
}
