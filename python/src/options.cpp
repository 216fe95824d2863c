#include "options.hpp"

namespace ahm::python {

void read_variant(const py::dict& options, Variant& variant) {
  read_choice(options, "variant", variant, {{"adaptive", Variant::adaptive}, {"localized", Variant::localized}});
}

HeatOptions heat_options(const py::dict& options) {
  HeatOptions o;
  read(options, "t_coef", o.t_coef);
  read_variant(options, o.variant);
  read(options, "order", o.order);
  read_choice(options, "strategy", o.strategy,
              {{"automatic", Strategy::automatic}, {"global", Strategy::global}, {"march", Strategy::march}});
  read(options, "expected_maps", o.expected_maps);
  read(options, "memory", o.memory);
  read(options, "accuracy", o.accuracy);
  read_choice(options, "ordering", o.ordering,
              {{"amd", Ordering::amd}, {"nested_dissection", Ordering::nested_dissection}});
  read(options, "supernodal", o.supernodal);
  read(options, "threads", o.threads);
  return o;
}

}  // namespace ahm::python
