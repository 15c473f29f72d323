// SPDX-License-Identifier: Apache-2.0
#include "server/daemon.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <system_error>
#include <utility>

#include <asio/post.hpp>
#include <asio/steady_timer.hpp>
#include <spdlog/spdlog.h>

#include "base/joined.h"
#include "base/process/memory_reserve.h"
#include "rig/rig_file.h"
#include "server/cluster/setup/make_coordinator.h"
#include "server/config/log.h"
#include "server/core/exit_code.h"
#include "server/core/network_address.h"
#include "server/core/within_memory.h"
#include "server/machine/confine.h"
#include "server/machine/early_signals.h"
#include "server/machine/own_addresses.h"
#include "server/machine/systemd_copy.h"
#include "server/net/await_tuple.h"
#include "server/net/clock.h"
#include "server/net/critical_task.h"
#include "server/net/pause.h"
#include "server/net/run_loop.h"

namespace furrow::server {
namespace {

constexpr auto kTick = std::chrono::milliseconds(10);
constexpr auto kSecond = std::chrono::seconds(1);
constexpr double kMega = 1e6;

// How long the last lines of the log may take where nothing else is waited for.
constexpr auto kLastLines = std::chrono::milliseconds(100);

// Returns unpredictable numbers, never 0, for session numbers and the tokens that prove an address.
std::uint64_t RandomNumber() {
  std::random_device source;
  std::uint64_t number = 0;
  while (number == 0) number = (static_cast<std::uint64_t>(source()) << 32) | source();
  return number;
}

}  // namespace

Status Daemon::StartRendering() {
  if (!config_.render || assets_.character == nullptr) return {};
  Rendering::Later later;
  if (assets_.lacks_pictures) {
    later.load = [config = config_, former = assets_.character](
                     character::Pictures pictures) -> Result<Rendering::SharedCharacter> {
      auto assets = LoadWithPictures(config, *former, pictures);
      FURROW_RETURN_IF_ERROR(assets);
      if (pictures == character::Pictures::kLoad) WarnAboutCharacter(*assets->character);
      return assets->character;
    };
    // A program that embeds the daemon has its own uses for the processor.
    later.drafts = options_.owns_process;
    later.on_started = [this](const Status& loaded) {
      asio::post(io_, [this, loaded] { OnRenderer(loaded); });
    };
  }
  const Status status = rendering_.Start(
      {.character = assets_.character,
       .skeleton = &assets_.shapes->skeleton,
       .device = config_.render_device,
       .settings = assets_.settings,
       .max_video_encoders = config_.max_video_encoders,
       .budget = {.host = config_.max_host_megapixels_per_second * kMega,
                  .total = config_.max_megapixels_per_second * kMega},
       .required = config_.require_render,
       .metrics = metrics_,
       .deliver =
           [this](FinishedPicture picture) {
             // The picture crosses to shard 0's thread by value, because only that thread may call
             // OnPicture(). `hub_` does not exist yet while the renderer starts, but no picture is
             // requested before.
             asio::post(io_, [this, picture = std::move(picture)] { DeliverPicture(picture); });
           },
       .later = std::move(later)});
  loads_later_ = assets_.lacks_pictures && rendering_.thread() != nullptr;
  return status;
}

void Daemon::DeliverPicture(const FinishedPicture& picture) {
  hub_->OnPicture(picture, ReadClock());
  if (picture.bytes.empty()) return;
  metrics_->Observe(Timing::kPictureRequestToSend, ReadClock() - picture.submitted);
}

// Loads a module and reads a file.
Status Daemon::LoadCluster() {
  auto made = MakeCoordinator(config_, RandomNumber());
  FURROW_RETURN_IF_ERROR(made);
  cluster_ = *std::move(made);
  return {};
}

Status Daemon::StartCluster() {
  if (cluster_ == nullptr) return {};
  const ClusterConfig& cluster = config_.cluster;
  const NodeAddress self{.name = config_.security.name,
                         .host = cluster.advertise.empty() ? config_.bind : cluster.advertise,
                         .tcp = ports_->tcp().port,
                         .udp = ports_->udp(),
                         .http = http_ ? http_->address().port : std::uint16_t{0},
                         .https = credentials_.tls().enabled()};
  spdlog::info("node '{}' of a cluster, at {}", self.name, self.host);
  return cluster_->Start(self);
}

// After helper programs have read files, which a character that is loaded later needs, too.
void Daemon::FinishConfinement() {
  if (options_.confined.empty()) {
    if (options_.owns_process) spdlog::info("not confined: security.confine is off");
  } else if (loads_later_) {
    spdlog::info("confined: {}; system calls follow with the renderer", options_.confined);
  } else {
    spdlog::info("confined: {}, {}", options_.confined, server::FinishConfinement());
  }
}

Status Daemon::LoadCredentials() {
  const Status status = credentials_.Load();
  if (options_.manager == nullptr || status.what().find("Permission denied") == std::string::npos) {
    return status;
  }
  return {status.code(), status.what(), status.where(),
          "the user of the service cannot read files of root: name them in LoadCredential=, as "
          "furrowd-credentials.conf does"};
}

Status Daemon::StartRecording() {
  const RecordConfig& record = config_.record;
  if (record.folder.empty()) return {};
  RecorderOptions options;
  options.folder = {.folder = record.folder,
                    .rotate_bytes = static_cast<std::uint64_t>(record.rotate_megabytes * 1e6),
                    .rotate_ns = static_cast<std::uint64_t>(record.rotate_seconds * 1e9),
                    .rig_json = rig::RigToJson(*assets_.rig)};
  options.datagrams = record.datagrams;
  // Read once, so that setting the system clock during a recording does not move its time back.
  const Time now = ReadClock();
  options.wall_offset = ReadUnixClock() - now;
  auto started = Recorder::Start(std::move(options), now, metrics_);
  if (!started.ok()) return started.status().At("--record");
  recorder_ = *std::move(started);
  return {};
}

void Daemon::MakeHub() {
  Hub::Parts parts;
  parts.limits = config_.limits;
  parts.jitter = config_.jitter;
  const SavedState* const former = former_->state();
  parts.session = session_ = former != nullptr ? former->session : RandomNumber();
  parts.rig = assets_.rig;
  // Without a renderer, weights need the character only if joints may move its shapes.
  const bool draws = rendering_.thread() != nullptr;
  const bool has_shapes = assets_.shapes != nullptr && !assets_.shapes->names.empty();
  if (draws || has_shapes) {
    parts.character = {.skeleton = &assets_.shapes->skeleton, .shapes = assets_.shapes->names};
    if (draws) parts.character.shape_rules = assets_.shapes->rules;
    if (has_shapes) parts.character.surface = &assets_.shapes->surface;
  }
  parts.skeletons = assets_.skeletons;
  parts.shape_matcher = assets_.shape_matcher;
  parts.pictures = rendering_.thread();
  parts.settings = assets_.settings;
  parts.metrics = metrics_;
  parts.random = RandomNumber;
  parts.clock = ReadClock;
  // The recorder is declared before the hub and therefore outlives it.
  parts.recording = recorder_.get();
  parts.shards = config_.threads;
  parts.gate = &credentials_.gate();
  parts.cluster = cluster_.get();
  if (cluster_ != nullptr) {
    parts.drain = [this](bool begin) { return shutdown_->OnDrainRequest(begin); };
  }
  parts.is_own_address = IsOwnAddress;
  hub_ = std::make_unique<Hub>(std::move(parts));
}

void Daemon::MakeShutdown() {
  Shutdown::Parts parts;
  parts.io = &io_;
  parts.hub = hub_.get();
  if (cluster_ != nullptr) {
    parts.mover = std::make_unique<Mover>(io_, &credentials_.gate(), hub_.get(), RandomNumber);
  }
  parts.drain_time = [this] { return FromSeconds(config_.limits.drain_seconds); };
  parts.on_begin = [this] {
    if (options_.manager != nullptr) options_.manager->Stopping();
    // While it completes its last picture, messages leave. Nobody receives pictures any more.
    if (RenderThread* const render = rendering_.thread()) render->Stop();
  };
  parts.stop = [this] {
    ports_->Drain();
    if (http_) http_->Drain();
  };
  // In a cluster, subjects move to other nodes instead.
  if (cluster_ == nullptr && options_.manager != nullptr && ServiceManager::StoreSize() > 0) {
    parts.let_go = [this] {
      assets_.character.reset();
      return rendering_.LetGo();
    };
    parts.leave = [this] { return ports_->Leave(); };
    parts.save = [this] { return Leave(); };
    parts.owes_frames = [this] { return ports_->OwesFrames(); };
  }
  parts.is_sending = [this] { return ports_->IsSending() || (http_ && http_->viewers() > 0); };
  parts.close = [this] { ports_->CloseAll(); };
  shutdown_ = std::make_unique<Shutdown>(std::move(parts));
}

Status Daemon::Listen() {
  MakeHub();
  MakeShutdown();
  ports_ = std::make_unique<Ports>(config_, Ports::Parts{.io = &io_,
                                                         .hub = hub_.get(),
                                                         .metrics = metrics_,
                                                         .waiting = &waiting_,
                                                         .credentials = &credentials_,
                                                         .recording = recorder_.get()});
  FURROW_RETURN_IF_ERROR(ports_->Open(config_, options_.listeners, former_));
  FURROW_RETURN_IF_ERROR(StartOsc());
  FURROW_RETURN_IF_ERROR(ListenToWeb());
  FURROW_RETURN_IF_ERROR(StartCluster());
  ResumeSessions(Transfer(), former_);
  return {};
}

TransferParts Daemon::Transfer() const {
  return {.ports = ports_.get(),
          .hub = hub_.get(),
          .metrics = metrics_,
          .manager = options_.manager,
          .session = session_};
}

// Between reading and sending for the last time.
bool Daemon::Leave() {
  if (exit_code_ != ExitCode::kOk) return false;  // the next daemon must meet the fault, too
  std::optional<int> http;
  if (http_ && !options_.listeners.http) http = http_->listening_socket();
  has_left_ = LeaveSessions(Transfer(), http);
  return has_left_;
}

// The renderer is there, or has failed, or there is none. `loaded`: the character's pictures.
void Daemon::OnRenderer(const Status& loaded) {
  if (std::exchange(loads_later_, false)) {
    FinishConfinement();
    // Somebody who starts the daemon wants to hear of a faulty file. Lack of memory may pass, and a
    // daemon that goes on with the sessions of a former one goes on.
    if (!loaded.ok() && loaded.code() != StatusCode::kUnavailable && !former_->exists()) {
      exit_code_ = ExitCode::kBadInput;
      return shutdown_->Request();
    }
    if (const RenderThread& thread = *rendering_.thread(); !thread.is_stuck()) {
      spdlog::info("rendering on {}", thread.description());
    }
  }
  // A program that embeds the daemon has its own uses for the processor.
  if (rendering_.thread() != nullptr && options_.owns_process && !shutdown_->has_begun()) {
    rendering_.Prepare(*assets_.rig, assets_.settings);
  }
}

// No thread has started yet, so the hub needs no lock.
Status Daemon::StartOsc() {
  OscTargets::Parts parts;
  parts.metrics = metrics_;
  parts.shards = config_.threads;
  parts.allow = config_.osc.allow;
  parts.own_ports = {ports_->udp()};
  for (const auto& port : {ports_->mocap().vmc_port(), ports_->mocap().livelink_face_port()}) {
    if (port) parts.own_ports.push_back(*port);
  }
  parts.on_active = [this](bool active) {
    // Each shard has sockets and buffers of its own, so the shards' threads need no lock here.
    hub_->SetOnWeights(active ? [this](const Subject& subject, int shard,
                                       Time now) { osc_->Send(subject, shard, now); }
                              : OnWeights());
  };
  osc_ = std::make_unique<OscTargets>(io_, std::move(parts));
  for (auto& [target, profile] : osc_outputs_) {
    const Status status = osc_->AddConfigured(target, std::move(profile));
    if (!status.ok()) return status.Within("osc");
  }
  return {};
}

Status Daemon::LoadPlayer() {
  auto player = server::LoadPlayer(config_);
  FURROW_RETURN_IF_ERROR(player);
  playback_.SetConfigured(*std::move(player));
  return {};
}

void Daemon::MakeApi() {
  Api::Parts parts;
  parts.session = session_;
  parts.started = ReadClock();
  parts.metrics = metrics_;
  parts.pictures = rendering_.thread();
  parts.video = rendering_.video();
  parts.wants_pictures = config_.render && assets_.character != nullptr;
  parts.playback = &playback_;
  parts.max_upload_bytes = [this] { return config_.http.upload_bytes(); };
  parts.osc = osc_.get();
  // Called on the hub's thread while `http_` exists; the counters are atomic.
  parts.connections = [this] { return http_->connections(); };
  parts.viewers = [this] { return http_->viewers(); };
  if (recorder_ != nullptr) {
    parts.recording_is_paused = [this] { return recorder_->is_paused(); };
  }
  parts.config_is_refused = [this] { return reload_ != nullptr && reload_->is_refused(); };
  parts.waiting = &waiting_;
  parts.open_to_network =
      (ListensToNetwork(config_) || ports_->adopted_network()) && !credentials_.gate().required();
  parts.gate = &credentials_.gate();
  parts.cluster = cluster_.get();
  parts.sources = {
      .bind = config_.bind,
      .allow = [this] { return config_.mocap_allow; },
      .livelink_face = [this](Time now) { return ports_->mocap().ReportLiveLinkFace(now); },
      .vmc = [this](Time now) { return ports_->mocap().ReportVmc(now); },
      .give = [this](bool vmc, const std::string& sender,
                     Time now) { return ports_->Give(vmc, sender, now); },
      .unix_now = ReadUnixClock};
  api_ = std::make_unique<Api>(std::move(parts));
}

// Runs on shard 0's thread.
ApiReply Daemon::AnswerWeb(const ApiRequest& request, Hub& hub, Time now) {
  // Strangers may ask the probes, and as often as they like, so these stop no other shard.
  if (IsProbe(request.url.path)) return api_->Answer(request, hub, now);
  // The other shards wait until the reply is complete, so replies are quick.
  const Hub::ExclusiveLock lock(hub, 0);
  return api_->Answer(request, hub, now);
}

Status Daemon::ListenToWeb() {
  if (!config_.http.enabled) return {};
  MakeApi();
  loader_ = std::make_unique<RecordingLoader>(
      RecordingLoader::Parts{.read = ReadOptions(config_),
                             .runs_helpers = options_.confined.empty(),
                             .metrics = metrics_});
  auto started = HttpServer::Listen(
      {.config = config_.http,
       .bind = config_.bind,
       .listener = options_.listeners.http
                       ? options_.listeners.http
                       : former_->TakeHttp(config_.bind, config_.http.port.value_or(0)),
       .find_character =
           [package = rendering_.thread() != nullptr ? assets_.package : std::filesystem::path()] {
             return package.empty() ? package : FindWebPackage(package);
           },
       .post_to_hub =
           [this](std::function<void(Hub&, Time)> task) {
             // The time is read when the task runs: it may have waited behind other work.
             asio::post(io_, [this, task = std::move(task)] { task(*hub_, ReadClock()); });
           },
       .answer = [this](const ApiRequest& request, Hub& hub,
                        Time now) { return AnswerWeb(request, hub, now); },
       .metrics = metrics_,
       .waiting = &waiting_,
       .gate = &credentials_.gate(),
       .tls = &credentials_.tls(),
       .cluster = cluster_.get(),
       .loader = loader_.get()});
  FURROW_RETURN_IF_ERROR(started);
  http_ = *std::move(started);
  return {};
}

void Daemon::Announce() const {
  Ready ready;
  ready.tcp = ports_->tcp().port;
  ready.udp = ports_->udp();
  ready.render = rendering_.thread() != nullptr;
  ready.vmc = ports_->mocap().vmc_port();
  ready.livelink_face = ports_->mocap().livelink_face_port();
  const auto bound = [this](std::uint16_t port) { return HostPortText({config_.bind, port}); };
  std::string line = "furrowd ready tcp=" + HostPortText(ports_->tcp()) +
                     " udp=" + bound(ready.udp) + " render=" + (ready.render ? "on" : "off");
  if (ready.vmc) line += " vmc=" + bound(*ready.vmc);
  if (ready.livelink_face) line += " livelink_face=" + bound(*ready.livelink_face);
  if (http_) {
    ready.http = http_->address().port;
    line += " http=" + HostPortText(http_->address());
  }
  std::printf("%s\n", line.c_str());
  // Scripts wait for this line, and a pipe is buffered.
  std::fflush(stdout);
  if (options_.manager != nullptr) options_.manager->Ready(line);
  if (options_.on_ready) options_.on_ready(ready);
}

void Daemon::HandleSignals() {
  signals_.add(SIGTERM);
  signals_.add(SIGINT);
  signals_.async_wait([this](const asio::error_code& error, int) {
    if (!error) shutdown_->Request();
  });
  // What came before can be missed no more.
  if (early_signals::stop()) shutdown_->Request();
  if (!options_.reload) return;
  reload_ = std::make_unique<ReloadLoop>(
      ReloadLoop::Parts{.io = &io_,
                        .metrics = metrics_,
                        .manager = options_.manager,
                        .request = [this] { return MakeReloadRequest(); },
                        .take_over = [this](Reload* reload) { return TakeOver(reload); },
                        .is_draining = [this] { return shutdown_->has_begun(); },
                        .shut_down = [this] { shutdown_->Request(); }});
  reload_->Start();
  if (early_signals::reload()) std::raise(SIGHUP);
}

ExitCode Daemon::Serve() {
  ports_->Start();
  StartCriticalTask(io_, TickLoop());
  StartCriticalTask(io_, SecondLoop());
  StartCriticalTask(io_, PlayLoop());
  if (options_.handle_signals) HandleSignals();
  // Another thread may request the stop; only the event loop's thread may shut down.
  const std::stop_callback on_stop(options_.stop,
                                   [this] { asio::post(io_, [this] { shutdown_->Request(); }); });
  // The web server's thread asks the cluster, so it starts after the cluster knows this node.
  if (http_) http_->Start();
  if (!loads_later_) OnRenderer({});
  // After all parts have started: a client that reads the line may connect at once.
  Announce();
  RunLoop(io_, metrics_);
  // The next daemon waits for the end of this process.
  if (has_left_ && options_.handle_signals) EndProcess();
  http_.reset();  // its thread posts to io_, so it ends first
  EndUploads();
  EndRendering();
  return exit_code_;
}

// Nobody waits any more for a recording that is still being read.
void Daemon::EndUploads() {
  if (loader_ == nullptr || !options_.handle_signals) return;
  if (!loader_->WaitUntil(shutdown_->deadline())) EndProcess();
}

// A process that was told to end waits until the deadline of its shutdown, and then ends without
// the last picture. An embedding program goes on, so it must wait.
void Daemon::EndRendering() {
  const auto deadline =
      options_.handle_signals ? std::optional(shutdown_->deadline()) : std::nullopt;
  rendering_.End(deadline, [this] {
    spdlog::warn("exiting before the last picture is complete: limits.drain_seconds are over");
    EndProcess();
  });
}

ExitCode Daemon::Abandon(ExitCode exit_code) {
  exit_code_ = exit_code;
  if (recorder_ != nullptr) recorder_->Discard();
  if (options_.owns_process) rendering_.End(ReadClock(), [this] { EndProcess(); });
  return exit_code;
}

// Without freeing memory or waiting for threads.
void Daemon::EndProcess() {
  recorder_.reset();  // closes the file
  cluster_.reset();   // gives the leases back; the hub is not used any more
  // Other threads may still write to the log, so it must not go away.
  Log::WriteOut(kLastLines);
  std::fflush(stdout);
  std::_Exit(static_cast<int>(exit_code_));
}

asio::awaitable<void> Daemon::TickLoop() {
  asio::steady_timer timer(io_);
  auto due = std::chrono::steady_clock::now();
  while (true) {
    // A fixed grid of deadlines does not drift. After a stall, missed ticks are left out, because a
    // burst of ticks would delay the loop further.
    due = std::max(due + kTick, std::chrono::steady_clock::now());  // skip missed ticks
    timer.expires_at(due);
    co_await timer.async_wait(kAwaitTuple);
    WithinMemory(metrics_, [&] {
      const Time now = ReadClock();
      hub_->Tick(now, now - due.time_since_epoch());
      if (osc_->limits_rates()) {
        const Hub::ExclusiveLock lock(*hub_, 0);
        osc_->SendOwed(hub_->subjects(), now);
      }
      ports_->Tick(now);
    });
  }
}

asio::awaitable<void> Daemon::SecondLoop() {
  StatusLine status_line(metrics_);
  while (true) {
    co_await Pause(kSecond);
    WithinMemory(metrics_, [&] { EverySecond(&status_line); });
  }
}

void Daemon::EverySecond(StatusLine* status_line) {
  const Time now = ReadClock();
  if (const std::size_t used = MemoryReserve::Refill(); used > 0) {
    metrics_->Add(Counter::kReserveUsed, used);
    spdlog::warn("an allocation failed: the daemon released {} MiB of its reserve of memory",
                 used * MemoryReserve::kChunkBytes >> 20);
  }
  if (RenderThread* const render = rendering_.thread()) render->Watch(now);
  credentials_.ReadIfChanged();
  // One that another thread was still noting when the event loop took over.
  if (options_.handle_signals && early_signals::stop()) shutdown_->Request();
  if (reload_) reload_->LookAtTerminal();
  if (!config_.verbose && options_.manager == nullptr) return;
  std::string line;
  {
    const Hub::ExclusiveLock lock(*hub_, 0);
    line = status_line->Next(hub_->num_subjects(), hub_->num_subscriptions(), now);
  }
  if (config_.verbose) spdlog::info("{}", line);
  if (options_.manager != nullptr && !shutdown_->has_begun()) options_.manager->Alive(line);
}

asio::awaitable<void> Daemon::PlayLoop() {
  playback_.Start(
      hub_.get(), ReadClock(), [this] { play_timer_.cancel(); },
      [this](std::unique_ptr<Player> player) { loader_->Release(std::move(player)); });
  while (true) {
    const Time now = ReadClock();
    // Advance() says when the next frame is due, so the loop wakes only for frames and changes.
    Time next = now + kTick;
    WithinMemory(metrics_, [&] { next = playback_.Advance(now); });
    play_timer_.expires_at(std::chrono::steady_clock::time_point(next));
    co_await play_timer_.async_wait(kAwaitTuple);
  }
}

ReloadRequest Daemon::MakeReloadRequest() {
  (void)rig_files_.Changed();
  return {.running = config_,
          .read = [this]() -> Result<Config> {
            auto read = options_.reload();
            FURROW_RETURN_IF_ERROR(read);
            return WithoutMissingParts(*std::move(read));
          },
          .drawn = rendering_.thread() != nullptr ? assets_.character : nullptr,
          .rig_changed = rig_files_.rig_changed(),
          .maps_changed = rig_files_.maps_changed(),
          .is_confined = !options_.confined.empty()};
}

// The rig first, because it alone can fail, and then nothing has changed.
Status Daemon::TakeOver(Reload* reload) {
  const ReloadPlan& plan = reload->plan;
  const Config& config = plan.config;
  {
    const Hub::ExclusiveLock lock(*hub_, 0);
    if (reload->files) {
      const auto& rig = reload->files->rig;
      const Status status = hub_->SetRigAndMaps(rig != nullptr ? rig : hub_->shared_rig(),
                                                std::move(reload->files->maps), ReadClock());
      if (!status.ok()) return status.Within("rig");
    }
    if (rendering_.thread() != nullptr && rig_files_.rig_changed()) {
      spdlog::warn("the file of the rig changed: takes effect after a restart");
    }
    hub_->SetLimits(config.limits);
    waiting_.SetMost(config.limits.waiting_bytes());
    osc_->SetAllowed(config.osc.allow);
  }
  credentials_.TakeOver(reload);
  ports_->Reload(config, config_);
  if (http_) http_->Reload(config.http);
  if (config.log_level != config_.log_level) Log::SetLevel(config.log_level);
  config_ = config;
  rig_files_ = std::move(reload->rig_files);
  spdlog::info("read the configuration, keys and certificates again; took effect: {}",
               plan.applied.empty() ? "nothing" : Joined(plan.applied));
  if (IsSystemdCopy(config.security.keys) || IsSystemdCopy(config.security.tls.certificate)) {
    spdlog::warn(
        "keys and certificates are systemd's copies (LoadCredential=): changes take "
        "'systemctl restart furrowd'");
  }
  for (const std::string& key : plan.needs_restart) {
    spdlog::warn("{} changed: takes effect after a restart", key);
  }
  return {};
}

}  // namespace furrow::server
