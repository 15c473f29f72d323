// SPDX-License-Identifier: Apache-2.0
// libfurrow.so against a real daemon: weights as the solver computes them, and a daemon that is
// killed and restarted.
#include <chrono>
#include <cmath>
#include <csignal>
#include <functional>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/c/include/furrow/furrow.h"
#include "daemon_fixture.h"
#include "process.h"
#include "tests/certificates.h"
#include "tests/temporary_folder.h"

namespace furrow::testing_net {
namespace {

using Clock = std::chrono::steady_clock;
using testing::HasSubstr;

struct Closer {
  void operator()(furrow_connection* connection) const { furrow_close(connection); }
};
using Handle = std::unique_ptr<furrow_connection, Closer>;

Handle Open(const std::string& address, std::uint32_t flags = 0) {
  char error[256] = "";
  furrow_options options{};
  options.struct_size = sizeof options;
  options.flags = flags;
  options.error = error;
  options.error_size = sizeof error;
  furrow_connection* connection = nullptr;
  EXPECT_EQ(furrow_open(address.c_str(), &options, &connection), FURROW_OK) << error;
  return Handle(connection);
}

std::string LastError(furrow_connection* connection) {
  char text[512] = "";
  (void)furrow_last_error(connection, text, sizeof text);
  return text;
}

// A face without joints that is published through furrow.h.
class Face {
 public:
  Face(furrow_connection* connection, const std::string& subject, const motion::Clip& clip)
      : connection_(connection), clip_(clip) {
    for (const std::string& name : clip.blend_shape_names) names_.push_back(name.c_str());
    furrow_skeleton skeleton{};
    skeleton.struct_size = sizeof skeleton;
    skeleton.subject = subject.c_str();
    skeleton.blend_shapes = names_.data();
    skeleton.num_blend_shapes = static_cast<std::uint32_t>(names_.size());
    EXPECT_EQ(furrow_offer(connection, &skeleton, &stream_), FURROW_OK) << LastError(connection);
  }
  // Sends one frame of the clip, `time_us` being its capture time.
  furrow_status Send(int frame, std::int64_t time_us) {
    furrow_pose pose{};
    pose.struct_size = sizeof pose;
    pose.capture_time_us = time_us;
    pose.blend_shapes = clip_.blend_shapes.data() + frame * names_.size();
    return furrow_send_pose(connection_, stream_, &pose);
  }
  [[nodiscard]] bool accepted() const {
    return furrow_stream_status(connection_, stream_) == FURROW_OK;
  }

 private:
  furrow_connection* connection_;
  const motion::Clip& clip_;
  std::vector<const char*> names_;
  std::uint32_t stream_ = 0;
};

// Lets the connections work until `done`. Only a failing test takes the whole time.
bool Until(const std::vector<furrow_connection*>& connections, const std::function<bool()>& done) {
  const auto end = Clock::now() + std::chrono::seconds(30);
  while (Clock::now() < end) {
    for (furrow_connection* connection : connections) {
      EXPECT_GE(furrow_poll(connection, 1), FURROW_OK) << LastError(connection);
    }
    if (done()) return true;
  }
  return false;
}

furrow_frame FrameOf(furrow_connection* connection, const std::string& subject,
                     std::vector<float>* values) {
  furrow_frame frame{};
  frame.struct_size = sizeof frame;
  values->resize(FURROW_MAX_WEIGHTS);
  if (furrow_weights(connection, subject.c_str(), values->data(), FURROW_MAX_WEIGHTS, &frame) !=
      FURROW_OK) {
    frame.number = 0;
  }
  values->resize(frame.count);
  return frame;
}

class CApi : public testing::TestWithParam<const char*> {
 protected:
  // The address of a daemon's port for the transport of the test.
  static std::string Address(int udp, int tcp, const std::string& query) {
    const bool is_udp = std::string(GetParam()) == "udp";
    return "furrow://127.0.0.1:" + std::to_string(is_udp ? udp : tcp) + "?transport=" + GetParam() +
           query;
  }
};

TEST_P(CApi, WeightsOfPublishedPosesEqualTheSolver) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  const motion::Clip clip = ArkitClip(60);
  const auto expected = Solve(clip, "arkit.json");
  // One connection for both directions.
  const Handle connection = Open(Address(daemon.ready().udp, daemon.ready().tcp, "&subject=ada"));
  Face face(connection.get(), "ada", clip);
  ASSERT_TRUE(Until({connection.get()}, [&] {
    return face.accepted() && furrow_layout(connection.get(), "ada", nullptr, nullptr) == FURROW_OK;
  }));
  std::vector<float> values;
  float most = 0.0f;
  for (int frame = 0; frame < 60; ++frame) {
    ASSERT_EQ(face.Send(frame, std::llround(clip.times[frame] * 1e6)), FURROW_OK);
    ASSERT_TRUE(Until({connection.get()}, [&] {
      const furrow_frame got = FrameOf(connection.get(), "ada", &values);
      return got.number > 0 && got.sequence == static_cast<std::uint32_t>(frame);
    })) << frame;
    ASSERT_EQ(values.size(), expected[frame].size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      ASSERT_NEAR(values[i], expected[frame][i], 1e-5) << frame;
      most = std::max(most, values[i]);
    }
  }
  EXPECT_GT(most, 0.3f) << "the clip moves nothing: the comparison says nothing";
  EXPECT_EQ(FrameOf(connection.get(), "ada", &values).missed, 0u);
}

TEST_P(CApi, PosesArriveAsTheyWerePublished) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  const motion::Clip clip = ArkitClip(10);
  const Handle connection =
      Open(Address(daemon.ready().udp, daemon.ready().tcp, ""), FURROW_OPEN_WITHOUT_SUBSCRIPTION);
  furrow_subscription poses{};
  poses.struct_size = sizeof poses;
  poses.subject = "ada";
  poses.flags = FURROW_SUBSCRIBE_POSES;
  ASSERT_EQ(furrow_subscribe(connection.get(), &poses), FURROW_OK);
  Face face(connection.get(), "ada", clip);
  furrow_skeleton_info info{};
  info.struct_size = sizeof info;
  ASSERT_TRUE(Until({connection.get()}, [&] {
    return furrow_get_skeleton(connection.get(), "ada", &info) == FURROW_OK;
  }));
  EXPECT_EQ(info.num_joints, 0u);
  ASSERT_EQ(info.num_blend_shapes, clip.blend_shape_names.size());
  for (int frame = 0; frame < 10; ++frame) {
    ASSERT_EQ(face.Send(frame, std::llround(clip.times[frame] * 1e6)), FURROW_OK);
    std::vector<float> shapes(info.num_blend_shapes);
    ASSERT_TRUE(Until({connection.get()}, [&] {
      furrow_pose_buffer pose{};
      pose.struct_size = sizeof pose;
      pose.blend_shapes = shapes.data();
      pose.num_blend_shapes = info.num_blend_shapes;
      return furrow_latest_pose(connection.get(), "ada", &pose) == FURROW_OK &&
             pose.sequence == static_cast<std::uint32_t>(frame);
    })) << frame;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      ASSERT_EQ(shapes[i], clip.blend_shapes[frame * shapes.size() + i]) << frame;
    }
  }
}

