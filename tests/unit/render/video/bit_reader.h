// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace furrow::test {

// One NAL unit of an Annex B stream, without start code and emulation prevention.
struct NalUnit {
  int type = 0;                    // nal_unit_type, ITU-T H.264 table 7-1
  std::vector<std::uint8_t> rbsp;  // after the header byte
};

// Splits a stream at its start codes (ITU-T H.264, annex B).
inline std::vector<NalUnit> SplitNalUnits(const std::vector<std::uint8_t>& bytes) {
  std::vector<NalUnit> units;
  int zeros = 0;
  bool is_header = false;
  for (const std::uint8_t byte : bytes) {
    if (zeros >= 2 && byte == 1) {
      if (!units.empty()) {  // the zeros belong to the start code
        auto& rbsp = units.back().rbsp;
        while (!rbsp.empty() && rbsp.back() == 0) rbsp.pop_back();
      }
      units.emplace_back();
      is_header = true;
    } else if (is_header) {
      units.back().type = byte & 0x1F;
      is_header = false;
    } else if (!units.empty() && !(zeros >= 2 && byte == 3)) {
      units.back().rbsp.push_back(byte);
    }
    zeros = byte == 0 ? zeros + 1 : 0;
  }
  return units;
}

// Reads fields of a NAL unit (ITU-T H.264, section 7.2). Beyond the end, all bits are 0.
class BitReader {
 public:
  explicit BitReader(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}
  unsigned Bits(int count) {
    unsigned value = 0;
    for (int i = 0; i < count; ++i, ++at_) {
      const unsigned bit = at_ / 8 < bytes_.size() ? bytes_[at_ / 8] >> (7 - at_ % 8) & 1u : 0u;
      value = value << 1 | bit;
    }
    return value;
  }
  bool Flag() { return Bits(1) == 1; }
  // ue(v), Exp-Golomb.
  unsigned Ue() {
    int zeros = 0;
    while (zeros < 31 && !Flag()) ++zeros;
    return (1u << zeros) - 1 + Bits(zeros);
  }

 private:
  const std::vector<std::uint8_t>& bytes_;
  std::size_t at_ = 0;
};

}  // namespace furrow::test
