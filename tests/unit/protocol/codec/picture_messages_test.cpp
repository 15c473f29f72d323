// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "protocol/codec/codec.h"
#include "tests/unit/protocol/samples.h"

namespace furrow::protocol {
namespace {

using test::DecodeChanged;
using test::Encoded;
using test::OpenAndDecode;

SubscribePictures ViewersPictures() {
  SubscribePictures pictures;
  pictures.width = 320;
  pictures.acknowledged = true;
  pictures.settings = {"shading=skin", "wrinkles=off"};
  pictures.has_camera = true;
  pictures.camera_follows = true;
  return pictures;
}

// Encodes a default picture request after `change`, and decodes it.
TEST(PictureMessages, RequestRoundTrip) {
  SubscribePictures sent;
  sent.subject = "anna";
  sent.width = 1920;
  sent.height = 16;
  sent.quality = 100;
  sent.format = ImageFormat::kPng;
  sent.view = "normal";
  sent.has_camera = true;
  sent.camera = {{1, 2, 3}, {4, 5, 6}, 45};
  SubscribePictures out;
  ASSERT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  EXPECT_EQ(out.width, 1920);
  EXPECT_EQ(out.height, 16);
  EXPECT_EQ(out.quality, 100);
  EXPECT_EQ(out.format, ImageFormat::kPng);
  EXPECT_EQ(out.view, "normal");
  ASSERT_TRUE(out.has_camera);
  EXPECT_EQ(out.camera.eye, sent.camera.eye);
  EXPECT_EQ(out.camera.target, sent.camera.target);
  EXPECT_EQ(out.camera.vertical_fov_degrees, 45.0f);
  sent.has_camera = false;
  sent.camera_preset = "face";
  ASSERT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  EXPECT_FALSE(out.has_camera);
  EXPECT_EQ(out.camera_preset, "face");
}

TEST(PictureMessages, RejectsBadRequest) {
  using S = SubscribePictures;
  const auto with = [](const auto& change) { return DecodeChanged(S(), change); };
  const auto with_camera = [](const auto& change) {
    return DecodeChanged(S(), [&change](S& s) {
      s.has_camera = true;
      change(s);
    });
  };
  EXPECT_EQ(with([](S& s) { s.width = 15; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.height = 4097; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.quality = 0; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.quality = 101; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with([](S& s) { s.format = static_cast<ImageFormat>(9); }), DecodeStatus::kBadValue);
  EXPECT_EQ(with_camera([](S&) {}), DecodeStatus::kOk);
  EXPECT_EQ(with_camera([](S& s) { s.camera_preset = "face"; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with_camera([](S& s) { s.camera.eye = s.camera.target; }), DecodeStatus::kBadValue);
  EXPECT_EQ(with_camera([](S& s) { s.camera.eye.x = NAN; }), DecodeStatus::kNonFinite);
  EXPECT_EQ(with_camera([](S& s) { s.camera.vertical_fov_degrees = 170; }),
            DecodeStatus::kBadValue);
}

TEST(PictureMessages, ViewerRequestRoundTrip) {
  SubscribePictures out;
  ASSERT_EQ(OpenAndDecode(Encoded(ViewersPictures()), out), DecodeStatus::kOk);
  EXPECT_TRUE(out.acknowledged);
  EXPECT_TRUE(out.camera_follows);
  EXPECT_EQ(out.settings, ViewersPictures().settings);
  // Decoding into the same object keeps nothing of the previous message.
  ASSERT_EQ(OpenAndDecode(Encoded(SubscribePictures{}), out), DecodeStatus::kOk);
  EXPECT_FALSE(out.acknowledged);
  EXPECT_FALSE(out.camera_follows);
  EXPECT_TRUE(out.settings.empty());
}

TEST(PictureMessages, BoundsSettings) {
  SubscribePictures sent;
  SubscribePictures out;
  sent.settings.assign(kMaxPictureSettings, "a=b");
  EXPECT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  sent.settings.emplace_back("a=b");
  EXPECT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kLimit);
  sent.settings = {std::string(kMaxNameBytes + 1, 'a')};
  EXPECT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kLimit);
  sent.settings = {""};
  EXPECT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kMissingField);
  sent.settings = {"a=\x01"};
  EXPECT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kBadText);
}

TEST(PictureMessages, ChecksUpdateLikeRequest) {
  UpdatePictures out;
  ASSERT_EQ(OpenAndDecode(Encoded(UpdatePictures{ViewersPictures()}), out), DecodeStatus::kOk);
  EXPECT_EQ(out.pictures.width, 320);
  EXPECT_EQ(out.pictures.settings, ViewersPictures().settings);
  UpdatePictures bad{ViewersPictures()};
  bad.pictures.height = kMinImageSize - 1;
  EXPECT_EQ(OpenAndDecode(Encoded(bad), out), DecodeStatus::kBadValue);
  bad = UpdatePictures{ViewersPictures()};
  bad.pictures.camera_preset = "face";
  EXPECT_EQ(OpenAndDecode(Encoded(bad), out), DecodeStatus::kBadValue);
  SubscribePictures other;
  EXPECT_EQ(OpenAndDecode(Encoded(UpdatePictures{ViewersPictures()}), other),
            DecodeStatus::kWrongKind);
}

TEST(PictureMessages, AcknowledgementsCountFromOne) {
  FrameAck out;
  ASSERT_EQ(OpenAndDecode(Encoded(FrameAck{0xFFFFFFFFu}), out), DecodeStatus::kOk);
  EXPECT_EQ(out.number, 0xFFFFFFFFu);
  EXPECT_EQ(OpenAndDecode(Encoded(FrameAck{0}), out), DecodeStatus::kBadValue);
}

TEST(PictureMessages, ImageStatesItsDelivery) {
  const ImageFrame sent{64, 48, ImageFormat::kJpeg, 5, {1, 2, 3}, 9, 2, true, 4, -7, 21};
  ImageFrame out;
  ASSERT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  EXPECT_EQ(out.number, 9u);
  EXPECT_EQ(out.tier, 2);
  EXPECT_TRUE(out.still);
  EXPECT_EQ(out.dropped, 4u);
  EXPECT_EQ(out.received_us, -7);
  EXPECT_EQ(out.view_request, 21u);
  ImageFrame bad = sent;
  bad.tier = kNumPictureTiers;
  EXPECT_EQ(OpenAndDecode(Encoded(bad), out), DecodeStatus::kBadValue);
}

TEST(PictureMessages, CodecsAreListed) {
  SubscribePictures sent;
  sent.codecs = {std::string(kH264), "av1"};
  SubscribePictures out;
  ASSERT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  EXPECT_EQ(out.codecs, sent.codecs);
  ASSERT_EQ(OpenAndDecode(Encoded(SubscribePictures{}), out), DecodeStatus::kOk);
  EXPECT_TRUE(out.codecs.empty());
  sent.codecs.assign(kMaxPictureCodecs, "a");
  EXPECT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  sent.codecs.emplace_back("a");
  EXPECT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kLimit);
  sent.codecs = {std::string(kMaxCodecBytes + 1, 'a')};
  EXPECT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kLimit);
  sent.codecs = {""};
  EXPECT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kMissingField);
  sent.codecs = {"h264\n"};
  EXPECT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kBadText);
}

