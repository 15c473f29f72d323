// SPDX-License-Identifier: Apache-2.0
//
// Furrow's client library for C++17 and later: furrow.h, with classes and exceptions.
//
//   furrow::Connection connection("furrow://127.0.0.1?subject=ada");
//   furrow::Weights weights;
//   while (drawing) {
//     connection.Poll();
//     if (connection.Latest("ada", weights)) Draw(weights.values);
//   }
//
// furrow.h is the manual: units, ranges, threads and limits are the same. This header is inline and
// needs no library besides libfurrow. For the poses of others, pass Connection::get() to the
// functions of furrow.h.
//
// Errors: functions throw furrow::Error, with the message of furrow_last_error(). Callbacks may
// throw, too: Poll() passes their exceptions on.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "furrow.h"

namespace furrow {

// A function of furrow.h failed.
class Error : public std::runtime_error {
 public:
  Error(furrow_status status, const std::string& message)
      : std::runtime_error(message.empty() ? std::string(furrow_status_text(status)) : message),
        status_(status) {}
  [[nodiscard]] furrow_status status() const noexcept { return status_; }

 private:
  furrow_status status_;
};

// The newest weights of a subject. Use the same object for every call: its memory is reused.
struct Weights {
  furrow_frame frame{};       // layout, age and loss
  std::vector<float> values;  // in [0, 1], in the order of the layout
};

// A joint of a skeleton, as furrow_joint.
struct Joint {
  std::string name;
  std::int32_t parent = -1;
  float translation[3] = {0.0f, 0.0f, 0.0f};
  float rotation[4] = {0.0f, 0.0f, 0.0f, 1.0f};  // x, y, z, w
  float scale[3] = {1.0f, 1.0f, 1.0f};
};

// A skeleton, as furrow_skeleton.
struct Skeleton {
  std::string subject;
  std::vector<Joint> joints;
  std::vector<std::string> blend_shapes;
  float metres_per_unit = 1.0f;
};

// A pose, as furrow_pose. An empty vector leaves its part at rest.
struct Pose {
  std::int64_t capture_time_us = 0;
  std::vector<float> rotations;     // 4 per joint
  std::vector<float> translations;  // 3 per joint
  std::vector<float> scales;        // 3 per joint
  std::vector<float> blend_shapes;
  bool packed = false;
  bool redundant = false;  // FURROW_POSE_REDUNDANT
};

// What Poll() calls. Empty functions are not called. See furrow_callbacks.
struct Callbacks {
  std::function<void(const char* subject, const furrow_frame& frame, const float* values)>
      on_weights;
  std::function<void(const char* subject, std::uint64_t layout,
                     const std::vector<std::string>& names)>
      on_layout;
  std::function<void(const char* subject)> on_subject_gone;
  std::function<void(furrow_state state)> on_state;
};

// A connection to a daemon. It can be moved but not copied, and belongs to one thread at a time.
class Connection {
 public:
  // `program`: your program and its version, for the daemon's log. `flags`: FURROW_OPEN_...
  explicit Connection(const std::string& address, const std::string& program = {},
                      std::uint32_t flags = 0)
      : callbacks_(std::make_unique<Slots>()) {
    char error[1024] = "";
    furrow_options options{};
    options.struct_size = sizeof options;
    options.flags = flags;
    options.program = program.empty() ? nullptr : program.c_str();
    options.error = error;
    options.error_size = sizeof error;
    furrow_connection* opened = nullptr;
    const furrow_status status = furrow_open(address.c_str(), &options, &opened);
    if (status < FURROW_OK) throw Error(status, error);
    connection_.reset(opened);
  }

  // Waits for up to `timeout` and does the work of the connection. Returns true if something
  // happened.
  bool Poll(std::chrono::milliseconds timeout = std::chrono::milliseconds(0)) {
    const furrow_status status = furrow_poll(get(), static_cast<std::int32_t>(timeout.count()));
    if (callbacks_->thrown) std::rethrow_exception(std::exchange(callbacks_->thrown, nullptr));
    return Check(status) == FURROW_OK;
  }

