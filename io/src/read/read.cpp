#include "ahm/io/read.hpp"

#include <new>

#include "ahm/io/formats.hpp"
#include "formats/format.hpp"

namespace ahm::io {
namespace {

/// Files that people have and that are not read, and what helps.
struct Refused {
  std::string_view extension, reason;
};

constexpr Refused refused[] = {
    {".zip", "archives are not read; unpack it first (unzip)"},
    {".xz", "of compressed files only .gz is read; unpack it first (unxz -k)"},
    {".bz2", "of compressed files only .gz is read; unpack it first (bunzip2 -k)"},
    {".zst", "of compressed files only .gz is read; unpack it first (unzstd)"},
    {".laz", "LAZ, compressed LAS, is not read; convert it to .las with laszip, las2las or pdal translate"},
    {".e57", "E57 is not read; convert it to .ply, .las or .pts with CloudCompare or pdal translate"},
};

Geometry read_by_extension(const std::filesystem::path& path) {
  std::string extension = lower_extension(path);
  if (extension == ".gz") extension = lower_extension(path.stem());
  if (const Format* format = find_format(extension)) {
    if (format->read != nullptr) return format->read(load(path));
    if (!format->missing.empty())
      throw IoError("cannot read " + quoted_path(path) + ": this build has no " + format->missing + ", which reads " +
                    extension + " files; convert it to .ply or .xyz");
  }
  for (const auto& [name, reason] : refused)
    if (extension == name) throw IoError("cannot read " + quoted_path(path) + ": " + std::string(reason));
  throw IoError("cannot read " + quoted_path(path) + ": unknown file type " + in_quotes(extension) + "; known are " +
                list_of(extensions(Use::read)) + ", each also as .gz");
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