TEST(PictureMessages, ImagesOfAVideo) {
  ImageFrame sent{64, 48, ImageFormat::kJpeg, 0, {0, 0, 1, 0x65}, 9};
  sent.codec = "avc1.42c01e";
  sent.key = true;
  ImageFrame out;
  ASSERT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  EXPECT_EQ(out.codec, "avc1.42c01e");
  EXPECT_TRUE(out.key);
  sent.key = false;
  ASSERT_EQ(OpenAndDecode(Encoded(sent), out), DecodeStatus::kOk);
  EXPECT_FALSE(out.key);
  ImageFrame bad = sent;
  bad.still = true;
  EXPECT_EQ(OpenAndDecode(Encoded(bad), out), DecodeStatus::kBadValue);
  for (const std::uint8_t percent : {0, 101}) {
    bad = sent;
    bad.drawn_percent = percent;
    EXPECT_EQ(OpenAndDecode(Encoded(bad), out), DecodeStatus::kBadValue);
  }
  bad = sent;
  bad.codec.clear();
  bad.key = true;
  EXPECT_EQ(OpenAndDecode(Encoded(bad), out), DecodeStatus::kBadValue);
  bad.codec = std::string(kMaxCodecBytes + 1, 'a');
  EXPECT_EQ(OpenAndDecode(Encoded(bad), out), DecodeStatus::kLimit);
  bad.codec = "avc1\x01";
  EXPECT_EQ(OpenAndDecode(Encoded(bad), out), DecodeStatus::kBadText);
}

