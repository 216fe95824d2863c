/// \file
/// A queue sorted as far as buckets go, whose items lie in chunks of a pool: what windows are kept in.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

namespace ahm::exact {

/// Items by ascending key, in any order within a bucket [XWLLH15]. Keys more than the ring of buckets ahead wait in its last
/// bucket: they come too early, which costs the algorithm time and nothing else. Memory grows by chunks and is used again.
template <class Item>
class BucketQueue {
 public:
  static constexpr std::uint32_t per_chunk = 42, ring = 4096, none = ~0u;
  struct Chunk {
    std::uint32_t count = 0, next = none;
    Item items[per_chunk];
  };

  explicit BucketQueue(double width) : inverse_width_(1 / width), first_(ring, none) {}

  void push(double key, const Item& item) {
    std::uint32_t& head = first_[slot(key)];
    if (head == none || chunks_[head]->count == per_chunk) {
      const std::uint32_t fresh = take();
      chunks_[fresh]->next = head;
      head = fresh;
    }
    Chunk& chunk = *chunks_[head];
    chunk.items[chunk.count++] = item;
    ++size_;
  }

  bool empty() const { return size_ == 0; }
  /// The lower end of the current bucket.
  double key() const { return static_cast<double>(bucket_) / inverse_width_; }
  bool bucket_empty() const { return first_[bucket_ % ring] == none; }
  /// Goes on to the next bucket.
  void advance() { ++bucket_; }

  /// Takes the chunk on top of the current bucket out and calls visit(item) for its items; pushing meanwhile is fine.
  template <class Visit>
  void drain_chunk(const Visit& visit) {
    std::uint32_t& head = first_[bucket_ % ring];
    const std::uint32_t taken = head;
    head = chunks_[taken]->next;
    size_ -= chunks_[taken]->count;
    const Chunk& chunk = *chunks_[taken];
    for (std::uint32_t k = 0; k < chunk.count; ++k) visit(chunk.items[k]);
    chunks_[taken]->next = free_;
    free_ = taken;
  }

  std::size_t bytes() const { return chunks_.size() * sizeof(Chunk) + first_.size() * sizeof(std::uint32_t); }

 private:
  std::size_t slot(double key) const {
    const double position = key * inverse_width_;
    const auto last = bucket_ + ring - 1;
    const auto bucket = position < static_cast<double>(last) ? static_cast<std::uint64_t>(position) : last;
    return std::max(bucket, bucket_) % ring;
  }
  std::uint32_t take() {
    if (free_ == none) {
      chunks_.push_back(std::make_unique_for_overwrite<Chunk>());
      return static_cast<std::uint32_t>(chunks_.size() - 1);
    }
    const std::uint32_t taken = free_;
    free_ = chunks_[taken]->next;
    chunks_[taken]->count = 0;
    return taken;
  }

  double inverse_width_;
  std::uint64_t bucket_ = 0;
  std::vector<std::uint32_t> first_;  ///< per bucket of the ring
  std::vector<std::unique_ptr<Chunk>> chunks_;
  std::uint32_t free_ = none;
  std::uint64_t size_ = 0;
};

}  // namespace ahm::exact
