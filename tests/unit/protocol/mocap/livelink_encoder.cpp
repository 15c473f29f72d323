// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/protocol/mocap/livelink_encoder.h"

#include <cstring>

namespace furrow::protocol::test {
namespace {

void AppendInt(Bytes& out, std::uint32_t value) {
  out.push_back(static_cast<std::uint8_t>(value >> 24));
  out.push_back(static_cast<std::uint8_t>(value >> 16));
  out.push_back(static_cast<std::uint8_t>(value >> 8));
  out.push_back(static_cast<std::uint8_t>(value));
}

void AppendFloat(Bytes& out, float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  AppendInt(out, bits);
}

void AppendText(Bytes& out, const std::string& text) {
  AppendInt(out, static_cast<std::uint32_t>(text.size()));
  out.insert(out.end(), text.begin(), text.end());
}

}  // namespace

Bytes LiveLinkPacket::Encode() const {
  Bytes out = {static_cast<std::uint8_t>(version)};
  AppendText(out, device);
  AppendText(out, subject);
  AppendInt(out, static_cast<std::uint32_t>(frame));
  AppendFloat(out, subframe);
  AppendInt(out, static_cast<std::uint32_t>(rate_numerator));
  AppendInt(out, static_cast<std::uint32_t>(rate_denominator));
  if (values.empty()) return out;
  out.push_back(static_cast<std::uint8_t>(values.size()));
  for (const float value : values) AppendFloat(out, value);
  return out;
}

}  // namespace furrow::protocol::test
