// SPDX-License-Identifier: Apache-2.0
// The web API: paths, queries and bodies of strangers. The input is a list of requests that end
// with a zero byte, each "METHOD target", a line feed and a body. After "-METHOD", the client may
// only watch. Every answer is well formed, and a client that may only watch changes nothing.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/codec/codec.h"
#include "protocol/messages/hash.h"
#include "server/http/api/api.h"
#include "server/http/pictures/picture_query.h"
#include "server/http/request/url.h"
#include "server/http/weights/weight_query.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_link.h"
#include "tests/shape_rig.h"

namespace furrow::server {
namespace {

void Require(bool holds) {
  if (!holds) std::abort();
}

class Pictures : public PictureSource {
 public:
  void Submit(RenderJob) override {}
  bool WithdrawStill(std::uint64_t) override { return true; }
  void Withdraw(std::uint64_t) override {}
  Result<render::Camera> Preset(std::string_view name) const override {
    if (name == "face") return render::Camera();
    return Status(StatusCode::kNotFound, "no such camera");
  }
};

// Keeps what was added, up to a few targets.
class Targets : public OscControl {
 public:
  Result<int> Add(const OscTargetConfig& config) override {
    if (views_.size() >= 4) return Status(StatusCode::kLimit, "too many targets");
    views_.push_back({.id = ++last_, .config = config});
    return last_;
  }
  Status Remove(int id) override {
    const auto removed = std::erase_if(views_, [id](const View& view) { return view.id == id; });
    return removed > 0 ? Status() : Status(StatusCode::kNotFound, "no such target");
  }
  std::vector<View> List() const override { return views_; }
  const std::vector<std::string>& allowed() const override { return allowed_; }

 private:
  int last_ = 0;
  std::vector<View> views_;
  std::vector<std::string> allowed_;
};

// A player of three frames of the same blend shape.
std::unique_ptr<Player> TestPlayer(const std::string& subject) {
  motion::Clip clip;
  clip.blend_shape_names = {"brow"};
  clip.name = subject;
  clip.times = {0.0, 0.1, 0.2};
  clip.blend_shapes = {0.0f, 0.5f, 1.0f};
  return std::make_unique<Player>(std::move(clip), "fuzz.csv");
}

// A daemon without sockets: one sender, one player, and the API.
class Daemon {
 public:
  Daemon() {
    Hub::Parts parts;
    parts.rig = std::make_shared<const wrinkle::Rig>(test::ShapeRig("fuzz", {"brow"}));
    parts.pictures = &pictures_;
    parts.metrics = &metrics_;
    parts.random = [this] { return ++random_; };
    hub_ = std::make_unique<Hub>(std::move(parts));
    api_ = std::make_unique<Api>(Api::Parts{.session = 1,
                                            .metrics = &metrics_,
                                            .pictures = &pictures_,
                                            .wants_pictures = true,
                                            .playback = &playback_,
                                            .max_upload_bytes = [] { return std::uint64_t{64}; },
                                            .osc = &targets_,
                                            .connections = [] { return 1; },
                                            .viewers = [] { return 1; }});
    playback_.SetConfigured(TestPlayer("take"));
    playback_.Start(hub_.get(), now_, {}, [](const std::unique_ptr<Player>&) {});
    sender_ = hub_->AddPeer(Transport::kTcp, "fuzz", &link_, now_);
    Publish();
    protocol::secure::Grant grant;
    grant.roles = protocol::secure::Roles(Role::kWatch);
    grant.subjects = "ann";
    watcher_ = Access::Of(grant, 1, now_ + FromSeconds(3600));
  }

  void Ask(std::string_view text) {
    const std::size_t line = std::min(text.find('\n'), text.size());
    const std::string_view head = text.substr(0, line);
    const std::size_t space = std::min(head.find(' '), head.size());
    const auto url = ParseUrl(head.substr(std::min(space + 1, head.size())));
    if (!url) return;
    (void)PicturesOf(*url);
    (void)WeightsOf(*url);
    ApiRequest request{.method = std::string(head.substr(0, space)),
                       .url = *url,
                       .body = std::string(text.substr(std::min(line + 1, text.size())))};
    // An upload arrives parsed. A name of the sender's subject is refused.
    if (request.method.ends_with("POST") && url->path == "/api/playback") {
      request.recording = std::make_shared<RecordingLoader::Loaded>();
      const std::string_view name = url->Value("name");
      if (!name.empty()) request.recording->player = TestPlayer(std::string(name));
    }
    const bool may_all = !request.method.starts_with('-');
    if (!may_all) {
      request.method.erase(0, 1);
      request.access = watcher_;
    }
    now_ += FromSeconds(0.05);
    ApiReply reply;
    {
      const Hub::ExclusiveLock lock(*hub_, 0);
      reply = api_->Answer(request, *hub_, now_);
    }
    Check(reply);
    if (!may_all && request.method != "GET") Require(reply.status >= 400);
    (void)playback_.Advance(now_);
    hub_->Tick(now_);
  }

 private:
  static void Check(const ApiReply& reply) {
    Require(reply.status >= 200 && reply.status < 600);
    Require((reply.status == 405) == !reply.allow.empty());
    if (reply.type != "application/json") return;
    const auto json = nlohmann::json::parse(reply.body, nullptr, false);
    Require(!json.is_discarded());
    if (reply.status >= 400) Require(json.contains("error"));
  }
  template <class Message>
  void Send(const Message& message, std::uint32_t sequence) {
    std::vector<std::uint8_t> bytes;
    encoder_.Encode({7, 1, sequence, 0}, message, bytes);
    hub_->OnMessage(sender_, bytes, now_);
  }
  void Publish() {
    protocol::SkeletonOffer offer;
    offer.subject = "ann";
    offer.blend_shape_names = {"brow"};
    offer.skeleton_hash = protocol::SkeletonHash(offer);
    Send(offer, 1);
    protocol::PoseFrame pose;
    pose.skeleton_hash = offer.skeleton_hash;
    pose.num_blend_shapes = 1;
    pose.blend_shape_indices = {0};
    pose.blend_shapes = {0.5f};
    Send(pose, 2);
  }

  Metrics metrics_;
  Pictures pictures_;
  Targets targets_;
  fuzz::QuietLink link_;
  Playback playback_;
  std::uint64_t random_ = 0;
  Time now_ = FromSeconds(1);
  std::unique_ptr<Hub> hub_;
  std::unique_ptr<Api> api_;
  PeerId sender_ = 0;
  Access watcher_;
  protocol::Encoder encoder_;
};

}  // namespace
}  // namespace furrow::server

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  furrow::fuzz::Input input({data, size});
  furrow::server::Daemon daemon;
  while (!input.empty()) {
    const auto request = input.UntilZero();
    daemon.Ask({reinterpret_cast<const char*>(request.data()), request.size()});
  }
  return 0;
}
