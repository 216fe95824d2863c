#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "tool_path/links.hpp"
#include "tool_path/order.hpp"
#include "tool_path/tool_path.hpp"

namespace ahm {
namespace {

/// Appends poses to a path. Positions are converted to world units.
class PoseWriter {
 public:
  PoseWriter(ToolPath& path, double spacing) : path_(path), spacing_(spacing) {}

  void add(const Spot& spot, ToolMotion kind, Index pass) {
    add(spot.position, spot.axis, kind, pass);
    path_.poses.back().contact = spacing_ * spot.contact;
  }
  void add(const Vec3& position, const Vec3& axis, ToolMotion kind, Index pass) {
    if (!path_.poses.empty() && kind != ToolMotion::missing) arclength_ += spacing_ * distance(position, last_);
    path_.poses.push_back({spacing_ * position, spacing_ * position, axis, {}, {}, pass, kind, arclength_});
    last_ = position;
  }
  double arclength() const { return arclength_; }

  /// Computes directions of travel, leans the axes and computes rotations.
  void finish(double lead, double tilt) {
    std::vector<ToolPose>& poses = path_.poses;
    for (std::size_t k = 0; k < poses.size(); ++k) poses[k].travel = travel(k);
    for (std::size_t k = poses.size(); k-- > 1;) {  // along the axis: the direction of the pass that begins there
      if (poses[k - 1].kind != ToolMotion::approach && poses[k - 1].kind != ToolMotion::missing) continue;
      const Vec3 flat = poses[k].travel - dot(poses[k].travel, poses[k - 1].axis) * poses[k - 1].axis;
      if (norm(flat) > 1e-6) poses[k - 1].travel = normalized(flat);
    }
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const Vec3 normal = poses[k].axis, ahead = poses[k].travel, left = cross(normal, ahead);
      poses[k].axis = std::cos(tilt) * (std::cos(lead) * normal + std::sin(lead) * ahead) + std::sin(tilt) * left;
      poses[k].travel = std::cos(lead) * ahead - std::sin(lead) * normal;
      poses[k].quaternion = rotation(poses[k].travel, poses[k].axis);
      if (k == 0) continue;
      double cosine = 0;
      for (std::size_t c = 0; c < 4; ++c) cosine += poses[k].quaternion[c] * poses[k - 1].quaternion[c];
      if (cosine < 0)
        for (double& c : poses[k].quaternion) c = -c;
    }
  }

 private:
  /// The direction from the previous to the next pose of the same kind, perpendicular to the axis.
  Vec3 travel(std::size_t k) const {
    const std::vector<ToolPose>& poses = path_.poses;
    const auto is_same = [&](std::size_t j) {
      return poses[j].kind == poses[k].kind && poses[j].pass == poses[k].pass;
    };
    const std::size_t from = k > 0 && is_same(k - 1) ? k - 1 : k,
                      to = k + 1 < poses.size() && is_same(k + 1) ? k + 1 : k;
    const Vec3& axis = poses[k].axis;
    for (const auto& [a, b] : {std::pair{from, to}, {k > 0 ? k - 1 : k, k}, {k, std::min(k + 1, poses.size() - 1)}}) {
      const Vec3 chord = poses[b].position - poses[a].position, flat = chord - dot(chord, axis) * axis;
      if (norm(flat) > 1e-6 * norm(chord) && norm(flat) > 0) return normalized(flat);
    }
    if (k > 0) {  // along the axis: the previous direction
      const Vec3 flat = poses[k - 1].travel - dot(poses[k - 1].travel, axis) * axis;
      if (norm(flat) > 1e-6) return normalized(flat);
    }
    return any_perpendicular(axis);
  }

  /// The rotation with these x and z axes, as a quaternion (w, x, y, z).
  static std::array<double, 4> rotation(const Vec3& x, const Vec3& z) {
    const Vec3 y = cross(z, x);
    const double trace = x[0] + y[1] + z[2];
    std::array<double, 4> q{trace, x[0], y[1], z[2]};
    const auto largest = static_cast<std::size_t>(std::ranges::max_element(q) - q.begin());
    if (largest == 0)
      q = {1 + trace, y[2] - z[1], z[0] - x[2], x[1] - y[0]};
    else if (largest == 1)
      q = {y[2] - z[1], 1 + 2 * x[0] - trace, x[1] + y[0], z[0] + x[2]};
    else if (largest == 2)
      q = {z[0] - x[2], x[1] + y[0], 1 + 2 * y[1] - trace, y[2] + z[1]};
    else
      q = {x[1] - y[0], z[0] + x[2], y[2] + z[1], 1 + 2 * z[2] - trace};
    double length = 0;
    for (const double c : q) length = std::hypot(length, c);
    for (double& c : q) c /= length;
    return q;
  }

  ToolPath& path_;
  double spacing_, arclength_ = 0;
  Vec3 last_{};
};

}  // namespace

std::array<std::array<double, 4>, 4> pose_matrix(const ToolPose& pose) {
  const Vec3 &x = pose.travel, &z = pose.axis, &p = pose.position, y = cross(z, x);
  return {{{x[0], y[0], z[0], p[0]}, {x[1], y[1], z[1], p[1]}, {x[2], y[2], z[2], p[2]}, {0, 0, 0, 1}}};
}

