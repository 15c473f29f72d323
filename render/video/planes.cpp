// SPDX-License-Identifier: Apache-2.0
#include "render/video/planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <turbojpeg.h>

namespace furrow::render {
namespace {

constexpr std::size_t kChannels = 3;

// TurboJPEG rounds the chroma planes up, but encoders want an even luma plane, too.
Image MakeEven(const Image& image) {
  Image even;
  even.width = image.width + image.width % 2;
  even.height = image.height + image.height % 2;
  const std::size_t row = kChannels * static_cast<std::size_t>(image.width);
  const std::size_t even_row = kChannels * static_cast<std::size_t>(even.width);
  even.rgb.resize(even_row * static_cast<std::size_t>(even.height));
  for (int y = 0; y < even.height; ++y) {
    const auto from =
        image.rgb.begin() + static_cast<std::ptrdiff_t>(row) * std::min(y, image.height - 1);
    const auto to = even.rgb.begin() + static_cast<std::ptrdiff_t>(even_row) * y;
    std::copy_n(from, row, to);
    const auto end = to + static_cast<std::ptrdiff_t>(row);
    if (even_row > row) std::copy_n(end - kChannels, kChannels, end);
  }
  return even;
}

// What becomes of each value of the full range.
using Table = std::array<std::uint8_t, 256>;

// `zero`: what 0 becomes; `steps`: of 255 that remain.
Table LimitedRange(double zero, double steps) {
  Table table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double value = zero + static_cast<double>(i) * (steps / 255.0);
    table[i] = static_cast<std::uint8_t>(std::lround(value));
  }
  return table;
}

void Apply(const Table& table, std::vector<std::uint8_t>* plane) {
  for (std::uint8_t& value : *plane) value = table[value];
}

}  // namespace

Status ToPlanes(const Image& image, Planes* planes) {
  const std::size_t bytes =
      kChannels * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.width < 1 || image.height < 1 || image.rgb.size() != bytes) {
    return {StatusCode::kInvalidArgument, "the pixels do not match the size", "image"};
  }
  if (image.width % 2 != 0 || image.height % 2 != 0) return ToPlanes(MakeEven(image), planes);
  struct Close {
    void operator()(void* handle) const { tjDestroy(handle); }
  };
  const std::unique_ptr<void, Close> converter(tjInitCompress());
  planes->width = image.width;
  planes->height = image.height;
  planes->y.resize(bytes / kChannels);
  planes->u.resize(bytes / kChannels / 4);
  planes->v.resize(bytes / kChannels / 4);
  unsigned char* targets[] = {planes->y.data(), planes->u.data(), planes->v.data()};
  int strides[] = {image.width, image.width / 2, image.width / 2};
  if (tjEncodeYUVPlanes(converter.get(), image.rgb.data(), image.width, 0, image.height, TJPF_RGB,
                        targets, strides, TJSAMP_420, TJFLAG_FASTDCT) != 0) {
    return {StatusCode::kInternal, tjGetErrorStr2(converter.get()), "TurboJPEG"};
  }
  static const Table luma = LimitedRange(16.0, 219.0);
  static const Table chroma = LimitedRange(128.0 - 128.0 * 224.0 / 255.0, 224.0);  // 128 stays
  Apply(luma, &planes->y);
  Apply(chroma, &planes->u);
  Apply(chroma, &planes->v);
  return {};
}

}  // namespace furrow::render
