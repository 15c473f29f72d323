// SPDX-License-Identifier: Apache-2.0
#include "protocol/mocap/osc_out.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "protocol/messages/limits.h"
#include "protocol/mocap/osc.h"

namespace furrow::protocol::mocap {
namespace {

constexpr std::string_view kBlendValue = "/VMC/Ext/Blend/Val";
constexpr std::string_view kBlendApply = "/VMC/Ext/Blend/Apply";
constexpr std::size_t kElementPrefixBytes = 4;

std::string AddressPart(std::string_view name) {
  constexpr std::string_view kForbidden = " #*,/?[]{}";
  std::string part(name);
  std::replace_if(
      part.begin(), part.end(),
      [kForbidden](char c) {
        return kForbidden.find(c) != std::string_view::npos || static_cast<unsigned char>(c) < ' ';
      },
      '_');
  return part;
}

}  // namespace

OscWeightWriter::OscWeightWriter(OscProfile profile, std::string prefix)
    : profile_(profile), prefix_(std::move(prefix)) {}

void OscWeightWriter::SetNames(const std::string& subject, std::span<const std::string> names) {
  addresses_.clear();
  const std::string base = prefix_ + "/" + AddressPart(subject) + "/";
  frame_address_ = base + "frame";
  for (const std::string& name : names) {
    addresses_.push_back(profile_ == OscProfile::kVmc ? name : base + AddressPart(name));
  }
}

std::size_t OscWeightWriter::MessageBytes(const std::string& address) const {
  const bool vmc = profile_ == OscProfile::kVmc;
  const std::size_t addressed =
      vmc ? OscStringBytes(kBlendValue.size()) + OscStringBytes(address.size())
          : OscStringBytes(address.size());
  return kElementPrefixBytes + addressed + OscStringBytes(vmc ? 3 : 2) + sizeof(float);
}

std::size_t OscWeightWriter::MarkBytes() const {
  return profile_ == OscProfile::kVmc
             ? kElementPrefixBytes + OscStringBytes(kBlendApply.size()) + OscStringBytes(1)
             : kElementPrefixBytes + OscStringBytes(frame_address_.size()) + OscStringBytes(3) +
                   sizeof(std::int32_t) + sizeof(std::int64_t);
}

void OscWeightWriter::Write(std::uint32_t sequence, std::int64_t capture_time_us,
                            std::span<const float> values, const Emit& emit) {
  const bool vmc = profile_ == OscProfile::kVmc;
  OscWriter writer(datagram_);
  writer.BeginBundle();
  // Sizes are computed before writing, because a message cannot be split over two bundles.
  const auto make_room = [&](std::size_t bytes) {
    if (datagram_.size() + bytes <= kMaxDatagramBytes) return;
    emit(datagram_);
    datagram_.clear();
    writer.BeginBundle();
  };
  for (std::size_t i = 0; i < std::min(values.size(), addresses_.size()); ++i) {
    make_room(MessageBytes(addresses_[i]));
    writer.BeginMessage(vmc ? kBlendValue : std::string_view(addresses_[i]), vmc ? "sf" : "f");
    if (vmc) writer.String(addresses_[i]);
    writer.Float(values[i]);
    writer.EndMessage();
  }
  make_room(MarkBytes());
  writer.BeginMessage(vmc ? kBlendApply : std::string_view(frame_address_), vmc ? "" : "ih");
  if (!vmc) {
    writer.Int(static_cast<std::int32_t>(sequence));
    writer.Int64(capture_time_us);
  }
  writer.EndMessage();
  emit(datagram_);
}

}  // namespace furrow::protocol::mocap
