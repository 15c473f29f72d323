// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "tests/unit/allocation_counter.h"

namespace furrow::protocol::bench {

using Bytes = std::vector<std::uint8_t>;

// Many of a kind, one after the other and round again, so that no branch is learnt by heart. What
// they fill is above a first-level cache and within a second-level one.
template <class T>
class Ring {
 public:
  static constexpr std::size_t kSize = 64;

  explicit Ring(std::vector<T> items) : items_(std::move(items)) {}
  [[nodiscard]] const T& Next() { return items_[next_++ % items_.size()]; }
  [[nodiscard]] const T& front() const { return items_.front(); }

 private:
  std::vector<T> items_;
  std::size_t next_ = 0;
};

// How often the loop calls operator new, by message; counts from here to Report().
class Allocations {
 public:
  Allocations() : before_(furrow::test::NumAllocations()) {}
  // Where none are allowed, one is an error of the benchmark.
  void Report(benchmark::State& state, bool allowed = false) const {
    const auto count = static_cast<double>(furrow::test::NumAllocations() - before_);
    state.counters["allocations"] = count / static_cast<double>(state.iterations());
    if (!allowed && count > 0.0) state.SkipWithError("allocates");
  }

 private:
  std::uint64_t before_;
};

// What memory alone costs: the same bytes, into one place.
inline void CopyMessages(benchmark::State& state, Ring<Bytes> messages) {
  Bytes copy(messages.front().size());
  for (auto _ : state) {
    const Bytes& message = messages.Next();
    std::copy(message.begin(), message.end(), copy.begin());
    benchmark::DoNotOptimize(copy.data());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(copy.size()));
}

}  // namespace furrow::protocol::bench
