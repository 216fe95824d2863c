// Streams of points from arbitrary bytes, also as gzip. They contain the points that the reader of the whole file returns.
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

std::vector<Vec3> stream(const std::filesystem::path& path) {
  io::PointStream file(path, path.parent_path());
  (void)file.has_normals();
  std::vector<Vec3> all(std::min<std::uint64_t>(file.size(), 100000));
  // In two parts, and again from the start.
  const std::span<Vec3> room(all);
  std::size_t count = file.read(room.first(room.size() / 2));
  count += file.read(room.subspan(count));
  require(count == room.size(), "as many points as the size of the stream");
  std::vector<Vec3> first(std::min<std::size_t>(2, count));
  file.rewind();
  require(file.read(first) == first.size(), "as many points again");
  require(first.empty() || std::memcmp(first.data(), all.data(), first.size() * sizeof(Vec3)) == 0,
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
  std::optional<std::vector<Vec3>> parts;
  allow_refusals([&] { parts = stream(path); });
  if (!whole || !parts || whole->points.size() > 100000) return;
  require(parts->size() == whole->points.size(), "as many points as in the whole file");
  require(std::equal(parts->begin(), parts->end(), whole->points.begin(),
                     [](const Vec3& a, const Vec3& b) {
                       for (int c = 0; c < 3; ++c)
                         if (!(a[c] == b[c] || (std::isnan(a[c]) && std::isnan(b[c])))) return false;
                       return true;
                     }),
          "the same points as in the whole file");
}

}  // namespace
}  // namespace ahm::fuzz

/// The first byte chooses the format.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ahm;
  if (size == 0) return 0;
  constexpr std::array extensions{".csv", ".las", ".pcd", ".ply", ".pts", ".xyz"};
  const io::Format& format = *io::find_format(extensions[*data % extensions.size()]);
  fuzz::check(format, std::string(reinterpret_cast<const char*>(data) + 1, size - 1));
  return 0;
}
