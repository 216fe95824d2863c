#include "output/lines.hpp"

#include "ahm/io/formats.hpp"
#include "ahm/io/write.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::app {

Polylines polylines_of(const std::vector<Isoline>& lines) {
  Polylines result;
  result.numbered = true;
  for (const Isoline& line : lines) {
    std::vector<Vec3> points = line.points;
    if (line.closed) points.push_back(points.front());
    result.add(points);
    result.levels.push_back(line.level);
  }
  return result;
}

void write_polylines(const std::string& file, const std::string& format, const Polylines& curves) {
  if (format.empty() && io::lower_extension(file) == ".obj")
    return io::write_obj_lines(file, curves.points, curves.begin);
  std::vector<double> arclength, number, level;
  io::Table table{.title = "curve by libahm", .text = true};
  for (std::size_t k = 0; k < curves.begin.size(); ++k)
    for (Index i = curves.begin[k]; i < curves.end(k); ++i) {
      number.push_back(static_cast<double>(k));
      if (!curves.levels.empty()) level.push_back(curves.levels[k]);
      const bool first = i == curves.begin[k];
      arclength.push_back(first ? 0 : arclength.back() + distance(curves.points[i - 1], curves.points[i]));
      if (!first) table.edges.push_back({i - 1, i});
    }
  if (curves.numbered) table.add("curve", number);
  if (!level.empty()) table.add("level", level);
  table.add({"x", "y", "z"}, curves.points);
  table.add("arclength", arclength);
  io::write(file, table, format);
}

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
