// SPDX-License-Identifier: Apache-2.0
#include "bench/video/measure_video.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <turbojpeg.h>
#include <wels/codec_api.h>

#include "bench/report/interleave.h"
#include "render/request/image_codec.h"
#include "render/video/planes.h"
#include "render/video/video_codec.h"

namespace furrow::bench {
namespace {

constexpr double kHz = 30.0;
constexpr int kUnlimited = 10'000'000;  // bits per picture

// The brightness of a picture, and how far other versions of it are away.
class Reference {
 public:
  explicit Reference(const std::vector<render::Image>& images) {
    for (const render::Image& image : images) {
      render::Planes planes;
      if (render::ToPlanes(image, &planes).ok()) luma_.push_back(std::move(planes.y));
    }
  }
  void Compare(std::size_t picture, const std::uint8_t* luma, int stride, int width, int height) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const double error = static_cast<double>(luma[y * stride + x]) -
                             luma_[picture][static_cast<std::size_t>(y * width + x)];
        squares_ += error * error;
      }
    }
    pixels_ += static_cast<double>(width) * height;
  }
  [[nodiscard]] double psnr_db() const {
    return 10.0 * std::log10(255.0 * 255.0 * pixels_ / std::max(squares_, 1e-9));
  }

 private:
  std::vector<std::vector<std::uint8_t>> luma_;
  double squares_ = 0.0;
  double pixels_ = 0.0;
};

Encoded Summary(const std::vector<std::size_t>& bytes, double psnr_db, double cpu_s) {
  const auto rate = [&bytes](std::size_t first) {
    double sum = 0.0;
    for (std::size_t i = first; i < bytes.size(); ++i) sum += 8.0 * static_cast<double>(bytes[i]);
    return sum / static_cast<double>(bytes.size() - first) * kHz / 1e6;
  };
  return {.mbit_s = rate(0),
          .later_mbit_s = rate(std::min<std::size_t>(bytes.size() - 1, 30)),
          .psnr_db = psnr_db,
          .cpu_ms = 1e3 * cpu_s / static_cast<double>(bytes.size())};
}

Status CompareJpeg(const std::vector<std::uint8_t>& bytes, std::size_t picture, Reference* with) {
  struct Close {
    void operator()(void* handle) const { tjDestroy(handle); }
  };
  const std::unique_ptr<void, Close> decoder(tjInitDecompress());
  int width = 0, height = 0, subsampling = 0, colours = 0;
  if (tjDecompressHeader3(decoder.get(), bytes.data(), bytes.size(), &width, &height, &subsampling,
                          &colours) != 0) {
    return {StatusCode::kInternal, tjGetErrorStr2(decoder.get())};
  }
  std::vector<std::uint8_t> grey(static_cast<std::size_t>(width) *
                                 static_cast<std::size_t>(height));
  // The brightness of a JPEG is stored as such, so this converts nothing.
  if (tjDecompress2(decoder.get(), bytes.data(), bytes.size(), grey.data(), width, 0, height,
                    TJPF_GRAY, TJFLAG_ACCURATEDCT) != 0) {
    return {StatusCode::kInternal, tjGetErrorStr2(decoder.get())};
  }
  with->Compare(picture, grey.data(), width, width, height);
  return {};
}

struct Destroy {
  void operator()(ISVCDecoder* decoder) const {
    decoder->Uninitialize();
    WelsDestroyDecoder(decoder);
  }
};

Result<std::unique_ptr<ISVCDecoder, Destroy>> MakeDecoder() {
  ISVCDecoder* made = nullptr;
  if (WelsCreateDecoder(&made) != 0) return Status(StatusCode::kInternal, "no decoder");
  std::unique_ptr<ISVCDecoder, Destroy> decoder(made);
  SDecodingParam parameters{};
  parameters.sVideoProperty.eVideoBsType = VIDEO_BITSTREAM_AVC;
  if (decoder->Initialize(&parameters) != 0) return Status(StatusCode::kInternal, "no decoder");
  return decoder;
}

