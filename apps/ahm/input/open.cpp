#include "input/open.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ahm/error.hpp"
#include "ahm/heat/heat_operators.hpp"
#include "ahm/io/read.hpp"
#include "ahm/surface/directions.hpp"
#include "cli/source_list.hpp"
#include "output/wording.hpp"

namespace ahm::app {
namespace {

void comment_on_blas(Journal& journal) {
  const LinearAlgebraInfo info = linear_algebra_info();
  if (!info.blas_optimized)
    journal.add_warning("CHOLMOD runs on a BLAS that is not optimized (" + info.blas +
                        "): several times slower; on Debian install libopenblas0-pthread");
}

io::Geometry read_input(const std::string& path, Journal& journal) {
  journal.start("read");
  io::Geometry input = io::read(path);
  journal.add_warnings(input.warnings);
  if (input.points.empty()) throw InvalidGeometry(path + ": holds no points");
  return input;
}

}  // namespace

Input open_input(const InputOptions& options, Journal& journal, const std::optional<SourceSpec>& source) {
  comment_on_blas(journal);
  io::Geometry geometry = read_input(options.path, journal);
  journal.start("graph");
  const Backend& backend = choose_backend(geometry, options.backend);
  Built built = backend.build(geometry, options, source, journal.progress());
  journal.add_warnings(built.warnings);
  return {std::move(geometry), &backend, std::move(built)};
}

SurfacePoint point_of(const Surface& surface, const SourceSpec& spec) {
  if (const auto* face = std::get_if<SourceFace>(&spec)) return FacePoint{face->face, face->weights};
  if (const auto* position = std::get_if<SourcePosition>(&spec)) return surface.nearest_row(position->position);
  return Row(std::get<SourceVertex>(spec).index);
}

PlacedSource place(const Surface& surface, const SourceSpec& spec, const std::optional<Vec3>& u_axis,
                   const std::string& option) try {
  return surface.source(point_of(surface, spec), u_axis);
} catch (const InvalidArgument& e) {
  if (u_axis && e.fault() == "axis_along_normal")
    throw InvalidArgument(fmt::format("--u-axis {},{},{}: is perpendicular to the surface at the source {}",
                                      (*u_axis)[0], (*u_axis)[1], (*u_axis)[2], to_string(spec)));
  throw InvalidArgument(fmt::format("{} {}: {}", option, to_string(spec), worded(e)));
}

PlacedSource resolve(const SourceOptions& options, const Input& input, unsigned threads) {
  const std::optional<UAxis>& axis = options.u_axis;
  PlacedSource source =
      place(input.surface(), options.spec, axis && !axis->curvature ? std::optional(axis->direction) : std::nullopt);
  if (!axis || !axis->curvature) return source;
  // In a face: at the corner that has most of the source.
  const auto weights = source.source.weights();
  const auto most = std::max_element(weights.begin(), weights.end()) - weights.begin();
  Vec3 direction;
  try {
    direction = bending_direction(input.graph(), source.source.vertices()[most], threads);
  } catch (const InvalidArgument& e) {
    throw InvalidArgument(fmt::format("--u-axis curvature: {}", worded(e)));
  }
  return place(input.surface(), options.spec, direction);
}

Vertex vertex_at(const Input& input, const SourceSpec& spec, const std::string& option) {
  position_in(input.geometry, spec, option);
  if (std::holds_alternative<SourceFace>(spec))
    throw InvalidArgument(fmt::format("{} {}: must be a vertex; write its number or x,y,z", option, to_string(spec)));
  return place(input.surface(), spec, std::nullopt, option).source.vertices().front();
}

std::vector<Vertex> vertices_at(const Input& input, const std::vector<SourceSpec>& specs, const std::string& option) {
  std::vector<Vertex> result;
  for (const SourceSpec& spec : specs) result.push_back(vertex_at(input, spec, option));
  return result;
}

}  // namespace ahm::app
