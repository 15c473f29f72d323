// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "client/c/include/furrow/furrow.h"
#include "client/c/listener.h"
#include "client/c/receiver.h"
#include "client/c/sender.h"
#include "client/cpp/address.h"

namespace furrow::capi {

// What furrow_connection points to. Its functions do what those of furrow.h of the same name do;
// their arguments are checked for null pointers by the caller.
class Connection {
 public:
  // `program`: for the daemon's log. `security`: what the address asks for.
  Connection(client::Address address, std::string program, client::Security security);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  furrow_status Poll(std::int32_t timeout_ms);
  furrow_status Subscribe(const furrow_subscription* subscription);
  furrow_status Unsubscribe(const char* subject);
  furrow_status Weights(const char* subject, float* values, std::uint32_t capacity,
                        furrow_frame* frame);
  furrow_status LatestPose(const char* subject, furrow_pose_buffer* pose);
  furrow_status GetSkeleton(const char* subject, furrow_skeleton_info* info);
  furrow_status GetJoint(const char* subject, std::uint32_t index, furrow_joint* joint,
                         std::string* name);
  furrow_status BlendShapeName(const char* subject, std::uint32_t index, std::string* name);
  furrow_status SetCallbacks(const furrow_callbacks* callbacks);
  furrow_status Offer(const furrow_skeleton* skeleton, std::uint32_t* stream);
  furrow_status SendPose(std::uint32_t stream, const furrow_pose* pose);
  furrow_status StreamStatus(std::uint32_t stream);
  furrow_status Withdraw(std::uint32_t stream);
  furrow_status GetInfo(furrow_connection_info* info);
  furrow_status SubjectName(std::uint32_t index, std::string* name);

  // Subscribes to the subjects of the address.
  furrow_status SubscribeToAddress();
  // The feed of a subject; null, with an error noted, if there is none.
  const Feed* Find(const char* subject);
  // Notes the message of an error and returns `status`.
  furrow_status Fail(furrow_status status, std::string message);

  // True while a callback runs.
  [[nodiscard]] bool calling_back() const { return calling_back_; }
  // Ends the connection when the callback has returned: Poll() returns FURROW_CLOSED.
  void CloseLater() { close_later_ = true; }
  [[nodiscard]] const std::string& last_error() const { return last_error_; }

 private:
  furrow_status Subscribe(const protocol::SubscribeWeights& request, bool poses);
  furrow_status Fail(const Status& status);
  // The poses of a subject with their skeleton; null, with a status, if there are none.
  const PoseFeed* FindPoses(const char* subject, furrow_status* status);
  std::unique_ptr<client::Transport> OpenTransport() const;
  // Says goodbye and ends the subscriptions. Throws std::bad_alloc.
  void SayGoodbye();
  bool Step(std::int64_t now_us, std::chrono::milliseconds wait, bool* done);
  void PollSender(std::int64_t now_us, std::chrono::milliseconds wait, bool* news);
  void SetState(furrow_state state);
  void NoteNetworkFailure();
  void NoteObstacle();

  client::Address address_;
  std::string program_;
  const client::Security security_;
  Listener listener_;
  client::Transport* receiving_ = nullptr;  // owned by receiver_
  client::Transport* sending_ = nullptr;    // owned by sender_
  std::optional<Receiver> receiver_;        // none without subscriptions
  std::optional<Sender> sender_;            // none without published subjects
  furrow_state state_ = FURROW_CONNECTING;
  std::uint64_t connects_ = 0;
  bool calling_back_ = false;
  bool close_later_ = false;
  std::string last_error_;
};

}  // namespace furrow::capi
