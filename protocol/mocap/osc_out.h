// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/time/timecode.h"

namespace furrow::protocol::mocap {

// An argument of a message.
enum class OscField : std::uint8_t {
  kName = 0,     // s: name of the weight
  kSubject,      // s
  kValue,        // f: the weight, in [0, 1]
  kSequence,     // i: sequence number of the pose
  kCaptureTime,  // h: capture time of the pose, microseconds
  kTimecode,     // s: "HH:MM:SS:FF" (TimecodeText()), "" if the source sends none
};

// A message with placeholders in its address:
//   {prefix}      the prefix of the writer
//   {subject}     name of the subject    } with '_' for the characters that OSC addresses forbid:
//   {name}        name of the weight     } space # * , / ? [ ] { } and control characters
//   {identifier}  name of the weight with '_' for everything but ASCII letters and digits
struct OscTemplate {
  std::string address;
  std::vector<OscField> arguments;
  friend bool operator==(const OscTemplate&, const OscTemplate&) = default;
};

// The form in which weights leave as OSC (docs/engines/osc.md). Data files describe profiles.
struct OscProfile {
  std::string name;
  OscTemplate value;                    // sent for each weight
  std::optional<OscTemplate> timecode;  // sent after the weights, if the source sends a timecode
  std::optional<OscTemplate> end;       // sent last in each frame
  // Other names for some weights: "brow_l.squash" -> "BrowDownLeft". If `only_renamed`, no other
  // weights are sent.
  std::map<std::string, std::string> names;
  bool only_renamed = false;
};

// The pose whose weights are sent.
struct OscFrame {
  std::uint32_t sequence = 0;
  std::int64_t capture_time_us = 0;
  std::optional<Timecode> timecode;
};

// Writes the weights of one subject as OSC bundles of at most kMaxDatagramBytes, one per datagram.
// Messages are never split over two bundles. Does not allocate after SetNames() and a first frame.
class OscWeightWriter {
 public:
  using Emit = std::function<void(std::span<const std::uint8_t> datagram)>;

  // `profile` outlives the writer. `prefix`: without slashes at its ends.
  explicit OscWeightWriter(const OscProfile* profile, std::string prefix = "furrow")
      : profile_(profile), prefix_(std::move(prefix)) {}

  // Sets the subject and the names of the values that Write() receives. `pattern`: globs of the
  // names to send (pattern.h). Non-ASCII UTF-8 stays as it is, so subjects in other scripts stay
  // distinct. Returns the number of weights that will be sent; a weight whose message exceeds a
  // datagram is left out.
  std::size_t SetNames(const std::string& subject, std::span<const std::string> names,
                       std::string_view pattern = "*");

  // Writes one message per selected value, the timecode and the end mark. `values`: one per name of
  // SetNames(); selected values that are missing are left out. Calls `emit` once per datagram,
  // which is valid during the call.
  void Write(const OscFrame& frame, std::span<const float> values, const Emit& emit);

 private:
  struct Message {
    std::size_t index = 0;  // of the value
    std::string address;
    std::string tags;
    std::string name;
    std::size_t bytes = 0;  // as an element of a bundle
  };
  [[nodiscard]] Message MakeMessage(const OscTemplate& form, const std::string& name) const;
  // Of a message that each frame has once; absent: the profile has none, or it never fits.
  [[nodiscard]] std::optional<Message> MakeOptional(const std::optional<OscTemplate>& form) const;

  const OscProfile* profile_;
  std::string prefix_;
  std::string subject_;
  std::vector<Message> messages_;
  std::optional<Message> timecode_;
  std::optional<Message> end_;
  std::vector<std::uint8_t> datagram_;
};

}  // namespace furrow::protocol::mocap
