// SPDX-License-Identifier: Apache-2.0
// Web connections that end with an internal exception: the hub removes their
// peers.
#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <new>
#include <utility>

#include <gtest/gtest.h>

#include "server/http/http_server.h"
#include "server/session/hub.h"
#include "web_client.h"

namespace furrow::testing_net {
namespace {

using server::Hub;
using server::Time;

// The hub's event loop, run by the test. Posting to it may fail on demand.
class Door {
 public:
  using Task = std::function<void(Hub&, Time)>;

  void Post(Task task) {
    const std::lock_guard lock(mutex_);
    if (fails_after_ >= 0 && fails_after_-- == 0) throw std::bad_alloc();
    tasks_.push_back(std::move(task));
    changed_.notify_one();
  }
  // Lets the post after `count` posts fail.
  void FailAfter(int count) {
    const std::lock_guard lock(mutex_);
    fails_after_ = count;
  }
  void RunNext(Hub& hub) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !tasks_.empty(); });
    const Task task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task(hub, server::FromSeconds(1));
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> tasks_;
  int fails_after_ = -1;
};

class WebFailure : public testing::Test {
 protected:
  void SetUp() override {
    Hub::Parts parts;
    parts.rig = std::make_shared<const wrinkle::Rig>();
    parts.metrics = &metrics;
    parts.random = [] { return 1; };
    hub = std::make_unique<Hub>(std::move(parts));
    auto started = server::HttpServer::Listen(
        {.config = {.port = 0},
         .bind = "127.0.0.1",
         .post_to_hub = [this](Door::Task task) { door.Post(std::move(task)); },
         .answer = [](const server::ApiRequest&, Hub&, Time) -> server::ApiReply {
           throw std::bad_alloc();
         },
         .metrics = &metrics});
    ASSERT_TRUE(started.ok()) << started.status().ToString();
    http = *std::move(started);
    http->Start();
  }

  server::Metrics metrics;
  Door door;
  std::unique_ptr<Hub> hub;  // outlives its links
  std::unique_ptr<server::HttpServer> http;
};

TEST_F(WebFailure, AFailedWebSocketLeavesNothingInTheHub) {
  WebClient client(http->port());
  ASSERT_EQ(client.Upgrade().status, 101);
  door.RunNext(*hub);  // the peer
  client.Send(protocol::SubscribeWeights{.subject = "ann", .wait = true}, 0, 1);
  door.RunNext(*hub);
  ASSERT_EQ(hub->num_subscriptions(), 1u);
  door.FailAfter(0);
  client.Send(protocol::Ping{1});
  while (client.Next()) {  // until the connection closes
  }
  door.RunNext(*hub);
  EXPECT_EQ(hub->num_subscriptions(), 0u);
  hub->Drain(Time{0});  // sends to every link
}

TEST_F(WebFailure, AFailedPictureStreamLeavesNothingInTheHub) {
  WebClient client(http->port());
  door.FailAfter(1);  // adding the peer succeeds, its request fails
  EXPECT_EQ(client.Ask("GET", "/mjpeg").status, 0);
  door.RunNext(*hub);
  door.RunNext(*hub);  // removes the peer
  hub->Drain(Time{0});
  EXPECT_EQ(WebClient(http->port()).Ask("HEAD", "/weights").status, 200);  // others are served
}

TEST_F(WebFailure, LackOfMemoryCostsOneRequest) {
  WebClient client(http->port());
  auto reply = std::async(std::launch::async, [&] { return client.Ask("GET", "/api/status"); });
  door.RunNext(*hub);  // the answer fails
  EXPECT_EQ(reply.get().status, 503);
  EXPECT_EQ(metrics.Get(server::Counter::kAllocationsFailed), 1u);
  EXPECT_EQ(client.Ask("HEAD", "/weights").status, 200) << "the connection goes on";
}

}  // namespace
}  // namespace furrow::testing_net
