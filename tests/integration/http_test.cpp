// SPDX-License-Identifier: Apache-2.0
// The web server over real sockets: replies, errors and closed connections (docs/HTTP-API.md).
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/ascii.h"
#include "daemon_fixture.h"
#include "tests/temporary_folder.h"
#include "web_client.h"

namespace furrow::testing_net {
namespace {

using Json = nlohmann::json;
using server::Counter;
using testing::ContainsRegex;
using testing::HasSubstr;

// Two joints and four frames of 0.25 s.
constexpr char kNod[] = R"(HIERARCHY
ROOT hips
{
  OFFSET 0 0 0
  CHANNELS 3 Zrotation Xrotation Yrotation
  JOINT head
  {
    OFFSET 0 10 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 2 0
    }
  }
}
MOTION
Frames: 4
Frame Time: 0.25
0 0 0 0 0 0
0 0 0 0 10 0
0 0 0 0 20 0
0 0 0 0 30 0
)";

class Http : public testing::Test {
 protected:
  void SetUp() override { Start(WeightsConfig("arkit.json")); }
  void Start(const server::Config& config) {
    daemon.emplace(config);
    ASSERT_TRUE(daemon->serves());
    ASSERT_TRUE(daemon->ready().http.has_value());
  }
  std::uint16_t port() const { return *daemon->ready().http; }
  WebClient::Answer Get(std::string_view target) { return WebClient(port()).Ask("GET", target); }
  // Publishes a face "ann" with one pose far from neutral.
  void PublishAnn() {
    const motion::Clip clip = ArkitClip(kFrame + 1);
    const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
    sender.emplace(daemon->ready().tcp);
    Offer(*sender, offer);
    sender->Send(PoseOf(clip, kFrame, offer), 1, 0, 1000);
    sender->Send(protocol::Ping{1});
    ASSERT_TRUE(sender->Await<protocol::Pong>().has_value());  // the pose has been processed
  }

  static constexpr int kFrame = 89;
  std::optional<DaemonThread> daemon;
  std::optional<TcpClient> sender;
};

TEST_F(Http, RoutesAnswerOnOneConnection) {
  WebClient client(port());
  EXPECT_EQ(client.Ask("GET", "/healthz").body, "{\"ok\":true}");
  EXPECT_EQ(client.Ask("GET", "/readyz").status, 200);
  const auto head = client.Ask("HEAD", "/api/status");
  EXPECT_EQ(head.status, 200);
  EXPECT_NE(head.head.find("nosniff"), std::string::npos);
  EXPECT_EQ(client.Ask("GET", "/api/nothing").status, 404);
  EXPECT_EQ(client.Ask("HEAD", "/api/nothing").status, 404);
  EXPECT_EQ(client.Ask("GET", "/../../etc/passwd").status, 404);
  EXPECT_EQ(client.Ask("GET", "/%2e%2e/%2e%2e/etc/passwd").status, 404);
  const auto metrics = client.Ask("GET", "/metrics");
  EXPECT_NE(metrics.body.find("\nfurrow_poses_received_total 0"), std::string::npos);
  EXPECT_NE(metrics.body.find("# TYPE furrow_subjects gauge"), std::string::npos);
  EXPECT_NE(metrics.body.find("# TYPE furrow_heap_used_bytes gauge"), std::string::npos);
  EXPECT_NE(metrics.body.find("# TYPE furrow_heap_bytes gauge"), std::string::npos);
  EXPECT_EQ(Json::parse(client.Ask("GET", "/api/status").body)["render"], false);
}

