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

// Cycles through many messages of one kind, so that the branch predictor cannot learn them.
// Together they exceed a first-level cache and fit a second-level cache.
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

// Counts calls of operator new until Report() or Refuse().
class Allocations {
 public:
  Allocations() : before_(furrow::test::NumAllocations()) {}
  // Per message.
  void Report(benchmark::State& state) const {
    state.counters["allocations"] =
        static_cast<double>(Count()) / static_cast<double>(state.iterations());
  }
  // A single allocation fails the benchmark.
  void Refuse(benchmark::State& state) const {
    if (Count() > 0) state.SkipWithError("allocates");
  }

 private:
  [[nodiscard]] std::uint64_t Count() const { return furrow::test::NumAllocations() - before_; }

  std::uint64_t before_;
};

// The cost of memory access alone: copies the same bytes to one buffer.
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
