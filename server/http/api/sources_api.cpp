// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/sources_api.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <nlohmann/json.hpp>

#include "server/core/network_address.h"
#include "server/http/request/json_reply.h"
#include "server/http/request/stream_json.h"
#include "server/machine/own_addresses.h"

namespace furrow::server {
namespace {

constexpr std::string_view kLiveLinkFace = "livelink_face";
constexpr std::string_view kVmc = "vmc";
// The reply is sent every second while the page shows it.
constexpr std::size_t kMaxListedSubjects = 64;
constexpr std::size_t kMaxListedNames = 32;
// Clocks further apart than this do not both count from 1970.
constexpr double kMaxOffsetSeconds = 86'400;

// Null: none has arrived.
Json AgeMs(const std::optional<MocapReport::Arrival>& arrival, Time now) {
  return arrival ? Json(ToSeconds(now - arrival->at) * 1e3) : Json();
}

std::string SenderOf(const std::optional<MocapReport::Arrival>& arrival) {
  return arrival ? arrival->sender : std::string();
}

// What a port has received, or what to do to open it.
Json InputJson(std::string_view name, std::string_view option, std::uint16_t usual_port,
               const std::function<std::optional<MocapReport>(Time)>& report_at, Time now) {
  const std::optional<MocapReport> found = report_at ? report_at(now) : std::nullopt;
  const MocapReport report = found.value_or(MocapReport());
  return {{"name", name},
          {"option", option},
          {"port", found ? Json(report.port) : Json()},
          {"usual_port", usual_port},
          {"packets", report.packets},
          {"malformed", report.malformed},
          {"rejected", report.rejected},
          {"rate_hz", report.rate_hz},
          {"holder", report.holder},
          {"sender", SenderOf(report.last)},
          {"age_ms", AgeMs(report.last, now)},
          {"malformed_sender", SenderOf(report.last_malformed)},
          {"malformed_age_ms", AgeMs(report.last_malformed, now)},
          {"rejected_sender", SenderOf(report.last_rejected)},
          {"rejected_age_ms", AgeMs(report.last_rejected, now)}};
}

Json NamesJson(std::span<const std::string> names) {
  const auto shown = names.first(std::min(names.size(), kMaxListedNames));
  return {{"count", names.size()},
          {"names", Json(std::vector<std::string>(shown.begin(), shown.end()))}};
}

// The daemon's clock minus the sender's, plus the network delay. Null: unknown.
Json ClockOffsetMs(const Subject& subject, Time now, Time unix_now) {
  const auto difference = subject.capture_clock.difference_us();
  if (!difference) return {};
  const double seconds = static_cast<double>(*difference) * 1e-6 + ToSeconds(unix_now - now);
  return std::abs(seconds) > kMaxOffsetSeconds ? Json() : Json(seconds * 1e3);
}

// Names the input of a subject that comes by a wire of others; empty: it comes by Furrow's own.
std::string_view InputOf(std::string_view source) {
  if (source == "livelink-face") return kLiveLinkFace;
  return source == "vmc" ? kVmc : std::string_view();
}

Json SubjectJson(const Subject& subject, Hub& hub, Time now, Time unix_now) {
  const StreamDefinition& stream = subject.pipeline->stream();
  const bool has_joints = stream.skeleton.num_joints() > 0;
  const bool has_shapes = !stream.blend_shapes.empty();
  const auto none = std::span<const std::string>();
  Json json = StreamJson(subject, hub, now);
  json.update({{"input", InputOf(hub.SourceOf(subject))},
               {"clock_offset_ms", ClockOffsetMs(subject, now, unix_now)},
               {"ignored_joints", NamesJson(stream.ignored_joints)},
               // A tracker of faces lacks no joints, and one of bodies no blend shapes.
               {"missing_joints", NamesJson(has_joints ? stream.binding->missing_joints() : none)},
               {"missing_blend_shapes",
                NamesJson(has_shapes ? stream.binding->missing_blend_shapes() : none)}});
  return json;
}

}  // namespace

ApiReply SourcesApi::Show(const ApiRequest& request, Hub& hub, Time now) const {
  Json inputs = Json::array();
  inputs.push_back(
      InputJson(kLiveLinkFace, "--livelink-face", kLiveLinkFacePort, parts_.livelink_face, now));
  inputs.push_back(InputJson(kVmc, "--vmc", kVmcPort, parts_.vmc, now));
  Json subjects = Json::array();
  std::size_t more = 0;
  for (const auto& subject : hub.subjects().all()) {
    if (!request.access.Concerns(subject->name)) continue;
    if (subjects.size() == kMaxListedSubjects) {
      ++more;
    } else {
      subjects.push_back(SubjectJson(*subject, hub, now, parts_.unix_now()));
    }
  }
  return JsonReply({{"bind", parts_.bind},
                    {"loopback", IsLoopback(parts_.bind)},
                    {"addresses", ReachableAddresses(parts_.bind)},
                    {"allow", parts_.allow()},
                    {"inputs", std::move(inputs)},
                    {"subjects", std::move(subjects)},
                    {"more_subjects", more}});
}

ApiReply SourcesApi::Accept(const ApiRequest& request, Hub& hub, Time now) const {
  const Result<Json> object = ParseObject(request);
  if (!object.ok()) return ErrorReply(object.status());
  std::string input;
  std::string sender;
  for (const auto& [name, value] : object->items()) {
    std::string* const target = name == "input" ? &input : name == "sender" ? &sender : nullptr;
    if (target == nullptr) {
      return ErrorReply(Status(StatusCode::kSchema, "must be one of input, sender", name));
    }
    if (!value.is_string()) return ErrorReply(Status(StatusCode::kSchema, "must be a text", name));
    *target = value.get<std::string>();
  }
  if (input != kVmc && input != kLiveLinkFace) {
    return ErrorReply(Status(StatusCode::kSchema, "must be vmc or livelink_face", "input"));
  }
  // A port may feed any subject.
  if (!request.access.ConcernsAll()) {
    return ErrorReply(403, "forbidden", "",
                      "a token for all subjects is needed; " + request.access.Text());
  }
  const Status status = parts_.give(input == kVmc, sender, now);
  return status.ok() ? Show(request, hub, now) : ErrorReply(status);
}

}  // namespace furrow::server
