// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace furrow::protocol::mocap {

// The form of the messages: address, type tags, arguments.
enum class OscProfile : std::uint8_t {
  kFurrow = 0,  // /furrow/<subject>/<weight> ,f value ... /furrow/<subject>/frame ,ih sequence time
  kVmc,         // /VMC/Ext/Blend/Val ,sf name value ... /VMC/Ext/Blend/Apply ,
};

// Writes the weights of one subject as OSC bundles of at most kMaxDatagramBytes, one per datagram.
// The last message of the last bundle ("frame", "Apply") marks the end of the frame. Does not
// allocate after SetNames() and a first frame.
class OscWeightWriter {
 public:
  using Emit = std::function<void(std::span<const std::uint8_t> datagram)>;

  // `prefix`: start of the addresses without a trailing slash, for kFurrow only.
  explicit OscWeightWriter(OscProfile profile = OscProfile::kFurrow,
                           std::string prefix = "/furrow");

  // Sets the subject and the names of the values that Write() receives. For kFurrow, replaces the
  // characters that OSC addresses forbid (space # * , / ? [ ] { } and control characters) by '_'.
  // Keeps non-ASCII UTF-8, so subjects in other scripts stay distinct.
  void SetNames(const std::string& subject, std::span<const std::string> names);

  // Writes one message per value and the end mark. Surplus values or names are left out. Calls
  // `emit` once per datagram, which is valid during the call. kVmc ignores the first two arguments,
  // the pose's sequence and capture time.
  void Write(std::uint32_t sequence, std::int64_t capture_time_us, std::span<const float> values,
             const Emit& emit);

 private:
  // Sizes as bundle elements.
  [[nodiscard]] std::size_t MessageBytes(const std::string& address) const;
  [[nodiscard]] std::size_t MarkBytes() const;

  OscProfile profile_;
  std::string prefix_;
  std::string frame_address_;
  std::vector<std::string> addresses_;  // kVmc: the names
  std::vector<std::uint8_t> datagram_;
};

}  // namespace furrow::protocol::mocap
