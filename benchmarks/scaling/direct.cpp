// The paper's systems solved by LU, as in public implementations, compared with the elimination. The 3n x 3n operator is
// not symmetric; that of the adaptive variant depends on the source.
#include <dlfcn.h>
#include <fmt/format.h>

#include <Eigen/CholmodSupport>
#include <Eigen/Sparse>
#include <Eigen/UmfPackSupport>
#include <complex>
#include <optional>
#include <stdexcept>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "scaling/sizes.hpp"
#include "shapes.hpp"
#include "speed.hpp"

namespace ahm::bench {
namespace {

using Complex = std::complex<double>;
using Scalars = Eigen::SparseMatrix<double>;
using Rotations = Eigen::SparseMatrix<Complex>;

/// UMFPACK's factors, which need their matrix in every solve.
struct Lu {
  Scalars matrix;
  Eigen::UmfPackLU<Scalars> factors;
};

/// The factors that a direct implementation of the paper's equations would keep: frames by Cholesky, the 3n x 3n operator
/// by LU.
class DirectSolver {
 public:
  /// @param graph  with rotations, d = 2; must outlive the solver
  explicit DirectSolver(const CsrGraph& graph)
      : graph_(graph), n_(graph.size()), tau_(square(graph.mean_edge_length())) {
    std::vector<Eigen::Triplet<Complex>> entries;
    for_each_edge([&](Index i, Index j, double weight, Complex turn, Complex) {
      entries.emplace_back(i, j, -tau_ * weight * turn);
    });
    for (Index i = 0; i < n_; ++i) entries.emplace_back(i, i, diagonal(i));
    Rotations B(n_, n_);
    B.setFromTriplets(entries.begin(), entries.end());
    frames_.compute(B);
    check(frames_.info());
  }

  /// phi from a vertex, in units of the graph.
  std::vector<Complex> solve(Index source, Variant variant) {
    Eigen::VectorXcd U = Eigen::VectorXcd::Zero(n_);
    U[source] = 1;
    U = frames_.solve(U).eval();
    for (Index i = 0; i < n_; ++i) U[i] /= std::abs(U[i]);
    if (variant == Variant::adaptive) {
      affine_.emplace();
      factor(*affine_, variant, U);
    } else if (!radial_) {
      radial_.emplace();
      factor(*radial_, variant, U);
    }
    Eigen::VectorXd b = Eigen::VectorXd::Zero(3 * n_);
    b[3 * source + 2] = 1;
    Lu& lu = variant == Variant::adaptive ? *affine_ : *radial_;
    const Eigen::VectorXd x = lu.factors.solve(b);
    check(lu.factors.info());
    std::vector<Complex> phi;
    for (Index i = 0; i < n_; ++i) {
      const Complex z(x[3 * i] / x[3 * i + 2], x[3 * i + 1] / x[3 * i + 2]);
      phi.push_back(variant == Variant::adaptive ? z : z * std::conj(U[i]));
    }
    return phi;
  }

 private:
  static double square(double x) { return x * x; }
  static void check(Eigen::ComputationInfo info) {
    if (info != Eigen::Success) throw std::runtime_error("a direct factorization failed");
  }

  /// Calls work(i, j, weight, transport from j to i, logarithm of j) for every directed edge.
  template <class Work>
  void for_each_edge(const Work& work) const {
    for (Index i = 0; i < n_; ++i) {
      const Star star = graph_.star(i);
      for (std::size_t e = 0; e < star.degree(); ++e)
        work(i, star.neighbors[e], star.weights[e], Complex(star.transports[2 * e], star.transports[2 * e + 1]),
             Complex(star.logs[2 * e], star.logs[2 * e + 1]));
    }
  }

  double diagonal(Index i) const {
    double sum = graph_.mass(i);
    for (const double weight : graph_.star(i).weights) sum += tau_ * weight;
    return sum;
  }

