// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "server/cluster/coordinator.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/http/request/api_types.h"
#include "server/pipeline/video_encoders.h"
#include "server/playback/playback.h"
#include "server/session/hub.h"
#include "server/shares/waiting_bytes.h"

namespace furrow::server {

// Reports the state of the daemon: /api/subjects, /api/status, /healthz, /readyz and /metrics.
class StatusApi {
 public:
  struct Parts {
    std::uint64_t session = 0;
    Time started{0};
    const Metrics* metrics = nullptr;
    bool wants_pictures = false;                      // the configuration asks for pictures
    const PictureSource* pictures = nullptr;          // the renderer; null: none is running
    const VideoEncoders* video = nullptr;             // null: the daemon renders nothing
    const Playback* playback = nullptr;               // not null
    std::function<std::uint64_t()> max_upload_bytes;  // of a recording; 0: none
    std::function<int()> connections;                 // HTTP connections
    std::function<int()> viewers;                     // WebSockets and picture streams
    std::function<bool()> recording_is_paused;        // by a full disk; empty: nothing is recorded
    std::function<bool()> config_is_refused;          // by the last reload; empty: there are none
    const WaitingBytes* waiting = nullptr;  // for clients that read slowly; null: no limit
    bool open_to_network = false;           // other computers need no token
    const Coordinator* cluster = nullptr;   // null: the daemon is alone
  };
  explicit StatusApi(Parts parts) : parts_(std::move(parts)) {}

  // All functions with a Hub require its exclusive lock.
  // The connected subjects that the request may know of, with the statistics of their streams.
  [[nodiscard]] ApiReply Subjects(const ApiRequest& request, Hub& hub, Time now) const;
  // The version, uptime, counts and renderer of the daemon, and what the request may do.
  [[nodiscard]] ApiReply ShowStatus(const ApiRequest& request, const Hub& hub, Time now) const;
  // Always 200: a reply shows that the hub's event loop runs.
  [[nodiscard]] ApiReply Health() const;
  // 200, or 503 while the daemon shuts down, lacks the renderer that its configuration asks for,
  // has one that does not respond, cannot record, or can place no subjects in its cluster.
  [[nodiscard]] ApiReply Ready(const Hub& hub, Time now) const;
  // Counters, histograms and gauges of the daemon and of its process, in Prometheus' text format.
  [[nodiscard]] ApiReply MetricsText(const Hub& hub, Time now) const;

 private:
  const Parts parts_;
};

}  // namespace furrow::server
