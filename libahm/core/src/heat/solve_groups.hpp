/// \file
/// Which supernodes of a factor can be solved with at the same time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ahm/types.hpp"
#include "heat/supernodal_factor.hpp"

namespace ahm {

/// Subtrees of the elimination tree, in groups of about the same work, and the supernodes above them all. On the way down
/// groups touch rows of their own, and add to those of the top; on the way up they read the top. The groups are the same on any
/// number of threads, and so are the sums.
struct SolveGroups {
  struct Subtree {
    Offset first, last;  ///< its supernodes
    Offset end;          ///< rows before this one are its own
  };
  std::vector<Subtree> subtrees;    ///< group after group
  std::vector<std::size_t> begin;   ///< of each group among them, and their end
  std::vector<Offset> top;          ///< supernodes above, in their order
  std::vector<std::int32_t> place;  ///< of every row among those of the top; -1: in a subtree
  std::size_t top_rows = 0;

  Offset count() const { return static_cast<Offset>(begin.size()) - 1; }
  std::size_t bytes() const { return place.size() * sizeof(std::int32_t); }
};

/// Null where they would not pay, for small factors.
/// @param parent  of each supernode, which are in postorder; -1: of a root
std::unique_ptr<const SolveGroups> solve_groups(const SupernodalFactor& L, std::span<const Offset> parent);

}  // namespace ahm
