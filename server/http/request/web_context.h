// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "server/cluster/coordinator.h"
#include "server/config/http_config.h"
#include "server/core/metrics.h"
#include "server/http/request/api_types.h"
#include "server/http/request/page_files.h"
#include "server/http/request/request_budget.h"
#include "server/http/request/request_guard.h"
#include "server/http/request/thread_handoff.h"
#include "server/playback/recording_loader.h"
#include "server/session/access/token_gate.h"
#include "server/shares/host_rates.h"
#include "server/shares/upload_turn.h"
#include "server/shares/waiting_bytes.h"
#include "server/tls/tls_identity.h"

namespace furrow::server {

// Answers the JSON routes, /metrics, /healthz, /readyz, and HEAD of pictures. Called on the hub's
// thread.
using AnswerApi = std::function<ApiReply(const ApiRequest& request, Hub& hub, Time now)>;

// Requests over http.requests_per_second are answered after this time: even an answer from memory
// costs processor time that weights need. They are not refused, because a supervisor's probe must
// get its answer.
inline constexpr auto kThrottlePause = std::chrono::milliseconds(100);

// The state that all connections of the web server share. It outlives the connections. The web
// thread uses it; other threads only read `connections` and `viewers`.
struct WebContext {
  HttpConfig config;
  RequestGuard guard;
  PageFiles page;
  PostToHub post_to_hub;
  PostToWeb post_to_web;
  AnswerApi answer;
  Metrics* metrics = nullptr;
  WaitingBytes* waiting = nullptr;       // for web clients; null: no limit
  const TokenGate* gate = nullptr;       // null: everybody may do everything
  const TlsIdentity* tls = nullptr;      // null or not enabled: plain HTTP
  const Coordinator* cluster = nullptr;  // null: the daemon is alone
  RecordingLoader* loader = nullptr;     // null: nothing can be uploaded
  UploadTurn uploads;
  std::shared_ptr<RequestBudget> budget =
      std::make_shared<RequestBudget>(config.api_share);  // of API requests
  // Of requests that are answered at once.
  HostRates pace{static_cast<std::uint32_t>(config.requests_per_second)};
  std::map<std::string, std::pair<Time, ApiReply>> probes;  // the last replies, by path
  std::atomic<int> connections = 0;
  std::atomic<int> viewers = 0;  // WebSockets and picture streams
};

// The protocol of WebSockets. A browser closes a connection if the server does not confirm one of
// the protocols that it offered; a token is offered beside this one and never confirmed.
inline constexpr char kWebProtocol[] = "furrow.1";

// Largest request body and largest WebSocket message from a client.
inline constexpr std::size_t kMaxWebMessageBytes = 64 * 1024;
// Largest header of a request.
inline constexpr std::size_t kMaxWebHeaderBytes = 8 * 1024;

}  // namespace furrow::server
