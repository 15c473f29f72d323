// SPDX-License-Identifier: Apache-2.0
// The module lib/furrow/furrow-video.so: H.264 by OpenH264 (video_codec.h).
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <string>

#include <wels/codec_api.h>

#include "render/video/video_codec.h"

namespace furrow::render {
namespace {

// The rate control of OpenH264 thinks in bits per second, and we in bits per picture.
constexpr float kNominalHz = 30.0f;
constexpr int kMaxQp = 51;
constexpr int kLeastQp = 12;  // of OpenH264's rate control
// Changes below this share are not worth starting the rate control again.
constexpr double kRateStep = 0.04;

// The quantiser whose error is about that of JPEG at `quality`. JPEG's tables are proportional to
// the scale of libjpeg; the quantiser doubles its step every 6.
int QpOf(int quality) {
  const double q = std::clamp(quality, 1, 99);
  const double scale = q < 50 ? 5000.0 / q : 200.0 - 2.0 * q;
  return std::clamp(static_cast<int>(std::lround(22.6 + 4.8 * std::log2(scale / 40.0))), kLeastQp,
                    kMaxQp);
}

struct Destroy {
  void operator()(ISVCEncoder* encoder) const {
    encoder->Uninitialize();
    WelsDestroySVCEncoder(encoder);
  }
};
using Encoder = std::unique_ptr<ISVCEncoder, Destroy>;

void SetColours(SSpatialLayerConfig* layer) {
  layer->bVideoSignalTypePresent = true;
  layer->uiVideoFormat = VF_UNDEF;
  layer->bFullRange = false;
  layer->bColorDescriptionPresent = true;
  layer->uiColorPrimaries = CP_BT709;
  layer->uiTransferCharacteristics = TRC_IEC61966_2_1;  // sRGB
  layer->uiColorMatrix = CM_SMPTE170M;                  // BT.601
}

SEncParamExt ParametersOf(ISVCEncoder* encoder, const VideoFormat& format, int bits_per_second) {
  SEncParamExt parameters;
  encoder->GetDefaultParams(&parameters);
  parameters.iUsageType = CAMERA_VIDEO_REAL_TIME;
  parameters.iPicWidth = format.width;
  parameters.iPicHeight = format.height;
  parameters.iTargetBitrate = bits_per_second;
  parameters.iMaxBitrate = UNSPECIFIED_BIT_RATE;
  parameters.iRCMode = RC_BITRATE_MODE;
  parameters.fMaxFrameRate = kNominalHz;
  parameters.iComplexityMode = LOW_COMPLEXITY;
  parameters.uiIntraPeriod = 0;  // key pictures on demand only
  parameters.iNumRefFrame = 1;
  parameters.eSpsPpsIdStrategy = CONSTANT_ID;
  parameters.bEnableFrameSkip = false;  // one in, one out
  parameters.iMinQp = QpOf(format.quality);
  parameters.iMaxQp = kMaxQp;
  parameters.iMultipleThreadIdc = 1;
  // A new camera makes a large picture, but the decoder needs no key picture for it.
  parameters.bEnableSceneChangeDetect = false;
  // It leaves the background as the first picture shows it, which costs quality rather than bits.
  parameters.bEnableBackgroundDetection = false;
  SSpatialLayerConfig& layer = parameters.sSpatialLayers[0];
  layer.iVideoWidth = format.width;
  layer.iVideoHeight = format.height;
  layer.fFrameRate = kNominalHz;
  layer.iSpatialBitrate = bits_per_second;
  layer.iMaxSpatialBitrate = UNSPECIFIED_BIT_RATE;
  layer.uiProfileIdc = PRO_BASELINE;
  layer.sSliceArgument.uiSliceMode = SM_SINGLE_SLICE;
  SetColours(&layer);
  return parameters;
}

class OpenH264Encoder : public VideoEncoder {
 public:
  OpenH264Encoder(Encoder encoder, int bits_per_second)
      : encoder_(std::move(encoder)), bits_per_second_(bits_per_second) {}

