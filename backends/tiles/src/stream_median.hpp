/// \file
/// Medians of sequences that do not fit into memory.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "ahm/error.hpp"

namespace ahm::tiles {

/// An integer key that sorts as the double does.
inline std::uint64_t sort_key(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value + 0.0);  // maps -0.0 to 0.0
  return bits >> 63 ? ~bits : bits | std::uint64_t{1} << 63;
}

/// The number at index size / 2 of the sorted sequence, as by `std::nth_element`. Reads the sequence several times: histograms of
/// leading bits narrow the range until the remaining numbers fit into memory. Repeat `begin`, `add` for all numbers, `end` until `done`.
class StreamMedian {
 public:
  /// @param size  length of the sequence
  /// @param most  largest number of values in memory
  explicit StreamMedian(std::uint64_t size, std::size_t most = std::size_t{1} << 22) : rank_(size / 2), most_(most) {
    left_ = size;
    done_ = size == 0;
  }
  bool done() const { return done_; }
  double value() const { return value_; }

  void begin() {
    collect_ = left_ <= most_ || known_ == 64;
    kept_.clear();
    if (!collect_) counts_.assign(std::size_t{1} << width(), 0);
  }
  void add(double value) {
    const std::uint64_t key = sort_key(value);
    if (known_ > 0 && key >> (64 - known_) != prefix_) return;
    if (!collect_)
      ++counts_[(key << known_) >> (64 - width())];
    else if (kept_.size() < most_)
      kept_.push_back(value);
  }
  void end() {
    if (collect_) {
      if (kept_.size() != std::min<std::uint64_t>(left_, most_))
        throw IoError("the input changed while it was read; run the command again");
      const std::uint64_t at = known_ == 64 ? 0 : rank_;  // with all 64 bits known, all remaining numbers are equal
      std::nth_element(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(at), kept_.end());
      value_ = kept_[at];
      kept_ = {};
      done_ = true;
      return;
    }
    std::size_t bucket = 0;
    while (bucket + 1 < counts_.size() && rank_ >= counts_[bucket]) rank_ -= counts_[bucket++];
    left_ = counts_[bucket];
    const unsigned taken = width();
    prefix_ = known_ == 0 ? bucket : prefix_ << taken | bucket;
    known_ += taken;
    counts_ = {};
  }

 private:
  unsigned width() const { return std::min(20u, 64 - known_); }

  std::uint64_t rank_, left_, prefix_ = 0;
  std::size_t most_;
  unsigned known_ = 0;  ///< number of leading bits that are known
  bool collect_ = false, done_ = false;
  double value_ = 0;
  std::vector<std::uint64_t> counts_;
  std::vector<double> kept_;
};

}  // namespace ahm::tiles
