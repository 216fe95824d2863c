#include "ahm/io/read.hpp"

#include <new>

#include "ahm/io/formats.hpp"
#include "ahm/util/text.hpp"
#include "formats/format.hpp"

namespace ahm::io {
namespace {

/// Common file types that are not supported, and what to do instead.
struct Refused {
  std::string_view extension, reason;
};

constexpr Refused refused[] = {
    {".zip", "archives are not supported; unpack it first (unzip)"},
    {".xz", "only .gz compression is supported; unpack it first (unxz -k)"},
    {".bz2", "only .gz compression is supported; unpack it first (bunzip2 -k)"},
    {".zst", "only .gz compression is supported; unpack it first (unzstd)"},
    {".vtp", "this build has no pugixml, which reads .vtp files; save it as .vtk or .ply in ParaView"},
    {".vtu", "of VTK's formats, only .vtp and .vtk are supported; save its surface as .vtp in ParaView"},
    {".pvtp", "files in several parts are not supported; save it as .vtp in ParaView"},
    {".vtm", "files in several parts are not supported; save its surface as .vtp in ParaView"},
    {".jsonl", "JSON lines can be written, but not read; use .csv"},
    {".laz", "LAZ (compressed LAS) is not supported; convert it with 'pdal translate FILE.laz FILE.las' or laszip"},
    {".e57", "E57 is not supported; convert it with 'pdal translate FILE.e57 FILE.las' or CloudCompare"},
};

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw IoError("cannot read " + quoted_path(path) + ": " + what);
}

/// The format of an extension. @throws IoError if this build cannot read it
const Format& format_to_read(const std::filesystem::path& path, const std::string& extension) {
  std::error_code none;
  if (std::filesystem::is_directory(path, none)) fail(path, "it is a folder, not a file");
  if (const Format* format = find_format(extension)) {
    if (format->read != nullptr) return *format;
    if (!format->missing.empty())
      fail(path, "this build has no " + format->missing + ", which reads " + extension +
                     " files; convert it to .ply or .xyz");
  }
  for (const auto& [name, reason] : refused)
    if (extension == name) fail(path, std::string(reason));
  throw IoError("unknown_type",
                "cannot read " + quoted_path(path) + ": unknown file type " + in_quotes(extension) +
                    "; known types are " + list_of(extensions(Use::read)) + ", each also as .gz",
                "rename it, or specify its format");
}

/// The extension of the file name; for compressed files, the extension before .gz.
std::string extension_of(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".gz" ? lower_extension(path.stem()) : extension;
}

Geometry read_by_extension(const std::filesystem::path& path, std::string extension) {
  if (extension.empty() || extension == ".gz") extension = extension_of(path);
  return format_to_read(path, extension).read(load(path));
}

/// Reads input without a name. The format follows from `extension`, or if that is empty, from the first bytes.
Geometry read_unnamed(const Input& in, std::string extension) {
  if (extension.empty()) {
    const Format* format = recognized_format(in.bytes);
    if (format == nullptr)
      throw IoError("unknown_bytes", "cannot read '-': its first bytes match no file type", "specify its extension");
    extension = format->extensions.front();
  }
  return format_to_read(in.path, extension).read(in);
}

/// Checks that the vertices of all faces exist, in any format.
void check_faces(const std::filesystem::path& path, const Geometry& g) {
  for (std::size_t f = 0; f < g.face_count(); ++f) {
    for (const Index vertex : g.face(f)) {
      if (vertex >= 0 && static_cast<std::size_t>(vertex) < g.points.size()) continue;
      throw IoError("cannot read " + quoted_path(path) + ": face " + std::to_string(f) + " has vertex number " +
                    std::to_string(vertex) + ", but there are " + detail::counted(g.points.size(), "vertex") +
                    ", counted from 0");
    }
  }
}

template <class Read>
Geometry checked(const std::filesystem::path& path, const Read& read) {
  try {
    Geometry g = read();
    check_faces(path, g);
    return g;
  } catch (const std::bad_alloc&) {
    throw ResourceExhausted("not enough memory to read " + quoted_path(path));
  }
}

}  // namespace

Geometry read(const std::filesystem::path& path, const std::string& extension) {
  return checked(path, [&] { return read_by_extension(path, extension); });
}

Geometry read(std::istream& stream, const std::string& extension) {
  return checked("-", [&] { return read_unnamed(load(stream), extension); });
}

Geometry read_standard_input(const std::string& extension) {
  return checked("-", [&] { return read_unnamed(load_standard_input(), extension); });
}

std::vector<std::filesystem::path> files_beside(const std::filesystem::path& path) try {
  const Format* const format = find_format(extension_of(path));
  return format != nullptr && format->files_beside != nullptr ? format->files_beside(load(path))
                                                              : std::vector<std::filesystem::path>();
} catch (const Error&) {
  return {};
}

}  // namespace ahm::io
