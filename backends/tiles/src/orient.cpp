#include "orient.hpp"

#include <algorithm>
#include <string>
#include <unordered_map>

#include "ahm/error.hpp"
#include "ahm/util/disjoint_sets.hpp"
#include "ahm/util/vec.hpp"
#include "orientation.hpp"

namespace ahm::tiles {
namespace {

/// An edge within the tile; a and b are indices into the surroundings.
struct InnerEdge {
  float bend;
  Index a, b;
  signed char turn;
};

signed char sign_of(double value) { return static_cast<signed char>((value > 0) - (value < 0)); }
signed char relative(signed char turn) { return turn < 0 ? -1 : 1; }
signed char product(signed char a, signed char b) { return static_cast<signed char>(a * b); }

}  // namespace

TileTrees tile_trees(const AroundFile& around, std::span<const Index> tails, std::span<const Index> heads) {
  const Index n = around.end - around.begin;
  const auto& normals = around.planes.normals;
  std::vector<InnerEdge> inner;
  TileTrees result;
  std::vector<char> leads_out(static_cast<std::size_t>(n), 0);
  const auto add_joint = [&](float bend, Index tail, Index head, signed char turn, bool leaves) {
    result.joints.push_back(
        {bend, around.numbers[tail], around.numbers[head], 0, around.numbers[head], 0, turn, 0, leaves});
  };
  for (std::size_t e = 0; e < tails.size(); ++e) {
    const Index a = tails[e], b = heads[e];
    const float bend = pointcloud::bend(normals[a], normals[b]);
    const signed char turn = sign_of(dot(normals[a], normals[b]));
    if (around.is_own(a) && around.is_own(b)) {
      inner.push_back({bend, a, b, turn});
      continue;
    }
    leads_out[(around.is_own(a) ? a : b) - around.begin] = 1;
    if (around.is_own(a)) add_joint(bend, a, b, turn, true);
  }
  std::stable_sort(inner.begin(), inner.end(), [](const InnerEdge& p, const InnerEdge& q) { return p.bend < q.bend; });

  pointcloud::SignedForest sets(n);  // points that are joined in the tree of the whole cloud
  detail::DisjointSets joined(static_cast<std::size_t>(n));
  std::vector<char> open = leads_out;  // whether a set has edges to other tiles, by its smallest member
  for (const InnerEdge& edge : inner) {
    const Index a = edge.a - around.begin, b = edge.b - around.begin;
    if (joined.root(a) == joined.root(b)) continue;
    joined.join(a, b);
    const bool from = open[sets.find(a).vertex], to = open[sets.find(b).vertex];
    if (from && to) {
      add_joint(edge.bend, edge.a, edge.b, edge.turn, false);
      continue;
    }
    sets.join(a, b, relative(edge.turn));
    open[sets.find(a).vertex] = from || to;
  }
  const Index first = around.numbers[around.begin];
  for (Index i = 0; i < n; ++i) {
    const auto [root, sign] = sets.find(i);
    result.root.push_back(first + root);
    result.sign.push_back(sign);
    if (leads_out[i]) result.terminals.push_back({first + i, first + root, sign});
  }
  for (Joint& joint : result.joints) {  // the sets of their ends are final only now
    joint.from = result.root[joint.tail - first];
    joint.inward = result.sign[joint.tail - first];
    joint.sign = product(joint.inward, relative(joint.turn));
    if (joint.leaves) continue;
    joint.to = result.root[joint.head - first];
    joint.sign = product(joint.sign, result.sign[joint.head - first]);
  }
  return result;
}

namespace {

using pointcloud::Evidence;
using pointcloud::SignedForest;

/// The sets of points with edges to other tiles, joined to components as in the whole cloud.
class OpenSets {
 public:
  explicit OpenSets(const TileFolder& folder);

  /// The component of a set: its index among components over several tiles, or -1 for a set within one tile.
  struct Member {
    Index component;
    signed char sign;  ///< sign of the set's root relative to the smallest point of the component
  };
  /// The component of a set. @param root  smallest point of the set
  Member find(Index root) const {
    const auto found = members_.find(root);
    return found == members_.end() ? Member{-1, 1} : found->second;
  }
  std::size_t components() const { return components_; }
  /// Number of edges between tiles that join opposed normals. It does not depend on the signs of the components.
  std::int64_t reflections() const { return reflections_; }

