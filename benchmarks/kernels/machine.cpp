#include "machine.hpp"

namespace ahm::bench {
namespace {

Stream& stream() {
  static Stream arrays;
  return arrays;
}

void copy(benchmark::State& state) {
  Stream& arrays = stream();
  for (auto _ : state) {
    arrays.copy();
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(state.iterations() * 16 * static_cast<std::int64_t>(Stream::length));
}
BENCHMARK(copy)->Name("machine/copy")->Unit(benchmark::kMillisecond);

void triad(benchmark::State& state) {
  Stream& arrays = stream();
  for (auto _ : state) {
    arrays.triad();
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(state.iterations() * 24 * static_cast<std::int64_t>(Stream::length));
}
BENCHMARK(triad)->Name("machine/triad")->Unit(benchmark::kMillisecond);

void read(benchmark::State& state) {
  const Stream& arrays = stream();
  for (auto _ : state) benchmark::DoNotOptimize(arrays.read());
  state.SetBytesProcessed(state.iterations() * 8 * static_cast<std::int64_t>(Stream::length));
}
BENCHMARK(read)->Name("machine/read")->Unit(benchmark::kMillisecond);

}  // namespace

void report_bandwidth(benchmark::State& state, double bytes, double seconds) {
  state.counters["GB/s"] = 1e-9 * bytes / seconds;
  state.counters["of copy"] = bytes / seconds / copy_bandwidth();
}

void report_flops(benchmark::State& state, double flops, double seconds) {
  state.counters["GFlop/s"] = 1e-9 * flops / seconds;
  state.counters["of arithmetic"] = flops / seconds / arithmetic_speed();
}

}  // namespace ahm::bench
