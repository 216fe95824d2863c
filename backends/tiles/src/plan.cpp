#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "ahm/error.hpp"
#include "ahm/io/point_stream.hpp"
#include "ahm/tiles/build_tiles.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "clean_points.hpp"
#include "cut_points.hpp"
#include "stream_median.hpp"
#include "tile_folder.hpp"

namespace ahm::tiles {
namespace {

constexpr std::size_t block = std::size_t{1} << 16;            // points read at a time
constexpr std::uint64_t most_points = std::uint64_t{1} << 30;  // the limit of clouds in memory
constexpr std::uint64_t most_samples = std::uint64_t{1} << 20;

/// Calls use(point, row) for every finite point of the file.
template <class Use>
void for_each_point(io::PointStream& stream, const Use& use) {
  std::vector<Vec3> points(block);
  stream.rewind();
  for (std::uint64_t row = 0;;) {
    const std::size_t count = stream.read(points);
    if (count == 0) return;
    for (std::size_t i = 0; i < count; ++i, ++row)
      if (is_finite(points[i])) use(points[i], row);
  }
}

/// Counts the finite points. @return the largest absolute coordinate
double survey(io::PointStream& stream, Manifest& m) {
  double largest = 0;
  std::uint64_t finite = 0;
  for_each_point(stream, [&](const Vec3& p, std::uint64_t) {
    ++finite;
    for (double x : p) largest = std::max(largest, std::abs(x));
  });
  m.non_finite = m.points - finite;
  if (m.non_finite > 0 && !m.options.drop_non_finite)
    throw InvalidGeometry("non_finite", detail::counted(m.non_finite, "non-finite point") + " in the file",
                          "drop such points with drop_non_finite");
  if (finite < 3)
    throw InvalidGeometry("the cloud has " + detail::counted(finite, "finite point") + "; at least 3 are required");
  return largest;
}

/// The exponent of the placement that `clean_points` would use. Computes its medians by streaming.
int exponent_of(io::PointStream& stream, Manifest& m, const Progress& progress) {
  const double largest = survey(stream, m);
  const std::uint64_t finite = m.points - m.non_finite;
  const int first = largest > 0 ? std::ilogb(largest) : 0;
  std::array<StreamMedian, 3> middle{StreamMedian(finite), StreamMedian(finite), StreamMedian(finite)};
  while (!middle[0].done() || !middle[1].done() || !middle[2].done()) {
    progress.step("place", 0.3);
    for (StreamMedian& median : middle)
      if (!median.done()) median.begin();
    for_each_point(stream, [&](const Vec3& p, std::uint64_t) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (!middle[axis].done()) middle[axis].add(std::scalbn(p[axis], -first));
    });
    for (StreamMedian& median : middle)
      if (!median.done()) median.end();
  }
  StreamMedian spread(finite);
  while (!spread.done()) {
    progress.step("place", 0.6);
    spread.begin();
    for_each_point(stream, [&](const Vec3& point, std::uint64_t) {
      double largest_difference = 0;
      for (std::size_t axis = 0; axis < 3; ++axis)
        largest_difference =
            std::max(largest_difference, std::abs(std::scalbn(point[axis], -first) - middle[axis].value()));
      spread.add(largest_difference);
    });
    spread.end();
  }
  return first + (spread.value() > 0 ? std::ilogb(spread.value()) : 0);
}

/// The first point on the curve of each tile except the first: quantiles of a sample.
std::vector<Vec3> cuts(io::PointStream& stream, const Manifest& m) {
  const std::uint64_t finite = m.points - m.non_finite, stride = finite / most_samples + 1;
  std::vector<Vec3> sample;
  std::uint64_t next = 0;
  for_each_point(stream, [&](const Vec3& p, std::uint64_t) {
    if (next++ % stride == 0) sample.push_back(p);
  });
  std::sort(sample.begin(), sample.end(), pointcloud::before_on_curve);
  const std::uint64_t tiles = (finite + m.options.tile_points - 1) / static_cast<std::uint64_t>(m.options.tile_points);
  std::vector<Vec3> result;
  for (std::uint64_t t = 1; t < tiles; ++t) result.push_back(sample[t * sample.size() / tiles]);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  if (!result.empty() && result.front() == sample.front()) result.erase(result.begin());  // there is no point before it
  return result;
}

/// Appends points to the files of their tiles.
class Cutter {
 public:
  Cutter(const std::filesystem::path& folder, std::size_t tiles) : folder_(folder), parts_(tiles) {
    for (std::size_t t = 0; t < tiles; ++t) {
      std::filesystem::remove(Manifest::file(folder, cut_kind, t));
      XXH3_64bits_reset(&parts_[t].hash);
    }
  }
  void add(std::size_t tile, const CutPoint& point) {
    Part& part = parts_[tile];
    part.waiting.push_back(point);
    if (part.waiting.size() == 2048) flush(tile);
  }
  void finish(std::vector<TileFacts>& facts) {
    facts.clear();
    for (std::size_t t = 0; t < parts_.size(); ++t) {
      flush(t);
      facts.push_back({.cut = parts_[t].count, .hash = XXH3_64bits_digest(&parts_[t].hash)});
    }
  }