 private:
  void read(const TileFolder& folder);
  std::unordered_map<Index, Terminal> terminals_;
  std::vector<Joint> joints_;
  std::vector<Index> roots_;                   // roots of the sets, ascending
  std::unordered_map<Index, Member> members_;  // component of each set, by root
  std::size_t components_ = 0;
  std::int64_t reflections_ = 0;
};

void OpenSets::read(const TileFolder& folder) {
  for (std::size_t t = 0; t < folder.tiles(); ++t) {
    const ArrayFile file = folder.open(kind::edges, t);
    const auto joints = file.get<Joint>("joints");
    joints_.insert(joints_.end(), joints.begin(), joints.end());
    for (const Terminal& terminal : file.get<Terminal>("terminals")) {
      terminals_[terminal.point] = terminal;
      roots_.push_back(terminal.root);
    }
  }
  std::sort(roots_.begin(), roots_.end());
  roots_.erase(std::unique(roots_.begin(), roots_.end()), roots_.end());
}

OpenSets::OpenSets(const TileFolder& folder) {
  read(folder);
  std::sort(joints_.begin(), joints_.end(), [](const Joint& a, const Joint& b) {
    if (a.bend != b.bend) return a.bend < b.bend;
    return a.tail != b.tail ? a.tail < b.tail : a.head < b.head;
  });
  const auto place = [&](Index root) {
    return static_cast<Index>(std::lower_bound(roots_.begin(), roots_.end(), root) - roots_.begin());
  };
  const auto terminal = [&](Index point) {
    const auto found = terminals_.find(point);
    if (found == terminals_.end())
      throw IoError("point " + std::to_string(point) +
                    " has an edge that is missing in its tile; build the tiles again");
    return found->second;
  };
  SignedForest forest(static_cast<Index>(roots_.size()));
  for (const Joint& joint : joints_) {
    if (!joint.leaves) {
      forest.join(place(joint.from), place(joint.to), joint.sign);
      continue;
    }
    const Terminal head = terminal(joint.head);
    forest.join(place(joint.from), place(head.root), static_cast<signed char>(joint.sign * head.sign));
  }
  std::unordered_map<Index, Index> number;
  for (std::size_t i = 0; i < roots_.size(); ++i) {
    const auto [root, sign] = forest.find(static_cast<Index>(i));
    members_[roots_[i]] = {number.try_emplace(root, static_cast<Index>(number.size())).first->second, sign};
  }
  components_ = number.size();
  for (const Joint& joint : joints_) {
    if (!joint.leaves) continue;
    const Terminal head = terminal(joint.head);
    reflections_ += joint.turn * joint.inward * find(joint.from).sign * head.sign * find(head.root).sign < 0;
  }
  terminals_.clear();
  joints_.clear();
}

/// The points of one tile with their normals and sets.
struct TileSets {
  TileSets(const TileFolder& folder, std::size_t tile)
      : points_file(folder.open(kind::surroundings, tile)), edges_file(folder.open(kind::edges, tile)) {
    const auto own = points_file.get<Index>("own");
    const auto begin = static_cast<std::size_t>(own[0]), count = static_cast<std::size_t>(own[1] - own[0]);
    points = points_file.get<Vec3>("points").subspan(begin, count);
    normals = points_file.get<Vec3>("normals").subspan(begin, count);
    root = edges_file.get<Index>("root");
    sign = edges_file.get<signed char>("sign");
    masses = edges_file.get<double>("masses");
    first_place = own[0];
    first = folder.first_point(tile);
  }
  ArrayFile points_file, edges_file;
  std::span<const Vec3> points, normals;
  std::span<const Index> root;
  std::span<const signed char> sign;
  std::span<const double> masses;
  Index first_place = 0;  ///< index of the tile's first own point in its surroundings
  Index first = 0;        ///< number of the first point in the whole cloud
};

/// Determines the signs of components from their points, in the order of the whole cloud.
class SignEvidence {
 public:
  SignEvidence(const TileFolder& folder, const OpenSets& sets) : sets_(sets), open_(sets.components()) {
    for (std::size_t t = 0; t < folder.tiles(); ++t) each(TileSets(folder, t), open_, &SignEvidence::count);
    for (std::size_t t = 0; t < folder.tiles(); ++t) each(TileSets(folder, t), open_, &SignEvidence::weigh);
  }
  /// The final sign of each point of a tile.
  std::vector<signed char> signs(const TileSets& tile) const {
    std::vector<Evidence> closed(tile.root.size());  // for components within the tile, by their smallest points
    visit(tile, [&](std::size_t i, OpenSets::Member m, Index local, signed char) {
      if (m.component < 0) closed[local].count(tile.points[i]);
    });
    visit(tile, [&](std::size_t i, OpenSets::Member m, Index local, signed char sign) {
      if (m.component < 0) closed[local].weigh(tile.points[i], static_cast<double>(sign) * tile.normals[i], sign);
    });
    std::vector<signed char> result(tile.root.size());
    visit(tile, [&](std::size_t i, OpenSets::Member m, Index local, signed char sign) {
      const Evidence& evidence = m.component < 0 ? closed[local] : open_[m.component];
      result[i] = static_cast<signed char>(evidence.sign(false) < 0 ? -sign : sign);
    });
    return result;
  }

