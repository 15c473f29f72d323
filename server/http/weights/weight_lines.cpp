// SPDX-License-Identifier: Apache-2.0
#include "server/http/weights/weight_lines.h"

#include "base/numbers.h"
#include "base/time/timecode.h"
#include "protocol/codec/codec.h"
#include "server/cluster/node/node_address.h"
#include "server/http/request/api_types.h"

namespace furrow::server {
namespace {

using protocol::DecodeStatus;
using protocol::MessageKind;

// {"type":"<type>","subject":<subject>
void Begin(std::string_view type, const std::string& subject, std::string* line) {
  *line = R"({"type":")";
  *line += type;
  *line += R"(","subject":)";
  *line += subject;
}

void WriteNames(const std::vector<std::string>& names, std::string* line) {
  *line += R"(,"names":[)";
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) *line += ',';
    *line += JsonText(names[i]);
  }
  *line += "]}";
}

void WriteFrame(const protocol::Header& header, const protocol::WeightFrame& frame,
                std::string* line) {
  *line += R"(,"sequence":)" + std::to_string(header.sequence);
  *line += R"(,"time_us":)" + std::to_string(header.capture_time_us);
  *line += R"(,"age_ms":)" + std::to_string(frame.age_us / 1000);
  if (frame.timecode) *line += R"(,"timecode":")" + TimecodeText(*frame.timecode) + '"';
  *line += R"(,"values":[)";
  for (std::size_t i = 0; i < frame.values.size(); ++i) {
    if (i > 0) *line += ',';
    AppendShortest(frame.values[i], line);
  }
  *line += "]}";
}

}  // namespace

const std::string& WeightLines::Requested(std::uint32_t sequence) const {
  static const std::string kNone;
  return sequence >= 1 && sequence <= requests_.size() ? requests_[sequence - 1].subject : kNone;
}

WeightLines::Line WeightLines::Translate(std::span<const std::uint8_t> message, std::string* line) {
  protocol::MessageView view;
  if (protocol::OpenMessage(message, view, protocol::kMaxReplyBytes) != DecodeStatus::kOk) {
    return Line::kNone;
  }
  const std::uint16_t stream = view.header.stream;
  if (view.kind == MessageKind::kWeights) {
    const auto subject = subjects_.find(stream);
    if (subject == subjects_.end() || protocol::Decode(view, frame_) != DecodeStatus::kOk) {
      return Line::kNone;
    }
    Begin("weights", subject->second, line);
    WriteFrame(view.header, frame_, line);
    return Line::kText;
  }
  if (view.kind == MessageKind::kSubscribeReply) {
    if (protocol::Decode(view, reply_) != DecodeStatus::kOk) return Line::kNone;
    if (reply_.names.empty()) {
      Begin("waiting", JsonText(Requested(view.header.sequence)), line);
      *line += '}';
      return Line::kText;
    }
    std::string& subject = subjects_[stream];
    subject = JsonText(reply_.subject);
    Begin("names", subject, line);
    WriteNames(reply_.names, line);
    return Line::kText;
  }
  if (view.kind == MessageKind::kGoodbye) {
    if (stream == 0) {  // to the whole peer
      *line = R"({"type":"bye"})";
      return Line::kLast;
    }
    const auto subject = subjects_.find(stream);
    if (subject == subjects_.end()) return Line::kNone;
    Begin("gone", subject->second, line);
    *line += '}';
    return Line::kText;
  }
  protocol::ErrorMessage error;
  if (protocol::Decode(view, error) != DecodeStatus::kOk) return Line::kNone;
  Begin("error", JsonText(Requested(view.header.sequence)), line);
  *line += R"(,"message":)" + JsonText(error.message);
  const std::string web = WebAddressOf({.name = {},
                                        .host = error.host,
                                        .tcp = error.tcp,
                                        .udp = error.udp,
                                        .http = error.web,
                                        .https = error.web_tls});
  if (error.host.empty() || web.empty()) {
    *line += '}';
    return Line::kText;
  }
  // Another daemon serves the subject. Other subjects of the connection go on.
  *line += R"(,"web":)" + JsonText(web) + "}";
  return requests_.size() == 1 ? Line::kLast : Line::kText;
}

}  // namespace furrow::server
