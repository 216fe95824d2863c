/// \file
/// Things by a number that each of them has.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "ahm/types.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/unset_vector.hpp"

namespace ahm::detail {

/// Calls body(from, to) on a few ranges of [0, keys), as many as there are threads: each looks at all things, and takes those whose
/// key is in its range. So what lies in one range comes in order, and nobody waits.
template <class Body>
void for_key_ranges(Index keys, unsigned threads, const Body& body) {
  constexpr Offset most = 4;  // looking takes time, too
  const Offset ranges = std::min<Offset>(thread_count(threads), most);
  parallel_chunks(keys, std::max<Offset>(1, (keys + ranges - 1) / ranges), threads, body);
}

/// The places of keys in an array that holds all things of key 0, then those of key 1, ...
/// @param sizes  how many there are of key k: at k + 1
inline std::vector<Offset> starts_of(std::vector<Offset> sizes) {
  for (std::size_t k = 1; k < sizes.size(); ++k) sizes[k] += sizes[k - 1];
  return sizes;
}

/// The numbers of things, by their keys, and ascending.
struct Buckets {
  std::vector<Offset> begin;  ///< keys + 1
  UnsetVector<Offset> members;

  std::span<const Offset> of(Index key) const {
    return std::span(members).subspan(static_cast<std::size_t>(begin[key]),
                                      static_cast<std::size_t>(begin[key + 1] - begin[key]));
  }
};

/// @param key  of thing k, in [0, keys)
template <class Key>
Buckets buckets_of(Offset count, Index keys, unsigned threads, const Key& key) {
  Buckets result{std::vector<Offset>(static_cast<std::size_t>(keys) + 1, 0), {}};
  for_key_ranges(keys, threads, [&](Offset from, Offset to) {
    for (Offset k = 0; k < count; ++k)
      if (const Offset i = key(k); from <= i && i < to) ++result.begin[i + 1];
  });
  result.begin = starts_of(std::move(result.begin));
  result.members.resize(static_cast<std::size_t>(count));
  std::vector<Offset> fill(result.begin.begin(), result.begin.end() - 1);
  for_key_ranges(keys, threads, [&](Offset from, Offset to) {
    for (Offset k = 0; k < count; ++k)
      if (const Offset i = key(k); from <= i && i < to) result.members[fill[i]++] = k;
  });
  return result;
}

}  // namespace ahm::detail
