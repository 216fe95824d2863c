/// \file
/// An edge between two tangent planes, unfolded into one: corners keep their length, noise across the surface does not
/// count.
#pragma once

#include <optional>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "tangent_planes.hpp"
#include "tufted_cover.hpp"

namespace ahm::pointcloud {

/// The plane half way between those of the two ends of an edge, the signs of their normals aside. Seen from there a bend of
/// the surface is symmetric: what lies across this plane is noise, or another sheet.
struct MeanPlane {
  MeanPlane(const Vec3& from, const Vec3& to);
  Vec3 normal;    ///< unit length, on the side of that of the first end
  Vec3 across;    ///< in the plane, across the crease; its length is the sine of half the angle between the two planes
  double cosine;  ///< of half that angle, at least the root of one half
};

/// Where the head of an edge lies in the tangent plane of its tail, in space. The part of the edge in the mean plane is unfolded
/// as two planes that meet in a crease half way; of its offset across the mean plane only what noise cannot explain adds
/// to the length. Reversing an edge turns the result by the transport between the planes, and reverses it.
/// @param tail, head  unit normals
Vec3 unfolded_edge(const Vec3& tail, const Vec3& head, const Vec3& edge, double noise);

/// Whether an edge leaves the surface: it rises steeply over the mean plane, and far beyond noise.
bool leaves_surface(const Vec3& tail, const Vec3& head, const Vec3& edge, double noise);

/// Fills the graph from oriented normals and weighted edges: vertices are the points that a triangle touches.
/// Where `trusted` is 0, an edge between opposed normals is a reflection; else it is a rotation by more than 90
/// degrees.
/// @param noise  of offsets across the surface, units of the clean points
/// @param kind  how transports are stored; none: as blocks where there is a reflection
/// @param vertex_of_clean  number of each clean point among the vertices, -1: none
CsrGraphData tangent_edges(const CleanPoints& cloud, const TangentPlanes& planes, const WeightedEdges& edges,
                           const std::vector<Index>& vertex_of_clean, Index vertices, const PerPart& trusted,
                           const PerPart& noise, unsigned threads, CloudDetails& report,
                           std::optional<TransportKind> kind = {});

}  // namespace ahm::pointcloud
