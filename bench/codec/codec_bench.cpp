// SPDX-License-Identifier: Apache-2.0
// Measures reading and writing of poses and weights. Compares the codec with a copy of the same
// bytes and with plain FlatBuffers, which checks neither counts nor numbers and unpacks nothing.
// Poses rotate every joint and move the root, as a performer does.
#include <span>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/codec/messages.h"
#include "bench/codec/plain_flatbuffers.h"
#include "protocol/codec/codec.h"
#include "tests/unit/protocol/samples.h"

namespace furrow::protocol::bench {
namespace {

constexpr int kWeights = 37;  // in the default character's rig

PoseEncoding EncodingOf(const benchmark::State& state) {
  return state.range(1) != 0 ? PoseEncoding::Small() : PoseEncoding{};
}

// Poses of range(0) joints.
std::vector<PoseFrame> Poses(const benchmark::State& state) {
  std::vector<PoseFrame> poses;
  for (std::uint32_t seed = 0; seed < Ring<PoseFrame>::kSize; ++seed) {
    PoseFrame& pose = poses.emplace_back(test::MakePose(static_cast<int>(state.range(0)), 0, seed));
    pose.translation_joints = {0};
    pose.translations.resize(1);
  }
  return poses;
}

// Weights in the format range(0).
std::vector<WeightFrame> Weights(const benchmark::State& state) {
  std::vector<WeightFrame> frames(Ring<WeightFrame>::kSize);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].names_hash = 7;
    frames[i].format = state.range(0) != 0 ? WeightFormat::kU8 : WeightFormat::kF32;
    for (std::size_t k = 0; k < kWeights; ++k) {
      frames[i].values.push_back(static_cast<float>((i * 5 + k * 3) % 17) / 17.0f);
    }
  }
  return frames;
}

template <class Frame, class... Options>
std::vector<Bytes> Encoded(const std::vector<Frame>& frames, const Options&... options) {
  std::vector<Bytes> messages;
  for (const Frame& frame : frames) messages.push_back(test::Encoded(frame, options...));
  return messages;
}

Ring<Bytes> PoseMessages(const benchmark::State& state) {
  return Ring(Encoded(Poses(state), EncodingOf(state)));
}
Ring<Bytes> WeightMessages(const benchmark::State& state) { return Ring(Encoded(Weights(state))); }

// `use` returns false if it rejects a message. Only the first message may allocate.
template <class Use>
void ForEach(benchmark::State& state, Ring<Bytes> messages, const Use& use) {
  const auto size = static_cast<std::int64_t>(messages.front().size());
  bool ok = use(messages.front());
  const Allocations allocations;
  for (auto _ : state) {
    ok = use(messages.Next()) && ok;
    benchmark::ClobberMemory();
  }
  if (!ok) state.SkipWithError("refused");
  allocations.Refuse(state);
  state.SetBytesProcessed(state.iterations() * size);
}

std::span<const std::uint8_t> PayloadOf(const Bytes& message) {
  return std::span(message).subspan(kEnvelopeBytes);
}

template <class Frame>
void Read(benchmark::State& state, Ring<Bytes> messages) {
  Frame frame;
  ForEach(state, std::move(messages), [&frame](const Bytes& message) {
    return test::OpenAndDecode(message, frame) == DecodeStatus::kOk;
  });
}

template <class Plain>
void ReadPlain(benchmark::State& state, Ring<Bytes> messages) {
  Plain plain;
  ForEach(state, std::move(messages),
          [&plain](const Bytes& message) { return ReadPlainly(PayloadOf(message), plain); });
}

template <class Frame, class... Options>
void Write(benchmark::State& state, Ring<Frame> frames, const Options&... options) {
  Encoder encoder;
  Bytes message;
  encoder.Encode(test::kHeader, frames.front(), message, options...);
  const Allocations allocations;
  for (auto _ : state) {
    encoder.Encode(test::kHeader, frames.Next(), message, options...);
    benchmark::DoNotOptimize(message.data());
    benchmark::ClobberMemory();
  }
  allocations.Refuse(state);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(message.size()));
}

void BM_CopyPose(benchmark::State& state) { CopyMessages(state, PoseMessages(state)); }
void BM_CopyPoseAgain(benchmark::State& state) { CopyMessages(state, PoseMessages(state)); }
void BM_VerifyPlainPose(benchmark::State& state) {
  ForEach(state, PoseMessages(state),
          [](const Bytes& message) { return VerifyPlainly(PayloadOf(message)); });
}
void BM_ReadPlainPose(benchmark::State& state) { ReadPlain<PlainPose>(state, PoseMessages(state)); }
void BM_DecodePose(benchmark::State& state) { Read<PoseFrame>(state, PoseMessages(state)); }
void BM_EncodePose(benchmark::State& state) { Write(state, Ring(Poses(state)), EncodingOf(state)); }

void BM_CopyWeights(benchmark::State& state) { CopyMessages(state, WeightMessages(state)); }
void BM_ReadPlainWeights(benchmark::State& state) {
  ReadPlain<PlainWeights>(state, WeightMessages(state));
}
void BM_DecodeWeights(benchmark::State& state) { Read<WeightFrame>(state, WeightMessages(state)); }
void BM_EncodeWeights(benchmark::State& state) { Write(state, Ring(Weights(state))); }

void PoseArgs(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"joints", "packed"})->ArgsProduct({{51, 60, 163}, {0, 1}});
}
void WeightArgs(benchmark::internal::Benchmark* bench) { bench->ArgName("u8")->Arg(0)->Arg(1); }

BENCHMARK(BM_CopyPose)->Apply(PoseArgs);
BENCHMARK(BM_CopyPoseAgain)->Apply(PoseArgs);
BENCHMARK(BM_VerifyPlainPose)->Apply(PoseArgs);
BENCHMARK(BM_ReadPlainPose)->Apply(PoseArgs);
BENCHMARK(BM_DecodePose)->Apply(PoseArgs);
BENCHMARK(BM_EncodePose)->Apply(PoseArgs);
BENCHMARK(BM_CopyWeights)->Apply(WeightArgs);
BENCHMARK(BM_ReadPlainWeights)->Apply(WeightArgs);
BENCHMARK(BM_DecodeWeights)->Apply(WeightArgs);
BENCHMARK(BM_EncodeWeights)->Apply(WeightArgs);

}  // namespace
}  // namespace furrow::protocol::bench