 private:
  struct Part {
    std::vector<CutPoint> waiting;
    std::uint64_t count = 0;
    XXH3_state_t hash;
  };
  void flush(std::size_t tile) {
    Part& part = parts_[tile];
    const auto bytes = part.waiting.size() * sizeof(CutPoint);
    const auto path = Manifest::file(folder_, cut_kind, tile);
    std::ofstream file(path, std::ios::binary | std::ios::app);
    if (!file.write(reinterpret_cast<const char*>(part.waiting.data()), static_cast<std::streamsize>(bytes)).flush())
      throw IoError("cannot write '" + path.string() + "': " + std::strerror(errno));
    XXH3_64bits_update(&part.hash, part.waiting.data(), bytes);
    part.count += part.waiting.size();
    part.waiting.clear();
  }

  std::filesystem::path folder_;
  std::vector<Part> parts_;
};

void check(const TileOptions& options) {
  check_tile_points(options.tile_points);
  if (options.k != 0 && options.k < 3)
    throw InvalidArgument("k is " + std::to_string(options.k) + "; it must be at least 3 (default 30)");
  if (!(options.max_edge_ratio >= 1))
    throw InvalidArgument("max_edge_ratio is " + detail::number(options.max_edge_ratio) + "; it must be at least 1");
}

void check(const TileOptions& options, const io::PointStream& stream) {
  if (stream.has_normals() && !options.ignore_normals)
    throw InvalidArgument("normals_given", "the file has normals, which tiles do not support",
                          "set ignore_normals to estimate them");
  if (stream.size() > most_points)
    throw ResourceExhausted("the file has " + detail::counted(stream.size(), "point") + "; at most 2^30 are supported");
}

/// The folder, or its nearest parent that exists.
std::filesystem::path folder_that_exists(std::filesystem::path folder) {
  folder = std::filesystem::absolute(folder);
  while (!std::filesystem::is_directory(folder) && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

}  // namespace

Manifest plan_tiles(const std::filesystem::path& input, const std::filesystem::path& folder, const TileOptions& options,
                    const Progress& progress) {
  check(options);
  check_no_tiles(folder);
  io::PointStream stream(input, folder_that_exists(folder));
  check(options, stream);
  std::filesystem::create_directories(folder);
  Manifest m;
  m.input = std::filesystem::absolute(input).string();
  m.options = options;
  m.points = stream.size();
  m.exponent = exponent_of(stream, m, progress);
  const std::vector<Vec3> begins = cuts(stream, m);
  progress.step("cut", 0.8);
  Cutter cutter(folder, begins.size() + 1);
  for_each_point(stream, [&](const Vec3& p, std::uint64_t row) {
    const auto tile = std::upper_bound(begins.begin(), begins.end(), p, pointcloud::before_on_curve) - begins.begin();
    cutter.add(static_cast<std::size_t>(tile), {p, static_cast<std::int64_t>(row)});
  });
  cutter.finish(m.tiles);
  m.write(folder);
  progress.step("cut", 1);
  return m;
}

}  // namespace ahm::tiles