TEST_F(Http, APoseIsTraced) {
  WebClient client(port());
  EXPECT_EQ(client.Ask("GET", "/api/trace").status, 404);
  EXPECT_EQ(client.Ask("POST", "/api/trace?subject=ann").status, 404);
  PublishAnn();
  EXPECT_EQ(client.Ask("POST", "/api/trace?subject=ann").status, 202);
  EXPECT_EQ(client.Ask("GET", "/api/trace").status, 503) << "no pose has come since";
  const motion::Clip clip = ArkitClip(kFrame + 1);
  sender->Send(PoseOf(clip, kFrame, OfferOf(clip, "ann")), 1, 1, 2000);
  sender->Send(protocol::Ping{2});
  ASSERT_TRUE(sender->Await<protocol::Pong>().has_value());
  const auto answer = client.Ask("GET", "/api/trace");
  ASSERT_EQ(answer.status, 200);
  const Json spans = Json::parse(answer.body)["resourceSpans"][0]["scopeSpans"][0]["spans"];
  ASSERT_EQ(spans.size(), 6u);
  EXPECT_EQ(spans[0]["name"], "pose");
  // Within this hour, so the two clocks are put together rightly.
  const double begun_s = std::stod(spans[0]["startTimeUnixNano"].get<std::string>()) * 1e-9;
  EXPECT_NEAR(begun_s, static_cast<double>(std::time(nullptr)), 3600.0);
}

// HELP says more than the name, and every family has one.
TEST_F(Http, EveryMetricIsExplained) {
  std::istringstream text(Get("/metrics").body);
  std::map<std::string, std::string> help;
  std::set<std::string> typed;
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string mark;
    std::string kind;
    std::string name;
    words >> mark >> kind >> name;
    if (mark != "#") continue;
    std::string rest;
    std::getline(words >> std::ws, rest);
    if (kind == "HELP") help[name] = rest;
    if (kind == "TYPE") typed.insert(name);
  }
  EXPECT_GT(typed.size(), 100u);
  for (const std::string& name : typed) {
    const std::string& sentence = help[name];
    EXPECT_TRUE(sentence.ends_with('.')) << name << ": " << sentence;
    // "Poses received." says no more than furrow_poses_received_total unless a word is added.
    std::istringstream words(sentence);
    int added = 0;
    for (std::string word; words >> word;) {
      word = AsciiLower(word.substr(0, word.find_last_not_of(".,:;") + 1));
      if (name.find(word) == std::string::npos) ++added;
    }
    EXPECT_GT(added, 0) << name << ": " << sentence;
  }
}

TEST_F(Http, LatencyIsCountedWhenWeightsLeave) {
  PublishAnn();
  const std::string body = Get("/metrics").body;
  EXPECT_THAT(body, HasSubstr("furrow_receive_to_send_seconds_count 1\n"));
  EXPECT_THAT(body, HasSubstr("furrow_receive_to_send_seconds_bucket{le=\"+Inf\"} 1\n"));
  EXPECT_THAT(body, HasSubstr("furrow_picture_stage_seconds_count{stage=\"draw\"} 0\n"));
  EXPECT_THAT(body, HasSubstr("furrow_build_info{version=\""));
  EXPECT_THAT(body, HasSubstr("furrow_ready 1\n"));
  EXPECT_THAT(body, ContainsRegex("process_resident_memory_bytes [1-9]"));
}

TEST_F(Http, AWrongMethodGetsAllow) {
  WebClient client(port());
  const auto allowed = [&](std::string_view method, std::string_view path) {
    const auto answer = client.Ask(method, path);
    EXPECT_EQ(answer.status, 405) << method << " " << path;
    const std::size_t at = answer.head.find("Allow: ");
    if (at == std::string::npos) return std::string();
    return answer.head.substr(at + 7, answer.head.find('\r', at) - at - 7);
  };
  EXPECT_EQ(allowed("DELETE", "/api/settings"), "GET, HEAD, PATCH");
  EXPECT_EQ(allowed("GET", "/api/capture"), "POST");
  EXPECT_EQ(allowed("HEAD", "/api/capture/undo"), "POST");
  EXPECT_EQ(allowed("PUT", "/healthz"), "GET, HEAD");
  EXPECT_EQ(allowed("POST", "/mjpeg"), "GET, HEAD");
  EXPECT_EQ(allowed("PATCH", "/snapshot.png?width=32"), "GET, HEAD");
  EXPECT_EQ(allowed("BREW", "/api/subjects"), "GET, HEAD");
  EXPECT_EQ(client.Ask("POST", "/nothing").status, 404);
  EXPECT_EQ(client.Ask("GET", "/healthz").status, 200);  // on the same connection
}

