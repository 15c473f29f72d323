// SPDX-License-Identifier: Apache-2.0
// libfurrow.so through furrow.h, against a daemon that the test controls.
#include <cstring>
#include <memory>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/c/include/furrow/furrow.h"
#include "fake_daemon.h"

namespace furrow::capi {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Closer {
  void operator()(furrow_connection* connection) const { furrow_close(connection); }
};
using Handle = std::unique_ptr<furrow_connection, Closer>;

Handle Open(const std::string& address, const furrow_options* options = nullptr) {
  furrow_connection* connection = nullptr;
  EXPECT_EQ(furrow_open(address.c_str(), options, &connection), FURROW_OK) << address;
  return Handle(connection);
}

std::string LastError(furrow_connection* connection) {
  char text[512];
  EXPECT_EQ(furrow_last_error(connection, text, sizeof text), FURROW_OK);
  return text;
}

furrow_frame NewFrame() {
  furrow_frame frame{};
  frame.struct_size = sizeof frame;
  return frame;
}

furrow_connection_info InfoOf(furrow_connection* connection) {
  furrow_connection_info info{};
  info.struct_size = sizeof info;
  EXPECT_EQ(furrow_get_info(connection, &info), FURROW_OK);
  return info;
}

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
  EXPECT_EQ(furrow_open("furrow://a?token=1", &options, &connection), FURROW_UNSUPPORTED);
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
  EXPECT_EQ(status_with([](furrow_options& o) { o.token = "x"; }), FURROW_UNSUPPORTED);
  EXPECT_EQ(status_with([](furrow_options& o) { o.server_key = ""; }), FURROW_UNSUPPORTED);
  EXPECT_EQ(status_with([](furrow_options& o) { o.tls_authority = "x"; }), FURROW_UNSUPPORTED);
  EXPECT_EQ(status_with([](furrow_options& o) { o.tls = 1; }), FURROW_UNSUPPORTED);
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

TEST_F(CApiTest, WeightsArriveWithTheirNames) {
  Connect("?subject=ada&pattern=brow_*&rate=60");
  EXPECT_EQ(daemon_->subscriptions[0].subject, "ada");
  EXPECT_EQ(daemon_->subscriptions[0].pattern, "brow_*");
  EXPECT_EQ(daemon_->subscriptions[0].max_rate_hz, 60.0f);
  float values[3] = {9, 9, 9};
  furrow_frame frame = NewFrame();
  EXPECT_EQ(furrow_weights(c(), "ada", values, 3, &frame), FURROW_NO_DATA);
  ASSERT_TRUE(Receive(8, {0.25f, 0.75f}));
  EXPECT_EQ(furrow_weights(c(), "ada", values, 3, &frame), FURROW_OK);
  EXPECT_THAT(values, ElementsAre(0.25f, 0.75f, 9.0f));
  EXPECT_EQ(frame.count, 2u);
  EXPECT_EQ(frame.capture_time_us, 8000);

  std::uint32_t count = 0;
  std::uint64_t layout = 0;
  EXPECT_EQ(furrow_layout(c(), "ada", &count, &layout), FURROW_OK);
  EXPECT_EQ(count, 2u);
  EXPECT_EQ(layout, frame.layout);
  char name[FURROW_NAME_SIZE];
  EXPECT_EQ(furrow_weight_name(c(), "ada", 1, name, sizeof name), FURROW_OK);
  EXPECT_STREQ(name, "brow_l.stretch");
  EXPECT_EQ(furrow_weight_name(c(), "ada", 2, name, sizeof name), FURROW_NOT_FOUND);
  std::uint32_t index = 9;
  EXPECT_EQ(furrow_find_weight(c(), "ada", "brow_l.stretch", &index), FURROW_OK);
  EXPECT_EQ(index, 1u);
  EXPECT_EQ(furrow_find_weight(c(), "ada", "nose", &index), FURROW_NOT_FOUND);
}

TEST_F(CApiTest, SmallBuffersGetNothing) {
  Connect();
  ASSERT_TRUE(Receive(1, {0.5f, 0.5f}));
  float values[2] = {9, 9};
  furrow_frame frame = NewFrame();
  EXPECT_EQ(furrow_weights(c(), "ada", values, 1, &frame), FURROW_BUFFER_TOO_SMALL);
  EXPECT_EQ(values[0], 9.0f);
  EXPECT_EQ(frame.count, 2u);
  EXPECT_EQ(furrow_weights(c(), "ada", nullptr, 2, &frame), FURROW_INVALID_ARGUMENT);
  EXPECT_EQ(furrow_weights(c(), "ada", values, 2, nullptr), FURROW_OK);
  char name[14] = "unchanged";
  EXPECT_EQ(furrow_weight_name(c(), "ada", 0, name, 13), FURROW_BUFFER_TOO_SMALL);
  EXPECT_STREQ(name, "");
  EXPECT_THAT(LastError(c()), HasSubstr("14 bytes"));
  EXPECT_EQ(furrow_weight_name(c(), "ada", 0, name, 14), FURROW_OK);
  EXPECT_STREQ(name, "brow_l.squash");
  EXPECT_EQ(furrow_weight_name(c(), "ada", 0, name, 0), FURROW_INVALID_ARGUMENT);
}

TEST_F(CApiTest, AFrameOfAnOlderProgramIsFilledPartly) {
  Connect();
  ASSERT_TRUE(Receive(5, {0.5f, 0.5f}));
  furrow_frame frame{};
  frame.layout = 42;
  frame.struct_size = offsetof(furrow_frame, layout);
  float values[2];
  EXPECT_EQ(furrow_weights(c(), "ada", values, 2, &frame), FURROW_OK);
  EXPECT_EQ(frame.sequence, 5u);
  EXPECT_EQ(frame.layout, 42u) << "beyond the older struct";
  frame.struct_size = 0;
  EXPECT_EQ(furrow_weights(c(), "ada", values, 2, &frame), FURROW_INVALID_ARGUMENT);
}

TEST_F(CApiTest, SeveralSubjectsHaveTheirOwnWeights) {
  Connect("?subject=ada");
  furrow_subscription more{};
  more.struct_size = sizeof more;
  more.subject = "bob";
  more.flags = FURROW_SUBSCRIBE_8_BIT | FURROW_SUBSCRIBE_DRIVERS;
  EXPECT_EQ(furrow_subscribe(c(), &more), FURROW_OK);
  EXPECT_EQ(furrow_subscribe(c(), &more), FURROW_INVALID_ARGUMENT) << "twice";
  ASSERT_TRUE(Polled([&] { return furrow_layout(c(), "bob", nullptr, nullptr) == FURROW_OK; }));
  EXPECT_EQ(daemon_->subscriptions[1].format, protocol::WeightFormat::kU8);
  EXPECT_EQ(daemon_->subscriptions[1].source, protocol::WeightSource::kDriverValues);
  EXPECT_TRUE(daemon_->subscriptions[1].wait);
  daemon_->SendWeights(2, 3, {1.0f, 0.0f});
  ASSERT_TRUE(Receive(3, {0.0f, 1.0f}));
  float values[2];
  EXPECT_EQ(furrow_weights(c(), "bob", values, 2, nullptr), FURROW_OK);
  EXPECT_THAT(values, ElementsAre(1.0f, 0.0f));
  EXPECT_EQ(furrow_weights(c(), "ada", values, 2, nullptr), FURROW_OK);
  EXPECT_THAT(values, ElementsAre(0.0f, 1.0f));
  EXPECT_EQ(InfoOf(c()).subjects, 2u);
  EXPECT_EQ(furrow_unsubscribe(c(), "ada"), FURROW_OK);
  EXPECT_EQ(furrow_weights(c(), "ada", values, 2, nullptr), FURROW_NOT_FOUND);
  ASSERT_TRUE(Polled([&] { return daemon_->unsubscribed == 1; }));
}

TEST_F(CApiTest, TheOldestSubjectIsFoundByBothNames) {
  Connect("");
  char name[FURROW_NAME_SIZE];
  EXPECT_EQ(furrow_subject_name(c(), 0, name, sizeof name), FURROW_OK);
  EXPECT_STREQ(name, "ada");
  for (const char* subject : {"", "ada", static_cast<const char*>(nullptr)}) {
    EXPECT_EQ(furrow_weights(c(), subject, nullptr, 0, nullptr), FURROW_NO_DATA);
  }
  EXPECT_EQ(furrow_subject_name(c(), 1, name, sizeof name), FURROW_NOT_FOUND);
}

TEST_F(CApiTest, ARejectedPatternIsReportedAndRequestedAgain) {
  daemon_->reject = protocol::ErrorCode::kNoMatch;
  connection_ = Open(daemon_->address("?subject=ada&pattern=nose"));
  float values[2];
  ASSERT_TRUE(
      Polled([&] { return furrow_weights(c(), "ada", values, 2, nullptr) == FURROW_NO_MATCH; }));
  EXPECT_EQ(LastError(c()), "rejected by the test");
  daemon_->reject = {};
  ASSERT_TRUE(Polled([&] { return furrow_layout(c(), "ada", nullptr, nullptr) == FURROW_OK; }));
}

TEST_F(CApiTest, AnotherRigChangesTheLayout) {
  Connect();
  std::uint64_t before = 0;
  EXPECT_EQ(furrow_layout(c(), "ada", nullptr, &before), FURROW_OK);
  daemon_->names = {"brow_l.stretch", "brow_l.squash"};
  daemon_->SendReply(1, daemon_->requests[0], "ada");
  std::uint64_t after = 0;
  ASSERT_TRUE(Polled(
      [&] { return furrow_layout(c(), "ada", nullptr, &after) == FURROW_OK && after != before; }));
  std::uint32_t index = 9;
  EXPECT_EQ(furrow_find_weight(c(), "ada", "brow_l.squash", &index), FURROW_OK);
  EXPECT_EQ(index, 1u);
}

TEST_F(CApiTest, ARestartedDaemonIsFoundAgain) {
  Connect();
  ASSERT_TRUE(Receive(100, {0.5f, 0.5f}));
  EXPECT_EQ(InfoOf(c()).state, FURROW_CONNECTED);
  const std::uint16_t port = daemon_->port();
  daemon_.reset();
  ASSERT_TRUE(Until([&] {
    EXPECT_GE(furrow_poll(c(), 1), FURROW_OK);
    return InfoOf(c()).state == FURROW_DISCONNECTED;
  }));
  EXPECT_THAT(LastError(c()), HasSubstr("no connection to 127.0.0.1"));
  float values[2];
  EXPECT_EQ(furrow_weights(c(), "ada", values, 2, nullptr), FURROW_OK) << "the last weights";
  daemon_ = std::make_unique<FakeDaemon>(port, 78);
  ASSERT_TRUE(Polled([&] { return InfoOf(c()).connects == 2 && !daemon_->requests.empty(); }));
  EXPECT_EQ(daemon_->subscriptions[0].subject, "ada");
  ASSERT_TRUE(Receive(0, {1.0f, 0.0f}));
  EXPECT_EQ(furrow_weights(c(), "ada", values, 2, nullptr), FURROW_OK);
  EXPECT_THAT(values, ElementsAre(1.0f, 0.0f));
}

TEST_F(CApiTest, HostileMessagesChangeNothing) {
  Connect();
  ASSERT_TRUE(Receive(1, {0.25f, 0.5f}));
  protocol::WeightFrame frame;
  frame.names_hash = protocol::NamesHash(daemon_->names);
  frame.values = {1.0f, 1.0f};
  std::vector<std::uint8_t> whole;
  protocol::Encoder().Encode({.session = 77, .stream = 1, .sequence = 2}, frame, whole);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    daemon_->SendBytes(std::span(whole).first(size));
    if (size % 16 == 0) (void)furrow_poll(c(), 0);
  }
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::uint8_t> bytes = whole;
    // After the envelope, so that the decoders of the payload see them too.
    for (int flips = 0; flips < 3; ++flips) bytes[32 + random() % (bytes.size() - 32)] = random();
    bytes[8] ^= 1;  // from another session, so that an intact one would only start over
    daemon_->SendBytes(bytes);
    (void)furrow_poll(c(), 0);
  }
  frame.names_hash = 1;
  daemon_->Send({.stream = 1, .sequence = 3}, frame);
  frame.values.resize(1);
  daemon_->Send({.stream = 9, .sequence = 3}, frame);
  EXPECT_GT(InfoOf(c()).malformed, 100u);
  // The connection still works. It has asked again, because other sessions seemed to answer.
  std::uint32_t sequence = 50;
  ASSERT_TRUE(Polled([&] {
    daemon_->SendWeights(static_cast<std::uint16_t>(daemon_->requests.size()), ++sequence,
                         {0.75f, 0.5f});
    float values[2];
    return furrow_weights(c(), "ada", values, 2, nullptr) == FURROW_OK && values[0] == 0.75f;
  }));
}

