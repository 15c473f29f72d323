// SPDX-License-Identifier: Apache-2.0
// Recordings that clients upload over real sockets: POST and DELETE /api/playback.
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon_fixture.h"
#include "protocol/secure/token/token_text.h"
#include "sealed_client.h"
#include "tests/temporary_folder.h"
#include "web_client.h"

namespace furrow::testing_net {
namespace {

using protocol::secure::Role;
using server::Counter;
using testing::HasSubstr;
using UploadJson = nlohmann::json;

// A joint and `frames` frames of 0.25 s. `stated`: the number that the file states.
std::string Bvh(int frames, int stated) {
  std::string text =
      "HIERARCHY\nROOT hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd "
      "Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: " +
      std::to_string(stated) + "\nFrame Time: 0.25\n";
  for (int i = 0; i < frames; ++i) text += "0 " + std::to_string(i % 90) + " 0\n";
  return text;
}
std::string Bvh(int frames) { return Bvh(frames, frames); }

class Upload : public testing::Test {
 protected:
  void SetUp() override { Start(WeightsConfig("arkit.json")); }
  void Start(const server::Config& config) {
    daemon.emplace(config);
    ASSERT_TRUE(daemon->serves());
  }
  std::uint16_t port() const { return *daemon->ready().http; }
  WebClient::Answer Post(const std::string& name, std::string_view body) {
    return WebClient(port()).Ask("POST", "/api/playback?name=" + name, body);
  }
  UploadJson Get(std::string_view target) {
    return UploadJson::parse(WebClient(port()).Ask("GET", target).body);
  }
  // A member of the error in the answer; empty: there is no error.
  static std::string Member(const WebClient::Answer& answer, const char* name) {
    const auto body = UploadJson::parse(answer.body, nullptr, /*allow_exceptions=*/false);
    const bool is_error = body.is_object() && body.contains("error");
    return is_error ? body["error"].value(name, "") : "";
  }

