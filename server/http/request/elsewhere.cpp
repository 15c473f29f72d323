// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/elsewhere.h"

#include <algorithm>
#include <string>

#include "protocol/messages/limits.h"
#include "protocol/messages/text.h"
#include "server/session/subjects/places.h"

namespace furrow::server {

std::optional<ApiReply> SendElsewhere(const Coordinator* cluster, const Url& url,
                                      const Access& access, bool is_https, Time now) {
  if (cluster == nullptr) return std::nullopt;
  const auto names_subject = [](const auto& value) { return value.first == "subject"; };
  if (std::ranges::count_if(url.values, names_subject) != 1) return std::nullopt;
  const std::string subject(url.Value("subject"));
  if (subject.empty() || subject.size() > protocol::kMaxNameBytes ||
      !protocol::IsPlainText(subject) || !access.MayWatch(subject)) {
    return std::nullopt;
  }
  const Place place = cluster->Find(subject, now);
  const std::string web = WebAddressOf(place.node);
  if (place.kind != Place::Kind::kElsewhere || web.empty()) return std::nullopt;
  if (is_https && !place.node.https) return std::nullopt;
  ApiReply reply = ErrorReply(307, "elsewhere", "subject", ElsewhereText(subject, place.node),
                              "ask " + web + ", with the token again if there is one");
  Url there = url;
  std::erase_if(there.values, [](const auto& value) { return value.first == "token"; });
  reply.location = web + TargetOf(there);
  return reply;
}

}  // namespace furrow::server
