// SPDX-License-Identifier: Apache-2.0
#include "server/daemon.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <asio/signal_set.hpp>
#include <asio/steady_timer.hpp>
#include <spdlog/spdlog.h>

#include "base/joined.h"
#include "base/status.h"
#include "character/pictures/picture_codec.h"
#include "motion/find_recording.h"
#include "protocol/secure/token/key_ring.h"
#include "rig/rig_file.h"
#include "server/assets.h"
#include "server/cluster/handover/mover.h"
#include "server/cluster/setup/make_coordinator.h"
#include "server/config/log.h"
#include "server/config/osc_profile_file.h"
#include "server/core/network_address.h"
#include "server/core/status_line.h"
#include "server/core/within_memory.h"
#include "server/daemon_files.h"
#include "server/http/api/api.h"
#include "server/http/http_server.h"
#include "server/machine/confine.h"
#include "server/machine/own_addresses.h"
#include "server/net/await_tuple.h"
#include "server/net/clock.h"
#include "server/net/critical_task.h"
#include "server/net/mocap_inputs.h"
#include "server/net/pause.h"
#include "server/net/run_loop.h"
#include "server/net/tcp/tcp_server.h"
#include "server/net/udp/secure_sessions.h"
#include "server/net/udp/udp_port.h"
#include "server/osc/osc_targets.h"
#include "server/pipeline/preparation.h"
#include "server/pipeline/render_thread.h"
#include "server/playback/player.h"
#include "server/recording/recorder.h"
#include "server/reload.h"
#include "server/reload_loop.h"
#include "server/session/access/key_file.h"
#include "server/session/access/token_gate.h"
#include "server/session/hub.h"
#include "server/tls/tls_identity.h"

namespace furrow::server {
namespace {

constexpr auto kTick = std::chrono::milliseconds(10);
constexpr auto kSecond = std::chrono::seconds(1);
// How often a shutdown checks whether the peers have received everything.
constexpr auto kDrainPoll = std::chrono::milliseconds(5);
// The time that joining a thread may take after it has ended.
constexpr Time kJoinTime = std::chrono::milliseconds(50);

// Returns unpredictable numbers, never 0, for session numbers and the tokens that prove an address.
std::uint64_t RandomNumber() {
  std::random_device source;
  std::uint64_t number = 0;
  while (number == 0) number = (static_cast<std::uint64_t>(source()) << 32) | source();
  return number;
}

// An installation without the module of pictures sends weights alone.
Config WithoutMissingParts(Config config) {
  config.render = config.render && (config.require_render || character::IsPictureCodecInstalled());
  return config;
}

// The OSC targets of the configuration, each with its profile.
using OscOutputs = std::vector<std::pair<OscTargetConfig, protocol::mocap::OscProfile>>;

// The parts of one daemon. Members are declared in the order of their dependencies.
class Daemon {
 public:
  // Keeps a reference to `options`, which outlives it.
  Daemon(const Config& config, const RunOptions& options, Assets assets, OscOutputs osc_outputs)
      : config_(config),
        options_(options),
        assets_(std::move(assets)),
        osc_outputs_(std::move(osc_outputs)),
        metrics_(options.metrics != nullptr ? options.metrics : &own_metrics_),
        signals_(io_),
        gate_({.security = config.security.mode,
               .name = config.security.name,
               .tokens_in_clear = config.security.tokens_in_clear},
              &UnixSeconds, metrics_),
        secure_(&gate_, &UnixSeconds, std::min(config.limits.max_udp_peers, 0xFFFF), config.threads,
                metrics_),
        keys_file_(config.security.keys),
        tls_(config.security.tls),
        rig_files_(config),
        confines_(options.confine && config.security.confine) {}

  // Call these in this order. Each leaves out what the configuration does not ask for.
  Status LoadPlayer();
  Status StartRendering();
  Status LoadCluster();
  void Confine();
  Status StartRecording();
  Status LoadKeys();
  Status LoadTls() { return tls_.Load(); }
  Status Listen();
  void Serve();