  std::optional<DaemonThread> daemon;
};

TEST_F(Upload, IsPlayedWithATimeline) {
  WebClient client(port());
  EXPECT_EQ(Get("/api/status")["playback"], false);
  EXPECT_EQ(Get("/api/status")["max_upload_bytes"], 64'000'000);
  const auto answer = client.Ask("POST", "/api/playback?name=nod.bvh", Bvh(5, 6));
  ASSERT_EQ(answer.status, 200) << answer.body;
  const auto played = UploadJson::parse(answer.body);
  EXPECT_EQ(played["file"], "nod.bvh");
  EXPECT_EQ(played["subject"], "nod");
  EXPECT_EQ(played["uploaded"], true);
  EXPECT_EQ(played["frames"], 5);
  EXPECT_EQ(played["loop"], true);
  ASSERT_EQ(played["warnings"].size(), 1u);
  EXPECT_THAT(played["warnings"][0].get<std::string>(), HasSubstr("nod.bvh"));
  // The connection goes on, also for a request that is sent right behind the file.
  const auto patched =
      client.Ask("PATCH", "/api/playback", R"({"playing":false,"position_s":0.5})");
  EXPECT_EQ(UploadJson::parse(patched.body)["frame"], 2);
  EXPECT_EQ(Get("/api/status")["playback"], true);
  EXPECT_EQ(Get("/api/subjects")["subjects"][0]["name"], "nod");
  EXPECT_EQ(client.Ask("DELETE", "/api/playback").status, 200);
  EXPECT_EQ(client.Ask("GET", "/api/playback").status, 409);
  EXPECT_EQ(client.Ask("DELETE", "/api/playback").status, 409);
}

TEST_F(Upload, ReplacesTheRecordingOfTheConfigurationUntilItIsClosed) {
  const TemporaryFolder folder;
  std::ofstream(folder / "show.bvh") << Bvh(3);
  daemon.reset();
  server::Config config = WeightsConfig("arkit.json");
  config.play = folder / "show.bvh";
  Start(config);
  WebClient client(port());
  ASSERT_EQ(client.Ask("PATCH", "/api/playback", R"({"playing":false,"position_s":0.25})").status,
            200);
  ASSERT_EQ(client.Ask("POST", "/api/playback?name=nod.bvh", Bvh(5)).status, 200);
  EXPECT_EQ(Get("/api/playback")["file"], "nod.bvh");
  // A later upload of the same name replaces the former one, and the recording of --play stays.
  ASSERT_EQ(client.Ask("POST", "/api/playback?name=nod.bvh", Bvh(7)).status, 200);
  EXPECT_EQ(Get("/api/playback")["frames"], 7);
  ASSERT_EQ(client.Ask("DELETE", "/api/playback").status, 200);
  const auto show = Get("/api/playback");
  EXPECT_EQ(show["file"], "show.bvh");
  EXPECT_EQ(show["uploaded"], false);
  EXPECT_EQ(show["frame"], 1);
  EXPECT_EQ(show["playing"], false);
}

TEST_F(Upload, OneClearErrorForWhatIsNoRecording) {
  ASSERT_EQ(Post("nod.bvh", Bvh(5)).status, 200);
  const auto picture = Post("photo.png", "\x89PNG");
  EXPECT_EQ(picture.status, 400);
  EXPECT_EQ(Member(picture, "message"), "unknown recording format '.png'");
  EXPECT_THAT(Member(picture, "hint"), HasSubstr(".mcap"));
  const auto cut = Post("cut.bvh", Bvh(5).substr(0, 60));
  EXPECT_EQ(cut.status, 400);
  EXPECT_THAT(Member(cut, "field"), HasSubstr("cut.bvh"));
  EXPECT_EQ(Post("", Bvh(5)).status, 400);
  EXPECT_EQ(Member(Post("", Bvh(5)), "field"), "name");
  EXPECT_EQ(Post("..%2Fother.bvh", Bvh(2)).status, 200);
  EXPECT_EQ(Get("/api/playback")["subject"], "other");
}

TEST_F(Upload, TheSubjectOfAnotherSenderIsNotTaken) {
  TcpClient sender(daemon->ready().tcp);
  const motion::Clip clip = ArkitClip(3);
  const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
  Offer(sender, offer);
  sender.Send(PoseOf(clip, 1, offer), 1, 0, 1000);
  const auto answer = Post("ann.bvh", Bvh(5));
  EXPECT_EQ(answer.status, 409);
  EXPECT_THAT(Member(answer, "message"), HasSubstr("another sender is sending 'ann'"));
  EXPECT_THAT(Member(answer, "hint"), HasSubstr("rename the file"));
  EXPECT_EQ(WebClient(port()).Ask("GET", "/api/playback").status, 409);
}

// The client announces much and sends nothing, so a reply shows that the daemon waited for nothing.
TEST_F(Upload, ALargeBodyIsRefusedByItsHeader) {
  const std::string head = "POST /api/playback?name=a.bvh HTTP/1.1\r\nHost: localhost\r\n";
  WebClient large(port());
  const auto refused = large.AskRaw(head + "Content-Length: 64000001\r\n\r\n");
  EXPECT_EQ(refused.status, 413);
  EXPECT_THAT(Member(refused, "message"), HasSubstr("the limit is 64 MB"));
  WebClient huge(port());
  EXPECT_EQ(huge.AskRaw(head + "Content-Length: 18446744073709551615\r\n\r\n").status, 413);
  WebClient unknown(port());
  EXPECT_EQ(unknown.AskRaw(head + "Transfer-Encoding: chunked\r\n\r\n").status, 411);
  // Other routes keep their limit.
  WebClient other(port());
  EXPECT_EQ(other
                .AskRaw("PATCH /api/playback HTTP/1.1\r\nHost: localhost\r\nContent-Length: "
                        "65537\r\n\r\n")
                .status,
            413);
  EXPECT_EQ(Post("nod.bvh", Bvh(5)).status, 200) << "nobody holds the turn";
}

TEST_F(Upload, OneAtATimeAndTheFirstIsNotDisturbed) {
  const std::string body = Bvh(20'000);
  WebClient first(port());
  const auto goes_on = first.AskRaw(
      "POST /api/playback?name=first.bvh HTTP/1.1\r\nHost: localhost\r\nExpect: "
      "100-continue\r\nContent-Length: " +
      std::to_string(body.size()) + "\r\n\r\n");
  ASSERT_EQ(goes_on.status, 100);
  const auto second = Post("second.bvh", Bvh(5));
  EXPECT_EQ(second.status, 503);
  EXPECT_THAT(second.head, HasSubstr("Retry-After: 1"));
  EXPECT_THAT(Member(second, "message"), HasSubstr("being uploaded"));
  const auto answer = first.AskRaw(body);
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(UploadJson::parse(answer.body)["frames"], 20'000);
  EXPECT_EQ(Post("second.bvh", Bvh(5)).status, 200);
}

TEST_F(Upload, AClientThatGoesAwayLeavesItsTurn) {
  ASSERT_EQ(Post("nod.bvh", Bvh(5)).status, 200);
  {
    WebClient gone(port());
    ASSERT_EQ(gone.AskRaw("POST /api/playback?name=gone.bvh HTTP/1.1\r\nHost: localhost\r\nExpect: "
                          "100-continue\r\nContent-Length: 1000\r\n\r\n")
                  .status,
              100);
  }
  int status = 503;
  while (status == 503) status = Post("next.bvh", Bvh(3)).status;  // until its end is noticed
  EXPECT_EQ(status, 200);
  EXPECT_EQ(Get("/api/playback")["file"], "next.bvh");
}

TEST_F(Upload, CanBeTurnedOff) {
  daemon.reset();
  server::Config config = WeightsConfig("arkit.json");
  config.http.max_upload_megabytes = 0;
  Start(config);
  EXPECT_EQ(Get("/api/status")["max_upload_bytes"], 0);
  const auto answer = Post("nod.bvh", Bvh(5));
  EXPECT_EQ(answer.status, 403);
  EXPECT_THAT(answer.body, HasSubstr("http.max_upload_megabytes is 0"));
}

TEST(SecureUpload, NeedsTheRoleBeforeItsBody) {
  const TestKeys keys;
  DaemonThread daemon(SecureConfig(keys));
  ASSERT_TRUE(daemon.serves());
  const auto begin = [&](const std::string& token, std::string_view size) {
    WebClient client(*daemon.ready().http);
    return client
        .AskRaw("POST /api/playback?name=nod.bvh HTTP/1.1\r\nHost: localhost\r\n" +
                (token.empty() ? "" : "Authorization: Bearer " + token + "\r\n") +
                "Expect: 100-continue\r\nContent-Length: " + std::string(size) + "\r\n\r\n")
        .status;
  };
  EXPECT_EQ(begin("", "1000"), 401);
  EXPECT_EQ(begin("", "1000000000"), 401);
  EXPECT_EQ(begin(ToText(keys.Token(Role::kWatch)), "1000"), 403);
  EXPECT_EQ(begin(ToText(keys.Token(Role::kOperate)), "1000000000"), 403);
  EXPECT_EQ(daemon.Count(Counter::kRefusedDirect), 2u);
  EXPECT_EQ(begin(ToText(keys.Token(Role::kDirect, "stage-*")), "1000"), 403);
  EXPECT_EQ(begin(ToText(keys.Token(Role::kDirect, "nod")), "1000"), 100);
}

}  // namespace
}  // namespace furrow::testing_net
