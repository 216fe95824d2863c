/// \file
/// Parts of tool paths that construction and measures share. Lengths are in spacings.
#pragma once

#include <vector>

#include "ahm/applications/tool_path.hpp"
#include "tool_path/passes.hpp"

namespace ahm {

/// The faces of a surface, positions divided by the spacing.
FaceMesh whole_mesh(const Surface& surface, double spacing);

/// The region of a surface with sides of at most `longest_window_side`.
/// @param mesh  `whole_mesh` of the surface
/// @throws InvalidArgument (as `tool_path`)
FaceMesh region_mesh(const Surface& surface, FaceMesh mesh, const ToolPathRegion& region, double spacing);

/// The curves from which the passes start, on the mesh.
/// @throws InvalidArgument (as `tool_path`)
std::vector<MeshCurve> seed_curves(const Surface& surface, const PathDomain& domain, const ToolPathOptions& options);

/// The part of a mesh that a closed curve encloses: all parts into which it divides its component, except for the largest.
/// @param outside  the largest part and the other components instead
/// @throws InvalidArgument (fault "region_not_enclosed": the curve does not divide its component)
FaceMesh enclosed_part(const PathDomain& domain, const MeshCurve& curve, bool outside);

/// Puts passes in an order, joins them and computes the poses, in world units.
/// @param whole  `whole_mesh` of the surface, which the tool must not cut
void add_poses(const FaceMesh& whole, const PathDomain& domain, std::vector<PassCurve> passes,
               const ToolPathOptions& options, ToolPath& path);

}  // namespace ahm
