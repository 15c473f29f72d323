// SPDX-License-Identifier: Apache-2.0
#include "protocol/mocap/osc.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "protocol/messages/bytes.h"

namespace furrow::protocol::mocap {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::string_view kBundleTag("#bundle\0", 8);
constexpr std::size_t kBundleHeaderBytes = 16;

// Consumes a string and its padding from the front.
bool TakeString(Bytes& bytes, std::string_view& text) {
  const auto end = std::find(bytes.begin(), bytes.end(), std::uint8_t{0});
  if (end == bytes.end()) return false;
  const auto length = static_cast<std::size_t>(end - bytes.begin());
  const std::size_t padded = OscStringBytes(length);
  if (padded > bytes.size()) return false;
  text = std::string_view(reinterpret_cast<const char*>(bytes.data()), length);
  bytes = bytes.subspan(padded);
  return true;
}

// Every Take function consumes its argument, or returns false if the packet is too short.
bool TakeFixed(Bytes& bytes, std::size_t size) {
  if (bytes.size() < size) return false;
  bytes = bytes.subspan(size);
  return true;
}

bool TakeBlob(Bytes& bytes) {
  if (bytes.size() < 4) return false;
  const std::size_t size = LoadBig<std::uint32_t>(bytes.data());
  if (size > bytes.size() - 4) return false;
  return TakeFixed(bytes, 4 + (size + 3) / 4 * 4);
}

// The sizes of OSC 1.0's types. Unknown types have unknown sizes, so the rest could not be read.
bool TakeArgument(Bytes& bytes, char tag) {
  std::string_view text;
  switch (tag) {
    case 'T':
    case 'F':
    case 'N':
    case 'I':
    case '[':
    case ']': return true;
    case 'i':
    case 'f':
    case 'c':
    case 'r':
    case 'm': return TakeFixed(bytes, 4);
    case 'h':
    case 't':
    case 'd': return TakeFixed(bytes, 8);
    case 's':
    case 'S': return TakeString(bytes, text);
    case 'b': return TakeBlob(bytes);
    default: return false;
  }
}

bool ReadMessage(Bytes bytes, OscMessage& message) {
  if (!TakeString(bytes, message.address) || !message.address.starts_with('/')) return false;
  message.tags = {};
  message.arguments = {};
  if (bytes.empty()) return true;  // old senders without type tags: no arguments
  if (!TakeString(bytes, message.tags) || !message.tags.starts_with(',')) return false;
  message.tags.remove_prefix(1);
  message.arguments = bytes;
  const bool fits = std::all_of(message.tags.begin(), message.tags.end(),
                                [&bytes](char tag) { return TakeArgument(bytes, tag); });
  return fits && bytes.empty();
}

bool IsBundle(Bytes bytes) {
  return bytes.size() >= kBundleHeaderBytes &&
         std::memcmp(bytes.data(), kBundleTag.data(), kBundleTag.size()) == 0;
}

// Walks a packet. Only checks it if `visit` is null.
class Walker {
 public:
  explicit Walker(const OscVisitor* visit) : visit_(visit) {}

  OscStatus Walk(Bytes bytes, int depth) {
    if (!IsBundle(bytes)) return Message(bytes);
    if (depth >= kMaxOscDepth) return OscStatus::kTooDeep;
    bytes = bytes.subspan(kBundleHeaderBytes);
    while (!bytes.empty()) {
      if (bytes.size() < 4) return OscStatus::kMalformed;
      const std::size_t size = LoadBig<std::uint32_t>(bytes.data());
      bytes = bytes.subspan(4);
      if (size % 4 != 0 || size > bytes.size()) return OscStatus::kMalformed;
      const OscStatus status = Walk(bytes.first(size), depth + 1);
      if (status != OscStatus::kOk) return status;
      bytes = bytes.subspan(size);
    }
    return OscStatus::kOk;
  }

 private:
  OscStatus Message(Bytes bytes) {
    OscMessage message;
    if (!ReadMessage(bytes, message)) return OscStatus::kMalformed;
    if (++messages_ > kMaxOscMessages) return OscStatus::kTooMany;
    if (visit_ != nullptr) (*visit_)(message);
    return OscStatus::kOk;
  }

  const OscVisitor* visit_;
  int messages_ = 0;
};

void AppendString(std::vector<std::uint8_t>& out, std::string_view text) {
  const std::size_t begin = out.size();
  out.resize(begin + OscStringBytes(text.size()), 0);
  std::copy(text.begin(), text.end(), out.begin() + static_cast<std::ptrdiff_t>(begin));
}

template <class T>
void AppendBig(std::vector<std::uint8_t>& out, T value) {
  out.resize(out.size() + sizeof(T));
  StoreBig(value, &out[out.size() - sizeof(T)]);
}

}  // namespace

OscArguments::OscArguments(const OscMessage& message)
    : tags_(message.tags), bytes_(message.arguments) {}

char OscArguments::next_tag() const { return tags_.empty() ? '\0' : tags_.front(); }

bool OscArguments::Float(float& value) {
  if (next_tag() != 'f') return false;
  value = std::bit_cast<float>(LoadBig<std::uint32_t>(bytes_.data()));
  tags_.remove_prefix(1);
  return TakeFixed(bytes_, 4);
}

bool OscArguments::Int(std::int32_t& value) {
  if (next_tag() != 'i') return false;
  value = LoadBig<std::int32_t>(bytes_.data());
  tags_.remove_prefix(1);
  return TakeFixed(bytes_, 4);
}

bool OscArguments::String(std::string_view& value) {
  if (next_tag() != 's' && next_tag() != 'S') return false;
  tags_.remove_prefix(1);
  return TakeString(bytes_, value);
}

OscStatus VisitOsc(std::span<const std::uint8_t> packet, const OscVisitor& visit) {
  if (packet.empty() || packet.size() % 4 != 0) return OscStatus::kMalformed;
  // Two walks: the first only checks, so that no message of a malformed packet has an effect.
  const OscStatus status = Walker(nullptr).Walk(packet, 0);
  return status == OscStatus::kOk ? Walker(&visit).Walk(packet, 0) : status;
}

OscWriter::OscWriter(std::vector<std::uint8_t>& out) : out_(out) { out_.clear(); }

void OscWriter::BeginBundle() {
  out_.insert(out_.end(), kBundleTag.begin(), kBundleTag.end());
  // The time tag 1 means "immediately".
  AppendBig(out_, std::uint64_t{1});
  in_bundle_ = true;
}

void OscWriter::BeginMessage(std::string_view address, std::string_view tags) {
  // Room for the size, which EndMessage() fills in.
  if (in_bundle_) AppendBig(out_, std::uint32_t{0});
  size_at_ = out_.size();
  AppendString(out_, address);
  const std::size_t begin = out_.size();
  out_.resize(begin + OscStringBytes(tags.size() + 1), 0);
  out_[begin] = ',';
  std::copy(tags.begin(), tags.end(), out_.begin() + static_cast<std::ptrdiff_t>(begin) + 1);
}

void OscWriter::Float(float value) { AppendBig(out_, std::bit_cast<std::uint32_t>(value)); }
void OscWriter::Int(std::int32_t value) { AppendBig(out_, value); }
void OscWriter::Int64(std::int64_t value) { AppendBig(out_, value); }
void OscWriter::String(std::string_view value) { AppendString(out_, value); }

void OscWriter::EndMessage() {
  if (in_bundle_) StoreBig(static_cast<std::uint32_t>(out_.size() - size_at_), &out_[size_at_ - 4]);
}

}  // namespace furrow::protocol::mocap
