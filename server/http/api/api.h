// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "server/cluster/coordinator.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/http/api/capture_api.h"
#include "server/http/api/cluster_api.h"
#include "server/http/api/osc_api.h"
#include "server/http/api/playback_api.h"
#include "server/http/api/rig_api.h"
#include "server/http/api/settings_api.h"
#include "server/http/api/sources_api.h"
#include "server/http/api/status_api.h"
#include "server/http/api/token_api.h"
#include "server/http/api/trace_api.h"
#include "server/http/request/api_types.h"
#include "server/osc/osc_control.h"
#include "server/pipeline/picture_source.h"
#include "server/pipeline/video_encoders.h"
#include "server/playback/playback.h"
#include "server/session/hub.h"
#include "server/shares/waiting_bytes.h"

namespace furrow::server {

// Answers the JSON routes (docs/HTTP-API.md), /healthz, /readyz, /metrics, and HEAD of pictures, by
// path and method. All functions run on the hub's thread and never wait for I/O or rendering.
class Api {
 public:
  // Pointers must outlive the Api.
  struct Parts {
    std::uint64_t session = 0;                        // the daemon's random session number
    Time started{0};                                  // when the daemon started
    Metrics* metrics = nullptr;                       // not null
    PictureSource* pictures = nullptr;                // null: the daemon renders nothing
    const VideoEncoders* video = nullptr;             // null: the daemon renders nothing
    bool wants_pictures = false;                      // the configuration asks for pictures
    Playback* playback = nullptr;                     // not null
    std::function<std::uint64_t()> max_upload_bytes;  // of a recording; 0: none
    OscControl* osc = nullptr;                        // not null
    std::function<int()> connections;                 // number of HTTP connections
    std::function<int()> viewers;                     // number of WebSockets and picture streams
    std::function<bool()> recording_is_paused;        // by a full disk; empty: nothing is recorded
    std::function<bool()> config_is_refused;          // by the last reload; empty: there are none
    const WaitingBytes* waiting = nullptr;  // for clients that read slowly; null: no limit
    bool open_to_network = false;           // other computers need no token
    const TokenGate* gate = nullptr;        // null: the daemon makes no tokens
    Coordinator* cluster = nullptr;         // null: the daemon is alone
    SourcesApi::Parts sources;
  };
  explicit Api(Parts parts);
  Api(const Api&) = delete;
  Api& operator=(const Api&) = delete;

  // Answers one request; an unknown path or method gives an error reply (404, 405). Requires the
  // hub's exclusive lock, except for a probe (IsProbe()).
  [[nodiscard]] ApiReply Answer(const ApiRequest& request, Hub& hub, Time now);

 private:
  // What a request needs to be answered.
  enum class Need : std::uint8_t { kNothing, kToken, kWatch, kDirect, kOperate };
  struct Route {
    std::string_view method;
    std::string_view path;
    Need need;
    std::function<ApiReply(const ApiRequest&, Hub&, Time)> answer;
  };

  // The routes by topic. Their answers use the parts below.
  [[nodiscard]] std::vector<Route> StatusRoutes();  // what is served, and how well
  [[nodiscard]] std::vector<Route> LookRoutes();    // pictures and the rig
  [[nodiscard]] std::vector<Route> PlaybackRoutes();
  [[nodiscard]] std::vector<Route> OperatorRoutes();  // targets, tokens, traces and the cluster
  [[nodiscard]] std::vector<Route> AllRoutes();

  [[nodiscard]] static bool Permits(Need need, const Access& access);
  [[nodiscard]] ApiReply Forbid(Need need, const ApiRequest& request);

  Metrics* const metrics_;
  StatusApi status_;
  SettingsApi settings_;
  CaptureApi captures_;
  RigApi rig_;
  PlaybackApi playback_;
  OscApi osc_;
  TokenApi tokens_;
  ClusterApi cluster_;
  SourcesApi sources_;
  TraceApi traces_;
  const std::vector<Route> routes_;
};

}  // namespace furrow::server
