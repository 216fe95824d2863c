/// \file
/// An allocator of the whole process that counts what lives and fails when it is told to: `malloc` and its kin, and so
/// `operator new` and what every library allocates.
#pragma once

namespace ahm::test {

/// While it lives, allocation number k from 1 fails, of any thread; with `ever_after` all later ones too.
class FailingAllocation {
 public:
  explicit FailingAllocation(long k, bool ever_after = false);
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;

  /// Whether it came to that.
  bool happened() const;
};

/// Blocks allocated and not freed.
long live_blocks();
/// Blocks allocated so far, freed or not.
long allocations();

/// The most bytes that live at a time while it does, less those before.
class PeakBytes {
 public:
  PeakBytes();
  long operator()() const;

 private:
  long before_;
};

}  // namespace ahm::test
