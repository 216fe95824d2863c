#include "factor_size.hpp"

#include <cholmod.h>

namespace ahm::bench {

FactorSize factor_size(SparseUpper& pattern, Ordering ordering) {
  cholmod_common common;
  cholmod_l_start(&common);
  common.nmethods = 1;
  common.method[0].ordering = ordering == Ordering::amd ? CHOLMOD_AMD : CHOLMOD_METIS;
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(pattern.size());
  view.nzmax = pattern.rows.size();
  view.p = pattern.column_begin.data();
  view.i = pattern.rows.data();
  view.stype = view.sorted = view.packed = 1;
  view.itype = CHOLMOD_LONG;
  view.xtype = CHOLMOD_PATTERN;
  cholmod_factor* L = cholmod_l_analyze(&view, &common);
  const FactorSize result{common.lnz, common.fl};
  cholmod_l_free_factor(&L, &common);
  cholmod_l_finish(&common);
  return result;
}

}  // namespace ahm::bench
