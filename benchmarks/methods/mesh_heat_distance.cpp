// HM on the faces of a triangle mesh: Algorithm 1 of [CWW13] with its Sec. 3.2.1.
#include <array>
#include <cmath>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"
#include "methods/heat_fields.hpp"
#include "methods/method.hpp"
#include "methods/sparse_cholesky.hpp"

namespace ahm::methods {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// A face in the plane, in graph units.
struct Face {
  Triangle vertices;
  double area;
  std::array<Eigen::Vector2d, 3> gradients;  ///< gradients of the three hat functions
};

Face lay_out(const trimesh::TriangleMesh& mesh, Index f) {
  const auto sides = mesh.layout(f);
  Face face;
  face.area = 0.5 * (sides[0][0] * sides[1][1] - sides[0][1] * sides[1][0]);
  if (!(face.area > 0))
    throw InvalidGeometry("face " + std::to_string(f) + ": area " + detail::number(face.area) +
                          " must be positive; use the graph of the intrinsic Delaunay triangulation");
  for (int k = 0; k < 3; ++k) {
    face.vertices[k] = mesh.tails()[3 * f + k];
    const auto& opposite = sides[(k + 1) % 3];
    face.gradients[k] = Eigen::Vector2d(-opposite[1], opposite[0]) / (2 * face.area);
  }
  return face;
}

double mean_edge_length(const trimesh::TriangleMesh& mesh) {
  double sum = 0;
  Index count = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto sides = mesh.layout(f);
    for (int s = 0; s < 3; ++s)
      if (const trimesh::Half h = 3 * f + s, twin = mesh.twins()[h]; twin < h) {
        sum += std::hypot(sides[s][0], sides[s][1]);
        ++count;
      }
  }
  return sum / count;
}

/// M + t L over all faces, with the cotan Laplacian L and lumped masses M.
Sparse heat_operator(const std::vector<Face>& faces, Index n, double mass, double t) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(9 * faces.size());
  for (const Face& face : faces)
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        entries.emplace_back(
            face.vertices[a], face.vertices[b],
            t * face.area * face.gradients[a].dot(face.gradients[b]) + (a == b ? mass * face.area / 3 : 0.0));
  Sparse A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

/// L with a small mass, which makes it definite in every component. The divergence of a field sums to zero, so distances
/// change by at most 1e-12 (diameter / h)^2 of their size.
Sparse poisson_operator(const std::vector<Face>& faces, Index n, double h) {
  return heat_operator(faces, n, 1e-12 / (h * h), 1.0);
}

class MeshHeatDistance final : public Baseline {
 public:
  MeshHeatDistance(const trimesh::TriangleMesh& mesh, double t_coef)
      : faces_(lay_out_all(mesh)),
        n_(mesh.vertex_count()),
        length_unit_(mesh.length_unit()),
        h_(mean_edge_length(mesh)),
        heat_(heat_operator(faces_, n_, 1.0, t_coef * h_ * h_), "the heat operator of the mesh"),
        laplacian_(poisson_operator(faces_, n_, h_), "the mesh's Laplacian") {}

  std::string_view name() const noexcept override { return "HM"; }

  Result solve(Index source) const override {
    check_source(source, n_);
    // I. Heat.
    Eigen::VectorXd u = Eigen::VectorXd::Zero(n_);
    u[source] = source_heat;
    u = heat_.solve(u);
    // II. X = -grad u / |grad u| per face, and its integrated divergence.
    Eigen::VectorXd divergence = Eigen::VectorXd::Zero(n_);
    for (const Face& face : faces_) {
      Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
      for (int k = 0; k < 3; ++k) gradient += u[face.vertices[k]] * face.gradients[k];
      const double length = gradient.stableNorm();
      if (!(length > 0)) continue;
      for (int k = 0; k < 3; ++k) divergence[face.vertices[k]] -= face.area * face.gradients[k].dot(gradient / length);
    }
    // III. Laplacian phi = div X.
    const Eigen::VectorXd phi = laplacian_.solve(divergence);
    return {{}, distances_from({phi.begin(), phi.end()}, source, length_unit_, [&](std::size_t i) {
              return u[static_cast<Eigen::Index>(i)] >= least_heat;
            })};
  }

 private:
  static std::vector<Face> lay_out_all(const trimesh::TriangleMesh& mesh) {
    std::vector<Face> faces;
    faces.reserve(static_cast<std::size_t>(mesh.face_count()));
    for (Index f = 0; f < mesh.face_count(); ++f) faces.push_back(lay_out(mesh, f));
    return faces;
  }

  std::vector<Face> faces_;
  Index n_;
  double length_unit_, h_;
  SparseCholesky heat_, laplacian_;
};

}  // namespace

Method heat_distance(const trimesh::TriangleMesh& mesh, double t_coef) {
  if (!(t_coef > 0) || !std::isfinite(t_coef))
    throw InvalidArgument("'t_coef' " + detail::number(t_coef) + " must be positive and finite");
  return std::make_unique<MeshHeatDistance>(mesh, t_coef);
}

}  // namespace ahm::methods