 private:
  void MakeHub();
  void SetKeys(protocol::secure::KeyRing keys);
  Status CheckListener(const ServiceManager::Listener& listener);
  Status StartCluster();
  void WarnAboutLoopback() const;
  Status StartOsc();
  Status StartWeb();
  void Announce() const;
  asio::awaitable<void> TickLoop();
  asio::awaitable<void> SecondLoop();
  void EverySecond(StatusLine* status_line);
  asio::awaitable<void> PlayLoop();
  asio::awaitable<void> Drain();
  asio::awaitable<void> MoveAndEnd();
  asio::awaitable<void> MoveInTime();
  protocol::DrainState OnDrainRequest(bool begin);
  void RequestDrain();
  void MakeVideo();
  ReloadRequest MakeReloadRequest();
  Status TakeOver(Reload* reload);
  void DeliverPicture(const FinishedPicture& picture);
  void PrepareRendering();
  void StopRendering();

  Config config_;  // TakeOver() changes it; only the main thread uses it after the start
  const RunOptions& options_;
  Assets assets_;
  OscOutputs osc_outputs_;
  Metrics own_metrics_;
  Metrics* const metrics_;
  std::uint64_t session_ = 0;
  asio::io_context io_{1};  // run by the calling thread, which owns shard 0
  asio::signal_set signals_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<VideoEncoders> video_;  // used by the render thread
  std::unique_ptr<RenderThread> render_;
  std::unique_ptr<Player> player_;   // a peer of the hub, so it outlives the hub
  std::unique_ptr<OscTargets> osc_;  // called by the hub, so it outlives the hub
  TokenGate gate_;
  SecureSessions secure_;
  KeyFile keys_file_;
  TlsIdentity tls_;
  RigFiles rig_files_;
  std::unique_ptr<Coordinator> cluster_;  // null: alone; used by the hub, so it outlives it
  std::unique_ptr<Hub> hub_;
  std::unique_ptr<Mover> mover_;  // null: alone
  std::unique_ptr<TcpServer> tcp_;
  std::unique_ptr<UdpPort> udp_;
  MocapInputs mocap_;
  std::unique_ptr<Api> api_;
  std::unique_ptr<HttpServer> http_;
  const bool confines_;
  bool render_is_confined_ = false;  // used by the render thread
  bool on_network_ = false;          // a socket of the service manager is
  bool draining_ = false;
  std::atomic<bool> moves_ = false;         // subjects are moved to other nodes
  std::atomic<bool> end_is_known_ = false;  // whoever asked for it knows that all have moved
  Time drain_deadline_{0};
  std::unique_ptr<ReloadLoop> reload_;  // its thread ends before the members above
};

// Loads the module before the daemon is confined.
void Daemon::MakeVideo() {
  if (config_.max_video_encoders == 0) {
    video_ = std::make_unique<VideoEncoders>(nullptr, 0, "render.max_video_encoders is 0");
    return;
  }
  const auto codec = render::GetVideoCodec();
  if (codec.ok()) {
    spdlog::info("H.264 by {}, for at most {} viewers", (*codec)->library,
                 config_.max_video_encoders);
    video_ = std::make_unique<VideoEncoders>(*codec, config_.max_video_encoders);
    return;
  }
  spdlog::warn("pictures are sent as JPEG only: {}", codec.status().ToString());
  // Without the paths of this machine, because viewers read it.
  video_ = std::make_unique<VideoEncoders>(nullptr, 0, "its library cannot be loaded; see its log");
}

Status Daemon::StartRendering() {
  if (!config_.render || assets_.character == nullptr) return {};
  MakeVideo();
  spdlog::info("starting the renderer");
  auto started = RenderThread::Start(
      &assets_.character->skeleton,
      [this, device = config_.render_device, files = FilesOf(config_)] {
        auto renderer = render::Renderer::Create(
            *assets_.character,
            {.device = device, .max_texture_bytes = PictureViews::kMaxTextureBytes});
        // After the first one: drivers may run helper programs to prepare their devices. Threads
        // confine themselves, so this one does, too.
        if (confines_ && !std::exchange(render_is_confined_, true)) {
          (void)server::Confine(files);
        }
        return renderer;
      },
      metrics_, &ReadClock,
      [this](FinishedPicture picture) {
        // Called on the render thread. The picture crosses to shard 0's thread by value, because
        // only that thread may call OnPicture(). `hub_` does not exist yet while the renderer
        // starts, but no picture is requested before.
        asio::post(io_, [this, picture = std::move(picture)] { DeliverPicture(picture); });
      },
      video_.get());
  if (started.ok()) {
    render_ = *std::move(started);
    spdlog::info("rendering on {}", render_->description());
    return {};
  }
  // Weights work without OpenGL, so the daemon serves them unless the user insists on pictures.
  if (config_.require_render) return started.status();
  spdlog::error("cannot render pictures: {}", started.status().ToString());
  return {};
}

void Daemon::DeliverPicture(const FinishedPicture& picture) {
  hub_->OnPicture(picture, ReadClock());
  if (picture.bytes.empty()) return;
  metrics_->Observe(Timing::kPictureRequestToSend, ReadClock() - picture.submitted);
}

// Before the daemon is confined: loads a module and reads a file.
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
                         .tcp = tcp_->address().port,
                         .udp = udp_->port(),
                         .http = http_ ? http_->address().port : std::uint16_t{0}};
  spdlog::info("node '{}' of a cluster, at {}", self.name, self.host);
  return cluster_->Start(self);
}