  // Follows one more subject; an empty name means the oldest one.
  void Subscribe(const std::string& subject, const std::string& pattern = {},
                 float max_rate_hz = 0.0f, std::uint32_t flags = 0) {
    furrow_subscription subscription{};
    subscription.struct_size = sizeof subscription;
    subscription.flags = flags;
    subscription.subject = subject.c_str();
    subscription.pattern = pattern.c_str();
    subscription.max_rate_hz = max_rate_hz;
    Check(furrow_subscribe(get(), &subscription));
  }
  void Unsubscribe(const std::string& subject) {
    Check(furrow_unsubscribe(get(), subject.c_str()));
  }

  // Copies the newest weights. Returns false before the first frame.
  bool Latest(const std::string& subject, Weights& weights) {
    return Copy(subject.c_str(), weights);
  }
  // As above, of the first subscription.
  bool Latest(Weights& weights) { return Copy(nullptr, weights); }

  // The names of the weights, in the order of their values; empty while they are unknown.
  [[nodiscard]] std::vector<std::string> Names(const std::string& subject) {
    std::uint32_t count = 0;
    std::vector<std::string> names;
    Check(furrow_layout(get(), subject.c_str(), &count, nullptr));
    char name[FURROW_NAME_SIZE];
    for (std::uint32_t i = 0; i < count; ++i) {
      Check(furrow_weight_name(get(), subject.c_str(), i, name, sizeof name));
      names.emplace_back(name);
    }
    return names;
  }

  [[nodiscard]] furrow_connection_info Info() {
    furrow_connection_info info{};
    info.struct_size = sizeof info;
    Check(furrow_get_info(get(), &info));
    return info;
  }
  // The message of the last error; empty if there was none.
  [[nodiscard]] std::string LastError() {
    char text[1024] = "";
    furrow_last_error(get(), text, sizeof text);
    return text;
  }

  // Replaces all callbacks.
  void SetCallbacks(Callbacks callbacks) {
    callbacks_->functions = std::move(callbacks);
    furrow_callbacks table{};
    table.struct_size = sizeof table;
    table.user = callbacks_.get();
    table.on_weights = &Slots::OnWeights;
    table.on_layout = &Slots::OnLayout;
    table.on_subject_gone = &Slots::OnSubjectGone;
    table.on_state = &Slots::OnState;
    Check(furrow_set_callbacks(get(), &table));
  }

  // Offers a subject and returns its stream number.
  std::uint32_t Offer(const Skeleton& skeleton) {
    std::vector<furrow_joint> joints;
    for (const Joint& joint : skeleton.joints) joints.push_back(ToC(joint));
    std::vector<const char*> shapes;
    for (const std::string& shape : skeleton.blend_shapes) shapes.push_back(shape.c_str());
    furrow_skeleton offered{};
    offered.struct_size = sizeof offered;
    offered.joint_size = sizeof(furrow_joint);
    offered.subject = skeleton.subject.c_str();
    offered.joints = joints.data();
    offered.num_joints = static_cast<std::uint32_t>(joints.size());
    offered.num_blend_shapes = static_cast<std::uint32_t>(shapes.size());
    offered.blend_shapes = shapes.data();
    offered.metres_per_unit = skeleton.metres_per_unit;
    std::uint32_t stream = 0;
    Check(furrow_offer(get(), &offered, &stream));
    const std::size_t count = streams_.size() <= stream ? stream + 1 : streams_.size();
    streams_.resize(count);
    streams_[stream] = {joints.size(), shapes.size()};
    return stream;
  }
  // Sends a pose. Returns false if it was dropped because there is no connection. Throws Error if a
  // vector has the wrong size.
  bool Send(std::uint32_t stream, const Pose& pose) {
    const Sizes sizes = stream < streams_.size() ? streams_[stream] : Sizes{};
    furrow_pose sent{};
    sent.struct_size = sizeof sent;
    sent.flags = (pose.packed ? FURROW_POSE_PACKED : 0u) |
                 (pose.redundant ? FURROW_POSE_REDUNDANT : 0u);
    sent.capture_time_us = pose.capture_time_us;
    sent.rotations = Data(pose.rotations, 4 * sizes.joints);
    sent.translations = Data(pose.translations, 3 * sizes.joints);
    sent.scales = Data(pose.scales, 3 * sizes.joints);
    sent.blend_shapes = Data(pose.blend_shapes, sizes.blend_shapes);
    const furrow_status status = furrow_send_pose(get(), stream, &sent);
    return status != FURROW_NO_CONNECTION && Check(status) == FURROW_OK;
  }
  // True once the daemon has accepted the offer. Throws Error if it rejected the offer.
  [[nodiscard]] bool Accepted(std::uint32_t stream) {
    return Check(furrow_stream_status(get(), stream)) == FURROW_OK;
  }
  void Withdraw(std::uint32_t stream) { Check(furrow_withdraw(get(), stream)); }