TEST_F(Http, HeadOfPicturesSaysThatThereAreNone) {
  WebClient client(port());
  EXPECT_EQ(client.Ask("HEAD", "/mjpeg?width=64").status, 503);
  const auto picture = client.Ask("HEAD", "/snapshot.png");
  EXPECT_EQ(picture.status, 503);
  EXPECT_NE(picture.head.find("Content-Type: application/json"), std::string::npos);
  EXPECT_EQ(picture.head.find("Retry-After"), std::string::npos);
  EXPECT_EQ(client.Ask("HEAD", "/snapshot.png?width=1").status, 400);
  EXPECT_EQ(client.Ask("GET", "/healthz").status, 200) << "the connection goes on";
  EXPECT_EQ(daemon->Count(Counter::kSubscriptionsRefused), 0u);
}

TEST_F(Http, ARequestIsAnsweredOnce) {
  WebClient client(port());
  EXPECT_EQ(client.Ask("GET", "/healthz").status, 200);
  client.EndSending();
  EXPECT_EQ(client.AskRaw("").status, 0);  // the connection closes without a second reply
  EXPECT_EQ(daemon->Count(Counter::kHttpRequests), 1u);
}

TEST_F(Http, ForeignHostsAndOriginsAreForbidden) {
  WebClient client(port());
  const auto ask = [&](std::string_view headers) {
    return client.Ask("GET", "/api/status", {}, headers).status;
  };
  EXPECT_EQ(ask("Host: evil.example\r\n"), 403);
  EXPECT_EQ(ask("Host: localhost\r\nOrigin: http://evil.example\r\n"), 403);
  EXPECT_EQ(ask("Host: localhost\r\nOrigin: http://localhost\r\n"), 200);
  EXPECT_EQ(WebClient(port()).Upgrade("Host: localhost\r\nOrigin: http://evil.example\r\n").status,
            403);
  EXPECT_EQ(daemon->Count(Counter::kHttpRefused), 3u);
}

TEST_F(Http, InvalidOrLargeRequestsCloseOnlyTheirConnection) {
  WebClient other(port());
  EXPECT_EQ(other.Ask("GET", "/healthz").status, 200);
  EXPECT_EQ(WebClient(port()).AskRaw("\x16\x03\x01 what is this\r\n\r\n").status, 400);
  const std::string many(9000, 'x');
  EXPECT_EQ(WebClient(port()).Ask("GET", "/", {}, "Host: localhost\r\nX: " + many + "\r\n").status,
            431);
  EXPECT_EQ(WebClient(port())
                .AskRaw("PATCH /api/settings HTTP/1.1\r\nHost: localhost\r\n"
                        "Content-Length: 65537\r\n\r\n")
                .status,
            413);
  EXPECT_EQ(other.Ask("GET", "/healthz").status, 200);
}

TEST_F(Http, SettingsChangeAllOrNothingAndErrorsNameTheField) {
  WebClient client(port());
  const auto value_of = [](const std::string& body, const std::string& name) {
    const Json answer = Json::parse(body);
    for (const Json& setting : answer["settings"]) {
      if (setting["name"] == name) return setting["value"].get<std::string>();
    }
    return std::string();
  };
  const auto patched =
      client.Ask("PATCH", "/api/settings", R"({"shading":"skin","wrinkles":false,"exposure":1.5})");
  EXPECT_EQ(patched.status, 200);
  EXPECT_EQ(value_of(patched.body, "shading"), "skin");
  EXPECT_EQ(value_of(patched.body, "wrinkles"), "off");
  EXPECT_EQ(value_of(patched.body, "exposure"), "1.5");
  const std::pair<const char*, const char*> wrong[] = {
      {R"({"exposure":2,"subsurface.width":99})", "subsurface.width"},
      {R"({"no.such":1})", "no.such"},
      {R"({"shading":[]})", "shading"},
      {"[]", "body"},
      {"{", "body"}};
  for (const auto& [body, field] : wrong) {
    const auto answer = client.Ask("PATCH", "/api/settings", body);
    EXPECT_EQ(answer.status, 400) << body;
    EXPECT_EQ(Json::parse(answer.body)["error"]["field"], field) << body;
  }
  EXPECT_EQ(value_of(client.Ask("GET", "/api/settings").body, "exposure"), "1.5");
}