TEST(PictureMessages, AcknowledgementsTellTimeAndNeeds) {
  FrameAck out;
  ASSERT_EQ(OpenAndDecode(Encoded(FrameAck{3, true, 0xFFFFFFFFu}), out), DecodeStatus::kOk);
  EXPECT_TRUE(out.needs_key);
  EXPECT_EQ(out.held_us, 0xFFFFFFFFu);
  ASSERT_EQ(OpenAndDecode(Encoded(FrameAck{4}), out), DecodeStatus::kOk);
  EXPECT_FALSE(out.needs_key);
  EXPECT_EQ(out.held_us, 0u);
}

// Truncated and flipped bytes: every message decodes or is refused, and what decodes keeps the
// rules.
TEST(PictureMessages, HostileVideoMessages) {
  ImageFrame image{64, 48, ImageFormat::kJpeg, 0, {0, 0, 1, 0x65}, 9};
  image.codec = "avc1.42c01e";
  image.key = true;
  SubscribePictures request = ViewersPictures();
  request.codecs = {std::string(kH264)};
  const auto check = [](const std::vector<std::uint8_t>& bytes) {
    MessageView view;
    if (OpenMessage(bytes, view, kMaxReplyBytes) != DecodeStatus::kOk) return;
    ImageFrame out;
    if (Decode(view, out) == DecodeStatus::kOk) {
      EXPECT_LE(out.codec.size(), std::size_t{kMaxCodecBytes});
      EXPECT_FALSE(out.codec.empty() && out.key);
      EXPECT_FALSE(!out.codec.empty() && out.still);
    }
    SubscribePictures wish;
    if (Decode(view, wish) == DecodeStatus::kOk) {
      EXPECT_LE(wish.codecs.size(), std::size_t{kMaxPictureCodecs});
    }
    FrameAck ack;
    if (Decode(view, ack) == DecodeStatus::kOk) {
      EXPECT_GT(ack.number, 0u);
    }
  };
  for (const auto& whole : {Encoded(image), Encoded(request), Encoded(FrameAck{12, true, 4200})}) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      check(std::vector<std::uint8_t>(whole.begin(),
                                      whole.begin() + static_cast<std::ptrdiff_t>(size)));
    }
    for (std::size_t at = 0; at < whole.size(); ++at) {
      for (const std::uint8_t flip : {0x01, 0x80, 0xFF}) {
        auto bytes = whole;
        bytes[at] ^= flip;
        check(bytes);
      }
    }
  }
}

TEST(PictureMessages, ImageRoundTripAndChecks) {
  const ImageFrame sent{1280, 720, ImageFormat::kPng, 5, std::vector<std::uint8_t>(300'000, 7)};
  ImageFrame out;
  MessageView view;
  const auto bytes = Encoded(sent);
  ASSERT_EQ(OpenMessage(bytes, view, kMaxReplyBytes), DecodeStatus::kOk);
  ASSERT_EQ(Decode(view, out), DecodeStatus::kOk);
  EXPECT_EQ(out.width, 1280);
  EXPECT_EQ(out.height, 720);
  EXPECT_EQ(out.format, ImageFormat::kPng);
  EXPECT_EQ(out.age_us, 5);
  EXPECT_EQ(out.bytes, sent.bytes);
  EXPECT_EQ(OpenAndDecode(Encoded(ImageFrame{4, 4, ImageFormat::kPng, 0, {}}), out),
            DecodeStatus::kMissingField);
  EXPECT_EQ(OpenAndDecode(Encoded(ImageFrame{0, 4, ImageFormat::kPng, 0, {1}}), out),
            DecodeStatus::kBadValue);
  EXPECT_EQ(OpenAndDecode(Encoded(ImageFrame{4, 4097, ImageFormat::kPng, 0, {1}}), out),
            DecodeStatus::kBadValue);
  EXPECT_EQ(OpenAndDecode(Encoded(ImageFrame{4, 4, static_cast<ImageFormat>(2), 0, {1}}), out),
            DecodeStatus::kBadValue);
}

}  // namespace
}  // namespace furrow::protocol
