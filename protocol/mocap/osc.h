// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

// Open Sound Control 1.0: big-endian numbers, all elements padded to four bytes.
namespace furrow::protocol::mocap {

inline constexpr int kMaxOscDepth = 4;        // bundles in bundles
inline constexpr int kMaxOscMessages = 4096;  // in one packet

// One message of a checked packet. Its members point into the packet, which must outlive them.
struct OscMessage {
  std::string_view address;
  std::string_view tags;                    // type tags without the comma
  std::span<const std::uint8_t> arguments;  // their sizes agree with `tags`
};

// Reads the arguments of a message in order. If the next argument has another type than the called
// function (or there is none), the function returns false, skips nothing and leaves `value`
// unchanged.
class OscArguments {
 public:
  explicit OscArguments(const OscMessage& message);

  [[nodiscard]] bool Float(float& value);              // f
  [[nodiscard]] bool Int(std::int32_t& value);         // i
  [[nodiscard]] bool String(std::string_view& value);  // s or S
  [[nodiscard]] char next_tag() const;                 // 0 at the end

 private:
  std::string_view tags_;
  std::span<const std::uint8_t> bytes_;
};

enum class OscStatus : std::uint8_t {
  kOk = 0,
  kMalformed,  // sizes, padding or type tags violate OSC
  kTooDeep,    // more than kMaxOscDepth bundles in one another
  kTooMany,    // more than kMaxOscMessages messages
};

using OscVisitor = std::function<void(const OscMessage& message)>;

// Calls `visit` for every message of a packet in order. Messages may be bare or in nested bundles;
// all time tags are treated as immediate. Checks the whole packet first, so no message of a
// malformed packet is visited.
[[nodiscard]] OscStatus VisitOsc(std::span<const std::uint8_t> packet, const OscVisitor& visit);

// Writes one OSC packet into a byte vector. Call one argument function per type tag, in order;
// nothing is checked.
//
//   OscWriter writer(bytes);
//   writer.BeginBundle();                       // optional, then any number of messages
//   writer.BeginMessage("/a", "sf"); writer.String("x"); writer.Float(1); writer.EndMessage();
class OscWriter {
 public:
  // Clears `out`, which must outlive the writer.
  explicit OscWriter(std::vector<std::uint8_t>& out);

  void BeginBundle();  // time tag "immediately"
  void BeginMessage(std::string_view address, std::string_view tags);
  void Float(float value);
  void Int(std::int32_t value);
  void Int64(std::int64_t value);
  void String(std::string_view value);
  void EndMessage();

 private:
  std::vector<std::uint8_t>& out_;
  bool in_bundle_ = false;
  std::size_t size_at_ = 0;
};

// The size in bytes of an OSC string of `length` characters, with its terminator and padding.
[[nodiscard]] constexpr std::size_t OscStringBytes(std::size_t length) {
  return (length / 4 + 1) * 4;
}

}  // namespace furrow::protocol::mocap