TEST_F(CApiTest, PosesArriveWithTheirSkeleton) {
  daemon_->skeleton.subject = "bob";
  daemon_->skeleton.joints = {{.name = "neck", .rest_translation = {0, 1, 0}},
                              {.name = "head", .parent = 0, .rest_translation = {0, 0.5f, 0}}};
  daemon_->skeleton.blend_shape_names = {"jawOpen"};
  daemon_->skeleton.skeleton_hash = protocol::SkeletonHash(daemon_->skeleton);
  Connect();
  furrow_skeleton_info info{};
  info.struct_size = sizeof info;
  EXPECT_EQ(furrow_get_skeleton(c(), "ada", &info), FURROW_NOT_FOUND) << "without poses";
  furrow_subscription more{};
  more.struct_size = sizeof more;
  more.subject = "bob";
  more.flags = FURROW_SUBSCRIBE_POSES;
  ASSERT_EQ(furrow_subscribe(c(), &more), FURROW_OK);
  EXPECT_EQ(furrow_get_skeleton(c(), "bob", &info), FURROW_NO_DATA);
  ASSERT_TRUE(Polled([&] { return furrow_get_skeleton(c(), "bob", &info) == FURROW_OK; }));
  EXPECT_EQ(info.num_joints, 2u);
  EXPECT_EQ(info.num_blend_shapes, 1u);
  EXPECT_EQ(info.layout, daemon_->skeleton.skeleton_hash);
  char name[FURROW_NAME_SIZE];
  furrow_joint joint;
  EXPECT_EQ(furrow_get_joint(c(), "bob", 1, name, sizeof name, &joint), FURROW_OK);
  EXPECT_STREQ(joint.name, "head");
  EXPECT_EQ(joint.parent, 0);
  EXPECT_EQ(joint.translation[1], 0.5f);
  EXPECT_EQ(furrow_get_joint(c(), "bob", 2, name, sizeof name, nullptr), FURROW_NOT_FOUND);
  EXPECT_EQ(furrow_blend_shape_name(c(), "bob", 0, name, 8), FURROW_OK);
  EXPECT_STREQ(name, "jawOpen");
  EXPECT_EQ(furrow_blend_shape_name(c(), "bob", 0, name, 7), FURROW_BUFFER_TOO_SMALL);

  float rotations[8];
  float translations[6];
  furrow_pose_buffer buffer{};
  const auto latest = [&](std::uint32_t num_joints) {
    buffer = {sizeof buffer};
    buffer.num_joints = num_joints;
    buffer.rotations = rotations;
    buffer.translations = translations;
    return furrow_latest_pose(c(), "bob", &buffer);
  };
  EXPECT_EQ(latest(2), FURROW_NO_DATA);
  protocol::PoseFrame pose;
  pose.skeleton_hash = daemon_->skeleton.skeleton_hash;
  pose.num_joints = 2;
  pose.num_blend_shapes = 1;
  pose.rotation_joints = {1};
  pose.rotations = {{0, 1, 0, 0}};
  pose.translation_joints = {0};
  pose.translations = {{0.25f, 0, 0}};
  const auto stream = static_cast<std::uint16_t>(daemon_->requests.size());
  daemon_->Send({.stream = stream, .sequence = 7, .capture_time_us = 70}, pose);
  ASSERT_TRUE(Polled([&] { return latest(2) == FURROW_OK; }));
  EXPECT_EQ(buffer.sequence, 7u);
  EXPECT_EQ(buffer.num_blend_shapes, 1u) << "its array was not asked for";
  EXPECT_THAT(rotations, ElementsAre(0, 0, 0, 1, 0, 1, 0, 0)) << "the neck is at rest";
  EXPECT_THAT(translations, ElementsAre(0.25f, 1, 0, 0, 0.5f, 0)) << "complete, not offsets";
  EXPECT_EQ(latest(1), FURROW_BUFFER_TOO_SMALL);
  EXPECT_EQ(buffer.num_joints, 2u);
  EXPECT_EQ(furrow_unsubscribe(c(), "bob"), FURROW_OK);
  ASSERT_TRUE(Polled([&] { return daemon_->unsubscribed == 2; })) << "weights and poses";
}

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

