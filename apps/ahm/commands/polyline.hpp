/// \file
/// Curves over the faces of a mesh: what `ahm path` and `ahm trace` have in common.
#pragma once

#include <string>
#include <vector>

#include "ahm/surface/exact/exact_geodesics.hpp"
#include "input/open.hpp"

namespace ahm::app {

/// The endings of files that `write_polyline` writes.
std::vector<std::string> polyline_endings();

/// The faces of the input, laid out. @throws InvalidArgument where there are none
ExactGeodesics geodesics_of(const Input& input);

/// The point that the user means; of a position the nearest point of the faces.
/// @param option  that asked for it, for messages
/// @throws InvalidArgument
SurfacePoint point_on_faces(const Input& input, const SourceSpec& spec, const std::string& option);

/// x, y, z and the length up to each point: .csv, .ply with edges, or .obj with a line.
void write_polyline(const std::string& name, const std::vector<Vec3>& points);

/// Writes --view, where it was asked for: the curve on the exact map of its first point.
void write_polyline_view(const ExactGeodesics& geodesics, const Input& input, const InputOptions& options,
                         const OutputOptions& output, const SurfacePoint& from, const std::vector<Vec3>& points,
                         Journal& journal);

}  // namespace ahm::app
