// SPDX-License-Identifier: Apache-2.0
#include "client/cli/load/own_chaos.h"

#include <utility>

#include "base/status.h"

namespace furrow::cli {

Status OwnChaos::Start(const load::ChaosOptions& up, const load::ChaosOptions& down,
                       load::Target* target) {
  if (!up.any() && !down.any()) return {};
  load::ChaosProxyOptions options{.to_host = target->host,
                                  .to_udp = target->udp,
                                  .to_tcp = target->tcp,
                                  .up = up,
                                  .down = down};
  auto proxy = load::ChaosProxy::Open(options);
  FURROW_RETURN_IF_ERROR(proxy);
  proxy_ = *std::move(proxy);
  target->host = options.listen_host;
  target->udp = proxy_->udp_port();
  target->tcp = proxy_->tcp_port();
  thread_ = std::thread([this] { proxy_->Run([this] { return !ended_.load(); }); });
  return {};
}

std::optional<Planted> OwnChaos::End() {
  ended_.store(true);
  if (!thread_.joinable()) return std::nullopt;
  thread_.join();
  return Planted{.up = proxy_->up(), .down = proxy_->down()};
}

}  // namespace furrow::cli
