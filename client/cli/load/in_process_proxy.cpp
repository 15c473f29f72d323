// SPDX-License-Identifier: Apache-2.0
#include "client/cli/load/in_process_proxy.h"

#include <utility>

#include "base/status.h"

namespace furrow::cli {

Status InProcessProxy::Start(const chaos::Faults& up, const chaos::Faults& down,
                             load::Target* target) {
  if (!up.any() && !down.any()) return {};
  chaos::ProxyOptions options{.to_host = target->host,
                              .to_udp = target->udp,
                              .to_tcp = target->tcp,
                              .up = up,
                              .down = down};
  auto proxy = chaos::Proxy::Open(options);
  FURROW_RETURN_IF_ERROR(proxy);
  proxy_ = *std::move(proxy);
  if (target->certificate_host.empty()) target->certificate_host = target->host;
  target->host = options.listen_host;
  target->udp = proxy_->udp_port();
  target->tcp = proxy_->tcp_port();
  thread_ = std::thread([this] { proxy_->Run([this] { return !ended_.load(); }); });
  return {};
}

std::optional<InjectedFaults> InProcessProxy::Stop() {
  ended_.store(true);
  if (!thread_.joinable()) return std::nullopt;
  thread_.join();
  return InjectedFaults{.up = proxy_->up(), .down = proxy_->down()};
}

}  // namespace furrow::cli
