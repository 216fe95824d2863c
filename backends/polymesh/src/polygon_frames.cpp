#include "polygon_frames.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "ahm/util/parallel.hpp"
#include "polygon.hpp"

namespace ahm::polymesh {
namespace {

using Eigen::Vector3d;

Vector3d position(const PolygonMesh& mesh, Index v) { return Vector3d(mesh.position(Vertex(v)).data()); }

/// A unit vector perpendicular to n.
Vector3d across(const Vector3d& n) { return n.unitOrthogonal(); }

/// The sum of the vector areas around a vertex, or where they cancel, the largest of them, or anything.
Vector3d vertex_normal(const PolygonMesh& mesh, const std::vector<Vector3d>& area, Index v) {
  Vector3d sum = Vector3d::Zero(), largest = Vector3d::Zero();
  for (Offset corner : mesh.corners_at(Vertex(v))) {
    const Vector3d& of_face = area[mesh.face_of(corner)];
    const Vector3d oriented = mesh.mirrored(corner) ? Vector3d(-of_face) : of_face;
    sum += oriented;
    if (oriented.squaredNorm() > largest.squaredNorm()) largest = oriented;
  }
  if (sum.norm() > 1e-9 * largest.norm()) return sum.normalized();
  return largest.norm() > 0 ? Vector3d(largest.normalized()) : Vector3d(0, 0, 1);
}

/// The rotation of smallest angle that takes one plane to the other, between their axes: the polar factor of
/// the projection. Where the normals are opposite, any rotation is as small as another.
std::complex<double> smallest_turn(const Axes& from, const Axes& to) {
  const std::complex<double> z{to.x.dot(from.x) + to.y.dot(from.y), to.y.dot(from.x) - to.x.dot(from.y)};
  const double size = std::abs(z);
  return size > 1e-12 ? z / size : 1.0;
}

}  // namespace

Axes axes_along(const Vector3d& normal, const Vector3d& direction) {
  Vector3d x = direction - normal.dot(direction) * normal;
  x = x.norm() > 1e-12 * direction.norm() ? Vector3d(x.normalized()) : across(normal);
  x = (x - normal.dot(x) * normal).normalized();  // twice is enough
  return {x, normal.cross(x), normal};
}

Frames find_frames(const PolygonMesh& mesh, unsigned threads) {
  const auto faces = static_cast<std::size_t>(mesh.face_count()), n = static_cast<std::size_t>(mesh.vertex_count());
  Frames frames;
  frames.vertex.resize(n);
  frames.face.resize(faces);
  frames.turn.resize(mesh.corners().size());
  std::vector<Vector3d> area(faces);
  detail::for_each_index(faces, threads, [&](std::size_t f) {
    const auto corners = mesh.face(static_cast<Index>(f));
    const Vector3d origin = position(mesh, corners[0]);
    area[f].setZero();
    for (std::size_t c = 1; c + 1 < corners.size(); ++c)
      area[f] += 0.5 * (position(mesh, corners[c]) - origin).cross(position(mesh, corners[c + 1]) - origin);
  });
  detail::for_each_index(n, threads, [&](std::size_t k) {
    const auto v = static_cast<Index>(k);
    const Offset corner = mesh.corners_at(Vertex(v)).front();
    const Index f = mesh.face_of(corner);
    const Offset next = corner + 1 == mesh.face_begin()[f + 1] ? mesh.face_begin()[f] : corner + 1;
    frames.vertex[k] =
        axes_along(vertex_normal(mesh, area, v), position(mesh, mesh.corners()[next]) - position(mesh, v));
  });
  detail::for_each_index(faces, threads, [&](std::size_t f) {
    const auto corners = mesh.face(static_cast<Index>(f));
    // A face without area lies in the tangent plane of its first corner.
    const double size = area[f].norm();
    const Vector3d normal = size > 0 ? Vector3d(area[f] / size) : frames.vertex[corners[0]].normal;
    frames.face[f] = axes_along(normal, position(mesh, corners[1]) - position(mesh, corners[0]));
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const auto corner = static_cast<std::size_t>(mesh.face_begin()[f]) + c;
      Axes plane = frames.face[f];
      if (mesh.mirrored(static_cast<Offset>(corner))) plane.y = -plane.y, plane.normal = -plane.normal;
      frames.turn[corner] = smallest_turn(frames.vertex[corners[c]], plane);
    }
  });
  return frames;
}

}  // namespace ahm::polymesh
