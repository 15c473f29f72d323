// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "render/renderer.h"
#include "server/http/http_server.h"
#include "server/pipeline/render_thread.h"
#include "server/session/hub.h"

namespace furrow::bench {

// A daemon reduced to its preview: hub, render thread and web server, each on its own thread as in
// furrowd. The drawn picture is fixed and ready at once, so only the path of a picture after
// drawing is measured.
class PreviewServer {
 public:
  static constexpr double kRate = 60.0;  // poses per second

  // `picture`: the content and size of every frame. Exits the program if no socket is available.
  explicit PreviewServer(render::Image picture);
  ~PreviewServer();
  PreviewServer(const PreviewServer&) = delete;
  PreviewServer& operator=(const PreviewServer&) = delete;

  [[nodiscard]] std::uint16_t port() const { return http_->port(); }
  [[nodiscard]] std::uint64_t Count(server::Counter counter) const { return metrics_.Get(counter); }
  // Time at which the last picture was ready to be encoded.
  [[nodiscard]] server::Time ready_at() const { return ready_at_.load(); }
  // Maximum number of encodings of one drawn picture since the last call.
  [[nodiscard]] int TakeMostEncodes() { return most_encodes_.exchange(0); }

  // Moves the subject once, or continuously at kRate while `on`.
  void MoveOnce();
  void Stream(bool on);

 private:
  class ReadyRenderer;
  using Task = std::function<void(server::Hub&, server::Time)>;

  void Post(Task task);
  void Run();
  void Offer();
  void SendPose(server::Time now);
  template <class Message>
  void Send(const Message& message, server::Time now);

  render::Image picture_;
  wrinkle::Skeleton skeleton_;
  server::Metrics metrics_;
  std::atomic<server::Time> ready_at_{server::Time{0}};
  std::atomic<int> most_encodes_ = 0;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> tasks_;
  bool stopping_ = false;

  struct Silent : server::Link {  // the publisher's link, which ignores replies
    void SendReply(std::span<const std::uint8_t>) override {}
    int SendFrame(std::uint64_t, std::span<const std::uint8_t>, std::size_t, int) override {
      return 0;
    }
    void DropFrames(std::uint64_t) override {}
  } publisher_link_;
  server::PeerId publisher_ = 0;
  std::uint64_t skeleton_hash_ = 0;
  std::uint32_t poses_ = 0;
  std::atomic<bool> streaming_ = false;
  protocol::Encoder encoder_;

  std::unique_ptr<server::RenderThread> render_;
  std::unique_ptr<server::Hub> hub_;
  std::unique_ptr<server::HttpServer> http_;
  std::thread loop_;
};

}  // namespace furrow::bench
