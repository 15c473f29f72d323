// SPDX-License-Identifier: Apache-2.0
// VMC and Live Link Face input, OSC output. The encoders here follow the published formats and do
// not share code with protocol/; liblo's tools are independent peers.
#include <array>
#include <bit>
#include <csignal>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "daemon_fixture.h"
#include "process.h"

namespace furrow::testing_net {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

void PutU32(Bytes* out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    out->push_back(static_cast<std::uint8_t>(value >> shift));
}
void PutF32(Bytes* out, float value) { PutU32(out, std::bit_cast<std::uint32_t>(value)); }

// An OSC string: NUL-terminated and padded to 4 bytes.
void PutOscString(Bytes* out, std::string_view text) {
  out->insert(out->end(), text.begin(), text.end());
  do out->push_back(0);
  while (out->size() % 4 != 0);
}

Bytes BlendVal(std::string_view name, float value) {
  Bytes out;
  PutOscString(&out, "/VMC/Ext/Blend/Val");
  PutOscString(&out, ",sf");
  PutOscString(&out, name);
  PutF32(&out, value);
  return out;
}

Bytes BlendApply() {
  Bytes out;
  PutOscString(&out, "/VMC/Ext/Blend/Apply");
  PutOscString(&out, ",");
  return out;
}

// A Live Link Face packet, version 6. `values` sets some of the 61 values by index; others are 0.
Bytes LiveLinkFace(std::string_view subject, std::uint32_t frame, std::map<int, float> values) {
  Bytes out = {6};
  const std::string device(36, 'A');
  PutU32(&out, static_cast<std::uint32_t>(device.size()));
  out.insert(out.end(), device.begin(), device.end());
  PutU32(&out, static_cast<std::uint32_t>(subject.size()));
  out.insert(out.end(), subject.begin(), subject.end());
  PutU32(&out, frame);
  PutF32(&out, 0.0f);
  PutU32(&out, 60);
  PutU32(&out, 1);
  out.push_back(61);
  for (int i = 0; i < 61; ++i) PutF32(&out, values.contains(i) ? values[i] : 0.0f);
  return out;
}

// A UDP socket on a free loopback port.
class UdpListener {
 public:
  UdpListener() : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<sockaddr*>(&address), size), 0);
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port = ntohs(address.sin_port);
  }
  ~UdpListener() { Close(); }
  void Close() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
  }
  std::uint16_t port = 0;

 private:
  int socket_;
};

server::Config ForeignConfig() {
  server::Config config = WeightsConfig("arkit.json");
  config.vmc = 0;
  config.livelink_face = 0;
  return config;
}

// The values of a weight frame by name.
std::map<std::string, float> Named(const protocol::SubscribeReply& reply,
                                   const protocol::WeightFrame& frame) {
  std::map<std::string, float> named;
  for (std::size_t i = 0; i < reply.names.size(); ++i) named[reply.names[i]] = frame.values[i];
  return named;
}

// Subscribes before the subject exists. The reply that binds arrives with the first frame.
void AwaitSubject(TcpClient& viewer, const std::string& subject) {
  const auto waiting = Watch(viewer, {.subject = subject, .wait = true});
  ASSERT_TRUE(waiting.has_value());
  ASSERT_TRUE(waiting->names.empty());
}

TEST(ForeignWires, LiveLinkFaceRaisesTheRightWeights) {
  DaemonThread daemon(ForeignConfig());
  ASSERT_TRUE(daemon.serves());
  TcpClient viewer(daemon.ready().tcp);
  AwaitSubject(viewer, "phone");
  UdpClient phone(*daemon.ready().livelink_face);
  const Bytes packet = LiveLinkFace("phone", 1000, {{41, 1.0f}, {49, 1.0f}});
  ASSERT_EQ(packet.size(), 26 + 36 + 5 + 4 * 61u);
  phone.SendRaw(packet);  // BrowDownLeft, NoseSneerLeft
  const auto reply = viewer.Await<protocol::SubscribeReply>();
  ASSERT_TRUE(reply.has_value());
  const auto frame = viewer.Await<protocol::WeightFrame>();
  ASSERT_TRUE(frame.has_value());
  auto weights = Named(*reply, *frame);
  EXPECT_GT(weights["brow_l.squash"], 0.5f);
  EXPECT_LT(weights["brow_r.squash"], weights["brow_l.squash"]);
  EXPECT_LT(weights["brow_l.stretch"], 0.05f);
  EXPECT_LT(weights["mouth_r.stretch"], 0.05f);
}

