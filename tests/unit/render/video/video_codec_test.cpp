// SPDX-License-Identifier: Apache-2.0
// The bitstream of the module, read by a small parser of its own and by OpenH264's decoder.
#include "render/video/video_codec.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <malloc.h>
#include <wels/codec_api.h>

#include "tests/unit/render/video/bit_reader.h"

namespace furrow::render {
namespace {

enum NalType { kSlice = 1, kIdr = 5, kSequenceParameters = 7, kPictureParameters = 8 };

// A shaded ball that moves before a gradient, with some texture.
Planes Ball(int width, int height, int frame) {
  Planes planes{.width = width, .height = height};
  const auto shade = [&](int x, int y) {
    const double dx = x - width * (0.3 + 0.01 * frame);
    const double dy = y - height * 0.5;
    const double r = std::hypot(dx, dy) / (0.25 * height);
    const double texture = 4.0 * std::sin(0.7 * (x - 0.01 * frame * width)) * std::sin(0.5 * y);
    return r < 1.0 ? 200.0 - 90.0 * r * r + texture : 40.0 + 60.0 * x / width;
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      planes.y.push_back(static_cast<std::uint8_t>(std::lround(shade(x, y))));
    }
  }
  const std::size_t quarter = planes.y.size() / 4;
  planes.u.assign(quarter, 120);
  planes.v.assign(quarter, 140);
  return planes;
}

double PsnrOf(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += std::pow(static_cast<double>(a[i]) - static_cast<double>(b[i]), 2.0);
  return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(a.size()) / std::max(sum, 1.0));
}

// Decodes one picture at a time.
class Decoder {
 public:
  Decoder() {
    ISVCDecoder* made = nullptr;
    EXPECT_EQ(WelsCreateDecoder(&made), 0);
    decoder_.reset(made);
    SDecodingParam parameters{};
    parameters.eEcActiveIdc = ERROR_CON_DISABLE;
    parameters.sVideoProperty.eVideoBsType = VIDEO_BITSTREAM_AVC;
    EXPECT_EQ(decoder_->Initialize(&parameters), 0);
  }
  // The brightness of the picture that comes out; empty: none, or an error.
  std::vector<std::uint8_t> Decode(const std::vector<std::uint8_t>& bytes) {
    std::array<unsigned char*, 3> planes{};
    SBufferInfo info{};
    const auto state = decoder_->DecodeFrameNoDelay(bytes.data(), static_cast<int>(bytes.size()),
                                                    planes.data(), &info);
    if (state != dsErrorFree || info.iBufferStatus != 1) return {};
    const SSysMEMBuffer& picture = info.UsrData.sSystemBuffer;
    std::vector<std::uint8_t> luma;
    for (int y = 0; y < picture.iHeight; ++y) {
      const unsigned char* row = planes[0] + y * picture.iStride[0];
      luma.insert(luma.end(), row, row + picture.iWidth);
    }
    return luma;
  }

 private:
  struct Destroy {
    void operator()(ISVCDecoder* decoder) const {
      decoder->Uninitialize();
      WelsDestroyDecoder(decoder);
    }
  };
  std::unique_ptr<ISVCDecoder, Destroy> decoder_;
};

class VideoCodecTest : public testing::Test {
 protected:
  static constexpr int kWidth = 320;
  static constexpr int kHeight = 208;

  void SetUp() override {
    const auto codec = GetVideoCodec();
    ASSERT_TRUE(codec.ok()) << codec.status().ToString();
    codec_ = *codec;
    Make({kWidth, kHeight, 80});
  }
  void Make(const VideoFormat& format) {
    std::string why;
    encoder_ = codec_->make_encoder(format, &why);
    ASSERT_NE(encoder_, nullptr) << why;
  }
  VideoPicture Encode(int frame, const VideoTarget& target = {}) {
    VideoPicture picture;
    std::string why;
    EXPECT_EQ(encoder_->Encode(Ball(kWidth, kHeight, frame), target, &picture, &why),
              StatusCode::kOk)
        << why;
    return picture;
  }

  const VideoCodec* codec_ = nullptr;
  std::unique_ptr<VideoEncoder> encoder_;
};

