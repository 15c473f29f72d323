// SPDX-License-Identifier: Apache-2.0
// Pictures over the web server: WebSocket with flow control, and plain HTTP.
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pictures_fixture.h"
#include "web_client.h"

namespace furrow::testing_net {
namespace {

class WebPictures : public PicturesTest {
 protected:
  static protocol::SubscribePictures Wish() {
    return {.subject = "ann",
            .width = 64,
            .height = 64,
            .acknowledged = true,
            .settings = {"shading=diffuse"}};
  }
  std::uint16_t port() const { return *daemon->ready().http; }
  // A viewer of Wish(); its subscription's number.
  std::uint16_t View(WebClient& viewer) {
    EXPECT_EQ(viewer.Upgrade().status, 101);
    viewer.Send(Wish(), 0, 1);
    protocol::Header header;
    EXPECT_TRUE(viewer.Take<protocol::SubscribeReply>(&header).has_value());
    return header.stream;
  }
  // Waits for the still of a pose at rest and acknowledges everything before it.
  std::optional<protocol::ImageFrame> AwaitStill(WebClient& viewer, std::uint16_t stream) {
    auto image = viewer.Await<protocol::ImageFrame>();
    while (image && !image->still) {
      viewer.Send(protocol::FrameAck{image->number}, stream);
      image = viewer.Await<protocol::ImageFrame>();
    }
    if (image) viewer.Send(protocol::FrameAck{image->number}, stream);
    return image;
  }
  // Reads the head of the next multipart part and returns its length.
  static std::size_t PartLength(WebClient& client) {
    client.ReadUntil("--furrow-picture\r\nContent-Type: image/jpeg\r\nContent-Length: ");
    const std::string length = client.ReadUntil("\r\n\r\n");
    std::size_t value = 0;
    std::from_chars(length.data(), length.data() + length.size(), value);
    return value;
  }
};

TEST_F(WebPictures, AStalledViewerReceivesTheNewestPicture) {
  WebClient viewer(port());
  const std::uint16_t stream = View(viewer);
  SendPose(0);
  auto image = viewer.Await<protocol::ImageFrame>();
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->number, 1u);
  EXPECT_EQ(image->view_request, 1u);
  SendPose(1);
  image = viewer.Await<protocol::ImageFrame>();  // of this pose, or the still of the previous one
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->number, 2u);
  for (int frame = 2; frame < 10; ++frame) SendPose(frame);
  sender->Send(protocol::Ping{1});
  ASSERT_TRUE(sender->Await<protocol::Pong>().has_value());
  viewer.Send(protocol::Ping{2});
  ASSERT_TRUE(viewer.Take<protocol::Pong>().has_value()) << "a third picture is under way";
  viewer.Send(protocol::FrameAck{2}, stream);
  protocol::Header header;
  image = viewer.Take<protocol::ImageFrame>(&header);
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->number, 3u);
  EXPECT_EQ(header.sequence, 9u);
  EXPECT_GE(image->dropped, 8u);
  EXPECT_GT(image->received_us, 0);
}

TEST_F(WebPictures, APoseAtRestGetsExactlyOneStill) {
  WebClient viewer(port());
  const std::uint16_t stream = View(viewer);
  SendPose(3);
  ASSERT_TRUE(AwaitStill(viewer, stream).has_value());
  sender->Send(PoseOf(clip, 3, offer), 1, 4, 4000);  // a new pose without movement
  sender->Send(protocol::Ping{1});
  ASSERT_TRUE(sender->Await<protocol::Pong>().has_value());
  viewer.Send(protocol::Ping{2});
  EXPECT_TRUE(viewer.Take<protocol::Pong>().has_value());
}

