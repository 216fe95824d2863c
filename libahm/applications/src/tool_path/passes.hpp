/// \file
/// The passes of a tool path, as curves on the fine mesh. Lengths are in spacings.
#pragma once

#include <span>
#include <vector>

#include "ahm/applications/tool_path.hpp"
#include "tool_path/front.hpp"

namespace ahm {

/// A pass before it has poses.
struct PassCurve {
  MeshCurve curve;
  PassOrigin origin = PassOrigin::level;
  double distance = 0;  ///< from the seed; on cut loci, boundaries and spirals the mean
};

/// Shorter passes are left out.
inline constexpr double shortest_pass = 0.5;
/// Pieces of curves that one source of an exact map represents. At distance d from a straight curve the error is at most
/// step^2 / (8 d): for seeds 0.002 at the first level, for passes 0.013 at the largest gap.
inline constexpr double seed_step = 0.125, pass_step = 0.25;

/// The point at the share t from the first to the second of two points of a face.
exact::MeshPoint between(const exact::MeshPoint& a, const exact::MeshPoint& b, double t);

/// Points on a curve at most `step` apart, including its corners.
std::vector<exact::MeshPoint> samples(const FaceMesh& mesh, const MeshCurve& curve, double step);
double curve_length(const FaceMesh& mesh, const MeshCurve& curve);

/// Appends a path to a curve, without its last point. A path of length zero has no segments.
void append_path(const FaceMesh& mesh, const exact::GeodesicPath& path, MeshCurve& curve);

/// A curve through points of one component in their order, joined by locally shortest paths.
MeshCurve joined_curve(const PathDomain& domain, std::span<const exact::MeshPoint> points, bool closed);

/// The level curves at the distances first, first + 1, ... Closed ones that follow each other are joined to spirals.
/// @param distances  one per point; NaN: not reached
/// @param farthest   largest distance
std::vector<PassCurve> spiral_levels(const FaceMesh& mesh, std::span<const double> distances, double first,
                                     double farthest);

/// All passes around seed curves.
/// @param phase   distance of the first pass from the seed: 0 or 0.5
/// @param spiral  joins passes to spirals
std::vector<PassCurve> make_passes(const FineDomain& domain, const std::vector<MeshCurve>& seeds, double phase,
                                   bool spiral, const Progress& progress);

}  // namespace ahm