TEST_F(VideoCodecTest, TheStreamIsConstrainedBaseline) {
  const VideoPicture key = Encode(0);
  EXPECT_TRUE(key.key);
  const auto units = test::SplitNalUnits(key.bytes);
  ASSERT_EQ(units.size(), 3u);
  ASSERT_EQ(units[0].type, kSequenceParameters);
  ASSERT_EQ(units[1].type, kPictureParameters);
  EXPECT_EQ(units[2].type, kIdr);

  test::BitReader sps(units[0].rbsp);  // section 7.3.2.1.1
  EXPECT_EQ(sps.Bits(8), 66u) << "profile_idc";
  EXPECT_TRUE(sps.Flag()) << "constraint_set0_flag";
  EXPECT_TRUE(sps.Flag()) << "constraint_set1_flag: constrained";
  EXPECT_EQ(sps.Bits(6) & 3u, 0u) << "reserved_zero_2bits";
  const unsigned level = sps.Bits(8);
  EXPECT_GE(level, 12u);
  EXPECT_LE(level, 31u);
  EXPECT_EQ(sps.Ue(), 0u) << "seq_parameter_set_id";
  sps.Ue();  // log2_max_frame_num_minus4
  const unsigned order = sps.Ue();
  EXPECT_TRUE(order == 0 || order == 2) << "pic_order_cnt_type";
  if (order == 0) sps.Ue();
  EXPECT_EQ(sps.Ue(), 1u) << "max_num_ref_frames";
  sps.Flag();
  EXPECT_EQ(sps.Ue() + 1, kWidth / 16u);
  EXPECT_EQ(sps.Ue() + 1, kHeight / 16u);
  EXPECT_TRUE(sps.Flag()) << "frame_mbs_only_flag";
  sps.Flag();  // direct_8x8_inference_flag
  if (sps.Flag()) {
    for (int side = 0; side < 4; ++side) EXPECT_EQ(sps.Ue(), 0u) << "no cropping";
  }
  ASSERT_TRUE(sps.Flag()) << "vui_parameters_present_flag";
  EXPECT_FALSE(sps.Flag()) << "aspect_ratio_info_present_flag";
  EXPECT_FALSE(sps.Flag()) << "overscan_info_present_flag";
  ASSERT_TRUE(sps.Flag()) << "video_signal_type_present_flag";
  sps.Bits(3);
  EXPECT_FALSE(sps.Flag()) << "video_full_range_flag";
  ASSERT_TRUE(sps.Flag()) << "colour_description_present_flag";
  EXPECT_EQ(sps.Bits(8), 1u) << "colour_primaries: BT.709";
  EXPECT_EQ(sps.Bits(8), 13u) << "transfer_characteristics: sRGB";
  EXPECT_EQ(sps.Bits(8), 6u) << "matrix_coefficients: BT.601";

  test::BitReader pps(units[1].rbsp);
  pps.Ue();
  pps.Ue();
  EXPECT_FALSE(pps.Flag()) << "entropy_coding_mode_flag: CAVLC";

  EXPECT_EQ(VideoCodecName(key.bytes), "avc1.42c0" +
                                           std::string(1, "0123456789abcdef"[level / 16]) +
                                           std::string(1, "0123456789abcdef"[level % 16]));
}

