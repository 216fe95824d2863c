/// \file
/// What the program needs of a backend. Each has a file of its own, input/NAME_backend.cpp, with a function
/// `NAME_backend`; the list of all is in apps/ahm/CMakeLists.txt.
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

/// A surface, and what was found and done on the way to it, in the program as in the library.
struct Built {
  std::unique_ptr<const Surface> surface;
  Report report;
  std::vector<Warning> warnings;

  explicit Built(std::unique_ptr<const Surface> built)
      : surface(std::move(built)), report(surface->report()), warnings(surface->warnings()) {}
};

/// A way to make a surface of an input.
struct Backend {
  std::string_view name;
  bool (*suits)(const io::Geometry&);  ///< `auto` takes the first that does
  BuildCost cost;
  /// @param source  that the surface is opened for, if there is one: filters of clouds keep it
  /// @throws what the backend throws
  Built (*build)(const io::Geometry& input, const InputOptions& options, const std::optional<SourceSpec>& source,
                 const Progress& progress);
  /// How many vertices of its own the graph will have beside those of the input; null: none.
  std::size_t (*more_vertices)(const io::Geometry& input, const InputOptions& options) = nullptr;
  bool uses_faces = true;  ///< or points alone
};

/// All of them, in the order in which `auto` asks them.
std::span<const Backend> backends();

/// The user's choice, or for `auto` the backend that suits the input; of triangles, too, the one for polygons where they are to be
/// solved as polygons.
const Backend& choose_backend(const io::Geometry& input, const InputOptions& options);

}  // namespace ahm::app
