#include "commands/coverage_table.hpp"

#include <vector>

#include "ahm/io/write.hpp"

namespace ahm::app {

void write_coverage(const std::string& file, const std::string& format, const CoveragePath& path) {
  std::vector<Index> piece, line, between;
  std::vector<Vec3> position, normal, heading;
  std::vector<double> u, v, arclength, spacing;
  io::Table table{.title = "coverage path by libahm", .text = true};
  for (const CoveragePoint& p : path.points) {
    const auto row = static_cast<Index>(piece.size());
    if (row > 0 && p.piece == piece.back()) table.edges.push_back({row - 1, row});
    piece.push_back(p.piece), line.push_back(p.line), between.push_back(p.between);
    position.push_back(p.position), normal.push_back(p.normal), heading.push_back(p.heading);
    u.push_back(p.coordinates[0]), v.push_back(p.coordinates[1]);
    arclength.push_back(p.arclength), spacing.push_back(p.spacing);
  }
  table.add("piece", piece), table.add("line", line);
  table.add({"x", "y", "z"}, position);
  table.add({"nx", "ny", "nz"}, normal);
  table.add({"hx", "hy", "hz"}, heading);
  table.add("u", u), table.add("v", v);
  table.add("arclength", arclength), table.add("spacing", spacing);
  table.add("between", between);
  io::write(file, table, format);
}

}  // namespace ahm::app
