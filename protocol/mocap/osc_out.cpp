// SPDX-License-Identifier: Apache-2.0
#include "protocol/mocap/osc_out.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "protocol/messages/limits.h"
#include "protocol/messages/pattern.h"
#include "protocol/mocap/osc.h"

namespace furrow::protocol::mocap {
namespace {

constexpr std::size_t kElementPrefixBytes = 4;
constexpr std::size_t kBundleHeadBytes = 16;  // "#bundle" and the time tag
constexpr std::size_t kTimecodeLength = 12;   // of the longest, "23:59:59:239"

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

// ASCII alone, whatever the locale. The engine plug-ins name properties by the same rule.
std::string Identifier(std::string_view name) {
  std::string identifier(name);
  std::replace_if(
      identifier.begin(), identifier.end(),
      [](char c) {
        return !((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'));
      },
      '_');
  return identifier;
}

// Replaces every `{key}` by its value; the values are not searched again.
std::string Expand(std::string_view text,
                   std::span<const std::pair<std::string_view, std::string>> values) {
  std::string out;
  while (!text.empty()) {
    const auto match = std::ranges::find_if(
        values, [text](const auto& value) { return text.starts_with(value.first); });
    if (match != values.end()) {
      out += match->second;
      text.remove_prefix(match->first.size());
    } else {
      out += text.front();
      text.remove_prefix(1);
    }
  }
  return out;
}

char TagOf(OscField field) {
  switch (field) {
    case OscField::kName:
    case OscField::kSubject:
    case OscField::kTimecode: return 's';
    case OscField::kValue: return 'f';
    case OscField::kSequence: return 'i';
    case OscField::kCaptureTime: return 'h';
  }
  return 'f';
}

}  // namespace

OscWeightWriter::Message OscWeightWriter::MakeMessage(const OscTemplate& form,
                                                      const std::string& name) const {
  const std::pair<std::string_view, std::string> values[] = {{"{prefix}", prefix_},
                                                             {"{subject}", AddressPart(subject_)},
                                                             {"{name}", AddressPart(name)},
                                                             {"{identifier}", Identifier(name)}};
  Message message;
  message.address = Expand(form.address, values);
  message.name = name;
  for (const OscField field : form.arguments) message.tags += TagOf(field);
  message.bytes = kElementPrefixBytes + OscStringBytes(message.address.size()) +
                  OscStringBytes(1 + form.arguments.size());
  for (const OscField field : form.arguments) {
    switch (field) {
      case OscField::kName: message.bytes += OscStringBytes(name.size()); break;
      case OscField::kSubject: message.bytes += OscStringBytes(subject_.size()); break;
      case OscField::kValue:
      case OscField::kSequence: message.bytes += 4; break;
      case OscField::kCaptureTime: message.bytes += 8; break;
      case OscField::kTimecode: message.bytes += OscStringBytes(kTimecodeLength); break;
    }
  }
  return message;
}

std::optional<OscWeightWriter::Message> OscWeightWriter::MakeOptional(
    const std::optional<OscTemplate>& form) const {
  if (!form) return {};
  Message message = MakeMessage(*form, {});
  if (kBundleHeadBytes + message.bytes > kMaxDatagramBytes) return {};
  return message;
}

std::size_t OscWeightWriter::SetNames(const std::string& subject,
                                      std::span<const std::string> names,
                                      std::string_view pattern) {
  subject_ = subject;
  messages_.clear();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!MatchesPattern(pattern, names[i])) continue;
    const auto renamed = profile_->names.find(names[i]);
    if (renamed == profile_->names.end() && profile_->only_renamed) continue;
    Message message =
        MakeMessage(profile_->value, renamed == profile_->names.end() ? names[i] : renamed->second);
    message.index = i;
    if (kBundleHeadBytes + message.bytes <= kMaxDatagramBytes) {
      messages_.push_back(std::move(message));
    }
  }
  timecode_ = MakeOptional(profile_->timecode);
  end_ = MakeOptional(profile_->end);
  return messages_.size();
}

void OscWeightWriter::Write(const OscFrame& frame, std::span<const float> values,
                            const Emit& emit) {
  OscWriter writer(datagram_);
  writer.BeginBundle();
  const auto add = [&](const OscTemplate& form, const Message& message, float value) {
    // Sizes are known before writing, because a message cannot be split over two bundles.
    if (datagram_.size() + message.bytes > kMaxDatagramBytes) {
      emit(datagram_);
      datagram_.clear();
      writer.BeginBundle();
    }
    writer.BeginMessage(message.address, message.tags);
    for (const OscField field : form.arguments) {
      switch (field) {
        case OscField::kName: writer.String(message.name); break;
        case OscField::kSubject: writer.String(subject_); break;
        case OscField::kValue: writer.Float(value); break;
        case OscField::kSequence: writer.Int(static_cast<std::int32_t>(frame.sequence)); break;
        case OscField::kCaptureTime: writer.Int64(frame.capture_time_us); break;
        case OscField::kTimecode:
          writer.String(frame.timecode ? TimecodeText(*frame.timecode) : std::string());
          break;
      }
    }
    writer.EndMessage();
  };
  for (const Message& message : messages_) {
    if (message.index < values.size()) add(profile_->value, message, values[message.index]);
  }
  if (timecode_ && frame.timecode) add(*profile_->timecode, *timecode_, 0.0f);
  if (end_) add(*profile_->end, *end_, 0.0f);
  if (datagram_.size() > kBundleHeadBytes) emit(datagram_);
}

}  // namespace furrow::protocol::mocap
