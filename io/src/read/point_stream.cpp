#include "ahm/io/point_stream.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "read/input.hpp"
#include "read/ply_value.hpp"

namespace ahm::io {

struct PointStream::Impl {
  Input in;  ///< the beginning of the file
  std::ifstream file;
  PlyFormat format = PlyFormat::little_endian;
  std::uint64_t begin = 0, count = 0, next = 0;  ///< bytes before the first point; points
  std::size_t stride = 0;                        ///< bytes per point
  std::array<std::size_t, 3> at{};               ///< of x, y, z in a point
  std::array<PlyType, 3> type{};
  bool has_normals = false;
  std::vector<char> buffer;

  void open();
  void find_points(const PlyHeader& header);
  void find_coordinates(const PlyElement& vertex);
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

void PointStream::Impl::find_points(const PlyHeader& header) {
  if (header.format == PlyFormat::ascii)
    fail(in, "it is a text file, of which only the whole can be read; make it binary");
  format = header.format;
  begin = header.body;
  for (const PlyElement& element : header.elements)
    if (element.name == "face" && element.count > 0) fail(in, "it has faces; only clouds of points can be streamed");
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      if (element.has_list()) fail(in, "its vertices have lists, so that points cannot be found without reading all");
      return find_coordinates(element);
    }
    if (element.has_list()) fail(in, "lists of element '" + element.name + "' stand before its vertices");
    begin += element.count * element.fixed_size();
  }
  fail(in, "it has no element 'vertex'");
}

void PointStream::Impl::find_coordinates(const PlyElement& vertex) {
  const auto offset_of = [&](std::size_t property) {
    std::size_t offset = 0;
    for (std::size_t p = 0; p < property; ++p) offset += size_of(vertex.properties[p].type);
    return offset;
  };
  count = vertex.count;
  stride = vertex.fixed_size();
  constexpr std::array names{"x", "y", "z"}, normals{"nx", "ny", "nz"};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto property = vertex.find(names[c]);
    if (!property) fail(in, std::string("its vertices have no property '") + names[c] + "'");
    at[c] = offset_of(*property);
    type[c] = vertex.properties[*property].type;
  }
  has_normals = std::ranges::all_of(normals, [&](const char* name) { return vertex.find(name).has_value(); });
}

PointStream::PointStream(const std::filesystem::path& path) : impl_(std::make_unique<Impl>()) {
  impl_->in.path = path;
  impl_->open();
  impl_->find_points(parse_ply_header(impl_->in));
  check_vertex_count(impl_->in, impl_->count);
  impl_->in.bytes.clear();
  impl_->in.bytes.shrink_to_fit();
  rewind();
}

PointStream::~PointStream() = default;
PointStream::PointStream(PointStream&&) noexcept = default;
PointStream& PointStream::operator=(PointStream&&) noexcept = default;

std::uint64_t PointStream::size() const noexcept { return impl_->count; }
bool PointStream::has_normals() const noexcept { return impl_->has_normals; }

std::size_t PointStream::read(std::span<Vec3> points) {
  Impl& s = *impl_;
  const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(points.size(), s.count - s.next));
  s.buffer.resize(wanted * s.stride);
  if (!s.file.read(s.buffer.data(), static_cast<std::streamsize>(s.buffer.size())))
    fail(s.in, "it ends at or after point " + std::to_string(s.next) + " of " + std::to_string(s.count));
  const bool swap = is_swapped(s.format);
  for (std::size_t i = 0; i < wanted; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      points[i][c] = load_value(s.type[c], s.buffer.data() + i * s.stride + s.at[c], swap);
  s.next += wanted;
  return wanted;
}

void PointStream::rewind() {
  impl_->next = 0;
  impl_->file.clear();
  impl_->file.seekg(static_cast<std::streamoff>(impl_->begin));
}

}  // namespace ahm::io
