// SPDX-License-Identifier: Apache-2.0
// libfurrow.so through furrow.h: versions, arguments, addresses and options.
#include <chrono>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api_testing.h"

namespace furrow::capi {
namespace {

using testing::HasSubstr;

TEST(CApi, StatesItsVersions) {
  EXPECT_EQ(furrow_abi_version(), static_cast<std::uint32_t>(FURROW_ABI_VERSION));
  EXPECT_THAT(furrow_version(), testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
}

TEST(CApi, EveryStatusHasItsOwnText) {
  std::vector<std::string> texts;
  for (int status = FURROW_REDIRECTED; status <= FURROW_CLOSED; ++status) {
    const std::string text = furrow_status_text(static_cast<furrow_status>(status));
    if (text != "unknown status") texts.push_back(text);
  }
  EXPECT_EQ(texts.size(), 21u);
  EXPECT_EQ(std::set<std::string>(texts.begin(), texts.end()).size(), texts.size());
  EXPECT_STREQ(furrow_status_text(FURROW_STATUS_IS_32_BITS), "unknown status");
}

TEST(CApi, NullConnectionsAreRejected) {
  std::uint32_t number = 0;
  char text[8] = "";
  float values[1];
  furrow_frame frame = NewFrame();
  furrow_close(nullptr);
  EXPECT_EQ(furrow_open(nullptr, nullptr, nullptr), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_poll(nullptr, 0), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_get_info(nullptr, nullptr), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_last_error(nullptr, text, sizeof text), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_subscribe(nullptr, nullptr), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_unsubscribe(nullptr, "a"), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_subject_name(nullptr, 0, text, sizeof text), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_weights(nullptr, "a", values, 1, &frame), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_layout(nullptr, "a", nullptr, nullptr), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_weight_name(nullptr, "a", 0, text, sizeof text), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_find_weight(nullptr, "a", "b", &number), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_latest_pose(nullptr, "a", nullptr), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_get_skeleton(nullptr, "a", nullptr), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_get_joint(nullptr, "a", 0, text, 8, nullptr), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_blend_shape_name(nullptr, "a", 0, text, 8), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_set_callbacks(nullptr, nullptr), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_offer(nullptr, nullptr, &number), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_send_pose(nullptr, 0, nullptr), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_stream_status(nullptr, 0), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_withdraw(nullptr, 0), FURROW_INVALID_ARGUMENT);
}

TEST(CApi, NullArgumentsAreRejected) {
  const Handle connection = Open("127.0.0.1:9");
  furrow_connection* const c = connection.get();
  std::uint32_t number = 0;
  char text[8];
  EXPECT_EQ(furrow_poll(c, -1), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_poll(c, FURROW_MAX_TIMEOUT_MS + 1), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_get_info(c, nullptr), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_last_error(c, nullptr, 5), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_last_error(c, text, 0), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_subscribe(c, nullptr), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_subject_name(c, 0, nullptr, 5), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_find_weight(c, nullptr, nullptr, &number), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_find_weight(c, nullptr, "a", nullptr), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_offer(c, nullptr, &number), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_offer(c, nullptr, nullptr), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_send_pose(c, 0, nullptr), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_set_callbacks(c, nullptr), FURROW_OK) << "removes the callbacks";
  EXPECT_EQ(furrow_stream_status(c, 0), FURROW_NOT_FOUND);
  EXPECT_EQ(furrow_withdraw(c, 7), FURROW_NOT_FOUND);
  EXPECT_EQ(furrow_unsubscribe(c, "nobody"), FURROW_NOT_FOUND);
  EXPECT_THAT(LastError(c), HasSubstr("nobody"));
}

TEST(CApi, AddressesAreChecked) {
  furrow_connection* connection = nullptr;
  char error[200];
  furrow_options options{};
  options.struct_size = sizeof options;
  options.error = error;
  options.error_size = sizeof error;
  EXPECT_EQ(furrow_open("http://a", &options, &connection), FURROW_INVALID_ADDRESS);
  EXPECT_EQ(connection, nullptr);
  EXPECT_THAT(error, HasSubstr("furrow://"));
  EXPECT_EQ(furrow_open("furrow://a?subject=x&subject=x", &options, &connection),
            FURROW_INVALID_ADDRESS);
  EXPECT_THAT(error, HasSubstr("subscribed already"));
  EXPECT_EQ(furrow_open("furrow://a?token=/nowhere/a.token", &options, &connection),
            FURROW_INVALID_ARGUMENT);
  EXPECT_THAT(error, HasSubstr("/nowhere/a.token"));
  EXPECT_EQ(furrow_open("furrow://a?transport=shm", &options, &connection), FURROW_UNSUPPORTED);
  options.error_size = 4;
  EXPECT_EQ(furrow_open("http://a", &options, &connection), FURROW_INVALID_ADDRESS);
  EXPECT_EQ(std::strlen(error), 3u);
}

TEST(CApi, ReservedOptionsAreRefusedRatherThanIgnored) {
  const auto status_with = [](const auto& change) {
    furrow_options options{};
    options.struct_size = sizeof options;
    change(options);
    furrow_connection* connection = nullptr;
    const furrow_status status = furrow_open("127.0.0.1", &options, &connection);
    furrow_close(connection);
    return status;
  };
  EXPECT_EQ(status_with([](furrow_options&) {}), FURROW_OK);
  EXPECT_EQ(status_with([](furrow_options& o) { o.token = "frw1_x"; }), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(status_with([](furrow_options& o) { o.token = ""; }), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(status_with([](furrow_options& o) { o.server_key = ""; }), FURROW_UNSUPPORTED);
  EXPECT_EQ(status_with([](furrow_options& o) { o.tls = 2; }), FURROW_UNSUPPORTED);
  EXPECT_EQ(status_with([](furrow_options& o) { o.tls = 1; }), FURROW_OK);
  EXPECT_EQ(status_with([](furrow_options& o) { o.tls_authority = ""; }), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(status_with([](furrow_options& o) { o.tls_authority = "/nowhere.crt"; }),
            FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(status_with([](furrow_options& o) { o.flags = 2; }), FURROW_UNSUPPORTED);
  EXPECT_EQ(status_with([](furrow_options& o) { o.program = "a\n"; }), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(status_with([](furrow_options& o) { o.struct_size = 3; }), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(status_with([](furrow_options& o) { o.struct_size = 8; }), FURROW_OK)
      << "the struct of an older program";
}

TEST(CApi, AStructOfANewerProgramIsAcceptedIfItsNewFieldsAreUnused) {
  struct {
    furrow_options options;
    std::uint64_t newer;
  } options{};
  options.options.struct_size = sizeof options;
  furrow_connection* connection = nullptr;
  EXPECT_EQ(furrow_open("127.0.0.1", &options.options, &connection), FURROW_OK);
  furrow_close(connection);
  options.newer = 1;
  EXPECT_EQ(furrow_open("127.0.0.1", &options.options, &connection), FURROW_UNSUPPORTED);
}

TEST(CApi, PollWaitsNoLongerThanAsked) {
  // Nobody listens there, so there is nothing to wait for except the timeout.
  for (const char* transport : {"udp", "tcp"}) {
    const Handle connection = Open(std::string("furrow://127.0.0.1:9?transport=") + transport);
    EXPECT_EQ(furrow_poll(connection.get(), 0), FURROW_TIMEOUT);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(furrow_poll(connection.get(), 30), FURROW_TIMEOUT);
    EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(29)) << transport;
    EXPECT_EQ(InfoOf(connection.get()).state, FURROW_CONNECTING);
  }
}

}  // namespace
}  // namespace furrow::capi
