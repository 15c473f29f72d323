// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/sources_api.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

class SourcesApiTest : public HubTest {
 protected:
  SourcesApi::Parts Parts() {
    return {.bind = "127.0.0.1",
            .allow = [] { return std::vector<std::string>(); },
            .livelink_face = {},
            .vmc = {},
            .give = [this](bool vmc, const std::string& sender, Time) -> Status {
              given.push_back((vmc ? "vmc " : "livelink_face ") + sender);
              return refusal;
            },
            .unix_now = [this] { return now + FromSeconds(1e6); }};
  }
  nlohmann::json Show(const SourcesApi& api) {
    return nlohmann::json::parse(api.Show({}, *hub, now).body);
  }
  nlohmann::json Accept(const std::string& body, int status) {
    const ApiReply reply =
        SourcesApi(Parts()).Accept({.method = "POST", .url = {}, .body = body}, *hub, now);
    EXPECT_EQ(reply.status, status) << reply.body;
    return nlohmann::json::parse(reply.body);
  }

  std::vector<std::string> given;
  Status refusal;
};

TEST_F(SourcesApiTest, SaysWhereToSendAndWhatHasArrived) {
  const Time kNow = now;
  const MocapReport report{
      .port = 11111,
      .packets = 130,
      .malformed = 3,
      .rejected = 7,
      .rate_hz = 60,
      .holder = "192.0.2.20",
      .last = MocapReport::Arrival{"192.0.2.20", kNow - std::chrono::milliseconds(250)},
      .last_rejected = MocapReport::Arrival{"192.0.2.66", kNow - std::chrono::seconds(2)}};
  SourcesApi::Parts parts = Parts();
  parts.bind = "192.0.2.7";
  parts.allow = [] { return std::vector<std::string>{"192.0.2.20"}; };
  parts.livelink_face = [&report](Time) { return std::optional(report); };
  const auto body = Show(SourcesApi(std::move(parts)));
  EXPECT_EQ(body["bind"], "192.0.2.7");
  EXPECT_EQ(body["loopback"], false);
  EXPECT_EQ(body["addresses"], nlohmann::json::array({"192.0.2.7"}));
  EXPECT_EQ(body["allow"], nlohmann::json::array({"192.0.2.20"}));
  const auto& phone = body["inputs"][0];
  EXPECT_EQ(phone["name"], "livelink_face");
  EXPECT_EQ(phone["port"], 11111);
  EXPECT_EQ(phone["packets"], 130);
  EXPECT_EQ(phone["malformed"], 3);
  EXPECT_EQ(phone["rejected"], 7);
  EXPECT_EQ(phone["holder"], "192.0.2.20");
  EXPECT_EQ(phone["sender"], "192.0.2.20");
  EXPECT_EQ(phone["age_ms"], 250.0);
  EXPECT_TRUE(phone["malformed_age_ms"].is_null());
  EXPECT_EQ(phone["rejected_sender"], "192.0.2.66");
  EXPECT_EQ(phone["rejected_age_ms"], 2000.0);
  const auto& vmc = body["inputs"][1];
  EXPECT_EQ(vmc["name"], "vmc");
  EXPECT_TRUE(vmc["port"].is_null()) << "it is off";
  EXPECT_EQ(vmc["usual_port"], 39539);
}

TEST_F(SourcesApiTest, LoopbackReachesNobodyElse) {
  const auto body = Show(SourcesApi(Parts()));
  EXPECT_EQ(body["loopback"], true);
  EXPECT_TRUE(body["addresses"].empty());
  EXPECT_TRUE(body["subjects"].empty());
}

TEST_F(SourcesApiTest, SaysWhatArrivesOfEachSubject) {
  FakePeer sender;
  Connect(&sender);
  Publish(sender, "ann");
  // Captured 20 ms before it arrives, on a clock that is 3 s behind.
  const std::int64_t captured = ToMicroseconds(now + FromSeconds(1e6 - 3.0 - 0.02));
  Send(sender, Pose(0.5f), 1, 1, captured);
  Send(sender, Pose(0.6f), 1, 4, captured + 100);
  // As the histograms of latency do where a socket sends.
  (void)hub->subjects().all().front()->capture_clock.Arrival(captured, now);
  const auto subject = Show(SourcesApi(Parts()))["subjects"][0];
  EXPECT_EQ(subject["name"], "ann");
  EXPECT_EQ(subject["input"], "") << "Furrow's own wire";
  EXPECT_EQ(subject["source"], "fake");
  EXPECT_EQ(subject["poses"], 2);
  EXPECT_EQ(subject["lost"], 2);
  EXPECT_NEAR(subject["clock_offset_ms"].get<double>(), 3020.0, 0.2);
  EXPECT_EQ(subject["blend_shapes"], 2);
  EXPECT_EQ(subject["missing_blend_shapes"]["count"], 0);
}

