#include "options.hpp"

#include "ahm/maps/log_map.hpp"

namespace ahm::python {

void read_variant(const py::dict& options, Variant& variant) {
  std::vector<std::pair<std::string, Variant>> choices;
  for (Variant each : all_variants) choices.emplace_back(to_string(each), each);
  read_choice(options, "variant", variant, choices);
}

HeatOptions heat_options(const py::dict& options) {
  HeatOptions o;
  read(options, "t_coef", o.t_coef);
  read_variant(options, o.variant);
  read_choice(options, "strategy", o.strategy,
              {{"automatic", Strategy::automatic}, {"global", Strategy::global}, {"march", Strategy::march}});
  read(options, "expected_maps", o.expected_maps);
  read(options, "memory", o.memory);
  read(options, "accuracy", o.accuracy);
  read_choice(
      options, "ordering", o.ordering,
      {{"auto", Ordering::automatic}, {"amd", Ordering::amd}, {"nested_dissection", Ordering::nested_dissection}});
  read(options, "threads", o.threads);
  return o;
}

}  // namespace ahm::python