TEST(ForeignWires, DamagedPacketsAreCountedAndChangeNothing) {
  DaemonThread daemon(ForeignConfig());
  ASSERT_TRUE(daemon.serves());
  TcpClient viewer(daemon.ready().tcp);
  AwaitSubject(viewer, "phone");
  UdpClient phone(*daemon.ready().livelink_face);
  Bytes packet = LiveLinkFace("phone", 1, {{41, 1.0f}});
  for (std::size_t size = 1; size < packet.size(); size += 13) {
    if (size == packet.size() - 245) continue;  // a packet without a face has this length
    phone.SendRaw(std::span(packet).first(size));
  }
  packet[0] = 5;
  phone.SendRaw(packet);
  packet[0] = 6;
  phone.SendRaw(packet);
  ASSERT_TRUE(viewer.Await<protocol::WeightFrame>().has_value());
  EXPECT_GT(daemon.Count(server::Counter::kMocapMalformed), 20u);
  EXPECT_EQ(daemon.Count(server::Counter::kMocapFrames), 1u);
}

TEST(ForeignWires, VmcRaisesTheRightWeights) {
  DaemonThread daemon(ForeignConfig());
  ASSERT_TRUE(daemon.serves());
  TcpClient viewer(daemon.ready().tcp);
  AwaitSubject(viewer, "vmc");
  UdpClient performer(*daemon.ready().vmc);
  performer.SendRaw(BlendVal("BrowInnerUp", 1.0f));  // names are case-insensitive
  performer.SendRaw(BlendVal("browOuterUpLeft", 1.0f));
  performer.SendRaw(BlendApply());
  const auto reply = viewer.Await<protocol::SubscribeReply>();
  ASSERT_TRUE(reply.has_value());
  const auto frame = viewer.Await<protocol::WeightFrame>();
  ASSERT_TRUE(frame.has_value());
  auto weights = Named(*reply, *frame);
  EXPECT_GT(weights["brow_l.stretch"], 0.5f);
  EXPECT_LT(weights["brow_l.squash"], 0.05f);
}

// A VRM avatar sends its expressions, and the rig reads ARKit's blend shapes.
TEST(ForeignWires, VrmPresetsOverVmcRaiseTheRightWeights) {
  DaemonThread daemon(ForeignConfig());
  ASSERT_TRUE(daemon.serves());
  TcpClient viewer(daemon.ready().tcp);
  AwaitSubject(viewer, "vmc");
  UdpClient performer(*daemon.ready().vmc);
  performer.SendRaw(BlendVal("Sorrow", 1.0f));
  performer.SendRaw(BlendVal("A", 1.0f));
  performer.SendRaw(BlendVal("Blink", 0.0f));
  performer.SendRaw(BlendVal("Angry", 0.0f));
  performer.SendRaw(BlendApply());
  const auto reply = viewer.Await<protocol::SubscribeReply>();
  ASSERT_TRUE(reply.has_value());
  const auto frame = viewer.Await<protocol::WeightFrame>();
  ASSERT_TRUE(frame.has_value());
  auto weights = Named(*reply, *frame);
  EXPECT_GT(weights["brow_l.stretch"], 0.5f);  // browInnerUp
  EXPECT_EQ(weights["brow_l.stretch"], weights["brow_r.stretch"]);
  EXPECT_GT(weights["mouth_l.stretch"], 0.3f);  // mouthFrownLeft
  EXPECT_GT(weights["nose.stretch"], 0.1f);     // jawOpen
  EXPECT_LT(weights["brow_l.squash"], 0.05f);
}