TEST_F(SourcesApiTest, SaysTheTimecodeOfTheSource) {
  FakePeer sender;
  Connect(&sender);
  Publish(sender, "ann");
  protocol::PoseFrame pose = Pose(0.5f);
  Send(sender, pose, 1, 1, 10);
  const auto without = Show(SourcesApi(Parts()))["subjects"][0];
  EXPECT_TRUE(without["timecode"].is_null()) << "not 00:00:00:00";
  EXPECT_TRUE(without["timecode_rate_hz"].is_null());
  pose.timecode = MakeTimecode(1800, 0.0, 30'000, 1001);
  Send(sender, pose, 1, 2, 20);
  const auto with = Show(SourcesApi(Parts()))["subjects"][0];
  EXPECT_EQ(with["timecode"], "00:01:00;02");
  EXPECT_NEAR(with["timecode_rate_hz"].get<double>(), 29.97, 0.001);
  sender.session = 78;  // the sender was restarted
  Publish(sender, "ann");
  EXPECT_TRUE(Show(SourcesApi(Parts()))["subjects"][0]["timecode"].is_null());
}

TEST_F(SourcesApiTest, AClockThatDoesNotCountFrom1970HasNoOffset) {
  FakePeer sender;
  Connect(&sender);
  Publish(sender, "ann");
  (void)hub->subjects().all().front()->capture_clock.Arrival(40'000, now);
  EXPECT_TRUE(Show(SourcesApi(Parts()))["subjects"][0]["clock_offset_ms"].is_null());
}

TEST_F(SourcesApiTest, NamesWhatTheRigLacks) {
  FakePeer sender;
  Connect(&sender);
  protocol::SkeletonOffer offer = Offer("ann");
  offer.blend_shape_names = {"brow", "unknown"};
  offer.skeleton_hash = protocol::SkeletonHash(offer);
  Send(sender, offer, 1);
  const auto subject = Show(SourcesApi(Parts()))["subjects"][0];
  EXPECT_EQ(subject["missing_blend_shapes"].dump(), R"({"count":1,"names":["nose"]})");
  EXPECT_EQ(subject["missing_joints"]["count"], 0);
}

TEST_F(SourcesApiTest, ListsOnlySubjectsOfTheToken) {
  FakePeer sender;
  Connect(&sender);
  Publish(sender, "ann");
  ApiRequest request;
  request.access = Access();
  const auto body = nlohmann::json::parse(SourcesApi(Parts()).Show(request, *hub, now).body);
  EXPECT_TRUE(body["subjects"].empty());
}

TEST_F(SourcesApiTest, CountsSubjectsBeyondTheList) {
  FakePeer sender;
  Connect(&sender);
  for (std::uint16_t i = 1; i <= 66; ++i) Publish(sender, "subject-" + std::to_string(i), i);
  const auto body = Show(SourcesApi(Parts()));
  EXPECT_EQ(body["subjects"].size(), 64u);
  EXPECT_EQ(body["more_subjects"], 2);
}

TEST_F(SourcesApiTest, GivesAPortToASender) {
  EXPECT_TRUE(Accept(R"({"input": "vmc", "sender": "192.0.2.7"})", 200).contains("inputs"));
  EXPECT_TRUE(Accept(R"({"sender": "::1", "input": "livelink_face"})", 200).contains("inputs"));
  EXPECT_EQ(given, (std::vector<std::string>{"vmc 192.0.2.7", "livelink_face ::1"}));
  refusal = Status(StatusCode::kUnavailable, "--vmc is off", "input");
  EXPECT_EQ(Accept(R"({"input": "vmc", "sender": "192.0.2.7"})", 503)["error"]["field"], "input");
}

TEST_F(SourcesApiTest, ATokenForSomeSubjectsTakesNoPort) {
  ApiRequest request{.method = "POST", .url = {}, .body = R"({"input": "vmc", "sender": "::1"})"};
  for (const auto& [subjects, status] : {std::pair("ann", 403), std::pair("*", 200)}) {
    request.access = Access::Of({.client_id = 1,
                                 .roles = protocol::secure::Role::kDirect,
                                 .packets_per_second = 0,
                                 .subjects = subjects,
                                 .audience = ""},
                                1, now + FromSeconds(60));
    EXPECT_EQ(SourcesApi(Parts()).Accept(request, *hub, now).status, status) << subjects;
  }
  EXPECT_EQ(given.size(), 1u);
}

TEST_F(SourcesApiTest, NamesTheWrongFieldOfARequest) {
  EXPECT_EQ(Accept(R"({"input": "osc", "sender": "::1"})", 400)["error"]["field"], "input");
  EXPECT_EQ(Accept(R"({"sender": "::1"})", 400)["error"]["field"], "input");
  EXPECT_EQ(Accept(R"({"input": "vmc", "sender": 7})", 400)["error"]["field"], "sender");
  EXPECT_EQ(Accept(R"({"input": "vmc", "port": 7})", 400)["error"]["field"], "port");
  Accept("[]", 400);
  EXPECT_TRUE(given.empty());
}

}  // namespace
}  // namespace furrow::server
