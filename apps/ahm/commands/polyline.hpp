/// \file
/// Curves over the faces of a mesh: what `ahm path` and `ahm trace` have in common.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ahm/surface/exact/exact_geodesics.hpp"
#include "input/open.hpp"

namespace ahm::app {

/// What a subcommand found, and what it tells.
struct Polyline {
  SurfacePoint from;
  std::vector<Vec3> points{};
  nlohmann::ordered_json json{};  ///< to programs, after the head of the summary
  std::string text{};             ///< to people
};
using FindPolyline = std::function<Polyline(const ExactGeodesics& geodesics, const Input& input)>;

/// Opens the input, finds the curve, and writes it: --output (.csv, .ply with edges, or .obj with a line), --view (the
/// curve on the exact map of its first point) and --json.
/// @param name    of the subcommand
/// @param source  --source, where the surface is opened for one
/// @throws InvalidArgument where the input has no faces; what opening, `find` and writing throw
void run_polyline(const std::string& name, const InputOptions& options, const OutputOptions& output,
                  const std::optional<SourceSpec>& source, const FindPolyline& find);

/// The point that the user means; of a position the nearest point of the faces.
/// @param option  that asked for it, for messages
/// @throws InvalidArgument
SurfacePoint point_on_faces(const Input& input, const SourceSpec& spec, const std::string& option);

std::vector<Vec3> positions_of(const ExactGeodesics& geodesics, const std::vector<exact::MeshPoint>& points);

}  // namespace ahm::app