TEST_F(CApiTest, SubjectsAreOfferedAndPosesSent) {
  furrow_options options{};
  options.struct_size = sizeof options;
  options.flags = FURROW_OPEN_WITHOUT_SUBSCRIPTION;
  connection_ = Open(daemon_->address(), &options);
  const furrow_joint joint{"head", -1, {0, 1, 0}, {0, 0, 0, 1}, {1, 1, 1}};
  furrow_skeleton skeleton{};
  skeleton.struct_size = sizeof skeleton;
  skeleton.joint_size = sizeof joint;
  skeleton.subject = "cleo";
  skeleton.joints = &joint;
  skeleton.num_joints = 1;
  std::uint32_t stream = 9;
  ASSERT_EQ(furrow_offer(c(), &skeleton, &stream), FURROW_OK) << LastError(c());
  EXPECT_EQ(stream, 0u);
  EXPECT_EQ(furrow_stream_status(c(), stream), FURROW_NO_DATA);
  const float rotation[4] = {0, 1, 0, 0};
  furrow_pose pose{};
  pose.struct_size = sizeof pose;
  pose.capture_time_us = 5;
  pose.rotations = rotation;
  EXPECT_EQ(furrow_send_pose(c(), stream, &pose), FURROW_NO_CONNECTION) << "not connected yet";
  ASSERT_TRUE(Polled([&] { return furrow_stream_status(c(), stream) == FURROW_OK; }));
  EXPECT_EQ(InfoOf(c()).state, FURROW_CONNECTED);
  EXPECT_EQ(InfoOf(c()).streams, 1u);
  ASSERT_EQ(furrow_send_pose(c(), stream, &pose), FURROW_OK) << LastError(c());
  ASSERT_TRUE(Polled([&] { return daemon_->poses.size() == 1; }));
  EXPECT_EQ(daemon_->offers[0].joints[0].name, "head");
  EXPECT_EQ(daemon_->poses[0].rotations[0].y, 1.0f);
  pose.flags = 8;
  EXPECT_EQ(furrow_send_pose(c(), stream, &pose), FURROW_UNSUPPORTED);
  EXPECT_EQ(furrow_send_pose(c(), 1, &pose), FURROW_UNSUPPORTED);
  pose.flags = 0;
  EXPECT_EQ(furrow_send_pose(c(), 1, &pose), FURROW_NOT_FOUND);
  EXPECT_EQ(furrow_withdraw(c(), stream), FURROW_OK);
  EXPECT_EQ(furrow_send_pose(c(), stream, &pose), FURROW_REJECTED);
  ASSERT_TRUE(Polled([&] { return daemon_->goodbyes == 1; }));
}

TEST_F(CApiTest, InvalidSkeletonsAreRejectedWithAReason) {
  connection_ = Open(daemon_->address());
  const char* const shapes[2] = {"jawOpen", "jawOpen"};
  furrow_skeleton skeleton{};
  skeleton.struct_size = sizeof skeleton;
  skeleton.subject = "cleo";
  skeleton.blend_shapes = shapes;
  skeleton.num_blend_shapes = 2;
  std::uint32_t stream = 9;
  EXPECT_EQ(furrow_offer(c(), &skeleton, &stream), FURROW_INVALID_ARGUMENT);
  EXPECT_THAT(LastError(c()), HasSubstr("duplicated"));
  EXPECT_EQ(stream, 9u);
  EXPECT_EQ(InfoOf(c()).streams, 0u);
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
