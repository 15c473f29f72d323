// SPDX-License-Identifier: Apache-2.0
// Measures fragmentation and reassembly of a message, compared with a copy of it: a pose of 163
// joints in floats, and skeleton offers of 163 joints and of the maximum.
#include <array>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/codec/messages.h"
#include "protocol/framing/fragment.h"
#include "protocol/messages/limits.h"
#include "tests/unit/protocol/samples.h"

namespace furrow::protocol::bench {
namespace {

// range(0): 0 for a pose of 163 joints, otherwise the number of joints in an offer.
Bytes Message(const benchmark::State& state) {
  const int joints = static_cast<int>(state.range(0));
  return joints == 0 ? test::Encoded(test::MakePose(163, 0, 1))
                     : test::Encoded(test::MakeOffer(joints, 0));
}

std::vector<Bytes> Cut(const Bytes& message) {
  std::vector<Bytes> datagrams(NumDatagrams(message.size()), Bytes(kMaxDatagramBytes));
  for (std::size_t i = 0; i < datagrams.size(); ++i)
    datagrams[i].resize(WriteDatagram(message, 1, i, datagrams[i]));
  return datagrams;
}

void Report(benchmark::State& state, const Bytes& message) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(message.size()));
  state.counters["datagrams"] = static_cast<double>(NumDatagrams(message.size()));
}

void BM_CopyFragmented(benchmark::State& state) {
  CopyMessages(state, Ring<Bytes>({Message(state)}));
}

void BM_Fragment(benchmark::State& state) {
  const Bytes message = Message(state);
  const std::size_t count = NumDatagrams(message.size());
  std::array<std::uint8_t, kMaxDatagramBytes> datagram;
  const Allocations allocations;
  for (auto _ : state) {
    for (std::size_t i = 0; i < count; ++i) {
      benchmark::DoNotOptimize(WriteDatagram(message, 1, i, datagram));
      benchmark::ClobberMemory();
    }
  }
  allocations.Refuse(state);
  Report(state, message);
}

// The last datagram of each message completes it.
void BM_Reassemble(benchmark::State& state) {
  const Bytes message = Message(state);
  const std::vector<Bytes> datagrams = Cut(message);
  Reassembler reassembler;
  std::span<const std::uint8_t> whole;
  const Allocations allocations;
  for (auto _ : state) {
    FragmentStatus status = FragmentStatus::kPending;
    for (const Bytes& datagram : datagrams) status = reassembler.Push({}, datagram, 0, whole);
    if (status != FragmentStatus::kComplete) {
      state.SkipWithError("the message is incomplete");
      break;
    }
  }
  allocations.Report(state);
  Report(state, message);
}

void MessageArgs(benchmark::internal::Benchmark* bench) {
  bench->ArgName("offered")->Arg(0)->Arg(163)->Arg(kMaxJoints);
}

BENCHMARK(BM_CopyFragmented)->Apply(MessageArgs);
BENCHMARK(BM_Fragment)->Apply(MessageArgs);
BENCHMARK(BM_Reassemble)->Apply(MessageArgs);

}  // namespace
}  // namespace furrow::protocol::bench
