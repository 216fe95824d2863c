#include "read/point_stream.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/io/point_stream.hpp"
#include "formats/format.hpp"

namespace ahm::io {
namespace {

constexpr std::size_t points_per_block = std::size_t{1} << 16;  // points

Vec3 load_point(const PointRecords& r, const char* bytes) {
  Vec3 point;
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = load_value(r.type[c], bytes + r.at[c], r.is_swapped);
    point[c] = r.is_scaled ? value * r.scale[c] + r.offset[c] : value;
  }
  return point;
}

[[noreturn]] void fail_short(const Input& in, std::uint64_t point, std::uint64_t count) {
  fail(in, "the file ends at or after point " + std::to_string(point) + " of " + std::to_string(count));
}

/// Reads fixed-size records of a compressed file and passes their points to `take`.
bool unpack(const ByteStream& file, const PointRecords& r, const TakePoint& take) {
  ByteStream bytes(file, r.begin);
  std::string buffer(points_per_block * r.stride, '\0');
  for (std::uint64_t i = 0; i < r.count;) {
    const std::size_t wanted = std::min<std::uint64_t>(points_per_block, r.count - i);
    if (bytes.read(std::span(buffer).first(wanted * r.stride)) < wanted * r.stride) fail_short(file.head(), i, r.count);
    for (std::size_t k = 0; k < wanted; ++k) take(load_point(r, buffer.data() + k * r.stride));
    i += wanted;
  }
  return r.has_normals;
}

const Format& format_of(const std::filesystem::path& path) {
  std::string extension = lower_extension(path);
  if (extension == ".gz") extension = lower_extension(path.stem());
  const Format* format = find_format(extension);
  const auto streams = [](const Format& f) { return f.records != nullptr || f.take_points != nullptr; };
  if (format != nullptr && streams(*format)) return *format;
  std::vector<std::string> known;
  for (const Format& other : formats())
    if (streams(other)) known.insert(known.end(), other.extensions.begin(), other.extensions.end());
  throw IoError(
      "no_cloud",
      "cannot read " + quoted_path(path) + ": points are read block by block from " + list_of(known, "or") + " files",
      "convert it to one of these");
}

}  // namespace

struct PointStream::Impl {
  Input in;  ///< for messages
  std::optional<RegularFile> file;
  PointRecords records;
  std::uint64_t next = 0;  ///< index of the next point
  std::vector<char> buffer;
};

PointStream::PointStream(const std::filesystem::path& path, const std::filesystem::path& scratch)
    : impl_(std::make_unique<Impl>()) {
  Impl& s = *impl_;
  s.in.path = path;
  const Format& format = format_of(path);
  const ByteStream bytes(path);
  const std::optional<PointRecords> records = format.records != nullptr ? format.records(bytes.head()) : std::nullopt;
  if (records) check_vertex_count(s.in, records->count);
  if (records && !bytes.is_packed()) {
    s.records = *records;
    s.file.emplace(path);
    return;
  }
  s.file.emplace(RegularFile::without_name(scratch));
  std::vector<Vec3> points;
  const auto write = [&] {
    s.file->append({reinterpret_cast<const char*>(points.data()), points.size() * sizeof(Vec3)});
    points.clear();
  };
  const TakePoint take = [&](const Vec3& point) {
    points.push_back(point);
    if (points.size() == points_per_block) write();
  };
  const bool has_normals = records ? unpack(bytes, *records, take) : format.take_points(bytes, take);
  write();
  s.records = {.count = s.file->size() / sizeof(Vec3),
               .stride = sizeof(Vec3),
               .at = {0, sizeof(double), 2 * sizeof(double)},
               .type = {PlyType::float64, PlyType::float64, PlyType::float64},
               .has_normals = has_normals};
}

PointStream::~PointStream() = default;
PointStream::PointStream(PointStream&&) noexcept = default;
PointStream& PointStream::operator=(PointStream&&) noexcept = default;

std::uint64_t PointStream::size() const noexcept { return impl_->records.count; }
bool PointStream::has_normals() const noexcept { return impl_->records.has_normals; }

std::size_t PointStream::read(std::span<Vec3> points) {
  Impl& s = *impl_;
  const PointRecords& r = s.records;
  const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(points.size(), r.count - s.next));
  s.buffer.resize(wanted * r.stride);
  if (s.file->read(r.begin + s.next * r.stride, s.buffer) < s.buffer.size()) fail_short(s.in, s.next, r.count);
  for (std::size_t i = 0; i < wanted; ++i) points[i] = load_point(r, s.buffer.data() + i * r.stride);
  s.next += wanted;
  return wanted;
}

void PointStream::rewind() { impl_->next = 0; }

}  // namespace ahm::io