TEST_P(CApi, AMissingPatternIsReported) {
  DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  const motion::Clip clip = ArkitClip(1);
  const Handle publisher =
      Open(Address(daemon.ready().udp, daemon.ready().tcp, ""), FURROW_OPEN_WITHOUT_SUBSCRIPTION);
  Face face(publisher.get(), "ada", clip);
  ASSERT_TRUE(Until({publisher.get()}, [&] { return face.accepted(); }));
  const Handle watcher =
      Open(Address(daemon.ready().udp, daemon.ready().tcp, "&subject=ada&pattern=nonsense_*"));
  ASSERT_TRUE(Until({publisher.get(), watcher.get()}, [&] {
    return furrow_weights(watcher.get(), "ada", nullptr, 0, nullptr) == FURROW_NO_MATCH;
  }));
  EXPECT_NE(LastError(watcher.get()), "");
}

// furrowd as a process that can be killed.
class DaemonProcess {
 public:
  explicit DaemonProcess(int tcp = 0, int udp = 0)
      : process_({FURROW_BINARY_DIR "/bin/furrowd", "--rig",
                  FURROW_SOURCE_DIR "/rig/rigs/arkit.json", "--no-render", "--http", "0", "--tcp",
                  std::to_string(tcp), "--udp", std::to_string(udp)}) {
    std::smatch match;
    const std::string line = process_.ReadLine().value_or("");
    const bool ready =
        std::regex_search(line, match, std::regex(R"(tcp=127\.0\.0\.1:(\d+) udp=[^:]*:(\d+))"));
    EXPECT_TRUE(ready) << line;
    if (!ready) return;
    tcp_ = std::stoi(match[1]);
    udp_ = std::stoi(match[2]);
  }
  void Kill() {
    process_.Signal(SIGKILL);
    EXPECT_EQ(process_.Wait(), 128 + SIGKILL);
  }
  [[nodiscard]] int tcp() const { return tcp_; }
  [[nodiscard]] int udp() const { return udp_; }

 private:
  Process process_;
  int tcp_ = 0;
  int udp_ = 0;
};

