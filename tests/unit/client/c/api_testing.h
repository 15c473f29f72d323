// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "client/c/include/furrow/furrow.h"
#include "fake_daemon.h"

// Shared by the tests of furrow.h.
namespace furrow::capi {

struct Closer {
  void operator()(furrow_connection* connection) const { furrow_close(connection); }
};
using Handle = std::unique_ptr<furrow_connection, Closer>;

inline Handle Open(const std::string& address, const furrow_options* options = nullptr) {
  furrow_connection* connection = nullptr;
  EXPECT_EQ(furrow_open(address.c_str(), options, &connection), FURROW_OK) << address;
  return Handle(connection);
}

inline std::string LastError(furrow_connection* connection) {
  char text[512];
  EXPECT_EQ(furrow_last_error(connection, text, sizeof text), FURROW_OK);
  return text;
}

inline furrow_frame NewFrame() {
  furrow_frame frame{};
  frame.struct_size = sizeof frame;
  return frame;
}

inline furrow_connection_info InfoOf(furrow_connection* connection) {
  furrow_connection_info info{};
  info.struct_size = sizeof info;
  EXPECT_EQ(furrow_get_info(connection, &info), FURROW_OK);
  return info;
}

// A connection to a fake daemon, which has answered the subscription.
class CApiTest : public testing::Test {
 protected:
  void Connect(const std::string& query = "?subject=ada") {
    connection_ = Open(daemon_->address(query));
    ASSERT_TRUE(Polled([&] { return furrow_layout(c(), nullptr, nullptr, nullptr) == FURROW_OK; }));
  }
  // Lets both sides work until `done`.
  bool Polled(const std::function<bool()>& done) {
    return Until([&] {
      EXPECT_GE(furrow_poll(c(), 1), FURROW_OK);
      daemon_->Step();
      return done();
    });
  }
  // Sends weights and waits until they are the newest.
  bool Receive(std::uint32_t sequence, const std::vector<float>& values) {
    daemon_->SendWeights(1, sequence, values);
    return Polled([&] {
      furrow_frame frame = NewFrame();
      return furrow_weights(c(), nullptr, nullptr, 0, &frame) == FURROW_BUFFER_TOO_SMALL &&
             frame.sequence == sequence;
    });
  }
  furrow_connection* c() { return connection_.get(); }

  std::unique_ptr<FakeDaemon> daemon_ = std::make_unique<FakeDaemon>();
  Handle connection_;
};

}  // namespace furrow::capi
