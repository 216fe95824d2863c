#include "tool_path/tool_path.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <variant>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "tool_path/curves.hpp"

namespace ahm {
namespace {

void check(const ToolPathOptions& o) {
  check_positive("spacing", o.spacing);
  for (const auto& [name, value] : {std::pair{"step", o.step},
                                    {"chord_error", o.chord_error},
                                    {"tool_radius", o.tool_radius},
                                    {"clearance", o.clearance},
                                    {"max_link", o.max_link},
                                    {"offset", o.offset}})
    if (value != 0) check_positive(name, value);
  for (const auto& [name, angle] : {std::pair{"lead", o.lead}, {"tilt", o.tilt}})
    if (!(std::abs(angle) < std::numbers::pi / 2))
      throw InvalidArgument(std::string(name) + " is " + detail::number(angle) + "; it must lie within (-pi/2, pi/2)");
}

Index count_uncovered(const PathDomain& domain, const std::vector<MeshCurve>& seeds) {
  std::map<Index, bool> covered;
  for (const Triangle& face : domain.mesh.faces) covered[domain.surface.component(face[0])];
  for (const MeshCurve& seed : seeds)
    covered[domain.surface.component(domain.mesh.faces[to_size(seed.faces.front())][0])] = true;
  return static_cast<Index>(std::ranges::count_if(covered, [](const auto& c) { return !c.second; }));
}

}  // namespace

ToolPath tool_path(const Surface& surface, const ToolPathOptions& options) {
  check(options);
  const FaceMesh whole = whole_mesh(surface, options.spacing);
  const PathDomain region(region_mesh(surface, whole, options.region, options.spacing));
  const FineDomain domain(region);
  const std::vector<MeshCurve> seeds = seed_curves(surface, domain, options);
  if (const double across = options.spacing * bounding_box(domain.mesh.points).diagonal(); options.tool_radius > across)
    throw InvalidArgument("tool_radius is " + detail::number(options.tool_radius) + "; the region is only " +
                          detail::number(across) + " across");
  const double phase = std::holds_alternative<BoundarySeed>(options.seed) ? 0.5 : 0;
  ToolPath path;
  path.spacing = options.spacing;
  path.uncovered_components = count_uncovered(domain, seeds);
  add_poses(whole, domain, make_passes(domain, seeds, phase, options.spiral, options.progress), options, path);
  return path;
}

}  // namespace ahm
