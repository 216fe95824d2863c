#include "cli/options.hpp"

#include <fmt/format.h>

namespace ahm::app {

std::vector<std::string> option_words(const InputOptions& o) {
  const InputOptions usual;
  std::vector<std::string> out;
  const auto add = [&](const char* name, const auto& value) {
    out.insert(out.end(), {name, fmt::format("{}", value)});
  };
  if (!o.format.empty()) add("--input-format", o.format.substr(1));
  if (o.backend != usual.backend) add("--backend", o.backend);
  if (o.threads != usual.threads) add("--threads", o.threads);
  if (o.voxel) add("--voxel", *o.voxel);
  if (o.outliers) out.emplace_back("--outliers");
  if (o.drop_nan) out.emplace_back("--drop-nan");
  if (o.k) add("--k", *o.k);
  if (o.knn != usual.knn) add("--knn", o.knn);
  if (o.normals != usual.normals) add("--normals", o.normals);
  if (o.smooth) add("--smooth", *o.smooth > 0 ? fmt::format("{}", *o.smooth) : "off");
  if (!o.flips) out.emplace_back("--no-flips");
  if (o.non_manifold != usual.non_manifold) add("--non-manifold", o.non_manifold);
  if (o.discretization != usual.discretization) add("--discretization", o.discretization);
  if (o.repair.weld) add("--weld", *o.repair.weld);
  if (o.repair.drop_degenerate) out.emplace_back("--drop-degenerate");
  if (o.repair.drop_duplicates) out.emplace_back("--drop-duplicates");
  if (o.repair.orient) out.emplace_back("--orient");
  return out;
}

}  // namespace ahm::app