// Two subjects; the daemon is killed and restarted, twice. Weights of both are back soon after it.
TEST_P(CApi, TwoSubjectsSurviveADaemonThatIsKilled) {
  auto daemon = std::make_unique<DaemonProcess>();
  ASSERT_NE(daemon->tcp(), 0);
  const int tcp = daemon->tcp();
  const int udp = daemon->udp();
  const motion::Clip clip = ArkitClip(200);
  const Handle publisher = Open(Address(udp, tcp, ""), FURROW_OPEN_WITHOUT_SUBSCRIPTION);
  const Handle watcher = Open(Address(udp, tcp, "&subject=ada&subject=bob"));
  Face ada(publisher.get(), "ada", clip);
  Face bob(publisher.get(), "bob", clip);
  std::int64_t time_us = 0;
  // Sends poses until `count` more frames of both subjects have arrived.
  const auto receive = [&](std::uint64_t count) {
    std::vector<float> values;
    const std::uint64_t ada_before = FrameOf(watcher.get(), "ada", &values).number;
    const std::uint64_t bob_before = FrameOf(watcher.get(), "bob", &values).number;
    return Until({publisher.get(), watcher.get()}, [&] {
      time_us += 16'667;
      const int frame = static_cast<int>(time_us / 16'667 % 200);
      (void)ada.Send(frame, time_us);
      (void)bob.Send(frame, time_us);
      return FrameOf(watcher.get(), "ada", &values).number >= ada_before + count &&
             FrameOf(watcher.get(), "bob", &values).number >= bob_before + count;
    });
  };
  const auto info = [&](furrow_connection* connection) {
    furrow_connection_info now{};
    now.struct_size = sizeof now;
    EXPECT_EQ(furrow_get_info(connection, &now), FURROW_OK);
    return now;
  };
  ASSERT_TRUE(receive(100));
  for (std::uint64_t connects = 2; connects <= 3; ++connects) {
    daemon->Kill();
    ASSERT_TRUE(Until({publisher.get(), watcher.get()}, [&] {
      (void)ada.Send(0, ++time_us);
      return info(watcher.get()).state == FURROW_DISCONNECTED;
    }));
    daemon = std::make_unique<DaemonProcess>(tcp, udp);
    ASSERT_EQ(daemon->tcp(), tcp);
    const auto start = Clock::now();
    ASSERT_TRUE(receive(100));
    RecordProperty(
        "milliseconds_until_100_frames",
        static_cast<int>(std::chrono::duration<double, std::milli>(Clock::now() - start).count()));
    EXPECT_EQ(info(watcher.get()).connects, connects);
    EXPECT_EQ(info(watcher.get()).state, FURROW_CONNECTED);
  }
}

TEST(CApiTls, ConnectsWithTheAuthorityOfTheOptions) {
  const TemporaryFolder folder;
  const std::string certificate = TestCertificate().Write(folder.path(), "daemon");
  server::Config config = WeightsConfig("arkit.json");
  config.security.tls = {
      .certificate = certificate, .key = folder / "daemon.key", .client_authority = {}};
  const DaemonThread daemon(config);
  ASSERT_TRUE(daemon.serves());
  const std::string address = "furrow://127.0.0.1:" + std::to_string(daemon.ready().tcp);
  furrow_options options{};
  options.struct_size = sizeof options;
  options.tls_authority = certificate.c_str();
  furrow_connection* connection = nullptr;
  ASSERT_EQ(furrow_open(address.c_str(), &options, &connection), FURROW_OK);
  const Handle trusting(connection);
  const Handle strange = Open(address + "?tls=1");
  furrow_connection_info info{};
  info.struct_size = sizeof info;
  const auto weights = [](const Handle& handle) {
    return furrow_weights(handle.get(), nullptr, nullptr, 0, nullptr);
  };
  EXPECT_EQ(weights(strange), FURROW_NO_DATA) << "not tried yet";
  EXPECT_TRUE(Until({trusting.get(), strange.get()},
                    [&] {
                      EXPECT_EQ(furrow_get_info(trusting.get(), &info), FURROW_OK);
                      return info.state == FURROW_CONNECTED &&
                             weights(strange) == FURROW_TLS_FAILED;
                    }))
      << LastError(trusting.get()) << "; " << LastError(strange.get());
  EXPECT_THAT(LastError(strange.get()), HasSubstr("no known authority"));
  EXPECT_EQ(weights(trusting), FURROW_NO_DATA) << "it has only no subject";
}

// A daemon without a certificate. `subscribes`: by a subscription, or by a published subject.
class CApiPlain : public testing::TestWithParam<bool> {};

TEST_P(CApiPlain, ADaemonThatSpeaksNoTlsIsAFailureOfTls) {
  const DaemonThread daemon(WeightsConfig("arkit.json"));
  ASSERT_TRUE(daemon.serves());
  const std::string address = "furrow://127.0.0.1:" + std::to_string(daemon.ready().tcp) + "?tls=1";
  const Handle handle = Open(address, GetParam() ? 0u : FURROW_OPEN_WITHOUT_SUBSCRIPTION);
  const motion::Clip clip = ArkitClip(1);
  std::optional<Face> face;
  if (!GetParam()) face.emplace(handle.get(), "ada", clip);
  const auto status = [&] {
    return GetParam() ? furrow_weights(handle.get(), nullptr, nullptr, 0, nullptr)
                      : face->Send(0, 1);
  };
  EXPECT_TRUE(Until({handle.get()}, [&] { return status() == FURROW_TLS_FAILED; }))
      << LastError(handle.get());
  EXPECT_EQ(status(), FURROW_TLS_FAILED);
  EXPECT_THAT(LastError(handle.get()), HasSubstr("TLS"));
}

INSTANTIATE_TEST_SUITE_P(Subscribes, CApiPlain, testing::Bool());

INSTANTIATE_TEST_SUITE_P(Transports, CApi, testing::Values("udp", "tcp"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace furrow::testing_net
