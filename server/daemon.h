// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/signal_set.hpp>
#include <asio/steady_timer.hpp>

#include "base/status.h"
#include "server/assets.h"
#include "server/cluster/coordinator.h"
#include "server/config/config.h"
#include "server/core/exit_code.h"
#include "server/core/metrics.h"
#include "server/core/status_line.h"
#include "server/core/time.h"
#include "server/credentials.h"
#include "server/http/api/api.h"
#include "server/http/http_server.h"
#include "server/http/request/api_types.h"
#include "server/osc/osc_targets.h"
#include "server/pipeline/picture_source.h"
#include "server/playback/playback.h"
#include "server/playback/recording_loader.h"
#include "server/ports.h"
#include "server/recording/recorder.h"
#include "server/reload.h"
#include "server/reload_loop.h"
#include "server/rendering.h"
#include "server/restart/inheritance.h"
#include "server/restart/shutdown.h"
#include "server/run_options.h"
#include "server/session/hub.h"
#include "server/session_transfer.h"
#include "server/shares/waiting_bytes.h"
#include "server/startup.h"

namespace furrow::server {

// The parts of one daemon. Members are declared in the order of their dependencies.
class Daemon {
 public:
  // Keeps a reference to `options`, which outlives it. `former`: not null; outlives it, too.
  Daemon(const Config& config, const RunOptions& options, Assets assets, OscOutputs osc_outputs,
         Inheritance* former)
      : config_(config),
        options_(options),
        assets_(std::move(assets)),
        osc_outputs_(std::move(osc_outputs)),
        metrics_(options.metrics != nullptr ? options.metrics : &own_metrics_),
        waiting_(config.limits.waiting_bytes(), metrics_),
        signals_(io_),
        credentials_(config, metrics_),
        rig_files_(config),
        former_(former) {}

  // Call these in this order. Each leaves out what the configuration does not ask for.
  Status LoadPlayer();
  Status StartRendering();
  Status LoadCluster();
  void FinishConfinement();
  Status StartRecording();
  Status LoadCredentials();
  Status Listen();
  // Until a stop is requested. kBadInput: pictures of the character, which are loaded while it
  // serves, cannot be read.
  ExitCode Serve();
  // Instead of Serve(), when a call has failed. The renderer may be busy for seconds, or for ever:
  // a process of its own ends without it.
  ExitCode Abandon(ExitCode exit_code);

 private:
  void MakeHub();
  void MakeShutdown();
  [[nodiscard]] TransferParts Transfer() const;
  bool Leave();
  void OnRenderer(const Status& loaded);
  Status StartCluster();
  Status StartOsc();
  void MakeApi();
  ApiReply AnswerWeb(const ApiRequest& request, Hub& hub, Time now);
  Status ListenToWeb();
  void Announce() const;
  asio::awaitable<void> TickLoop();
  asio::awaitable<void> SecondLoop();
  void EverySecond(StatusLine* status_line);
  asio::awaitable<void> PlayLoop();
  void HandleSignals();
  ReloadRequest MakeReloadRequest();
  Status TakeOver(Reload* reload);
  void DeliverPicture(const FinishedPicture& picture);
  void EndUploads();
  void EndRendering();
  [[noreturn]] void EndProcess();

  Config config_;  // TakeOver() changes it; only the main thread uses it after the start
  const RunOptions& options_;
  Assets assets_;
  OscOutputs osc_outputs_;
  Metrics own_metrics_;
  Metrics* const metrics_;
  WaitingBytes waiting_;  // of clients; tasks of the event loop may hold accounts
  std::uint64_t session_ = 0;
  asio::io_context io_{1};  // run by the calling thread, which owns shard 0
  asio::signal_set signals_;
  asio::steady_timer play_timer_{io_};  // of PlayLoop()
  std::unique_ptr<Recorder> recorder_;
  Rendering rendering_;
  Playback playback_;                // peers of the hub, so they outlive the hub
  std::unique_ptr<OscTargets> osc_;  // called by the hub, so it outlives the hub
  Credentials credentials_;
  RigFiles rig_files_;
  Inheritance* const former_;
  bool loads_later_ = false;  // the renderer loads the character; confinement waits
  ExitCode exit_code_ = ExitCode::kOk;
  bool has_left_ = false;                 // the next daemon goes on with the sessions
  std::unique_ptr<Coordinator> cluster_;  // null: alone; used by the hub, so it outlives it
  std::unique_ptr<Hub> hub_;
  std::unique_ptr<Shutdown> shutdown_;
  std::unique_ptr<Ports> ports_;
  std::unique_ptr<RecordingLoader> loader_;
  std::unique_ptr<Api> api_;
  std::unique_ptr<HttpServer> http_;
  std::unique_ptr<ReloadLoop> reload_;  // its thread ends before the members above
};

}  // namespace furrow::server
