// Solvers kept between maps, since factors serve every source.
#pragma once

#include <algorithm>
#include <exception>
#include <list>
#include <memory>
#include <optional>

#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/viewer/session.hpp"

namespace ahm::viewer {

/// Not safe to use from several threads.
class Makers {
 public:
  Makers(const Surface& surface, unsigned threads) : surface_(surface), threads_(threads) {}

  /// Whether factors of the whole take long.
  bool is_large() const { return surface_.graph().size() > 200'000; }

  /// Of the two that were used last, or a new one. Maps of large surfaces that end at a radius are marched: without
  /// factors, in time proportional to what they reach.
  const LogMapSolver& solver(const Settings& settings, const std::stop_token& stop) {
    const bool marched = settings.radius && is_large();
    const auto fits = [&](const Kept& kept) { return kept.t_coef == settings.t_coef && kept.marched == marched; };
    const auto found = std::find_if(kept_.begin(), kept_.end(), fits);
    if (found != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, found);
    } else {
      if (kept_.size() >= 2) kept_.pop_back();
      HeatOptions heat;
      heat.t_coef = settings.t_coef;
      heat.strategy = marched ? Strategy::march : Strategy::automatic;
      heat.threads = threads_;
      heat.progress.stop = stop;
      kept_.push_front({settings.t_coef, marched, LogMapSolver(surface_.graph(), heat)});
    }
    return kept_.front().solver;
  }

  const PolarMapSolver& polar() {
    if (!polar_) polar_.emplace(surface_, PolarSolverOptions{.threads = threads_});
    return *polar_;
  }

  /// @throws InvalidArgument: no faces
  const ExactGeodesics& geodesics() {
    if (surface_.faces().size() == 0)
      throw InvalidArgument("paths and exact maps run over faces, which this input does not have");
    if (refusal_) std::rethrow_exception(refusal_);
    try {
      if (!geodesics_) geodesics_.emplace(surface_);
    } catch (const InvalidArgument&) {
      refusal_ = std::current_exception();
      throw;
    } catch (const InvalidGeometry&) {
      refusal_ = std::current_exception();
      throw;
    }
    return *geodesics_;
  }

  /// The same; null where there are no flat faces.
  const ExactGeodesics* flat_faces() try { return &geodesics(); } catch (const Error&) {
    return nullptr;
  }

 private:
  struct Kept {
    double t_coef;
    bool marched;
    LogMapSolver solver;
  };
  const Surface& surface_;
  unsigned threads_;
  std::list<Kept> kept_;
  std::optional<PolarMapSolver> polar_;
  std::optional<ExactGeodesics> geodesics_;
  std::exception_ptr refusal_;  ///< why there are none
};

}  // namespace ahm::viewer
