#include "ahm/io/point_stream.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "formats/format.hpp"
#include "read/input.hpp"
#include "read/point_records.hpp"

namespace ahm::io {

struct PointStream::Impl {
  Input in;  ///< the beginning of the file
  std::ifstream file;
  PointRecords records;
  std::uint64_t next = 0;  ///< number of a point
  std::vector<char> buffer;

  void open();
};

/// Loads what the header may take of the file.
void PointStream::Impl::open() {
  constexpr std::uint64_t most = 1 << 20;
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(in.path, error);
  if (error) fail(in, error.message());
  file.open(in.path, std::ios::binary);
  in.bytes.resize(std::min(size, most));
  in.beyond = size - in.bytes.size();
  if (!file.read(in.bytes.data(), static_cast<std::streamsize>(in.bytes.size()))) fail(in, "reading it failed");
}

PointStream::PointStream(const std::filesystem::path& path) : impl_(std::make_unique<Impl>()) {
  Impl& s = *impl_;
  s.in.path = path;
  const Format* format = find_format(lower_extension(path));
  if (format == nullptr || format->records == nullptr) {
    std::vector<std::string> known;
    for (const Format& other : formats())
      if (other.records != nullptr) known.insert(known.end(), other.extensions.begin(), other.extensions.end());
    fail(s.in, "points are read block by block from " + list_of(known, "or") + " files; convert it to one");
  }
  s.open();
  s.records = format->records(s.in);
  check_vertex_count(s.in, s.records.count);
  s.in.bytes.clear();
  s.in.bytes.shrink_to_fit();
  rewind();
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
  if (!s.file.read(s.buffer.data(), static_cast<std::streamsize>(s.buffer.size())))
    fail(s.in, "it ends at or after point " + std::to_string(s.next) + " of " + std::to_string(r.count));
  for (std::size_t i = 0; i < wanted; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = load_value(r.type[c], s.buffer.data() + i * r.stride + r.at[c], r.is_swapped);
      points[i][c] = r.is_scaled ? value * r.scale[c] + r.offset[c] : value;
    }
  s.next += wanted;
  return wanted;
}

void PointStream::rewind() {
  impl_->next = 0;
  impl_->file.clear();
  impl_->file.seekg(static_cast<std::streamoff>(impl_->records.begin));
}

}  // namespace ahm::io
