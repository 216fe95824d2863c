/// \file
/// Edges of the graph: unfolding from one tangent plane to another, and the transports R of the connection Laplacian, whose
/// weights are those of `tufted_laplacian`. Creases keep their length, and noise across
/// the surface adds none.
#pragma once

#include <optional>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "tangent_planes.hpp"
#include "tufted_cover.hpp"

namespace ahm::pointcloud {

/// The plane halfway between the planes at the two ends of an edge, whatever the signs of their normals. Relative to this plane
/// a bend of the surface is symmetric, so an offset across it is noise, or another sheet.
struct MeanPlane {
  MeanPlane(const Vec3& from, const Vec3& to);
  Vec3 normal;    ///< unit length, on the side of the first end's normal
  Vec3 across;    ///< in the plane, across the crease; its length is the sine of half the angle between the two planes
  double cosine;  ///< cosine of half that angle, at least sqrt(1/2)
};

/// Position of the head of an edge in the tangent plane of its tail, as a vector of space. Unfolds the part of the edge in the
/// mean plane like two planes that meet in a crease halfway. Of the offset across the mean plane, only the part beyond noise
/// adds to the length. The reversed edge gives the negative vector, rotated by the transport between the planes.
/// @param tail, head  unit normals at the ends
Vec3 unfolded_edge(const Vec3& tail, const Vec3& head, const Vec3& edge, double noise);

/// Whether an edge leaves the surface: it rises steeply over the mean plane, far beyond noise.
bool leaves_surface(const Vec3& tail, const Vec3& head, const Vec3& edge, double noise);

/// Builds the graph from oriented normals and weighted edges. Its vertices are the points that a triangle touches. Where
/// `consistent_signs` is 0, an edge between opposed normals is a reflection; elsewhere it is a rotation by more than 90 degrees.
/// @param vertex_of_clean  vertex of each clean point, -1: none
/// @param noise            standard deviation of offsets across the surface, in units of the clean points
/// @param kind             storage of the transports; none: blocks if there is a reflection
CsrGraphData tangent_edges(const CleanPoints& cloud, const TangentPlanes& planes, const WeightedEdges& edges,
                           const std::vector<Index>& vertex_of_clean, Index vertices, const PerPart& consistent_signs,
                           const PerPart& noise, unsigned threads, CloudDetails& report,
                           std::optional<TransportKind> kind = {});

}  // namespace ahm::pointcloud
