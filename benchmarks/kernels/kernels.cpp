#include "kernels/kernels.hpp"

#include <benchmark/benchmark.h>

#include "ahm/cholesky/cholesky.hpp"
#include "ahm/heat/heat_operators.hpp"

namespace ahm::bench {

int run_kernels(std::vector<std::string> options) {
  options.insert(options.begin(), "ahm-bench kernels");
  std::vector<char*> argv;
  for (std::string& option : options) argv.push_back(option.data());
  int argc = static_cast<int>(argv.size());
  benchmark::Initialize(&argc, argv.data());
  if (benchmark::ReportUnrecognizedArguments(argc, argv.data())) return 1;
  benchmark::AddCustomContext("registers", register_set());
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace ahm::bench
