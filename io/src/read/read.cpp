#include "ahm/io/read.hpp"

#include <limits>
#include <new>

#include "read/readers.hpp"

namespace ahm::io {
namespace {

Geometry read_by_extension(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".ply") return read_ply(load(path));
  if (extension == ".off") return read_off(load(path));
  if (extension == ".obj") return read_obj(load(path));
  if (extension == ".stl") return read_stl(load(path));
  if (extension == ".pcd") return read_pcd(load(path));
  if (extension == ".xyz" || extension == ".txt") return read_xyz(load(path));
  if (extension == ".csv") return read_csv(load(path));
  if (extension == ".gz" || extension == ".zip" || extension == ".xz" || extension == ".bz2") {
    throw IoError("cannot read " + quoted_path(path) + ": compressed files are not read; unpack it first");
  }
  throw IoError("cannot read " + quoted_path(path) + ": unknown file type " + in_quotes(extension) +
                "; known are .ply, .off, .obj, .stl, .pcd, .xyz, .txt and .csv");
}

/// The one law every format shares: a face names vertices that exist.
void check_faces(const std::filesystem::path& path, const Geometry& g) {
  for (std::size_t f = 0; f < g.face_count(); ++f) {
    for (const Index vertex : g.face(f)) {
      if (vertex >= 0 && static_cast<std::size_t>(vertex) < g.points.size()) continue;
      throw IoError("cannot read " + quoted_path(path) + ": face " + std::to_string(f) + " has vertex number " +
                    std::to_string(vertex) + ", but there are " + std::to_string(g.points.size()) +
                    " vertices, counted from 0");
    }
  }
}

}  // namespace

void check_vertex_count(const Input& in, std::uint64_t count) {
  if (count > static_cast<std::uint64_t>(std::numeric_limits<Index>::max())) {
    fail(in, std::to_string(count) + " vertices are more than 2147483647, the most this library can number");
  }
}

Geometry read(const std::filesystem::path& path) {
  try {
    Geometry g = read_by_extension(path);
    check_faces(path, g);
    return g;
  } catch (const std::bad_alloc&) {
    throw ResourceExhausted("not enough memory to read " + quoted_path(path));
  }
}

}  // namespace ahm::io