TEST_F(WebPictures, AChangedViewIsShownWithoutANewPose) {
  WebClient viewer(port());
  const std::uint16_t stream = View(viewer);
  SendPose(0);
  ASSERT_TRUE(AwaitStill(viewer, stream).has_value());
  protocol::UpdatePictures update{Wish()};
  update.pictures.width = 96;
  viewer.Send(update, stream, 9);
  auto image = viewer.Await<protocol::ImageFrame>();
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->view_request, 9u);
  EXPECT_EQ(image->width, 96);
  update.pictures.width = 32;
  update.pictures.settings = {"subsurface.width=99"};
  viewer.Send(update, stream, 10);
  protocol::Header header;
  const auto error = viewer.Await<protocol::ErrorMessage>(&header);
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(header.sequence, 10u);
  EXPECT_NE(error->message.find("subsurface.width"), std::string::npos) << error->message;
  viewer.Send(protocol::FrameAck{image->number}, stream);
  SendPose(1);
  image = viewer.Await<protocol::ImageFrame>();
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->view_request, 9u);
  EXPECT_EQ(image->width, 96);
}

TEST_F(WebPictures, TheDaemonsSettingsApplyToViewsWithoutOverrides) {
  WebClient viewer(port());
  const std::uint16_t stream = View(viewer);
  SendPose(0);
  const auto before = AwaitStill(viewer, stream);
  ASSERT_TRUE(before.has_value());
  EXPECT_EQ(WebClient(port()).Ask("PATCH", "/api/settings", R"({"exposure":2})").status, 200);
  const auto after = AwaitStill(viewer, stream);
  ASSERT_TRUE(after.has_value());
  EXPECT_NE(before->bytes, after->bytes);
}

TEST_F(WebPictures, MjpegFollowsThePoses) {
  SendPose(0);
  WebClient client(port());
  const auto answer = client.Ask("GET", "/mjpeg?subject=ann&width=64&height=64&shading=diffuse");
  ASSERT_EQ(answer.status, 200);
  EXPECT_NE(answer.head.find("multipart/x-mixed-replace; boundary=furrow-picture"),
            std::string::npos);
  std::string before;
  for (int frame = 10; frame < 12; ++frame) {
    std::string picture = client.Take(PartLength(client));
    // A still comes twice, and on a busy machine the pose may rest for long enough to get one.
    while (!picture.empty() && picture == before) picture = client.Take(PartLength(client));
    EXPECT_EQ(picture.substr(0, 2), "\xFF\xD8");
    before = picture;
    SendPose(frame);
  }
}

// Browsers show a part when the next one begins, so the still comes twice.
TEST_F(WebPictures, MjpegEndsWithTheStillOfAPoseAtRest) {
  SendPose(3);
  // The first picture of a pose evaluates its wrinkles per pixel. Later ones paint them, which
  // differs in a few values.
  WebClient first(port());
  ASSERT_EQ(first.Ask("GET", "/snapshot.png?subject=ann&width=64&height=64&shading=diffuse").status,
            200);
  WebClient viewer(port());
  const std::uint16_t stream = View(viewer);
  const auto still = AwaitStill(viewer, stream);
  ASSERT_TRUE(still.has_value());
  WebClient client(port());
  const auto answer = client.Ask("GET", "/mjpeg?subject=ann&width=64&height=64&shading=diffuse");
  ASSERT_EQ(answer.status, 200);
  const std::string expected(still->bytes.begin(), still->bytes.end());
  std::string picture = client.Take(PartLength(client));
  while (!picture.empty() && picture != expected) picture = client.Take(PartLength(client));
  ASSERT_EQ(picture, expected);
  EXPECT_EQ(client.Take(PartLength(client)), expected);
}

TEST_F(WebPictures, MjpegWaitsForASubjectThatHasLeft) {
  SendPose(0);
  WebClient client(port());
  ASSERT_EQ(client.Ask("GET", "/mjpeg?width=64&height=64&shading=diffuse").status, 200);
  EXPECT_FALSE(client.Take(PartLength(client)).empty());
  TcpClient watcher(daemon->ready().tcp);
  ASSERT_TRUE(Watch(watcher, {.subject = "ann"}).has_value());
  sender->Send(protocol::Goodbye{}, 1);
  ASSERT_TRUE(watcher.Await<protocol::Goodbye>().has_value());  // the subject has decayed and left
  Offer(*sender, offer);
  for (int frame = 10; frame < 16; ++frame) {  // more than were unacknowledged when it left
    SendPose(frame);
    ASSERT_FALSE(client.Take(PartLength(client)).empty()) << frame;
  }
}

