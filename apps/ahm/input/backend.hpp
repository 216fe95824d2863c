/// \file
/// The program's interface of a backend. Each backend is a file input/NAME_backend.cpp with a function `NAME_backend`;
/// apps/ahm/CMakeLists.txt lists them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/io/geometry.hpp"
#include "ahm/progress.hpp"
#include "ahm/report.hpp"
#include "ahm/surface/surface.hpp"
#include "cli/options.hpp"

namespace ahm::app {

/// A surface, and the report and warnings of its construction, by the program and the library.
struct BuiltSurface {
  std::unique_ptr<const Surface> surface;
  Report report;
  std::vector<Warning> warnings;

  explicit BuiltSurface(std::unique_ptr<const Surface> built)
      : surface(std::move(built)), report(surface->report()), warnings(surface->warnings()) {}
};

/// Builds surfaces from inputs.
struct Backend {
  std::string_view name;
  bool (*suits)(const io::Geometry&);  ///< whether the backend suits an input; `auto` uses the first that does
  BuildCost cost;
  /// @param source  source of the single map, if there is one: filters of clouds keep its point
  /// @throws what the backend throws
  BuiltSurface (*build)(const io::Geometry& input, const InputOptions& options, const std::optional<SourceSpec>& source,
                        const Progress& progress);
  /// Number of vertices that the graph will have in addition to those of the input; null: none.
  std::size_t (*more_vertices)(const io::Geometry& input, const InputOptions& options) = nullptr;
  bool uses_faces = true;  ///< false: only the points
};

/// All backends, in the order in which `auto` tries them.
std::span<const Backend> backends();

/// The backend that the user chose, or for `auto` the first that suits the input. With --discretization polygons `auto` uses the
/// backend of polygon meshes for triangles, too.
const Backend& choose_backend(const io::Geometry& input, const InputOptions& options);

}  // namespace ahm::app
