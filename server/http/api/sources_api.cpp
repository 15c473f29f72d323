// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/sources_api.h"

#include <cstdint>
#include <optional>
#include <string_view>

#include <nlohmann/json.hpp>

#include "server/core/network_address.h"
#include "server/http/request/json_reply.h"
#include "server/machine/own_addresses.h"

namespace furrow::server {
namespace {

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
          {"sender", SenderOf(report.last)},
          {"age_ms", AgeMs(report.last, now)},
          {"malformed_sender", SenderOf(report.last_malformed)},
          {"malformed_age_ms", AgeMs(report.last_malformed, now)},
          {"rejected_sender", SenderOf(report.last_rejected)},
          {"rejected_age_ms", AgeMs(report.last_rejected, now)}};
}

}  // namespace

ApiReply SourcesApi::Show(Time now) const {
  Json list = Json::array();
  list.push_back(
      InputJson("livelink_face", "--livelink-face", kLiveLinkFacePort, parts_.livelink_face, now));
  list.push_back(InputJson("vmc", "--vmc", kVmcPort, parts_.vmc, now));
  return JsonReply({{"bind", parts_.bind},
                    {"loopback", IsLoopback(parts_.bind)},
                    {"addresses", ReachableAddresses(parts_.bind)},
                    {"allow", parts_.allow()},
                    {"inputs", std::move(list)}});
}

}  // namespace furrow::server
