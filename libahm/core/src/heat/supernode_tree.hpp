/// \file
/// The elimination tree of a factor's supernodes.
#pragma once

#include <vector>

#include "heat/supernodal_factor.hpp"

namespace ahm {

struct SupernodeTree {
  std::vector<Offset> parent;  ///< the supernode of the first row below; -1: of a root
  /// Of each supernode its children, ascending: children[child_begin[s]] to children[child_begin[s + 1]].
  std::vector<Offset> child_begin, children;

  std::span<const Offset> children_of(Offset s) const {
    return std::span(children).subspan(child_begin[s], child_begin[s + 1] - child_begin[s]);
  }
};

SupernodeTree supernode_tree(const SupernodalFactor& L);

}  // namespace ahm