TEST(ForeignWires, APortAcceptsItsFirstSenderAndCountsOthers) {
  DaemonThread daemon(ForeignConfig());
  ASSERT_TRUE(daemon.serves());
  TcpClient viewer(daemon.ready().tcp);
  AwaitSubject(viewer, "phone");
  UdpClient garbage(*daemon.ready().livelink_face, "127.0.0.2");
  UdpClient phone(*daemon.ready().livelink_face, "127.0.0.3");
  garbage.SendRaw(Bytes(100, 0x11));  // does not hold the port
  phone.SendRaw(LiveLinkFace("phone", 1, {{41, 1.0f}}));
  garbage.SendRaw(LiveLinkFace("phone", 2, {{41, 0.0f}}));
  phone.SendRaw(LiveLinkFace("phone", 3, {{41, 1.0f}}));
  ASSERT_TRUE(viewer.Await<protocol::WeightFrame>().has_value());
  ASSERT_TRUE(viewer.Await<protocol::WeightFrame>().has_value());
  EXPECT_EQ(daemon.Count(server::Counter::kMocapMalformed), 1u);
  EXPECT_EQ(daemon.Count(server::Counter::kMocapLockedOut), 1u);
  EXPECT_EQ(daemon.Count(server::Counter::kMocapFrames), 2u);
}

TEST(ForeignWires, OscsendOfLibloIsUnderstood) {
  const std::string oscsend = FindProgram("oscsend");
  if (oscsend.empty()) GTEST_SKIP() << "no oscsend: install liblo-tools";
  DaemonThread daemon(ForeignConfig());
  ASSERT_TRUE(daemon.serves());
  TcpClient viewer(daemon.ready().tcp);
  AwaitSubject(viewer, "vmc");
  const std::string port = std::to_string(*daemon.ready().vmc);
  Process value({oscsend, "127.0.0.1", port, "/VMC/Ext/Blend/Val", "sf", "noseSneerRight", "1.0"});
  ASSERT_EQ(value.Wait(), 0) << value.ReadErrors();
  Process apply({oscsend, "127.0.0.1", port, "/VMC/Ext/Blend/Apply"});
  ASSERT_EQ(apply.Wait(), 0) << apply.ReadErrors();
  const auto reply = viewer.Await<protocol::SubscribeReply>();
  ASSERT_TRUE(reply.has_value());
  const auto frame = viewer.Await<protocol::WeightFrame>();
  ASSERT_TRUE(frame.has_value());
  EXPECT_GT(Named(*reply, *frame)["nose.squash"], 0.1f);
}

TEST(ForeignWires, OscdumpOfLibloReadsWhatWeSend) {
  const std::string oscdump = FindProgram("oscdump");
  const std::string stdbuf = FindProgram("stdbuf");
  if (oscdump.empty() || stdbuf.empty()) GTEST_SKIP() << "no oscdump: install liblo-tools";
  UdpListener reserved;
  server::Config config = WeightsConfig("arkit.json");
  config.osc_out = server::HostPort{"127.0.0.1", reserved.port};
  reserved.Close();  // for oscdump
  Process dump({stdbuf, "-oL", oscdump, "-L", std::to_string(reserved.port)});
  DaemonThread daemon(config);
  ASSERT_TRUE(daemon.serves());
  const motion::Clip clip = ArkitClip(60);
  const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
  TcpClient client(daemon.ready().tcp);
  Offer(client, offer);
  const auto reply = Watch(client, {.subject = "ann"});
  ASSERT_TRUE(reply.has_value());
  // oscdump needs a moment to start, so the pose repeats until the first line appears.
  std::jthread sender([&](std::stop_token stop) {
    for (std::uint32_t i = 0; !stop.stop_requested(); ++i) {
      client.Send(PoseOf(clip, 59, offer), 1, i, 1000 * i);
      if (!client.Await<protocol::WeightFrame>()) return;
    }
  });
  std::string lines;
  for (std::string line; line.find("/furrow/ann/frame") == std::string::npos; lines += line) {
    auto next = dump.ReadLine();
    ASSERT_TRUE(next.has_value()) << dump.ReadErrors();
    line = *next + "\n";
  }
  dump.ReadLine();
  sender.request_stop();
  sender.join();
  for (const std::string& name : reply->names) {
    EXPECT_THAT(lines, HasSubstr("/furrow/ann/" + name + " f "));
  }
}

}  // namespace
}  // namespace furrow::testing_net