TEST_F(Http, SubjectsAndTheirWeightsAreExplained) {
  EXPECT_EQ(Get("/api/explain?weight=x").status, 404);
  PublishAnn();
  const Json subject = Json::parse(Get("/api/subjects").body)["subjects"][0];
  EXPECT_EQ(subject["name"], "ann");
  EXPECT_EQ(subject["state"], "live");
  EXPECT_EQ(subject["blend_shapes"], 52);
  EXPECT_EQ(subject["poses"], 1);
  const Json rig = Json::parse(Get("/api/rig").body);
  const std::string weight = rig["regions"][0]["weights"][0]["name"];
  const Json why = Json::parse(Get("/api/explain?subject=ann&weight=" + weight).body);
  EXPECT_EQ(why["weight"], weight);
  EXPECT_GT(why["live"], 0.01);
  // The filter does not change the first pose; only the order of summation differs.
  EXPECT_NEAR(why["result"].get<double>(), why["live"].get<double>(), 1e-6);
  EXPECT_FALSE(why["contributions"].empty());
  const auto unknown = Get("/api/explain?subject=ann&weight=nothing.at.all");
  EXPECT_EQ(unknown.status, 404);
  EXPECT_EQ(Json::parse(unknown.body)["error"]["field"], "weight");
}

TEST_F(Http, ANeutralCanBePreviewedCapturedAndUndone) {
  PublishAnn();
  WebClient client(port());
  EXPECT_EQ(client.Ask("POST", "/api/capture/undo", "{}").status, 409);
  EXPECT_EQ(client.Ask("POST", "/api/capture", R"({"pose":"a b"})").status, 400);
  const auto largest = [&](const std::string& field, const std::string& body) {
    float most = 0.0f;
    const Json answer = Json::parse(client.Ask("POST", "/api/capture", body).body);
    for (const Json& weight : answer["weights"]) most = std::max(most, weight[field].get<float>());
    return most;
  };
  const std::string preview = R"({"subject":"ann","pose":"neutral","preview":true})";
  const float before = largest("before", preview);
  EXPECT_GT(before, 0.0f);
  EXPECT_EQ(largest("after", preview), 0.0f);
  EXPECT_EQ(largest("before", preview), before);  // a preview changes nothing
  EXPECT_EQ(largest("after", R"({"pose":"neutral"})"), 0.0f);
  EXPECT_EQ(largest("before", preview), 0.0f);
  EXPECT_EQ(client.Ask("POST", "/api/capture/undo", "{}").status, 200);
  EXPECT_EQ(largest("before", preview), before);
}

TEST_F(Http, WithoutARendererPicturesAreUnavailable) {
  for (const char* path : {"/snapshot.png", "/mjpeg", "/api/cameras"}) {
    const auto answer = Get(path);
    EXPECT_EQ(answer.status, 503) << path;
    EXPECT_EQ(answer.head.find("Retry-After"), std::string::npos) << "it would not help: " << path;
  }
  for (const auto& [query, field] : {std::pair("width=1", "width"), std::pair("view=x", "view"),
                                     std::pair("camera=x", "camera"), std::pair("fog=1", "fog")}) {
    const auto answer = Get(std::string("/mjpeg?") + query);
    EXPECT_EQ(answer.status, 400) << query;
    EXPECT_EQ(Json::parse(answer.body)["error"]["field"], field);
  }
  EXPECT_EQ(Get("/api/playback").status, 409);
}