 private:
  /// Calls use(i, member, index of the root in the tile, sign relative to the smallest point of the component) for each point.
  template <class Use>
  void visit(const TileSets& tile, const Use& use) const {
    for (std::size_t i = 0; i < tile.root.size(); ++i) {
      const OpenSets::Member member = sets_.find(tile.root[i]);
      use(i, member, tile.root[i] - tile.first, static_cast<signed char>(member.sign * tile.sign[i]));
    }
  }
  template <class Step>
  void each(const TileSets& tile, std::vector<Evidence>& open, const Step& step) const {
    visit(tile, [&](std::size_t i, OpenSets::Member m, Index, signed char sign) {
      if (m.component >= 0) step(open[m.component], tile.points[i], tile.normals[i], sign);
    });
  }
  static void count(Evidence& e, const Vec3& point, const Vec3&, signed char) { e.count(point); }
  static void weigh(Evidence& e, const Vec3& point, const Vec3& normal, signed char sign) {
    e.weigh(point, static_cast<double>(sign) * normal, sign);
  }

  const OpenSets& sets_;
  std::vector<Evidence> open_;
};

/// Number of edges within a tile that join opposed normals.
std::int64_t reflections_within(const TileSets& tile, const std::vector<signed char>& signs) {
  const auto tails = tile.edges_file.get<Index>("tails"), heads = tile.edges_file.get<Index>("heads");
  const auto count = static_cast<Index>(signs.size());
  std::int64_t result = 0;
  for (std::size_t e = 0; e < tails.size(); ++e) {
    const Index a = tails[e] - tile.first_place, b = heads[e] - tile.first_place;
    if (a < 0 || b < 0 || a >= count || b >= count) continue;
    result += signs[a] * signs[b] * dot(tile.normals[a], tile.normals[b]) < 0;
  }
  return result;
}

}  // namespace

/// Determines the signs of all normals, and numbers vertices and components in the order of the whole cloud.
void orient(TileFolder& folder) {
  const OpenSets sets(folder);
  const SignEvidence witnesses(folder, sets);
  Manifest& m = folder.manifest();
  m.reflections = sets.reflections();
  m.components = 0;
  Index vertices = 0;
  std::vector<Index> number_of_open(sets.components(), -1);
  for (std::size_t t = 0; t < folder.tiles(); ++t) {
    const TileSets tile(folder, t);
    const std::vector<signed char> sign = witnesses.signs(tile);
    m.reflections += reflections_within(tile, sign);
    std::vector<Index> vertex(sign.size(), -1), component(sign.size(), -1), number_of_closed(sign.size(), -1);
    const Index first = vertices;
    for (std::size_t i = 0; i < sign.size(); ++i) {
      if (!(tile.masses[i] > 0)) continue;
      vertex[i] = vertices++;
      const Index open = sets.find(tile.root[i]).component;
      Index& number = open >= 0 ? number_of_open[open] : number_of_closed[tile.root[i] - tile.first];
      if (number < 0) number = m.components++;
      component[i] = number;
    }
    m.tiles[t].vertices = vertices - first;
    folder.write(kind::vertices, t, {array("vertex", vertex), array("component", component), array("sign", sign)});
  }
  m.kind = m.reflections > 0 ? TransportKind::block : TransportKind::rotation2;
  folder.finish(Stage::oriented);
}

}  // namespace ahm::tiles
