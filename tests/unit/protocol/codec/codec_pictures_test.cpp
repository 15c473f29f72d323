// SPDX-License-Identifier: Apache-2.0
// What viewers add to pictures: settings, acknowledgements, another view (STANDARD.md 8 and 9).
#include <gtest/gtest.h>

#include "protocol/codec/codec.h"
#include "tests/unit/protocol/samples.h"

namespace furrow::protocol {
namespace {

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

TEST(CodecPictures, AViewersRequestComesBack) {
  SubscribePictures out;
  ASSERT_EQ(OpenAndDecode(Encoded(ViewersPictures()), out), DecodeStatus::kOk);
  EXPECT_TRUE(out.acknowledged);
  EXPECT_TRUE(out.camera_follows);
  EXPECT_EQ(out.settings, ViewersPictures().settings);
  // Into the same object: nothing of the last one stays.
  ASSERT_EQ(OpenAndDecode(Encoded(SubscribePictures{}), out), DecodeStatus::kOk);
  EXPECT_FALSE(out.acknowledged);
  EXPECT_FALSE(out.camera_follows);
  EXPECT_TRUE(out.settings.empty());
}

TEST(CodecPictures, SettingsAreBounded) {
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

TEST(CodecPictures, AnUpdateIsCheckedLikeTheRequest) {
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

TEST(CodecPictures, AcknowledgementsCountFromOne) {
  FrameAck out;
  ASSERT_EQ(OpenAndDecode(Encoded(FrameAck{0xFFFFFFFFu}), out), DecodeStatus::kOk);
  EXPECT_EQ(out.number, 0xFFFFFFFFu);
  EXPECT_EQ(OpenAndDecode(Encoded(FrameAck{0}), out), DecodeStatus::kBadValue);
}

TEST(CodecPictures, APictureSaysHowItCame) {
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

}  // namespace
}  // namespace furrow::protocol
