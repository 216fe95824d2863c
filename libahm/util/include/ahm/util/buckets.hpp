/// \file
/// Items grouped by an integer key (counting sort).
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "ahm/types.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/unset_vector.hpp"

namespace ahm::detail {

/// Splits [0, keys) into ranges, at most one per thread, and calls body(from, to) for each. A body visits all items and processes
/// those whose key is in its range. So each range is processed in order, and threads need no locks.
template <class Body>
void for_key_ranges(Index keys, unsigned threads, const Body& body) {
  constexpr Offset most = 4;  // each range costs one pass over all items
  const Offset ranges = std::min<Offset>(thread_count(threads), most);
  parallel_chunks(keys, std::max<Offset>(1, (keys + ranges - 1) / ranges), threads, body);
}

/// Begin of each key in an array that is sorted by key.
/// @param sizes  entry k + 1: number of items with key k
inline std::vector<Offset> begin_of_groups(std::vector<Offset> sizes) {
  for (std::size_t k = 1; k < sizes.size(); ++k) sizes[k] += sizes[k - 1];
  return sizes;
}

/// Item numbers grouped by key, ascending within each key.
struct Buckets {
  std::vector<Offset> begin;  ///< keys + 1 positions in `members`
  UnsetVector<Offset> members;

  std::span<const Offset> of(Index key) const {
    return std::span(members).subspan(static_cast<std::size_t>(begin[key]),
                                      static_cast<std::size_t>(begin[key + 1] - begin[key]));
  }
};

/// Groups the items 0 to count - 1 by key.
/// @param key  key(k): key of item k, in [0, keys)
template <class Key>
Buckets buckets_of(Offset count, Index keys, unsigned threads, const Key& key) {
  Buckets result{std::vector<Offset>(static_cast<std::size_t>(keys) + 1, 0), {}};
  for_key_ranges(keys, threads, [&](Offset from, Offset to) {
    for (Offset k = 0; k < count; ++k)
      if (const Offset i = key(k); from <= i && i < to) ++result.begin[i + 1];
  });
  result.begin = begin_of_groups(std::move(result.begin));
  result.members.resize(static_cast<std::size_t>(count));
  std::vector<Offset> fill(result.begin.begin(), result.begin.end() - 1);
  for_key_ranges(keys, threads, [&](Offset from, Offset to) {
    for (Offset k = 0; k < count; ++k)
      if (const Offset i = key(k); from <= i && i < to) result.members[fill[i]++] = k;
  });
  return result;
}

}  // namespace ahm::detail