  // For functions of furrow.h. The connection remains the owner.
  [[nodiscard]] furrow_connection* get() const noexcept { return connection_.get(); }

 private:
  struct Close {
    void operator()(furrow_connection* connection) const noexcept { furrow_close(connection); }
  };
  struct Sizes {
    std::size_t joints = 0;
    std::size_t blend_shapes = 0;
  };

  // The functions that C calls. No exception may pass through C, so it is kept for Poll().
  struct Slots {
    Callbacks functions;
    std::exception_ptr thrown;

    template <class Function>
    static void Run(void* user, Function&& function) noexcept {
      auto& slots = *static_cast<Slots*>(user);
      if (slots.thrown) return;
      try {
        function(slots.functions);
      } catch (...) {
        slots.thrown = std::current_exception();
      }
    }
    static void OnWeights(void* user, const char* subject, const furrow_frame* frame,
                          const float* values) noexcept {
      Run(user, [&](Callbacks& functions) {
        if (functions.on_weights) functions.on_weights(subject, *frame, values);
      });
    }
    static void OnLayout(void* user, const char* subject, std::uint64_t layout,
                         const char* const* names, std::uint32_t count) noexcept {
      Run(user, [&](Callbacks& functions) {
        if (!functions.on_layout) return;
        functions.on_layout(subject, layout, std::vector<std::string>(names, names + count));
      });
    }
    static void OnSubjectGone(void* user, const char* subject) noexcept {
      Run(user, [&](Callbacks& functions) {
        if (functions.on_subject_gone) functions.on_subject_gone(subject);
      });
    }
    static void OnState(void* user, furrow_state state) noexcept {
      Run(user, [&](Callbacks& functions) {
        if (functions.on_state) functions.on_state(state);
      });
    }
  };

  furrow_status Check(furrow_status status) {
    if (status < FURROW_OK) throw Error(status, LastError());
    return status;
  }

  bool Copy(const char* subject, Weights& weights) {
    weights.frame.struct_size = sizeof weights.frame;
    furrow_status status =
        furrow_weights(get(), subject, weights.values.data(),
                       static_cast<std::uint32_t>(weights.values.size()), &weights.frame);
    if (status == FURROW_BUFFER_TOO_SMALL) {
      weights.values.resize(weights.frame.count);
      status = furrow_weights(get(), subject, weights.values.data(), weights.frame.count,
                              &weights.frame);
    }
    if (Check(status) != FURROW_OK) return false;
    weights.values.resize(weights.frame.count);
    return true;
  }

  static furrow_joint ToC(const Joint& joint) {
    furrow_joint to{};
    to.name = joint.name.c_str();
    to.parent = joint.parent;
    for (int i = 0; i < 3; ++i) to.translation[i] = joint.translation[i];
    for (int i = 0; i < 4; ++i) to.rotation[i] = joint.rotation[i];
    for (int i = 0; i < 3; ++i) to.scale[i] = joint.scale[i];
    return to;
  }

  static const float* Data(const std::vector<float>& values, std::size_t count) {
    if (values.empty()) return nullptr;
    if (values.size() == count) return values.data();
    throw Error(FURROW_INVALID_ARGUMENT, "pose: a vector has " + std::to_string(values.size()) +
                                             " numbers instead of " + std::to_string(count));
  }

  // Before connection_, which may call them until it is closed.
  std::unique_ptr<Slots> callbacks_;
  std::unique_ptr<furrow_connection, Close> connection_;
  std::vector<Sizes> streams_;
};

}  // namespace furrow