  /// M + tau L over (z, 1) [SS25, Eq. 10 and 16].
  void factor(Lu& lu, Variant variant, const Eigen::VectorXcd& U) const {
    std::vector<Eigen::Triplet<double>> entries;
    for_each_edge([&](Index i, Index j, double weight, Complex turn, Complex log) {
      const double amount = -tau_ * weight;
      const Complex R = variant == Variant::adaptive ? 1 : turn,
                    t = variant == Variant::adaptive ? -std::conj(U[i]) * log : -log;
      const double block[3][3] = {{R.real(), -R.imag(), t.real()}, {R.imag(), R.real(), t.imag()}, {0, 0, 1}};
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          if (block[a][b] != 0) entries.emplace_back(3 * i + a, 3 * j + b, amount * block[a][b]);
    });
    for (Index i = 0; i < n_; ++i)
      for (int a = 0; a < 3; ++a) entries.emplace_back(3 * i + a, 3 * i + a, diagonal(i));
    lu.matrix.resize(3 * n_, 3 * n_);
    lu.matrix.setFromTriplets(entries.begin(), entries.end());
    lu.factors.compute(lu.matrix);
    check(lu.factors.info());
  }

  const CsrGraph& graph_;
  Index n_;
  double tau_;
  Eigen::CholmodSupernodalLLT<Rotations> frames_;
  std::optional<Lu> affine_, radial_;
};

/// CPU seconds of the first map and of an additional one, and peak memory up to the first, MB.
template <class Make, class Solve>
std::vector<double> timed(const Make& make, const Solve& solve) {
  const double first = cpu_seconds_of([&] {
    make();
    solve();
  });
  const double peak = peak_megabytes();
  return {first, cpu_seconds_of(solve), peak};
}

auto icosphere_surface(Index n) {
  const Mesh mesh = split_icosphere(n);
  return trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.threads = 1});
}

std::vector<double> by_elimination(Index n, Variant variant) {
  const auto surface = icosphere_surface(n);
  const Source source = Source::at_vertex(Vertex(0));
  std::optional<LogMapSolver> solver;
  return timed([&] { solver.emplace(surface.graph(), HeatOptions{.strategy = Strategy::global, .threads = 1}); },
               [&] { solver->solve(source, {.variant = variant, .threads = 1}); });
}

/// The numbers of `timed` for LU, and the largest difference of the two maps as a share of the longest vector.
std::vector<double> by_lu(Index n, Variant variant) {
  const auto surface = icosphere_surface(n);
  const CsrGraph& graph = surface.graph();
  std::optional<DirectSolver> solver;
  std::vector<Complex> phi;
  if (void* set = dlsym(RTLD_DEFAULT, "openblas_set_num_threads")) reinterpret_cast<void (*)(int)>(set)(1);
  // CHOLMOD, which factors the frames, uses OpenMP. A forked process has no OpenMP threads, so parallel regions are
  // switched off.
  if (void* set = dlsym(RTLD_DEFAULT, "omp_set_max_active_levels")) reinterpret_cast<void (*)(int)>(set)(0);
  std::vector<double> numbers = timed([&] { solver.emplace(graph); }, [&] { phi = solver->solve(0, variant); });
  const LogMap map = LogMapSolver(graph, {.strategy = Strategy::global, .threads = 1})
                         .solve(Source::at_vertex(Vertex(0)), {.variant = variant});
  double apart = 0, longest = 0;
  for (Index i = 0; i < graph.size(); ++i) {
    const auto ours = map.coordinates(Vertex(i));
    apart = std::max(apart, std::abs(phi[i] * graph.length_unit() - Complex(ours[0], ours[1])));
    longest = std::max(longest, std::abs(phi[i]) * graph.length_unit());
  }
  numbers.push_back(apart / longest);
  return numbers;
}

}  // namespace

Table direct(const Settings& settings) {
  Table table({"vertices", "variant", "first map cpu s", "by LU cpu s", "first, times", "additional map cpu s",
               "additional by LU cpu s", "additional, times", "peak MB", "by LU MB", "memory, times", "apart"});
  for (const Index n : sizes(settings, 600, {10000, 40000}))
    for (const Variant variant : all_variants) {
      const std::vector<double> ours = in_own_process(3, [&] { return by_elimination(n, variant); }),
                                lu = in_own_process(4, [&] { return by_lu(n, variant); });
      table.add({n, std::string(to_string(variant)), ours[0], lu[0], lu[0] / ours[0], ours[1], lu[1], lu[1] / ours[1],
                 ours[2], lu[2], lu[2] / ours[2], lu[3]});
    }
  table.seen = fmt::format(
      "By LU first maps take {:.0f} to {:.0f} times as long, additional ones {:.0f} to {:.0f} times; maps differ by up "
      "to "
      "{:.0e}.",
      table.smallest("first, times"), table.largest("first, times"), table.smallest("additional, times"),
      table.largest("additional, times"), table.largest("apart"));
  return table;
}

}  // namespace ahm::bench