TEST_F(VideoCodecTest, OneInOneOut) {
  Decoder decoder;
  for (int frame = 0; frame < 40; ++frame) {
    const VideoPicture picture = Encode(frame, {.bits = 200'000});
    EXPECT_EQ(picture.key, frame == 0) << frame;
    for (const test::NalUnit& unit : test::SplitNalUnits(picture.bytes)) {
      if (unit.type != kSlice) continue;
      test::BitReader slice(unit.rbsp);
      EXPECT_EQ(slice.Ue(), 0u) << "one slice per picture";
      EXPECT_EQ(slice.Ue() % 5, 0u) << "P";
    }
    const auto luma = decoder.Decode(picture.bytes);
    ASSERT_EQ(luma.size(), std::size_t{kWidth} * kHeight) << frame;
    // Of this picture, not of one before it.
    EXPECT_GT(PsnrOf(luma, Ball(kWidth, kHeight, frame).y), 40.0) << frame;
  }
}

TEST_F(VideoCodecTest, AKeyPictureNeedsNoEarlierOne) {
  for (int frame = 0; frame < 5; ++frame) Encode(frame);
  const VideoPicture delta = Encode(5);
  const VideoPicture key = Encode(6, {.key = true});
  const VideoPicture next = Encode(7);
  EXPECT_FALSE(delta.key);
  ASSERT_TRUE(key.key);
  EXPECT_FALSE(next.key) << "one is enough";
  Decoder late;
  EXPECT_TRUE(late.Decode(delta.bytes).empty());
  EXPECT_GT(PsnrOf(late.Decode(key.bytes), Ball(kWidth, kHeight, 6).y), 35.0);
  EXPECT_GT(PsnrOf(late.Decode(next.bytes), Ball(kWidth, kHeight, 7).y), 35.0);
}

TEST_F(VideoCodecTest, BitsFollowTheTarget) {
  std::mt19937 random(3);
  const auto bits_at = [&](int bits) {
    Make({kWidth, kHeight, 99});
    double sum = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
      Planes grain = Ball(kWidth, kHeight, frame % 30);  // needs more bits than it may have
      for (std::uint8_t& y : grain.y) y = static_cast<std::uint8_t>(y + random() % 32);
      VideoPicture picture;
      std::string why;
      EXPECT_EQ(encoder_->Encode(grain, {.bits = bits}, &picture, &why), StatusCode::kOk) << why;
      if (frame >= 20) sum += 8.0 * static_cast<double>(picture.bytes.size()) / 40.0;
    }
    return sum;
  };
  for (const int bits : {40'000, 80'000, 160'000}) {
    const double used = bits_at(bits);
    EXPECT_LT(used, 1.3 * bits);
    EXPECT_GT(used, 0.5 * bits);
  }
}

TEST_F(VideoCodecTest, QualityLimitsTheBits) {
  std::vector<std::size_t> sizes;
  for (const int quality : {40, 60, 80, 95}) {
    Make({kWidth, kHeight, quality});
    std::size_t bytes = 0;
    for (int frame = 0; frame < 10; ++frame) {
      bytes += Encode(frame, {.bits = 1'000'000}).bytes.size();
    }
    EXPECT_GT(bytes, sizes.empty() ? 0 : sizes.back()) << quality;
    sizes.push_back(bytes);
  }
}

TEST_F(VideoCodecTest, EncodersKeepToTheirMemory) {
  for (const auto& [width, height] : {std::pair{64, 64}, {640, 400}, {1280, 720}, {2048, 2048}}) {
    encoder_.reset();
    malloc_trim(0);
    const auto used = [] {
      const struct mallinfo2 heap = mallinfo2();
      return heap.uordblks + heap.hblkhd;
    };
    const Planes planes = Ball(width, height, 0);
    const std::size_t before = used();
    Make({width, height, 80});
    for (int frame = 0; frame < 3; ++frame) {
      VideoPicture picture;
      std::string why;
      ASSERT_EQ(encoder_->Encode(planes, {}, &picture, &why), StatusCode::kOk) << why;
    }
    EXPECT_LE(used() - before, VideoEncoderBytes(width, height)) << width << " x " << height;
  }
}

TEST_F(VideoCodecTest, AnImpossibleSizeIsAnError) {
  std::string why;
  EXPECT_EQ(codec_->make_encoder({0, 0, 80}, &why), nullptr);
  EXPECT_NE(why.find("0 x 0"), std::string::npos) << why;
}

TEST(VideoCodecName, IsEmptyWithoutAParameterSet) {
  EXPECT_EQ(VideoCodecName({}), "");
  EXPECT_EQ(VideoCodecName({0, 0, 0, 1, 0x65, 1, 2, 3}), "");
  const std::vector<std::uint8_t> whole = {0, 0, 0, 1, 0x67, 0x42, 0xC0, 0x1F};
  EXPECT_EQ(VideoCodecName(whole), "avc1.42c01f");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(VideoCodecName(std::vector<std::uint8_t>(
                  whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))),
              "")
        << size;
  }
}

}  // namespace
}  // namespace furrow::render
