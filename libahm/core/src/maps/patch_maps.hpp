/// \file
/// The maps of a few sources near each other, solved for on a patch of the graph around them.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/maps/source.hpp"
#include "ahm/progress.hpp"
#include "ahm/util/parallel.hpp"
#include "heat/blas_control.hpp"
#include "heat/component_scales.hpp"
#include "heat/heat_system.hpp"
#include "maps/affine_heat.hpp"
#include "maps/ball.hpp"

namespace ahm {

/// A patch with its natural boundary.
struct Patch {
  std::vector<Index> vertices;  ///< of the whole graph, ascending; their places there are the patch's own numbers
  std::vector<Index> edge;      ///< the patch's numbers of those with neighbours outside, ascending
  CsrGraph graph;
  std::vector<Source> sources;  ///< in the patch's numbers
};

/// A patch, its factors with the diffusion times of the whole graph, and the maps on it.
struct PatchMaps : Patch {
  PatchMaps(Patch patch, std::vector<double> tau, const HeatOptions& options)
      : Patch(std::move(patch)), operators(factored_system(graph, std::move(tau), options), graph, {}) {}
  PatchMaps(const PatchMaps&) = delete;
  PatchMaps& operator=(const PatchMaps&) = delete;

  HeatOperators operators;
  std::optional<AffineHeat> heat;  ///< solved, without squares
};

/// Cuts out patches and solves on them, one after the other.
class PatchSolver {
 public:
  /// @param options  t_coef and variant count. All three must outlive this object.
  PatchSolver(const TangentGraph& graph, const ComponentScales& scales, const HeatOptions& options);

  /// The patch of all vertices within `limit` along edges (graph units) of any source.
  Patch cut(std::span<const Source> sources, double limit);
  std::unique_ptr<PatchMaps> solve(Patch patch) const;
  /// The largest sqrt(tau) at a vertex of the sources, graph units.
  double sqrt_tau(std::span<const Source> sources) const;

 private:
  const TangentGraph& graph_;
  const ComponentScales& scales_;
  HeatOptions options_;
  Ball ball_;
  SparseArray<Index> place_;  ///< 1 + place in the patch at hand, 0: outside
};

/// The checks of what is solved for on patches.
/// @throws InvalidGraph, InvalidArgument
void check_patches(const TangentGraph& graph, std::span<const Source> sources, const HeatOptions& options,
                   double margin);

/// Sources whose patches overlap anyway. @param extent  how far along edges (graph units) each map goes
std::vector<std::vector<Index>> patch_groups(const TangentGraph& graph, const ComponentScales& scales,
                                             std::span<const Source> sources, std::span<const double> extent,
                                             const HeatOptions& options, double margin);

/// Calls work(worker, group) for every group, a few at a time by each thread; `make` makes the worker of a thread.
/// @param progress  stage "solve"
template <class Make, class Work>
void share_groups(const std::vector<std::vector<Index>>& groups, unsigned threads, const Progress& progress,
                  const Make& make, const Work& work) {
  using Worker = decltype(make());
  const OneBlasThread one_thread;
  std::mutex mutex;
  std::vector<Worker> idle;
  Offset done = 0;
  const Offset at_once = groups.size() < 64 ? 1 : 8;
  detail::parallel_chunks(static_cast<Offset>(groups.size()), at_once, threads, [&](Offset begin, Offset end) {
    Worker worker;
    {
      std::scoped_lock lock(mutex);
      if (!idle.empty()) worker = std::move(idle.back()), idle.pop_back();
    }
    if (!worker) worker = make();
    for (Offset g = begin; g < end; ++g) work(*worker, groups[static_cast<std::size_t>(g)]);
    std::scoped_lock lock(mutex);
    idle.push_back(std::move(worker));
    done += end - begin;
    progress.step("solve", static_cast<double>(done) / static_cast<double>(groups.size()));
  });
}

}  // namespace ahm