// Before the threads that serve strangers start, because they inherit it.
void Daemon::Confine() {
  if (!options_.confine) return;
  if (!confines_) {
    spdlog::info("not confined: security.confine is off");
    return;
  }
  std::error_code ignored;  // the recorder reports it
  if (!config_.record.folder.empty()) {
    std::filesystem::create_directories(config_.record.folder, ignored);
  }
  spdlog::info("confined: {}", server::Confine(FilesOf(config_)));
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
  parts.session = session_ = RandomNumber();
  parts.rig = assets_.rig;
  // Without a renderer, weights need the character only if joints may move its shapes.
  if (assets_.shapes != nullptr) {
    parts.character = {.skeleton = &assets_.shapes->skeleton,
                       .shapes = assets_.shapes->names,
                       .surface = &assets_.shapes->surface};
  }
  if (render_ != nullptr) {
    parts.character.skeleton = &assets_.character->skeleton;
    parts.character.shapes = assets_.character->shapes;
    parts.character.shape_rules = assets_.character->shape_rules;
  }
  parts.skeletons = assets_.skeletons;
  parts.shape_matcher = assets_.shape_matcher;
  parts.pictures = render_.get();
  parts.settings = assets_.settings;
  parts.metrics = metrics_;
  parts.random = RandomNumber;
  parts.clock = ReadClock;
  // The recorder is declared before the hub and therefore outlives it.
  parts.recording = recorder_.get();
  parts.shards = config_.threads;
  parts.gate = &gate_;
  parts.cluster = cluster_.get();
  if (cluster_ != nullptr) parts.drain = [this](bool begin) { return OnDrainRequest(begin); };
  parts.is_own_address = IsOwnAddress;
  hub_ = std::make_unique<Hub>(std::move(parts));
  if (cluster_ != nullptr) {
    mover_ = std::make_unique<Mover>(io_, &gate_, hub_.get(), RandomNumber);
  }
}

// The configuration does not know where the sockets of the service manager listen, and an open
// daemon must not be on the network without anybody having said so.
Status Daemon::CheckListener(const ServiceManager::Listener& listener) {
  if (IsLoopback(listener.address)) return {};
  on_network_ = true;
  if (gate_.required() || config_.open) return {};
  return Status(StatusCode::kUnavailable,
                "a socket of the service manager listens on " + listener.address +
                    ", where everybody could publish and change settings",
                "", "set --security required, or --open");
}

Status Daemon::Listen() {
  MakeHub();
  // ValidateConfig() has checked the address, so this does not throw.
  const auto address = asio::ip::make_address(config_.bind);
  tcp_ = std::make_unique<TcpServer>(io_, config_.limits, hub_.get(), metrics_, &tls_);
  const auto& listeners = options_.listeners;
  for (const auto& listener : {listeners.tcp, listeners.http}) {
    if (listener) FURROW_RETURN_IF_ERROR(CheckListener(*listener));
  }
  FURROW_RETURN_IF_ERROR(listeners.tcp ? tcp_->Adopt(*listeners.tcp)
                                       : tcp_->Open({address, config_.tcp}));
  udp_ = std::make_unique<UdpPort>(io_, config_.threads, config_.limits, hub_.get(), metrics_,
                                   recorder_.get(), &secure_, gate_.required());
  FURROW_RETURN_IF_ERROR(udp_->Open({address, config_.udp}));
  FURROW_RETURN_IF_ERROR(mocap_.Open({.bind = config_.bind,
                                      .vmc = config_.vmc,
                                      .livelink_face = config_.livelink_face,
                                      .allow = config_.mocap_allow},
                                     io_, hub_.get(), metrics_));
  WarnAboutLoopback();
  FURROW_RETURN_IF_ERROR(StartOsc());
  FURROW_RETURN_IF_ERROR(StartWeb());
  return StartCluster();
}

