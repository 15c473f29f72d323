// SPDX-License-Identifier: Apache-2.0
// Callbacks of libfurrow.so.
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api_testing.h"

namespace furrow::capi {
namespace {

using testing::ElementsAre;

struct Calls {
  furrow_connection* connection = nullptr;
  std::vector<std::string> log;
  bool close = false;
  bool raise = false;
};

furrow_callbacks Callbacks(Calls* calls) {
  furrow_callbacks callbacks{};
  callbacks.struct_size = sizeof callbacks;
  callbacks.user = calls;
  callbacks.on_weights = [](void* user, const char* subject, const furrow_frame* frame,
                            const float* values) {
    auto& to = *static_cast<Calls*>(user);
    to.log.push_back(std::string(subject) + " " + std::to_string(frame->sequence) + " " +
                     std::to_string(values[frame->count - 1]).substr(0, 4));
    EXPECT_EQ(furrow_poll(to.connection, 0), FURROW_WRONG_CALL);
    EXPECT_EQ(furrow_unsubscribe(to.connection, subject), FURROW_WRONG_CALL);
    EXPECT_EQ(furrow_layout(to.connection, subject, nullptr, nullptr), FURROW_OK);
    if (to.close) furrow_close(to.connection);
    if (to.raise) throw std::runtime_error("from a callback");
  };
  callbacks.on_layout = [](void* user, const char* subject, std::uint64_t layout,
                           const char* const* names, std::uint32_t count) {
    EXPECT_NE(layout, 0u);
    static_cast<Calls*>(user)->log.push_back(std::string(subject) + " has " +
                                             std::to_string(count) + ", last " + names[count - 1]);
  };
  callbacks.on_subject_gone = [](void* user, const char* subject) {
    static_cast<Calls*>(user)->log.push_back(std::string(subject) + " left");
  };
  callbacks.on_state = [](void* user, furrow_state state) {
    static_cast<Calls*>(user)->log.push_back("state " + std::to_string(state));
  };
  return callbacks;
}

TEST_F(CApiTest, CallbacksRunInsidePoll) {
  connection_ = Open(daemon_->address("?subject=ada"));
  Calls calls{c(), {}};
  const furrow_callbacks callbacks = Callbacks(&calls);
  EXPECT_EQ(furrow_set_callbacks(c(), &callbacks), FURROW_OK);
  ASSERT_TRUE(Polled([&] { return calls.log.size() == 2; }));
  daemon_->SendWeights(1, 4, {0.0f, 0.5f});
  daemon_->Send({.stream = 1}, protocol::Goodbye{protocol::GoodbyeReason::kSubjectGone});
  ASSERT_TRUE(Polled([&] { return calls.log.size() == 4; }));
  EXPECT_THAT(calls.log,
              ElementsAre("state 1", "ada has 2, last brow_l.stretch", "ada 4 0.50", "ada left"));
  furrow_frame frame = NewFrame();
  float values[2];
  EXPECT_EQ(furrow_weights(c(), "ada", values, 2, &frame), FURROW_OK);
  EXPECT_EQ(frame.flags, FURROW_FRAME_SUBJECT_GONE);
  EXPECT_EQ(furrow_set_callbacks(c(), nullptr), FURROW_OK);
  ASSERT_TRUE(Receive(5, {0.0f, 0.5f}));
  EXPECT_EQ(calls.log.size(), 4u);
}

TEST_F(CApiTest, ACallbackMayCloseTheConnection) {
  Connect();
  Calls calls{c(), {}, true};
  const furrow_callbacks callbacks = Callbacks(&calls);
  EXPECT_EQ(furrow_set_callbacks(c(), &callbacks), FURROW_OK);
  daemon_->SendWeights(1, 4, {0.0f, 0.5f});
  furrow_connection* const closed = connection_.release();
  ASSERT_TRUE(Until([&] { return furrow_poll(closed, 1) == FURROW_CLOSED; }));
  ASSERT_TRUE(Until([&] {
    daemon_->Step();
    return daemon_->unsubscribed == 1;
  }));
}

TEST_F(CApiTest, AnExceptionOfACallbackDoesNotPass) {
  Connect();
  Calls calls{c(), {}, false, true};
  const furrow_callbacks callbacks = Callbacks(&calls);
  EXPECT_EQ(furrow_set_callbacks(c(), &callbacks), FURROW_OK);
  daemon_->SendWeights(1, 4, {0.0f, 0.5f});
  ASSERT_TRUE(Until([&] { return furrow_poll(c(), 1) == FURROW_INTERNAL; }));
  EXPECT_EQ(furrow_set_callbacks(c(), nullptr), FURROW_OK);
  EXPECT_TRUE(Receive(5, {0.0f, 0.5f})) << "the connection goes on";
}

}  // namespace
}  // namespace furrow::capi
