// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/node/node_address.h"

#include <algorithm>
#include <charconv>
#include <cstddef>

#include "base/text.h"
#include "protocol/messages/limits.h"
#include "protocol/secure/token/connect_token.h"

namespace furrow::server {
namespace {

constexpr std::string_view kLetters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
constexpr std::string_view kHostLetters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.:%";

constexpr std::uint16_t kHttpPort = 7480;  // HttpConfig::kDefaultPort

bool TakePort(std::string_view* text, std::uint16_t* port) {
  if (text->empty()) return true;
  if (text->front() != ':') return false;
  text->remove_prefix(1);
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), *port);
  text->remove_prefix(static_cast<std::size_t>(end - text->data()));
  return error == std::errc() && *port != 0;
}

}  // namespace

bool IsNodeName(std::string_view name) {
  return !name.empty() && name.size() <= protocol::secure::kMaxAudienceBytes &&
         name.find_first_not_of(kLetters) == std::string_view::npos;
}

bool IsHost(std::string_view host) {
  return !host.empty() && host.size() <= protocol::kMaxHostBytes &&
         host.find_first_not_of(kHostLetters) == std::string_view::npos;
}

std::string WebAddressOf(const NodeAddress& node) {
  // Browsers know no zones of IPv6 addresses.
  if (node.http == 0 || node.host.find('%') != std::string::npos) return {};
  const bool is_v6 = node.host.find(':') != std::string::npos;
  return (node.https ? "https://" : "http://") + (is_v6 ? "[" + node.host + "]" : node.host) + ":" +
         std::to_string(node.http);
}

Result<NodeAddress> ParseNode(std::string_view text) {
  const std::size_t equals = std::min(text.find('='), text.size());
  NodeAddress node{.name = std::string(text.substr(0, equals)),
                   .host = {},
                   .tcp = protocol::kDefaultTcpPort,
                   .udp = protocol::kDefaultUdpPort,
                   .http = kHttpPort,
                   .https = false};
  std::string_view rest = text.substr(std::min(equals + 1, text.size()));
  const bool bracketed = rest.starts_with('[');
  if (bracketed) rest.remove_prefix(1);
  const std::size_t end = std::min(rest.find(bracketed ? ']' : ':'), rest.size());
  const bool closed = !bracketed || end < rest.size();
  node.host = rest.substr(0, end);
  rest.remove_prefix(std::min(end + (bracketed ? 1 : 0), rest.size()));
  const bool valid = IsNodeName(node.name) && IsHost(node.host) && closed &&
                     TakePort(&rest, &node.tcp) && TakePort(&rest, &node.udp) &&
                     TakePort(&rest, &node.http) && rest.empty();
  if (valid) return node;
  return Status(StatusCode::kInvalidArgument, Quoted(text) + " is not a node", "",
                "for example b=192.168.0.11 or b=192.168.0.11:7400:7401:7480");
}

}  // namespace furrow::server
