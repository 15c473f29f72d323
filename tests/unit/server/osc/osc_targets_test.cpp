// SPDX-License-Identifier: Apache-2.0
#include "server/osc/osc_targets.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/mocap/osc.h"
#include "server/config/osc_profile_file.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using testing::HasSubstr;

// A socket on a free loopback port.
class Receiver {
 public:
  explicit Receiver(asio::io_context& io) : socket_(io, {asio::ip::address_v4::loopback(), 0}) {
    socket_.non_blocking(true);
  }
  [[nodiscard]] std::uint16_t port() { return socket_.local_endpoint().port(); }
  // The addresses of all messages that have arrived.
  std::vector<std::string> Take() {
    std::vector<std::string> addresses;
    std::array<std::uint8_t, 2048> buffer;
    asio::error_code error;
    for (std::size_t size = socket_.receive(asio::buffer(buffer), 0, error); !error;
         size = socket_.receive(asio::buffer(buffer), 0, error)) {
      EXPECT_LE(size, 1200u);
      EXPECT_EQ(protocol::mocap::VisitOsc(std::span(buffer).first(size),
                                          [&](const protocol::mocap::OscMessage& message) {
                                            addresses.emplace_back(message.address);
                                          }),
                protocol::mocap::OscStatus::kOk);
    }
    return addresses;
  }

 private:
  asio::ip::udp::socket socket_;
};

class OscTargetsTest : public HubTest {
 protected:
  void SetUp() override {
    HubTest::SetUp();
    Connect(&sender_);
    Publish(sender_, "ann");
    Make({});
  }
  void Make(std::vector<std::string> allow) {
    OscTargets::Parts parts;
    parts.metrics = &metrics;
    parts.allow = std::move(allow);
    parts.own_ports = {7401};
    parts.on_active = [this](bool active) { active_.push_back(active); };
    targets_ = std::make_unique<OscTargets>(io_, std::move(parts));
  }
  [[nodiscard]] const Subject& subject() const { return *hub->subjects().all().front(); }
  OscTargetConfig To(std::uint16_t port) {
    OscTargetConfig config;
    config.to = {"127.0.0.1", port};
    return config;
  }
  Status Configure(const OscTargetConfig& config) {
    return targets_->AddConfigured(config, LoadOscProfile(config.profile).value());
  }
  Status Refusal(const OscTargetConfig& config) { return targets_->Add(config).status(); }

  asio::io_context io_;
  FakePeer sender_;
  Receiver receiver_{io_};
  std::unique_ptr<OscTargets> targets_;
  std::vector<bool> active_;
};

TEST_F(OscTargetsTest, SendsToEachTargetInItsProfile) {
  OscTargetConfig vmc = To(receiver_.port());
  vmc.profile = "vmc";
  ASSERT_TRUE(targets_->Add(vmc).ok());
  Receiver other(io_);
  ASSERT_TRUE(Configure(To(other.port())).ok());
  EXPECT_EQ(active_, std::vector<bool>{true});
  targets_->Send(subject(), 0, Time{0});
  const auto blend = receiver_.Take();
  ASSERT_GE(blend.size(), 2u);
  EXPECT_EQ(blend.front(), "/VMC/Ext/Blend/Val");
  EXPECT_EQ(blend.back(), "/VMC/Ext/Blend/Apply");
  const auto plain = other.Take();
  EXPECT_EQ(plain.size(), blend.size());
  EXPECT_EQ(plain.back(), "/furrow/ann/frame");
  for (const OscControl::View& view : targets_->List()) {
    EXPECT_EQ(view.packets, 1u);
    EXPECT_EQ(view.errors, 0u);
    EXPECT_EQ(view.last_error, "");
  }
  EXPECT_EQ(metrics.Get(Counter::kOscPacketsSent), 2u);
}

TEST_F(OscTargetsTest, RemovedTargetsReceiveNothing) {
  const Result<int> id = targets_->Add(To(receiver_.port()));
  ASSERT_TRUE(id.ok());
  const Result<int> again = targets_->Add(To(receiver_.port()));
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(*again, *id) << "a repeated request adds nothing";
  EXPECT_TRUE(targets_->Remove(*id).ok());
  EXPECT_EQ(active_, (std::vector<bool>{true, false}));
  targets_->Send(subject(), 0, Time{0});
  EXPECT_TRUE(receiver_.Take().empty());
  EXPECT_EQ(targets_->Remove(*id).code(), StatusCode::kNotFound);
}

TEST_F(OscTargetsTest, TargetsOfTheOperatorStay) {
  ASSERT_TRUE(Configure(To(receiver_.port())).ok());
  EXPECT_EQ(targets_->Remove(targets_->List().front().id).code(), StatusCode::kUnsupported);
  EXPECT_EQ(targets_->List().size(), 1u);
}

TEST_F(OscTargetsTest, SendsOnlyTheSubjectAndTheNamesThatWereAskedFor) {
  OscTargetConfig config = To(receiver_.port());
  config.subject = "bob";
  ASSERT_TRUE(targets_->Add(config).ok());
  targets_->Send(subject(), 0, Time{0});
  EXPECT_TRUE(receiver_.Take().empty());
  config.subject = "ann";
  config.pattern = "none*";
  ASSERT_TRUE(targets_->Add(config).ok());
  targets_->Send(subject(), 0, Time{0});
  EXPECT_EQ(receiver_.Take(), std::vector<std::string>{"/furrow/ann/frame"});
}

