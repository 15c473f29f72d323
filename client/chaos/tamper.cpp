// SPDX-License-Identifier: Apache-2.0
#include "client/chaos/tamper.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <utility>

#include "protocol/codec/codec.h"
#include "protocol/framing/bundle.h"

namespace furrow::chaos {
namespace {

using protocol::DecodeStatus;
using protocol::MessageKind;
using Bytes = std::vector<std::uint8_t>;

// The message of a datagram, or the messages of a bundle.
// Copies, because the callers change messages and put them together again.
std::vector<Bytes> TakeApart(std::span<const std::uint8_t> datagram) {
  Bytes copy(datagram.begin(), datagram.end());
  protocol::Unbundler unbundler;
  (void)unbundler.Open(copy);
  std::vector<Bytes> messages;
  std::span<const std::uint8_t> message;
  while (unbundler.Next(message)) messages.emplace_back(message.begin(), message.end());
  return messages;
}

// A single message may be larger than a datagram; a bundle may not.
bool PutTogether(std::span<const Bytes> messages, Bytes* datagram) {
  Bytes bytes;
  if (messages.size() == 1) {
    *datagram = messages.front();
    return true;
  }
  if (!protocol::WriteBundle(messages, bytes)) return false;
  *datagram = std::move(bytes);
  return true;
}

// Opens a whole pose or weights message; false for all others.
bool OpenTamperable(std::span<const std::uint8_t> message, protocol::MessageView* view) {
  return protocol::OpenMessage(message, *view) == DecodeStatus::kOk &&
         (view->kind == MessageKind::kPose || view->kind == MessageKind::kWeights);
}

// An index in [0, count) for a share in [0, 1).
std::size_t Choose(std::size_t count, double share) {
  return static_cast<std::size_t>(share * static_cast<double>(count));
}

// Moves the value by 0.5. A value in [0, 1] stays in [0, 1].
void FalsifyValue(float* value) { *value += *value < 0.5f ? 0.5f : -0.5f; }

bool FalsifyWeights(const protocol::MessageView& view, double share,
                    std::vector<std::uint8_t>* out) {
  protocol::WeightFrame frame;
  if (protocol::Decode(view, frame) != DecodeStatus::kOk || frame.values.empty()) return false;
  FalsifyValue(&frame.values[Choose(frame.values.size(), share)]);
  protocol::Encoder().Encode(view.header, frame, *out);
  return true;
}

// Multiplies by a rotation of 120 degrees about x: (1/2 + sqrt(3)/2 i).
// The result is still a unit quaternion, so the receiver's checks accept it.
void FalsifyRotation(protocol::Quat* rotation) {
  constexpr float kCosine = 0.5f;
  constexpr float kSine = 0.86602540378f;
  const protocol::Quat q = *rotation;
  *rotation = {kCosine * q.x + kSine * q.w, kCosine * q.y + kSine * q.z,
               kCosine * q.z - kSine * q.y, kCosine * q.w - kSine * q.x};
}

// Writes the pose in its former encoding, so that only one number changes. The encoding whose size
// is nearer to the former size wins.
void WritePose(const protocol::MessageView& view, const protocol::PoseFrame& frame, Bytes* out) {
  Bytes packed;
  protocol::Encoder encoder;
  encoder.Encode(view.header, frame, *out);
  encoder.Encode(view.header, frame, packed, protocol::PoseEncoding::Small());
  const auto off = [&view](const Bytes& message) {
    return std::abs(std::ssize(message) - std::ssize(view.payload) -
                    static_cast<std::ptrdiff_t>(protocol::kEnvelopeBytes));
  };
  if (off(packed) < off(*out)) *out = std::move(packed);
}

// Changes one joint or one blend shape. False: the pose has neither.
bool FalsifyPose(const protocol::MessageView& view, double share, std::vector<std::uint8_t>* out) {
  protocol::PoseFrame frame;
  if (protocol::Decode(view, frame) != DecodeStatus::kOk) return false;
  const std::size_t joints = frame.rotations.size();
  if (joints + frame.blend_shapes.size() == 0) return false;
  const std::size_t chosen = Choose(joints + frame.blend_shapes.size(), share);
  if (chosen < joints) {
    FalsifyRotation(&frame.rotations[chosen]);
  } else {
    FalsifyValue(&frame.blend_shapes[chosen - joints]);
  }
  WritePose(view, frame, out);
  return true;
}

bool FalsifyMessage(Bytes* message, double share) {
  protocol::MessageView view;
  if (!OpenTamperable(*message, &view)) return false;
  Bytes changed;
  const bool done = view.kind == MessageKind::kPose ? FalsifyPose(view, share, &changed)
                                                    : FalsifyWeights(view, share, &changed);
  if (done) *message = std::move(changed);
  return done;
}

// Exchanges payloads and keeps envelopes, so that only the weights themselves can reveal the swap.
bool SwapMessages(Bytes* a, Bytes* b) {
  protocol::MessageView first;
  protocol::MessageView second;
  if (!OpenTamperable(*a, &first) || !OpenTamperable(*b, &second) || first.kind != second.kind)
    return false;
  Bytes changed;
  protocol::WriteMessage(first.header, second.payload, changed);
  Bytes other;
  protocol::WriteMessage(second.header, first.payload, other);
  *a = std::move(changed);
  *b = std::move(other);
  return true;
}

}  // namespace

bool IsTamperable(std::span<const std::uint8_t> datagram) {
  return std::ranges::any_of(TakeApart(datagram), [](const Bytes& message) {
    protocol::MessageView view;
    return OpenTamperable(message, &view);
  });
}

bool Falsify(Bytes* datagram, double share) {
  std::vector<Bytes> messages = TakeApart(*datagram);
  const std::size_t first = Choose(messages.size(), share);
  // One random number chooses twice: the whole part of share * count the message, its fraction a
  // number in it.
  const double rest = share * static_cast<double>(messages.size()) - static_cast<double>(first);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    if (FalsifyMessage(&messages[(first + i) % messages.size()], rest))
      return PutTogether(messages, datagram);
  }
  return false;
}

bool SwapContents(Bytes* a, Bytes* b) {
  std::vector<Bytes> of_a = TakeApart(*a);
  std::vector<Bytes> of_b = TakeApart(*b);
  for (Bytes& first : of_a) {
    for (Bytes& second : of_b) {
      if (!SwapMessages(&first, &second)) continue;
      Bytes changed;
      // `a` changes last: if one bundle became too large, both stay as they were.
      if (!PutTogether(of_a, &changed) || !PutTogether(of_b, b)) return false;
      *a = std::move(changed);
      return true;
    }
  }
  return false;
}

}  // namespace furrow::chaos