// The port is useless for phones otherwise, and nothing on them says why.
void Daemon::WarnAboutLoopback() const {
  if (!mocap_.livelink_face_port() || !IsLoopback(config_.bind)) return;
  spdlog::warn(
      "--livelink-face listens on {} only, so no phone can reach it: --bind 0.0.0.0 --open opens "
      "the daemon to the network (docs/SECURITY.md)",
      config_.bind);
}

Status Daemon::LoadKeys() {
  auto keys = keys_file_.Load();
  FURROW_RETURN_IF_ERROR(keys);
  SetKeys(*std::move(keys));
  return {};
}

void Daemon::SetKeys(protocol::secure::KeyRing keys) {
  secure_.SetKeys(keys);
  gate_.SetKeys(std::move(keys));
}

// No thread has started yet, so the hub needs no lock.
Status Daemon::StartOsc() {
  OscTargets::Parts parts;
  parts.metrics = metrics_;
  parts.shards = config_.threads;
  parts.allow = config_.osc.allow;
  parts.own_ports = {udp_->port()};
  for (const auto& port : {mocap_.vmc_port(), mocap_.livelink_face_port()}) {
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
  if (config_.play.empty()) return {};
  const auto file = motion::FindRecording(config_.play.string());
  FURROW_RETURN_IF_ERROR(file);
  auto player = Player::Load(*file, PlayOptions(config_));
  FURROW_RETURN_IF_ERROR(player);
  player_ = *std::move(player);
  return {};
}

Status Daemon::StartWeb() {
  if (!config_.http.enabled) return {};
  Api::Parts parts;
  parts.session = session_;
  parts.started = ReadClock();
  parts.metrics = metrics_;
  parts.pictures = render_.get();
  parts.video = video_.get();
  parts.wants_pictures = config_.render && assets_.character != nullptr;
  if (render_ != nullptr) parts.renderer = render_->description();
  parts.player = player_.get();
  parts.osc = osc_.get();
  // Called on the hub's thread while `http_` exists; the counters are atomic.
  parts.connections = [this] { return http_->connections(); };
  parts.viewers = [this] { return http_->viewers(); };
  if (recorder_ != nullptr) {
    parts.recording_is_paused = [this] { return recorder_->is_paused(); };
  }
  parts.open_to_network = (ListensToNetwork(config_) || on_network_) && !gate_.required();
  parts.gate = &gate_;
  parts.cluster = cluster_.get();
  parts.sources = {.bind = config_.bind,
                   .allow = [this] { return config_.mocap_allow; },
                   .livelink_face = [this](Time now) { return mocap_.ReportLiveLinkFace(now); },
                   .vmc = [this](Time now) { return mocap_.ReportVmc(now); }};
  api_ = std::make_unique<Api>(std::move(parts));
  auto started = HttpServer::Start(
      {.config = config_.http,
       .bind = config_.bind,
       .listener = options_.listeners.http,
       .character = render_ != nullptr ? assets_.web_package : std::filesystem::path(),
       .post_to_hub =
           [this](std::function<void(Hub&, Time)> task) {
             // The time is read when the task runs: it may have waited behind other work.
             asio::post(io_, [this, task = std::move(task)] { task(*hub_, ReadClock()); });
           },
       .answer =
           [this](const ApiRequest& request, Hub& hub, Time now) {
             // Runs on shard 0's thread. Strangers may ask the probes, and as often as they like,
             // so these stop no other shard.
             if (IsProbe(request.url.path)) return api_->Answer(request, hub, now);
             // The other shards wait until the reply is complete, so replies are quick.
             const Hub::ExclusiveLock lock(hub, 0);
             return api_->Answer(request, hub, now);
           },
       .metrics = metrics_,
       .gate = &gate_,
       .tls = &tls_});
  FURROW_RETURN_IF_ERROR(started);
  http_ = *std::move(started);
  return {};
}

void Daemon::Announce() const {
  Ready ready;
  ready.tcp = tcp_->address().port;
  ready.udp = udp_->port();
  ready.render = render_ != nullptr;
  ready.vmc = mocap_.vmc_port();
  ready.livelink_face = mocap_.livelink_face_port();
  const auto bound = [this](std::uint16_t port) { return HostPortText({config_.bind, port}); };
  std::string line = "furrowd ready tcp=" + HostPortText(tcp_->address()) +
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

// While nobody watches yet, so that the first viewer does not wait for the shader compiler.
void Daemon::PrepareRendering() {
  const auto camera = render_->Preset("face");
  if (!camera.ok()) return;
  auto jobs = Preparations(*assets_.character, *assets_.rig, assets_.settings, *camera);
  if (jobs.ok()) render_->Prepare(*std::move(jobs));
}

void Daemon::Serve() {
  tcp_->Start();
  udp_->Start();
  mocap_.Start();
  StartCriticalTask(io_, TickLoop());
  StartCriticalTask(io_, SecondLoop());
  if (player_) StartCriticalTask(io_, PlayLoop());
  if (options_.handle_signals) {
    signals_.add(SIGTERM);
    signals_.add(SIGINT);
    signals_.async_wait([this](const asio::error_code& error, int) {
      if (!error) RequestDrain();
    });
    if (options_.reload) {
      reload_ = std::make_unique<ReloadLoop>(
          ReloadLoop::Parts{.io = &io_,
                            .metrics = metrics_,
                            .manager = options_.manager,
                            .request = [this] { return MakeReloadRequest(); },
                            .take_over = [this](Reload* reload) { return TakeOver(reload); },
                            .is_draining = [this] { return draining_; },
                            .shut_down = [this] { RequestDrain(); }});
      reload_->Start();
    }
  }
  // Another thread may request the stop; only the event loop's thread may drain.
  const std::stop_callback on_stop(options_.stop,
                                   [this] { asio::post(io_, [this] { RequestDrain(); }); });
  // After all parts have started: a client that reads the line may connect at once.
  Announce();
  // A program that embeds the daemon has its own uses for the processor.
  if (render_ && options_.confine) PrepareRendering();
  RunLoop(io_, metrics_);
  http_.reset();  // both post to io_, so they end first
  StopRendering();
}

// The render thread may be in the middle of a large picture, which nothing can interrupt. A process
// that was told to end waits until the deadline of Drain() for it, and then ends without it.
void Daemon::StopRendering() {
  if (render_ == nullptr) return;
  const std::future<void> ended = std::async(std::launch::async, [this] { render_.reset(); });
  // An embedding program goes on, so it must wait.
  if (!options_.handle_signals) return;
  // Drain() has stopped the thread, so it has usually ended by now, and is only joined.
  const Time left = std::max(drain_deadline_ - ReadClock(), kJoinTime);
  if (ended.wait_for(left) == std::future_status::ready) return;
  spdlog::warn("ends before a picture is complete: it takes longer than limits.drain_seconds");
  recorder_.reset();  // closes the file
  spdlog::shutdown();
  std::fflush(stdout);
  std::_Exit(static_cast<int>(ExitCode::kOk));
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
      mocap_.Tick(now);
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
  if (render_) render_->Watch(now);
  if (auto keys = keys_file_.ReadIfChanged()) SetKeys(*std::move(keys));
  tls_.ReadIfChanged();
  if (reload_) reload_->LookAtTerminal();
  if (!config_.verbose && options_.manager == nullptr) return;
  std::string line;
  {
    const Hub::ExclusiveLock lock(*hub_, 0);
    line = status_line->Next(hub_->num_subjects(), hub_->num_subscriptions(), now);
  }
  if (config_.verbose) spdlog::info("{}", line);
  if (options_.manager != nullptr && !draining_) options_.manager->Alive(line);
}

asio::awaitable<void> Daemon::PlayLoop() {
  asio::steady_timer timer(io_);
  player_->Start(hub_.get(), ReadClock());
  while (true) {
    const Time now = ReadClock();
    // Advance() says when the next frame is due, so the loop wakes only for frames.
    timer.expires_after(player_->Advance(now) - now);
    co_await timer.async_wait(kAwaitTuple);
  }
}

void Daemon::RequestDrain() {
  // A second SIGTERM must not start a second shutdown.
  if (std::exchange(draining_, true)) return;
  StartCriticalTask(io_, Drain());
}

// May run on any shard's thread.
protocol::DrainState Daemon::OnDrainRequest(bool begin) {
  if (begin && !moves_.exchange(true)) {
    asio::post(io_, [this] { StartCriticalTask(io_, MoveAndEnd()); });
  }
  const Mover::Progress progress = mover_->progress();
  protocol::DrainState state;
  state.draining = moves_;
  state.moved = progress.moved;
  state.why = MessageSender::Truncate(progress.why);
  if (state.draining && hub_->num_subjects() == 0) end_is_known_ = true;
  return state;
}

// Moves all subjects, however long that takes, and ends then.
asio::awaitable<void> Daemon::MoveAndEnd() {
  if (draining_) co_return;
  spdlog::info("moves its subjects to other nodes");
  co_await mover_->Run();
  for (const Time end = ReadClock() + kSecond; !end_is_known_ && ReadClock() < end;) {
    co_await Pause(kDrainPoll);
  }
  RequestDrain();
}

// Moves the subjects until shortly before the deadline of Drain().
asio::awaitable<void> Daemon::MoveInTime() {
  const Time left = drain_deadline_ - ReadClock();
  mover_->EndBy(ReadClock() + left * 3 / 4);
  if (!moves_.exchange(true)) {
    co_await mover_->Run();
  } else {
    while (mover_->running()) co_await Pause(kDrainPoll);
  }
}

// Says goodbye to all peers, lets queued messages leave until the deadline, then ends the event
// loop.
asio::awaitable<void> Daemon::Drain() {
  spdlog::info("shutting down");
  if (options_.manager != nullptr) options_.manager->Stopping();
  drain_deadline_ = ReadClock() + FromSeconds(config_.limits.drain_seconds);
  // While it completes its last picture, messages leave. Nobody receives pictures any more.
  if (render_) render_->Stop();
  if (mover_) co_await MoveInTime();
  hub_->Drain(ReadClock());
  // Joins the threads of the other shards: from here on only this thread uses the hub. The goodbyes
  // have left already, at the end of the hub's exclusive lock.
  udp_->Close();
  mocap_.Close();
  // Connections close by themselves once their queues are empty.
  tcp_->Drain();
  if (http_) http_->Drain();
  const auto is_awaited = [this] {
    return tcp_->num_sessions() > 0 || (http_ && http_->viewers() > 0);
  };
  while (is_awaited() && ReadClock() < drain_deadline_) co_await Pause(kDrainPoll);
  // Clients that did not read until the deadline lose what is left.
  tcp_->CloseAll();
  io_.stop();
}

ReloadRequest Daemon::MakeReloadRequest() {
  (void)rig_files_.Changed();
  return {.running = config_,
          .read = [this]() -> Result<Config> {
            auto read = options_.reload();
            FURROW_RETURN_IF_ERROR(read);
            return WithoutMissingParts(*std::move(read));
          },
          .drawn = render_ != nullptr ? assets_.character : nullptr,
          .rig_changed = rig_files_.rig_changed(),
          .maps_changed = rig_files_.maps_changed()};
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
    if (render_ != nullptr && rig_files_.rig_changed()) {
      spdlog::warn("the file of the rig changed: takes effect after a restart");
    }
    hub_->SetLimits(config.limits);
    osc_->SetAllowed(config.osc.allow);
  }
  keys_file_ = std::move(reload->keys_file);
  SetKeys(std::move(reload->keys));
  if (reload->tls) {
    tls_.Replace(config.security.tls, std::move(reload->tls_watches), *std::move(reload->tls));
  }
  tcp_->SetLimits(config.limits);
  if (http_) http_->Reload(config.http);
  // A new gate lets the holder of a port go.
  if (config.mocap_allow != config_.mocap_allow) mocap_.SetAllowed(config.mocap_allow);
  if (config.log_level != config_.log_level) Log::SetLevel(config.log_level);
  config_ = config;
  rig_files_ = std::move(reload->rig_files);
  spdlog::info("read the configuration, keys and certificates again; changed: {}",
               plan.applied.empty() ? "nothing" : Joined(plan.applied));
  for (const std::string& key : plan.needs_restart) {
    spdlog::warn("{} changed: takes effect after a restart", key);
  }
  return {};
}

ExitCode Fail(ExitCode code, const Status& status) {
  spdlog::error("{}", status.ToString());
  return code;
}

Result<OscOutputs> LoadOscOutputs(const Config& config) {
  std::vector<OscTargetConfig> targets = config.osc.targets;
  if (config.osc_out) {
    targets.insert(targets.begin(), {.to = *config.osc_out, .prefix = config.osc_prefix});
  }
  OscOutputs outputs;
  for (OscTargetConfig& target : targets) {
    auto profile = LoadOscProfile(target.profile);
    if (!profile.ok()) return profile.status().Within("osc.target");
    outputs.emplace_back(std::move(target), *std::move(profile));
  }
  return outputs;
}

void WarnAboutSecurity(const Config& config) {
  if (!ListensToNetwork(config)) return;
  const bool has_tls = config.security.tls.enabled();
  if (config.security.mode == Security::kOpen) {
    spdlog::warn(
        "open to the network: everybody who reaches {} may publish, watch and change settings",
        config.bind);
  } else if (has_tls) {
    return;
  } else if (config.security.tokens_in_clear) {
    spdlog::warn(
        "tokens over TCP and HTTP are not encrypted: everybody on the way can read and use them");
  } else {
    spdlog::info(
        "other computers are served over UDP only: TCP and HTTP are not encrypted without "
        "--tls-certificate");
  }
}

ExitCode LoadAndServe(const Config& asked, const RunOptions& options) {
  // Tests and embedders call Run() without ParseCommandLine(), which has validated already.
  if (Status status = ValidateConfig(asked); !status.ok()) return Fail(ExitCode::kUsage, status);
  const Config config = WithoutMissingParts(asked);
  if (asked.render && !config.render) {
    spdlog::warn("no pictures: the package furrow-pictures is not installed; weights go on");
  }
  Result<Assets> assets = LoadAssets(config);
  if (!assets.ok()) return Fail(ExitCode::kBadInput, assets.status());
  if (assets->rig->regions.empty()) {
    spdlog::warn(
        "the character has no wrinkle rig, so there are no weights and no wrinkles: put "
        "NAME.rig.json beside NAME.glb, or choose a rig by --rig");
  }
  WarnAboutSecurity(config);
  if (config.render && assets->character != nullptr) {
    for (const std::string& warning : assets->character->warnings) {
      spdlog::warn("character: {}", warning);
    }
    for (const std::string& name : assets->character->missing_rig_pictures) {
      spdlog::warn("picture '{}' of the rig is missing; wrinkles that need it are not rendered",
                   name);
    }
  }
  auto osc_outputs = LoadOscOutputs(config);
  if (!osc_outputs.ok()) return Fail(ExitCode::kBadInput, osc_outputs.status());
  Daemon daemon(config, options, *std::move(assets), *std::move(osc_outputs));
  if (Status status = daemon.LoadPlayer(); !status.ok()) {
    return Fail(ExitCode::kBadInput, status.At("--play"));
  }
  if (Status status = daemon.StartRendering(); !status.ok()) {
    return Fail(ExitCode::kFailed, status);
  }
  if (Status status = daemon.LoadCluster(); !status.ok()) {
    return Fail(status.code() == StatusCode::kUnavailable ? ExitCode::kFailed : ExitCode::kBadInput,
                status);
  }
  daemon.Confine();
  if (Status status = daemon.StartRecording(); !status.ok()) {
    return Fail(ExitCode::kFailed, status);
  }
  if (Status status = daemon.LoadKeys(); !status.ok()) {
    return Fail(ExitCode::kBadInput, status.Within("--keys"));
  }
  if (Status status = daemon.LoadTls(); !status.ok()) {
    return Fail(ExitCode::kBadInput, status.Within("tls"));
  }
  if (Status status = daemon.Listen(); !status.ok()) return Fail(ExitCode::kFailed, status);
  daemon.Serve();
  return ExitCode::kOk;
}

}  // namespace

ExitCode Run(const Config& config, const RunOptions& options) {
  try {
    return LoadAndServe(config, options);
  } catch (const std::exception& error) {  // such as out of memory or threads
    // Parts report errors as Status. Only the standard library and the event loop throw here.
    return Fail(ExitCode::kFailed, Status(StatusCode::kInternal, error.what(), "furrowd"));
  }
}

}  // namespace furrow::server
