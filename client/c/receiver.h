// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "client/c/feed.h"
#include "client/c/include/furrow/furrow.h"
#include "client/c/listener.h"
#include "client/cpp/subscriber.h"

namespace furrow::capi {

// The subscriptions of a connection. Time is a parameter: microseconds of a monotonic clock.
class Receiver {
 public:
  // What one step of the receiver found.
  enum class Step {
    kNothing = 0,   // nothing arrived in time
    kNoConnection,  // there is no connection at present
    kConnected,     // the daemon answered, at first or after a loss
    kOther,         // something arrived that is of no interest to the program
    kNews,          // something that the program can see has changed
  };

  // `transport`: one that reconnects. `program`: for the daemon's log.
  Receiver(std::unique_ptr<client::Transport> transport, std::string program)
      : subscriber_(std::move(transport), std::move(program)) {}

  // Adds a subscription. Returns false if there is one for this subject.
  // `poses`: also of the subject's poses.
  bool Subscribe(const protocol::SubscribeWeights& request, bool poses);
  // Ends a subscription of this receiver.
  void Unsubscribe(const Feed& feed);

  // Waits up to `wait` for one message and handles it. `error` receives the daemon's message if it
  // reports an error.
  Step Next(std::int64_t now_us, std::chrono::milliseconds wait, const Listener& listener,
            std::string* error);

  // True if the daemon wants a token, or another one.
  [[nodiscard]] bool needs_token() const { return needs_token_; }
  // Feed::SetObstacle() of all feeds.
  void SetObstacle(furrow_status obstacle);

  // The feed of a subject: by the requested name, or by the daemon's name. Null: the first one.
  // Returns null if there is none.
  [[nodiscard]] const Feed* Find(const char* subject) const;
  [[nodiscard]] const std::vector<std::unique_ptr<Feed>>& feeds() const { return feeds_; }
  [[nodiscard]] std::uint64_t malformed() const { return subscriber_.malformed(); }

 private:
  Feed* FindRequest(std::uint32_t number);
  Feed* FindSubscription(std::uint16_t subscription);
  // The poses of a request or a subscription; null if there are none.
  PoseFeed* FindPoses(std::uint32_t request, std::uint16_t subscription);
  void AskForPoses(Feed& feed);
  void AskAgain(std::int64_t now_us);
  Step OnReply(const client::Event& event, const Listener& listener);
  Step OnWeights(const client::Event& event, std::int64_t now_us, const Listener& listener);
  Step OnPoses(const client::Event& event, std::int64_t now_us);
  Step OnError(const client::Event& event, std::int64_t now_us, std::string* error);
  Step OnGoodbye(const client::Event& event, std::int64_t now_us, const Listener& listener);

  client::Subscriber subscriber_;
  bool needs_token_ = false;
  // On the heap, because callbacks hold references while the program changes nothing else.
  std::vector<std::unique_ptr<Feed>> feeds_;
};

}  // namespace furrow::capi
