#include "input/open.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ahm/error.hpp"
#include "ahm/heat/heat_operators.hpp"
#include "ahm/io/read.hpp"
#include "ahm/surface/directions.hpp"
#include "cli/source_list.hpp"

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
  Input input{read_input(options.path, journal), nullptr, nullptr};
  journal.start("graph");
  input.backend = &choose_backend(input.geometry, options.backend);
  input.surface = input.backend->build(input.geometry, options, source, journal.progress());
  journal.add_warnings(input.surface->warnings());
  return input;
}

ResolvedSource resolve(const Model& model, const SourceSpec& spec, const std::optional<Vec3>& u_axis,
                       const std::string& option) try {
  return model.source(spec, u_axis);
} catch (const InvalidArgument& e) {
  std::string message = e.what();
  const std::string own = "--source";
  if (message.starts_with(own)) message.replace(0, own.size(), option);
  throw InvalidArgument(message);
}

ResolvedSource resolve(const SourceOptions& options, const Input& input) {
  const Model& model = *input.surface;
  const std::optional<UAxis>& axis = options.u_axis;
  if (!axis || !axis->curvature)
    return model.source(options.spec, axis ? std::optional(axis->direction) : std::nullopt);
  const Source plain = model.source(options.spec, std::nullopt).source;
  // In a face: at the corner that has most of the source.
  const auto most = std::max_element(plain.weights().begin(), plain.weights().end()) - plain.weights().begin();
  try {
    return model.source(options.spec, bending_direction(model.graph(), plain.vertices()[most]));
  } catch (const InvalidArgument& e) {
    if (e.fault() != "no_bending_direction") throw;
    throw InvalidArgument(fmt::format("--u-axis curvature: {}; give the axis as X,Y,Z", e.problem()));
  }
}

Vertex vertex_at(const Input& input, const SourceSpec& spec, const std::string& option) {
  position_in(input.geometry, spec, option);
  if (std::holds_alternative<SourceFace>(spec))
    throw InvalidArgument(fmt::format("{} {}: must be a vertex; write its number or x,y,z", option, to_string(spec)));
  return resolve(*input.surface, spec, std::nullopt, option).source.vertices().front();
}

std::vector<Vertex> vertices_at(const Input& input, const std::vector<SourceSpec>& specs, const std::string& option) {
  std::vector<Vertex> result;
  for (const SourceSpec& spec : specs) result.push_back(vertex_at(input, spec, option));
  return result;
}

}  // namespace ahm::app
