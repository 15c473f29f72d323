// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace furrow::protocol::mocap {

enum class OscProfile : std::uint8_t {
  kFurrow = 0,  // /furrow/<subject>/<weight> ,f value ... /furrow/<subject>/frame ,ih sequence time
  kVmc,         // /VMC/Ext/Blend/Val ,sf name value ... /VMC/Ext/Blend/Apply ,
};

// One subject's weights as OSC bundles of at most 1,200 bytes; the last message of the last bundle
// is the mark that the frame is whole. Does not allocate after SetNames() and a first frame.
class OscWeightWriter {
 public:
  using Emit = std::function<void(std::span<const std::uint8_t> datagram)>;

  // `prefix` without the trailing slash; for kFurrow alone.
  explicit OscWeightWriter(OscProfile profile = OscProfile::kFurrow,
                           std::string prefix = "/furrow");

  // Characters that OSC addresses may not have (space # * , / ? [ ] { } and controls) become '_';
  // UTF-8 beyond ASCII stays, so that subjects of other scripts stay apart.
  void SetNames(const std::string& subject, std::span<const std::string> names);

  // Writes min(values, names) messages and the mark. `emit` is called once a datagram.
  void Write(std::uint32_t sequence, std::int64_t capture_time_us, std::span<const float> values,
             const Emit& emit);

 private:
  // As bundle elements.
  [[nodiscard]] std::size_t MessageBytes(const std::string& address) const;
  [[nodiscard]] std::size_t MarkBytes() const;

  OscProfile profile_;
  std::string prefix_;
  std::string frame_address_;
  std::vector<std::string> addresses_;  // kVmc: the names
  std::vector<std::uint8_t> datagram_;
};

}  // namespace furrow::protocol::mocap