TEST_F(OscTargetsTest, ARateSkipsFramesAndSendsTheLastOneLater) {
  OscTargetConfig config = To(receiver_.port());
  config.rate_hz = 10;
  ASSERT_TRUE(targets_->Add(config).ok());
  EXPECT_TRUE(targets_->limits_rates());
  targets_->Send(subject(), 0, FromSeconds(1.00));
  EXPECT_FALSE(receiver_.Take().empty());
  targets_->Send(subject(), 0, FromSeconds(1.02));
  targets_->SendOwed(hub->subjects(), FromSeconds(1.05));
  EXPECT_TRUE(receiver_.Take().empty());
  targets_->SendOwed(hub->subjects(), FromSeconds(1.11));
  EXPECT_FALSE(receiver_.Take().empty());
  targets_->SendOwed(hub->subjects(), FromSeconds(2.00));
  EXPECT_TRUE(receiver_.Take().empty()) << "nothing is owed any more";
  targets_->Send(subject(), 0, FromSeconds(3.00));
  targets_->Send(subject(), 0, FromSeconds(3.02));
  EXPECT_FALSE(receiver_.Take().empty());
  const SubjectRegistry nobody{64};
  targets_->SendOwed(nobody, FromSeconds(3.20));
  EXPECT_TRUE(receiver_.Take().empty()) << "the subject has left";
}

TEST_F(OscTargetsTest, ClientsCannotAimAtOthers) {
  for (const char* host : {"192.168.0.20", "8.8.8.8", "0.0.0.0", "255.255.255.255", "224.0.0.1",
                           "::ffff:8.8.8.8", "fe80::1"}) {
    OscTargetConfig config = To(9000);
    config.to.host = host;
    const Status status = Refusal(config);
    EXPECT_EQ(status.code(), StatusCode::kUnsupported) << host;
    EXPECT_EQ(status.where(), "to");
    EXPECT_THAT(status.todo(), HasSubstr("osc.allow"));
  }
  EXPECT_TRUE(targets_->List().empty());
  Make({"192.0.2.7"});
  OscTargetConfig allowed = To(9000);
  allowed.to.host = "192.0.2.7";
  const Status status = Refusal(allowed);
  // A machine without a network has no route to the address.
  EXPECT_TRUE(status.ok() || status.code() == StatusCode::kUnavailable) << status.ToString();
  allowed.to.port = 7401;  // the daemon's port on another machine
  EXPECT_THAT(Refusal(allowed).what(), testing::Not(HasSubstr("belongs to this daemon")));
}

TEST_F(OscTargetsTest, ClientsCannotFeedTheDaemonWithItsOwnWeights) {
  EXPECT_THAT(Refusal(To(7401)).what(), HasSubstr("belongs to this daemon"));
}

TEST_F(OscTargetsTest, ClientsCannotNameFiles) {
  for (const char* profile : {"../../etc/passwd", "/dev/zero", "vmc.toml", "nothing"}) {
    OscTargetConfig config = To(receiver_.port());
    config.profile = profile;
    const Status status = Refusal(config);
    EXPECT_EQ(status.code(), StatusCode::kNotFound) << profile;
    EXPECT_THAT(status.todo(), HasSubstr("furrow, vmc, vrchat"));
  }
}

TEST_F(OscTargetsTest, InvalidFieldsAreNamed) {
  const auto field = [&](auto change) {
    OscTargetConfig config = To(receiver_.port());
    change(config);
    return Refusal(config).where();
  };
  for (const std::string& prefix :
       {std::string("a b"), std::string(), std::string("/a"), std::string("a/"),
        std::string("a\0,s\0\0b", 7), std::string("\xFF"), std::string(256, 'a')}) {
    EXPECT_EQ(field([&](auto& config) { config.prefix = prefix; }), "prefix") << prefix;
  }
  EXPECT_EQ(field([](auto& config) { config.rate_hz = -1; }), "rate_hz");
  EXPECT_EQ(field([](auto& config) { config.rate_hz = std::nan(""); }), "rate_hz");
  EXPECT_EQ(field([](auto& config) { config.pattern = ""; }), "pattern");
  EXPECT_EQ(field([](auto& config) { config.subject = std::string(300, 's'); }), "subject");
}

TEST_F(OscTargetsTest, TargetsAreLimited) {
  for (std::size_t i = 0; i < OscTargets::kMaxAdded; ++i) {
    ASSERT_TRUE(targets_->Add(To(static_cast<std::uint16_t>(20'000 + i))).ok());
  }
  EXPECT_EQ(Refusal(To(30'000)).code(), StatusCode::kLimit);
  EXPECT_TRUE(targets_->Add(To(20'000)).ok()) << "a repeated request adds nothing";
  ASSERT_TRUE(Configure(To(30'000)).ok()) << "the operator is not limited";
}

TEST_F(OscTargetsTest, ATargetThatNobodyReadsIsReported) {
  std::uint16_t free_port = 0;
  {
    Receiver gone(io_);
    free_port = gone.port();
  }
  ASSERT_TRUE(targets_->Add(To(free_port)).ok());
  // The system reports the first packet's fate with the second.
  targets_->Send(subject(), 0, Time{0});
  targets_->Send(subject(), 0, Time{0});
  const OscControl::View view = targets_->List().front();
  EXPECT_GT(view.errors, 0u);
  EXPECT_THAT(view.last_error, HasSubstr("refused"));
  EXPECT_EQ(metrics.Get(Counter::kOscPacketsUnsendable), view.errors);
}

}  // namespace
}  // namespace furrow::server
