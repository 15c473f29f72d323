// SPDX-License-Identifier: Apache-2.0
#include "render/video/video_codec.h"

#include <cstdio>
#include <filesystem>

#include "base/process/module.h"

namespace furrow::render {
namespace {

constexpr int kSequenceParameterSet = 7;  // nal_unit_type, ITU-T H.264 table 7-1

Result<const VideoCodec*> LoadModule() {
  const std::filesystem::path path = ModulePath("furrow-video.so");
  std::string why;  // names the file that is missing
  void* make = LoadFromModule(path, "FurrowVideoCodec", &why);
  if (make == nullptr) {
    return Status(StatusCode::kUnavailable, why.empty() ? path.string() + " has no codec" : why, "",
                  "install furrow with libopenh264");
  }
  return reinterpret_cast<const VideoCodec* (*)()>(make)();
}

}  // namespace

Result<const VideoCodec*> GetVideoCodec() {
  static const Result<const VideoCodec*> codec = LoadModule();
  return codec;
}

std::string VideoCodecName(const std::vector<std::uint8_t>& key_picture) {
  // A start code, the type, and three bytes of the parameter set.
  for (std::size_t i = 0; i + 7 <= key_picture.size(); ++i) {
    const std::uint8_t* at = key_picture.data() + i;
    if (at[0] != 0 || at[1] != 0 || at[2] != 1 || (at[3] & 0x1F) != kSequenceParameterSet) continue;
    char name[sizeof("avc1.000000")];
    std::snprintf(name, sizeof(name), "avc1.%02x%02x%02x", at[4], at[5], at[6]);
    return name;
  }
  return {};
}

}  // namespace furrow::render