Encoded Mix(const Encoded& a, const Encoded& b, double share) {
  const auto mix = [share](double x, double y) { return x + share * (y - x); };
  const auto mix_log = [&mix](double x, double y) {
    return std::exp(mix(std::log(x), std::log(y)));
  };
  return {.mbit_s = mix_log(a.mbit_s, b.mbit_s),
          .later_mbit_s = mix_log(a.later_mbit_s, b.later_mbit_s),
          .psnr_db = mix(a.psnr_db, b.psnr_db),
          .cpu_ms = mix(a.cpu_ms, b.cpu_ms)};
}

}  // namespace

Result<Encoded> MeasureJpeg(const std::vector<render::Image>& images, int quality) {
  Reference reference(images);
  std::vector<std::size_t> sizes;
  double cpu_s = 0.0;
  for (const render::Image& image : images) {
    Result<std::vector<std::uint8_t>> bytes = Status(StatusCode::kInternal, "not encoded");
    cpu_s +=
        Measure([&] { bytes = render::EncodeImage(image, render::ImageFormat::kJpeg, quality); }, 1)
            .cpu;
    FURROW_RETURN_IF_ERROR(bytes);
    FURROW_RETURN_IF_ERROR(CompareJpeg(*bytes, sizes.size(), &reference));
    sizes.push_back(bytes->size());
  }
  return Summary(sizes, reference.psnr_db(), cpu_s);
}

Result<Encoded> MeasureVideo(const std::vector<render::Image>& images, int quality) {
  const auto codec = render::GetVideoCodec();
  FURROW_RETURN_IF_ERROR(codec);
  const auto decoder = MakeDecoder();
  FURROW_RETURN_IF_ERROR(decoder);
  std::string why;
  const auto encoder = (*codec)->make_encoder({images[0].width, images[0].height, quality}, &why);
  if (encoder == nullptr) return Status(StatusCode::kInternal, why);
  Reference reference(images);
  std::vector<std::size_t> sizes;
  double cpu_s = 0.0;
  render::Planes planes;
  for (const render::Image& image : images) {
    render::VideoPicture picture;
    Status status;
    cpu_s += Measure(
                 [&] {
                   status = render::ToPlanes(image, &planes);
                   if (!status.ok()) return;
                   const auto code = encoder->Encode(planes, {.bits = kUnlimited}, &picture, &why);
                   if (code != StatusCode::kOk) status = Status(code, why);
                 },
                 1)
                 .cpu;
    FURROW_RETURN_IF_ERROR(status);
    std::array<unsigned char*, 3> decoded{};
    SBufferInfo info{};
    if ((*decoder)->DecodeFrameNoDelay(picture.bytes.data(), static_cast<int>(picture.bytes.size()),
                                       decoded.data(), &info) != dsErrorFree ||
        info.iBufferStatus != 1) {
      return Status(StatusCode::kInternal, "the picture does not decode at once");
    }
    reference.Compare(sizes.size(), decoded[0], info.UsrData.sSystemBuffer.iStride[0], image.width,
                      image.height);
    sizes.push_back(picture.bytes.size());
  }
  return Summary(sizes, reference.psnr_db(), cpu_s);
}

Result<Encoded> VideoAt(const std::vector<render::Image>& images, double psnr_db) {
  std::optional<Encoded> below;
  for (const int quality : {20, 40, 55, 65, 72, 77, 80, 83, 86, 89, 92, 95, 98}) {
    const auto encoded = MeasureVideo(images, quality);
    FURROW_RETURN_IF_ERROR(encoded);
    if (encoded->psnr_db < psnr_db) {
      below = *encoded;
    } else if (!below) {
      return *encoded;
    } else {
      const double share = (psnr_db - below->psnr_db) / (encoded->psnr_db - below->psnr_db);
      return Mix(*below, *encoded, share);
    }
  }
  return Status(StatusCode::kNotFound, "H.264 does not reach this quality");
}

}  // namespace furrow::bench
