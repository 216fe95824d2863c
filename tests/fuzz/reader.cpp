// Readers of files, on arbitrary bytes.
#include <string>

#include "bytes.hpp"
#include "formats/format.hpp"
#include "read/gunzip.hpp"

namespace ahm::fuzz {
namespace {

void check(const io::Geometry& g) {
  const std::size_t n = g.points.size();
  require(g.normals.empty() || g.normals.size() == n, "one normal per point");
  require(g.colors.empty() || g.colors.size() == n, "one color per point");
  for (const io::Property& property : g.properties) require(property.values.size() == n, "one value per point");
  for (std::size_t f = 0; f < g.face_count(); ++f) (void)g.face(f).size();
  if (!g.face_begin.empty())
    require(static_cast<std::size_t>(g.face_begin.back()) == g.face_vertices.size(), "faces contain all corners");
}

}  // namespace
}  // namespace ahm::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ahm;
  if (size == 0) return 0;
  static const io::Format& format = *io::find_format(AHM_FUZZED_EXTENSION);
  return fuzz::allow_refusals([&] {
    io::Input in{"/nowhere/file" AHM_FUZZED_EXTENSION, std::string(reinterpret_cast<const char*>(data), size)};
    if (io::is_gzip(in)) io::gunzip(in);
    fuzz::check(format.read(in));
  });
}