TEST_F(Http, APlayedRecordingHasATimeline) {
  const TemporaryFolder folder;
  std::ofstream(folder / "nod.bvh") << kNod;
  daemon.reset();
  server::Config config = WeightsConfig("arkit.json");
  config.play = folder / "nod.bvh";
  Start(config);
  WebClient client(port());
  const auto patch = [&](const std::string& body) {
    return Json::parse(client.Ask("PATCH", "/api/playback", body).body);
  };
  const Json paused = patch(R"({"playing":false,"position_s":0.5,"loop":false,"speed":2})");
  EXPECT_EQ(paused["file"], "nod.bvh");
  EXPECT_EQ(paused["subject"], "nod");
  EXPECT_EQ(paused["frames"], 4);
  EXPECT_NEAR(paused["seconds"].get<double>(), 0.75, 1e-9);
  EXPECT_EQ(paused["frame"], 2);
  EXPECT_EQ(paused["playing"], false);
  EXPECT_EQ(paused["loop"], false);
  EXPECT_EQ(paused["speed"], 2.0);
  EXPECT_EQ(patch(R"({"position_s":1,"speed":9})")["error"]["field"], "speed");
  EXPECT_EQ(patch(R"({"position_s":"1"})")["error"]["field"], "position_s");
  EXPECT_EQ(patch(R"({"colour":1})")["error"]["field"], "colour");
  EXPECT_EQ(Json::parse(Get("/api/playback").body), paused);  // all or nothing
  EXPECT_EQ(patch(R"({"position_s":99})")["frame"], 3);
  EXPECT_EQ(patch(R"({"position_s":-1})")["frame"], 0);
  const Json subject = Json::parse(Get("/api/subjects").body)["subjects"][0];
  EXPECT_EQ(subject["name"], "nod");
  EXPECT_EQ(subject["state"], "live");
}

TEST_F(Http, AWebSocketIsAPeerOfTheHub) {
  PublishAnn();
  WebClient client(port());
  const auto upgraded = client.Upgrade();
  ASSERT_EQ(upgraded.status, 101);
  EXPECT_NE(upgraded.head.find("Sec-WebSocket-Protocol: furrow.1"), std::string::npos);
  client.Send(protocol::Ping{42});
  EXPECT_EQ(client.Take<protocol::Pong>()->time_us, 42);
  client.Send(protocol::SubscribeWeights{.subject = "ann"}, 0, 5);
  protocol::Header header;
  const auto reply = client.Take<protocol::SubscribeReply>(&header);
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(header.sequence, 5u);
  const auto weights = client.Take<protocol::WeightFrame>();
  ASSERT_TRUE(weights.has_value());
  EXPECT_EQ(weights->values.size(), reply->names.size());
  client.Send(protocol::SubscribePictures{.subject = "ann"}, 0, 6);
  EXPECT_EQ(client.Take<protocol::ErrorMessage>()->code, protocol::ErrorCode::kNotRendering);
}

TEST_F(Http, AnInvalidWebSocketIsClosedAndOthersStay) {
  WebClient good(port());
  ASSERT_EQ(good.Upgrade().status, 101);
  const auto close_code = [&](int opcode, const std::vector<std::uint8_t>& payload) {
    WebClient client(port());
    EXPECT_EQ(client.Upgrade().status, 101);
    client.SendFrame(opcode, payload);
    const auto frame = client.Next();
    return frame && frame->opcode == WebClient::kClose ? frame->close_code() : -1;
  };
  EXPECT_EQ(close_code(WebClient::kText, {'h', 'i'}), 1003);
  EXPECT_EQ(close_code(WebClient::kBinary, {1, 2, 3}), 1002);
  EXPECT_EQ(close_code(WebClient::kBinary, std::vector<std::uint8_t>(65537)), 1009);
  good.Send(protocol::Ping{7});
  EXPECT_EQ(good.Take<protocol::Pong>()->time_us, 7);
}

TEST_F(Http, AWebSocketReceivesTheGoodbye) {
  std::jthread stop;  // joined after the client is destroyed
  WebClient client(port());
  ASSERT_EQ(client.Upgrade().status, 101);
  client.Send(protocol::Ping{1});
  ASSERT_TRUE(client.Take<protocol::Pong>().has_value());
  stop = std::jthread([this] { EXPECT_EQ(daemon->Stop(), server::ExitCode::kOk); });
  const auto goodbye = client.Take<protocol::Goodbye>();
  ASSERT_TRUE(goodbye.has_value());
  EXPECT_EQ(goodbye->reason, protocol::GoodbyeReason::kDraining);
  const auto close = client.Next();
  ASSERT_TRUE(close.has_value());
  EXPECT_EQ(close->opcode, WebClient::kClose);
  EXPECT_EQ(close->close_code(), 1001);
  client.SendFrame(WebClient::kClose, close->payload);
}

