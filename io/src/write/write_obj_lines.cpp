#include <string>

#include "write/writers.hpp"

namespace ahm::io {

void write_obj_lines(const std::filesystem::path& path, std::span<const Vec3> points, std::span<const Index> begin) {
  std::string text = "# curve by libahm\n";
  for (const Vec3& p : points) {
    text += 'v';
    for (const double x : p) append_decimals(text += ' ', x);
    text += '\n';
  }
  for (std::size_t k = 0; k < begin.size(); ++k) {
    const Index end = k + 1 < begin.size() ? begin[k + 1] : static_cast<Index>(points.size());
    if (begin[k] == end) continue;
    text += 'l';
    for (Index i = begin[k]; i < end; ++i) text += ' ' + std::to_string(i + 1);
    text += '\n';
  }
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace ahm::io
