// SPDX-License-Identifier: Apache-2.0
#include "bench/codec/plain_flatbuffers.h"

#include <algorithm>

#include <flatbuffers/flatbuffers.h>

#include "protocol/schema/pose_generated.h"
#include "protocol/schema/weights_generated.h"

namespace furrow::protocol::bench {
namespace {

using flatbuffers::uoffset_t;
using flatbuffers::Vector;

template <class Root>
const Root* Verified(std::span<const std::uint8_t> payload, const char* identifier) {
  flatbuffers::Verifier verifier(payload.data(), payload.size());
  if (!verifier.VerifyBuffer<Root>(identifier)) return nullptr;
  return flatbuffers::GetRoot<Root>(payload.data());
}

template <class Wire, class Out, class Read>
void CopyStructs(const Vector<const Wire*>* from, Out& out, const Read& read) {
  const uoffset_t count = from == nullptr ? 0 : from->size();
  for (uoffset_t i = 0; i < count; ++i) out[i] = read(*from->Get(i));
}

template <class T, class Out>
void CopyNumbers(const Vector<T>* from, Out& out) {
  if (from != nullptr) std::copy(from->begin(), from->end(), out.begin());
}

}  // namespace

bool ReadPlainly(std::span<const std::uint8_t> payload, PlainPose& pose) {
  const auto* root = Verified<wire::Pose>(payload, "FPOS");
  if (root == nullptr) return false;
  using Floats = std::array<float, 3>;
  using Quaternion = std::array<float, 4>;
  pose.skeleton_hash = root->skeleton_hash();
  pose.num_joints = root->num_joints();
  pose.translation_range = root->translation_range();
  CopyStructs(root->rotations(), pose.rotations, [](const wire::Quat& q) {
    return Quaternion{q.x(), q.y(), q.z(), q.w()};
  });
  CopyStructs(root->packed_rotations(), pose.packed_rotations, [](const wire::PackedQuat& q) {
    return std::array<std::uint16_t, 3>{q.low(), q.middle(), q.high()};
  });
  CopyStructs(root->translations(), pose.translations, [](const wire::Vec3& v) {
    return Floats{v.x(), v.y(), v.z()};
  });
  CopyStructs(root->packed_translations(), pose.packed_translations,
              [](const wire::PackedOffset& v) {
                return std::array<std::int16_t, 3>{v.x(), v.y(), v.z()};
              });
  CopyNumbers(root->rotation_mask(), pose.rotation_mask);
  CopyNumbers(root->translation_mask(), pose.translation_mask);
  return true;
}

bool ReadPlainly(std::span<const std::uint8_t> payload, PlainWeights& weights) {
  const auto* root = Verified<wire::Weights>(payload, "FWGT");
  if (root == nullptr) return false;
  weights.names_hash = root->names_hash();
  weights.age_us = root->age_us();
  CopyNumbers(root->values(), weights.values);
  CopyNumbers(root->packed_values(), weights.packed_values);
  return true;
}

bool VerifyPlainly(std::span<const std::uint8_t> pose_payload) {
  return Verified<wire::Pose>(pose_payload, "FPOS") != nullptr;
}

}  // namespace furrow::protocol::bench