void add_poses(const FaceMesh& whole, const PathDomain& domain, std::vector<PassCurve> passes,
               const ToolPathOptions& options, ToolPath& path) {
  const double spacing = options.spacing;
  const auto or_else = [&](double length, double otherwise) { return length > 0 ? length / spacing : otherwise; };
  const double step = or_else(options.step, 0.25), tolerance = or_else(options.chord_error, 0.005);
  const MeshTree tree(whole);
  const ToolPlacer placer(tree, domain.mesh,
                          {step, tolerance, or_else(options.tool_radius, 0.5), options.offset / spacing});
  const double clearance = or_else(options.clearance, 1), max_link = or_else(options.max_link, 3);
  const Linker linker(tree, domain, placer, clearance);
  path.chord_error = spacing * tolerance;

  constexpr double max_poses = 1 << 24;
  double length = 0;
  for (const PassCurve& pass : passes) length += curve_length(domain.mesh, pass.curve);
  if (length / step > max_poses)
    throw ResourceExhausted("the step, " + detail::number(spacing * step) +
                            ", requires more than 2^24 poses; enlarge it, or cover a smaller region");

  std::vector<std::vector<TrackedPass>> pieces(passes.size());  // a pass ends where a ball of the offset does not fit
  detail::parallel_chunks(static_cast<Offset>(passes.size()), 1, options.threads, [&](Offset k, Offset) {
    const PassCurve& pass = passes[static_cast<std::size_t>(k)];
    std::vector<Track> parts = placer.tracks(pass.curve);
    const bool closed = pass.curve.closed && parts.size() == 1 && parts[0].front().position == parts[0].back().position;
    for (Track& part : parts)
      pieces[static_cast<std::size_t>(k)].push_back({std::move(part), pass.origin, pass.distance, closed});
  });
  std::vector<TrackedPass> tracks;
  for (std::vector<TrackedPass>& of_pass : pieces)
    tracks.insert(tracks.end(), std::make_move_iterator(of_pass.begin()), std::make_move_iterator(of_pass.end()));
  std::erase_if(tracks, [](const TrackedPass& pass) { return pass.track.size() < 2; });
  if (tracks.empty() && options.offset == 0)
    throw InvalidArgument("spacing_too_large", "every pass on the region has only one pose",
                          "choose a smaller spacing");
  if (tracks.empty())
    throw InvalidArgument(
        "offset_too_large",
        "a ball with the radius of the offset, " + detail::number(options.offset) + ", fits nowhere on the region",
        "choose a smaller offset");
  tracks = ordered(std::move(tracks), options.one_way);

  PoseWriter writer(path, spacing);
  const auto rise = [&](const Spot& spot, Index pass) {
    if (linker.can_rise(spot)) writer.add(linker.lifted(spot), spot.axis, ToolMotion::retreat, pass);
  };
  /// Down to a spot, to which no link leads.
  const auto arrive = [&](const Spot& spot, Index pass) {
    const ToolMotion first = pass == 0 ? ToolMotion::approach : ToolMotion::missing;
    if (linker.can_rise(spot)) {
      writer.add(linker.lifted(spot), spot.axis, first, pass);
      writer.add(spot, ToolMotion::approach, pass);
    } else if (pass > 0) {
      writer.add(spot, first, pass);
    }
  };
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    const TrackedPass& pass = tracks[k];
    const auto number = static_cast<Index>(k);
    const Spot& start = pass.track.front();
    if (k == 0) {
      arrive(start, number);
    } else {
      const Spot& end = tracks[k - 1].track.back();
      std::optional<Track> along = linker.on_surface(end, start, max_link);
      std::optional<std::vector<Vec3>> over;
      if (!along) over = linker.through_space(end, start);
      if (!along && !over) along = linker.on_surface(end, start);
      if (!along && !over) over = linker.around(end, start);
      if (along) {
        ++path.surface_links;
        for (std::size_t i = 1; i < along->size(); ++i) writer.add((*along)[i], ToolMotion::link, number);
      } else if (over) {
        ++path.lifted_links;
        writer.add(over->front(), end.axis, ToolMotion::retreat, number);
        for (std::size_t i = 1; i < over->size(); ++i) {
          const double share = static_cast<double>(i) / static_cast<double>(over->size() - 1);
          const Vec3 mixed = (1 - share) * end.axis + share * start.axis;
          writer.add((*over)[i], norm(mixed) > 1e-3 ? normalized(mixed) : start.axis, ToolMotion::link, number);
        }
        writer.add(start, ToolMotion::approach, number);
      } else {
        ++path.missing_links;
        rise(end, number);
        arrive(start, number);
      }
    }
    const std::size_t begin = path.poses.size();
    double before = writer.arclength();
    for (std::size_t i = 0; i < pass.track.size(); ++i) {
      writer.add(pass.track[i], ToolMotion::pass, number);
      if (i == 0) before = writer.arclength();
    }
    path.passes.push_back(
        {begin, path.poses.size(), pass.closed, pass.origin, spacing * pass.distance, writer.arclength() - before});
    path.pass_length += path.passes.back().length;
  }
  rise(tracks.back().track.back(), static_cast<Index>(tracks.size()) - 1);
  path.link_length = writer.arclength() - path.pass_length;
  writer.finish(options.lead, options.tilt);
}

}  // namespace ahm
