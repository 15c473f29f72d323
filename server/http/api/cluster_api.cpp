// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/cluster_api.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "protocol/messages/limits.h"
#include "protocol/messages/text.h"
#include "server/http/request/json_reply.h"

namespace furrow::server {
namespace {

constexpr std::size_t kMaxListed = 10'000;

ApiReply Alone() {
  return ErrorReply(404, "not_found", "", "this daemon is in no cluster",
                    "start it with --cluster; see docs/CLUSTER.md");
}

Json NodeJson(const NodeAddress& node) {
  const std::string web = WebAddressOf(node);
  return {{"node", node.name}, {"host", node.host}, {"tcp", node.tcp},
          {"udp", node.udp},   {"http", node.http}, {"web", web.empty() ? Json() : Json(web)}};
}

}  // namespace

ApiReply ClusterApi::FindPlace(const ApiRequest& request, Time now) {
  if (cluster_ == nullptr) return Alone();
  const std::string subject(request.url.Value("subject"));
  if (subject.empty() || subject.size() > protocol::kMaxNameBytes ||
      !protocol::IsPlainText(subject)) {
    return ErrorReply(400, "bad_request", "subject", "must be a name of 1 to 255 bytes",
                      "for example /api/place?subject=ada");
  }
  if (!request.access.MayWatch(subject) && !request.access.MayPublish(subject)) {
    return ErrorReply(
        403, "forbidden", "subject",
        "not permitted to publish or watch '" + subject + "'; " + request.access.Text(),
        "use a token for this subject");
  }
  const Place found = cluster_->Find(subject, now);
  const bool is_served = found.kind != Place::Kind::kNowhere;
  const Place place = is_served ? found : cluster_->Propose(subject, now);
  if (place.kind == Place::Kind::kNowhere) {
    return ErrorReply(503, "unavailable", "", "'" + subject + "' has no place: " + place.why);
  }
  Json json = NodeJson(place.node);
  json["subject"] = subject;
  json["served"] = is_served;
  json["epoch"] = is_served ? place.epoch : 0;
  json["token"] = nullptr;
  if (!request.url.Value("roles").empty()) {
    const auto token = tokens_->MakeFor(request, place.node.name, subject, now);
    if (!token.ok()) return TokenRefusal(token.status());
    json["token"] = *token;
  }
  return JsonReply(json);
}

ApiReply ClusterApi::Show(Time now) const {
  if (cluster_ == nullptr) return Alone();
  const ClusterState state = cluster_->State(now);
  Json nodes = Json::array();
  for (const ClusterState::Node& node : state.nodes) {
    Json json = NodeJson(node.address);
    json["self"] = node.self;
    json["draining"] = node.draining;
    json["subjects"] = node.subjects;
    json["capacity"] = node.capacity;
    nodes.push_back(std::move(json));
  }
  Json subjects = Json::array();
  for (std::size_t i = 0; i < std::min(state.subjects.size(), kMaxListed); ++i) {
    const ClusterState::Subject& subject = state.subjects[i];
    subjects.push_back({{"name", subject.name}, {"node", subject.node}, {"epoch", subject.epoch}});
  }
  return JsonReply({{"fault", state.fault.empty() ? Json() : Json(state.fault)},
                    {"nodes", std::move(nodes)},
                    {"subjects", std::move(subjects)},
                    {"total", state.subjects.size()}});
}

}  // namespace furrow::server