  StatusCode Encode(const Planes& planes, const VideoTarget& target, VideoPicture* picture,
                    std::string* why) override {
    picture->bytes.clear();
    SetRate(target.bits);
    if (target.key) encoder_->ForceIntraFrame(true);
    SSourcePicture source{};
    source.iColorFormat = videoFormatI420;
    source.iPicWidth = planes.width;
    source.iPicHeight = planes.height;
    const std::vector<std::uint8_t>* all[] = {&planes.y, &planes.u, &planes.v};
    for (int i = 0; i < 3; ++i) {
      source.iStride[i] = i == 0 ? planes.width : planes.width / 2;
      source.pData[i] = const_cast<std::uint8_t*>(all[i]->data());  // it only reads them
    }
    source.uiTimeStamp = num_pictures_++ * 1000 / static_cast<int>(kNominalHz);
    SFrameBSInfo info{};
    const int failed = encoder_->EncodeFrame(&source, &info);
    if (failed != cmResultSuccess || info.eFrameType == videoFrameTypeInvalid ||
        info.eFrameType == videoFrameTypeSkip) {
      *why = "OpenH264 did not encode a picture: error " + std::to_string(failed);
      return StatusCode::kInternal;
    }
    picture->key = info.eFrameType == videoFrameTypeIDR;
    for (int i = 0; i < info.iLayerNum; ++i) {
      const SLayerBSInfo& layer = info.sLayerInfo[i];
      int bytes = 0;
      for (int n = 0; n < layer.iNalCount; ++n) bytes += layer.pNalLengthInByte[n];
      picture->bytes.insert(picture->bytes.end(), layer.pBsBuf, layer.pBsBuf + bytes);
    }
    return StatusCode::kOk;
  }

 private:
  void SetRate(int bits) {
    const int wanted = static_cast<int>(kNominalHz) * std::clamp(bits, 1000, 10'000'000);
    if (std::abs(wanted - bits_per_second_) < kRateStep * bits_per_second_) return;
    SBitrateInfo rate{SPATIAL_LAYER_ALL, wanted};
    if (encoder_->SetOption(ENCODER_OPTION_BITRATE, &rate) == cmResultSuccess) {
      bits_per_second_ = wanted;
    }
  }

  Encoder encoder_;
  int bits_per_second_;
  long long num_pictures_ = 0;
};

std::unique_ptr<VideoEncoder> MakeEncoder(const VideoFormat& format, std::string* why) {
  ISVCEncoder* made = nullptr;
  if (WelsCreateSVCEncoder(&made) != 0 || made == nullptr) {
    *why = "OpenH264 cannot make an encoder";
    return nullptr;
  }
  Encoder encoder(made);
  int quiet = WELS_LOG_QUIET;  // it writes to the standard error of the daemon otherwise
  encoder->SetOption(ENCODER_OPTION_TRACE_LEVEL, &quiet);
  const int bits_per_second = static_cast<int>(kNominalHz) * VideoTarget().bits;
  SEncParamExt parameters = ParametersOf(encoder.get(), format, bits_per_second);
  if (const int failed = encoder->InitializeExt(&parameters); failed != cmResultSuccess) {
    *why = "OpenH264 cannot encode " + std::to_string(format.width) + " x " +
           std::to_string(format.height) + " pixels: error " + std::to_string(failed);
    return nullptr;
  }
  return std::make_unique<OpenH264Encoder>(std::move(encoder), bits_per_second);
}

std::string LibraryName() {
  const OpenH264Version version = WelsGetCodecVersion();
  return "OpenH264 " + std::to_string(version.uMajor) + "." + std::to_string(version.uMinor) + "." +
         std::to_string(version.uRevision);
}

}  // namespace
}  // namespace furrow::render

extern "C" __attribute__((visibility("default"))) const furrow::render::VideoCodec*
FurrowVideoCodec() {
  static const furrow::render::VideoCodec codec{furrow::render::LibraryName(),
                                                &furrow::render::MakeEncoder};
  return &codec;
}
