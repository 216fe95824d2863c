/// \file
/// What the program needs of a backend. A new backend is one more source file with a `build_...` function and one line
/// in the table of backends.cpp.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/io/geometry.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/maps/source.hpp"
#include "ahm/progress.hpp"
#include "ahm/surface/surface.hpp"
#include "cli/options.hpp"

namespace ahm::app {

/// Where the map starts.
struct ResolvedSource {
  Source source;
  std::optional<Index> row;  ///< the input vertex, when it is one
  Vec3 position{};
  std::optional<Frame> frame;  ///< u axis, v axis and normal in space
};

/// A vertex of the graph that stands for a row of the input. A row may have several (where a mesh was cut) or none.
struct RowVertex {
  Index row, vertex;
};

/// The input as a tangent graph, and the way from the user's terms to the graph's and back.
class Model {
 public:
  virtual ~Model() = default;

  virtual const TangentGraph& graph() const = 0;
  virtual const Surface& surface() const = 0;
  /// @throws InvalidArgument, in the user's terms: row numbers are those of the input
  virtual ResolvedSource source(const SourceSpec& spec, const std::optional<Vec3>& u_axis) const = 0;
  virtual std::vector<RowVertex> row_vertices() const = 0;
  /// The vertex at every corner of the input's faces, face after face, all oriented alike where that is possible; empty
  /// for clouds.
  virtual std::vector<Index> corner_vertices() const { return {}; }
  /// Unit normal per input row, NaN where there is none.
  virtual std::vector<Vec3> normals() const = 0;
  /// What was found and done on the way, under the backend's own keys.
  virtual nlohmann::ordered_json report() const = 0;
  virtual std::vector<std::string> warnings() const = 0;
};

/// A way to make a surface of an input.
struct Backend {
  std::string_view name;
  bool has_faces;                      ///< maps the faces of the input, not its points alone
  bool (*suits)(const io::Geometry&);  ///< `auto` takes the first of the table that does
  double bytes, seconds;               ///< of reading the input and building the graph, per point
  /// @param source  that the surface is opened for, if there is one: filters of clouds keep it
  /// @throws what the backend throws
  std::unique_ptr<Model> (*build)(const io::Geometry& input, const InputOptions& options,
                                  const std::optional<SourceSpec>& source, const Progress& progress);
};

/// Names of the table, in its order.
std::vector<std::string> backend_names();

/// The user's choice, or for `auto` the backend that suits the input.
const Backend& choose_backend(const io::Geometry& input, const std::string& requested);

std::unique_ptr<Model> build_trimesh(const io::Geometry&, const InputOptions&, const std::optional<SourceSpec>&,
                                     const Progress&);
std::unique_ptr<Model> build_polymesh(const io::Geometry&, const InputOptions&, const std::optional<SourceSpec>&,
                                      const Progress&);
std::unique_ptr<Model> build_pointcloud(const io::Geometry&, const InputOptions&, const std::optional<SourceSpec>&,
                                        const Progress&);

}  // namespace ahm::app
