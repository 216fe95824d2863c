/// \file
/// Replaces `malloc` and its relatives for the whole process, including `operator new` and all libraries. Counts allocations and makes
/// them fail.
#pragma once

namespace ahm::test {

/// While it exists, allocation k = 1, 2, ... of all threads fails; with `ever_after`, all later ones fail, too.
class FailingAllocation {
 public:
  explicit FailingAllocation(long k, bool ever_after = false);
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;

  /// Whether an allocation failed.
  bool happened() const;
};

/// Blocks allocated and not freed.
long live_blocks();
/// Blocks allocated so far, freed or not.
long allocations();

/// The largest number of bytes in use at a time while it exists, minus those in use before.
class PeakBytes {
 public:
  PeakBytes();
  long operator()() const;

 private:
  long before_;
};

}  // namespace ahm::test