TEST_F(WebPictures, ASnapshotShowsTheCurrentPose) {
  SendPose(5);
  sender->Send(protocol::Ping{1});
  ASSERT_TRUE(sender->Await<protocol::Pong>().has_value());
  WebClient client(port());
  const auto picture =
      client.Ask("GET", "/snapshot.png?subject=ann&width=64&height=32&shading=diffuse");
  ASSERT_EQ(picture.status, 200) << picture.body;
  ASSERT_GT(picture.body.size(), 24u);
  EXPECT_EQ(picture.body.substr(0, 4), "\x89PNG");
  EXPECT_EQ(picture.body[19], 64);
  EXPECT_EQ(picture.body[23], 32);
  EXPECT_EQ(client.Ask("GET", "/snapshot.png?subject=nobody").status, 404);
  EXPECT_EQ(client.Ask("GET", "/snapshot.png?width=1").status, 400);
  const auto wrong = client.Ask("GET", "/snapshot.png?shading=nonsense");
  EXPECT_EQ(wrong.status, 400);
  EXPECT_EQ(nlohmann::json::parse(wrong.body)["error"]["field"], "shading");
  const auto cameras = nlohmann::json::parse(client.Ask("GET", "/api/cameras").body);
  EXPECT_EQ(cameras["cameras"][0]["name"], "face");
}

TEST_F(WebPictures, HeadAnswersAsGetWithoutDrawing) {
  SendPose(5);
  sender->Send(protocol::Ping{1});
  ASSERT_TRUE(sender->Await<protocol::Pong>().has_value());
  WebClient client(port());
  const auto picture = client.Ask("HEAD", "/snapshot.png?subject=ann&width=64");
  EXPECT_EQ(picture.status, 200);
  EXPECT_NE(picture.head.find("Content-Type: image/png"), std::string::npos);
  EXPECT_EQ(picture.head.find("Content-Length"), std::string::npos);
  EXPECT_EQ(client.Ask("HEAD", "/snapshot.png?subject=nobody").status, 404);
  EXPECT_EQ(client.Ask("HEAD", "/snapshot.png?shading=nonsense").status, 400);
  const auto stream = client.Ask("HEAD", "/mjpeg?subject=nobody");
  EXPECT_EQ(stream.status, 200) << "a stream waits for its subject";
  EXPECT_NE(stream.head.find("Content-Type: multipart/x-mixed-replace"), std::string::npos);
  EXPECT_EQ(daemon->Count(server::Counter::kSubscriptionsAccepted), 0u);
}

constexpr std::string_view kSnapshot =
    "GET /snapshot.png?subject=ann&width=64&height=32&shading=diffuse HTTP/1.1\r\n"
    "Host: localhost\r\n\r\n";

// Its place and its picture are free at once, not after the time that a picture may take.
TEST_F(WebPictures, NobodyDrawsASnapshotForAClientThatHasLeft) {
  WebClient client(port());
  const std::string probe = "GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n";
  ASSERT_EQ(client.AskRaw(probe + std::string(kSnapshot)).status, 200);
  client.EndSending();
  // Without a pose there is no picture. A client that stays would be told so by a reply.
  EXPECT_EQ(client.ReadUntil("\r\n\r\n"), "");
}

TEST_F(WebPictures, AClientMaySendItsNextRequestBeforeTheSnapshot) {
  WebClient client(port());
  SendPose(5);
  sender->Send(protocol::Ping{1});
  ASSERT_TRUE(sender->Await<protocol::Pong>().has_value());
  const WebClient::Answer first = client.AskRaw(std::string(kSnapshot) + std::string(kSnapshot));
  EXPECT_EQ(first.status, 200) << first.body;
  EXPECT_EQ(client.AskRaw(kSnapshot).status, 200);
  EXPECT_EQ(client.AskRaw("").status, 200);
}

}  // namespace
}  // namespace furrow::testing_net
