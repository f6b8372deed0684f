/// What one core can do at best: vector multiply-adds a second on the widest SIMD target, single
/// and double precision, and bytes a second from each cache. The roofline of README.md in this
/// folder.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/bench/core_bench.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kChains = 16;  // more than a multiply-add's latency times its units

/// `rounds` times kChains independent multiply-adds; returns how many values a vector has.
template <typename T>
std::size_t multiply_adds(std::size_t rounds, T* HWY_RESTRICT out) {
  const hn::ScalableTag<T> d;
  using V = hn::Vec<decltype(d)>;
  V chains[kChains];
  for (int k = 0; k < kChains; ++k) chains[k] = hn::Set(d, static_cast<T>(k));
  const V factor = hn::Set(d, static_cast<T>(0.999));
  const V term = hn::Set(d, static_cast<T>(0.001));
  for (std::size_t n = 0; n < rounds; ++n) {
    HWY_UNROLL(16)
    for (V& chain : chains) chain = hn::MulAdd(chain, factor, term);
  }
  V sum = chains[0];
  for (int k = 1; k < kChains; ++k) sum = sum + chains[k];
  hn::StoreU(sum, d, out);
  return hn::Lanes(d);
}

std::size_t single_precision(std::size_t rounds, float* out) { return multiply_adds(rounds, out); }
std::size_t double_precision(std::size_t rounds, double* out) { return multiply_adds(rounds, out); }

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <benchmark/benchmark.h>

#include <numeric>
#include <vector>

namespace sluice {
namespace {

HWY_EXPORT(single_precision);
HWY_EXPORT(double_precision);

constexpr std::size_t kRounds = 10000;
constexpr int kChainCount = 16;

template <typename T, class Body>
void measure_multiply_adds(benchmark::State& state, const Body& body) {
  T out[64] = {};
  std::size_t lanes = 0;
  for ([[maybe_unused]] const auto& round : state) {
    lanes = body(kRounds, out);
    benchmark::DoNotOptimize(out);
  }
  using benchmark::Counter;
  const double vectors = static_cast<double>(kRounds * kChainCount);
  state.counters["vectors/s"] = Counter(vectors, Counter::kIsIterationInvariantRate);
  state.counters["flop/s"] =
      Counter(2.0 * vectors * static_cast<double>(lanes), Counter::kIsIterationInvariantRate);
}

void single(benchmark::State& state) {
  measure_multiply_adds<float>(state, [](std::size_t rounds, float* out) {
    return HWY_DYNAMIC_DISPATCH(single_precision)(rounds, out);
  });
}
BENCHMARK(single)->Name("multiply-adds/single");

void twofold(benchmark::State& state) {
  measure_multiply_adds<double>(state, [](std::size_t rounds, double* out) {
    return HWY_DYNAMIC_DISPATCH(double_precision)(rounds, out);
  });
}
BENCHMARK(twofold)->Name("multiply-adds/double");

/// Reads and writes of an array of so many KiB.
void stream(benchmark::State& state) {
  std::vector<double> values(static_cast<std::size_t>(state.range(0)) * 1024 / sizeof(double), 1.0);
  for ([[maybe_unused]] const auto& round : state) {
    for (double& value : values) value = value * 0.999 + 0.001;
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) *
                          static_cast<std::int64_t>(2 * sizeof(double) * values.size()));
}
BENCHMARK(stream)->Arg(24)->Arg(1024)->Arg(16 * 1024)->Arg(256 * 1024);

}  // namespace
}  // namespace sluice

BENCHMARK_MAIN();
#endif
