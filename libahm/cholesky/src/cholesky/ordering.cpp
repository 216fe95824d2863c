#include "cholesky/ordering.hpp"

#include <amd.h>
#include <cholmod.h>

#include <limits>
#include <mutex>
#include <string>

#include "ahm/error.hpp"

namespace ahm {
namespace {

constexpr const char* out_of_memory = "symbolic analysis: out of memory in the ordering";
constexpr const char* no_order =
    "symbolic analysis: METIS returned no ordering: out of memory, or interrupted by a signal";

std::vector<std::int32_t> by_minimum_degree(const SparseUpper& pattern) {
  if (pattern.rows.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw ResourceExhausted("symbolic analysis: the matrix is too large for the 32-bit ordering");
  const std::vector<std::int32_t> begin(pattern.column_begin.begin(), pattern.column_begin.end()),
      rows(pattern.rows.begin(), pattern.rows.end());
  std::vector<std::int32_t> order(static_cast<std::size_t>(pattern.size()));
  const int status =
      amd_order(static_cast<std::int32_t>(pattern.size()), begin.data(), rows.data(), order.data(), nullptr, nullptr);
  if (status == AMD_OUT_OF_MEMORY) throw ResourceExhausted(out_of_memory);
  if (status != AMD_OK) throw Error("symbolic analysis: AMD failed with status " + std::to_string(status));
  return order;
}

/// Owns CHOLMOD's workspace.
class Common {
 public:
  Common() {
    cholmod_l_start(&common_);
    common_.print = 0;  // libahm does not print
  }
  ~Common() { cholmod_l_finish(&common_); }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;
  cholmod_common* get() { return &common_; }

 private:
  cholmod_common common_;
};

bool is_permutation(const std::vector<Offset>& order) {
  std::vector<bool> seen(order.size(), false);
  for (const Offset row : order) {
    if (row < 0 || row >= static_cast<Offset>(order.size()) || seen[row]) return false;
    seen[row] = true;
  }
  return true;
}

std::vector<std::int32_t> by_nested_dissection(const SparseUpper& pattern) {
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(pattern.size());
  view.nzmax = pattern.rows.size();
  view.p = const_cast<Offset*>(pattern.column_begin.data());
  view.i = const_cast<Offset*>(pattern.rows.data());
  view.stype = 1;
  view.itype = CHOLMOD_LONG;
  view.xtype = CHOLMOD_PATTERN;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = 1;
  // METIS seeds and uses the random number generator of the process. Concurrent calls would make the ordering irreproducible.
  static std::mutex mutex;
  const std::scoped_lock lock(mutex);
  Common common;
  std::vector<Offset> order(view.nrow);
  const bool done = cholmod_l_metis(&view, nullptr, 0, 0, order.data(), common.get());
  if (common.get()->status == CHOLMOD_OUT_OF_MEMORY) throw ResourceExhausted(out_of_memory);
  if (!done || common.get()->status < 0)
    throw Error("symbolic analysis: METIS failed with status " + std::to_string(common.get()->status));
  if (!is_permutation(order)) throw ResourceExhausted(no_order);  // CHOLMOD does not check the return value of METIS
  return {order.begin(), order.end()};
}

}  // namespace

std::vector<std::int32_t> elimination_order(const SparseUpper& pattern, Ordering ordering) {
  return ordering == Ordering::amd ? by_minimum_degree(pattern) : by_nested_dissection(pattern);
}

std::string cholmod_version() {
  int version[3];
  cholmod_l_version(version);
  return std::to_string(version[0]) + "." + std::to_string(version[1]) + "." + std::to_string(version[2]);
}

}  // namespace ahm