TEST_F(Http, ConnectionsAreLimited) {
  daemon.reset();
  server::Config config = WeightsConfig("arkit.json");
  config.http.max_connections = 3;  // two for one host
  Start(config);
  WebClient first(port());
  WebClient second(port());
  EXPECT_EQ(first.Ask("GET", "/healthz").status, 200);
  EXPECT_EQ(second.Ask("GET", "/healthz").status, 200);
  const WebClient::Answer refused = WebClient(port()).AskRaw("");
  EXPECT_EQ(refused.status, 429);
  EXPECT_NE(refused.head.find("Retry-After: 1"), std::string::npos);
  EXPECT_NE(refused.body.find("http.max_connections"), std::string::npos);
  EXPECT_EQ(first.Ask("GET", "/healthz").status, 200);
}

TEST_F(Http, AFloodOfProbesIsAnsweredLaterButNotRefused) {
  daemon.reset();
  server::Config config = WeightsConfig("arkit.json");
  config.http.requests_per_second = 1;
  Start(config);
  WebClient client(port());
  for (int i = 0; i < 5; ++i) EXPECT_EQ(client.Ask("GET", "/healthz").status, 200);
  EXPECT_GE(daemon->Count(Counter::kHttpSlowed), 1u);
}

// All web places of this host are taken by viewers that wait for a subject which never comes.
TEST_F(Http, WaitingWebSocketsGiveWayToANewcomer) {
  daemon.reset();
  server::Config config = WeightsConfig("arkit.json");
  config.http.max_connections = 16;  // 8 for one host
  Start(config);
  std::vector<std::unique_ptr<WebClient>> waiting;
  for (int i = 0; i < 8; ++i) {
    waiting.push_back(std::make_unique<WebClient>(port()));
    ASSERT_EQ(waiting.back()->Upgrade().status, 101);
    waiting.back()->Send(protocol::SubscribeWeights{.subject = "nobody", .wait = true}, 0, 1);
    ASSERT_TRUE(waiting.back()->Take<protocol::SubscribeReply>().has_value()) << i;
  }
  WebClient newcomer(port());
  EXPECT_EQ(newcomer.Ask("GET", "/api/status").status, 200);
  EXPECT_EQ(daemon->Count(Counter::kConnectionsRefused), 0u);
  const auto error = waiting.front()->Take<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->code, protocol::ErrorCode::kLimit);
  EXPECT_TRUE(waiting.front()->Take<protocol::Goodbye>().has_value());
  std::optional<WebClient::Frame> last;
  while (auto frame = waiting.front()->Next()) last = frame;
  ASSERT_TRUE(last.has_value());
  EXPECT_EQ(last->opcode, WebClient::kClose);
  waiting.back()->Send(protocol::Ping{7});
  EXPECT_TRUE(waiting.back()->Take<protocol::Pong>().has_value()) << "the others stay";
}

// The same for streams of JSON lines, whose last line says why.
TEST_F(Http, WaitingWeightLinesGiveWayToANewcomer) {
  daemon.reset();
  server::Config config = WeightsConfig("arkit.json");
  config.http.max_connections = 4;  // 2 for one host
  Start(config);
  WebClient first(port());
  WebClient second(port());
  for (WebClient* each : {&first, &second}) {
    EXPECT_EQ(each->Ask("GET", "/weights?subject=nobody").status, 200);
    EXPECT_NE(each->ReadUntil("}\n").find("waiting"), std::string::npos);
  }
  EXPECT_EQ(WebClient(port()).Ask("GET", "/api/status").status, 200);
  EXPECT_NE(first.ReadUntil("}\n").find("newcomer"), std::string::npos);
  EXPECT_NE(first.ReadUntil("}\n").find("bye"), std::string::npos);
}

}  // namespace
}  // namespace furrow::testing_net
