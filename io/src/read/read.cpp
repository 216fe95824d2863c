#include "ahm/io/read.hpp"

#include <new>

#include "ahm/io/formats.hpp"
#include "formats/format.hpp"

namespace ahm::io {
namespace {

Geometry read_by_extension(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (const Format* format = find_format(extension)) {
    if (format->read != nullptr) return format->read(load(path));
    if (!format->missing.empty())
      throw IoError("cannot read " + quoted_path(path) + ": this build has no " + format->missing + ", which reads " +
                    extension + " files; convert it to .ply or .xyz");
  }
  if (extension == ".gz" || extension == ".zip" || extension == ".xz" || extension == ".bz2") {
    throw IoError("cannot read " + quoted_path(path) + ": compressed files are not read; unpack it first");
  }
  throw IoError("cannot read " + quoted_path(path) + ": unknown file type " + in_quotes(extension) + "; known are " +
                list_of(extensions(Use::read)));
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
