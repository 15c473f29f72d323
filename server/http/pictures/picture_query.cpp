// SPDX-License-Identifier: Apache-2.0
#include "server/http/pictures/picture_query.h"

#include <algorithm>
#include <charconv>
#include <string>

#include "base/status.h"
#include "protocol/messages/limits.h"
#include "render/renderer.h"
#include "render/settings/named_settings.h"

namespace furrow::server {
namespace {

// Parses a number in [low, high] into `target`. The comparison is written so that NaN fails.
template <class Number, class Target>
Status Read(const std::string& name, const std::string& text, Number low, Number high,
            Target* target) {
  Number value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || !(value >= low && value <= high)) {
    return Status(StatusCode::kInvalidArgument,
                  "'" + text + "' is not a number from " + std::to_string(low) + " to " +
                      std::to_string(high),
                  name);
  }
  *target = static_cast<Target>(value);
  return {};
}

// The error of another layer, with the name in the query as the field.
Status AtName(const std::string& name, const Status& why) {
  return {StatusCode::kInvalidArgument, why.what(), name, why.todo()};
}

// Checks that the view, the camera, or the setting with this value exists.
Status CheckName(const std::string& name, const std::string& value) {
  if (name == "subject") return {};
  if (name == "view") {
    const Result<render::View> view = render::ParseView(value);
    return view.ok() ? Status() : AtName(name, view.status());
  }
  if (name == "camera") {
    const auto names = render::CameraPresetNames();
    if (value.empty() || std::ranges::find(names, value) != names.end()) return {};
    return {StatusCode::kInvalidArgument, "no camera '" + value + "'", name,
            "one of: " + render::ListCameraPresets()};
  }
  // Tried on default settings, so that the error comes before a subscription is made.
  render::Settings settings;
  const Status status = render::SetSetting(name, value, &settings);
  return status.ok() ? Status() : AtName(name, status);
}

// Stores one name and value. Names that are not listed are settings of the picture.
Status Set(const std::string& name, const std::string& value, protocol::SubscribePictures* out) {
  using protocol::kMaxImageSize;
  using protocol::kMinImageSize;
  if (name == "subject") {
    out->subject = value;
  } else if (name == "view") {
    out->view = value;
  } else if (name == "camera") {
    out->camera_preset = value;
  } else if (name == "width") {
    return Read(name, value, kMinImageSize, kMaxImageSize, &out->width);
  } else if (name == "height") {
    return Read(name, value, kMinImageSize, kMaxImageSize, &out->height);
  } else if (name == "quality") {
    return Read(name, value, 1, 100, &out->quality);
  } else if (name == "rate") {
    return Read(name, value, 0.0f, protocol::kMaxRateHz, &out->max_rate_hz);
  } else {
    out->settings.push_back(name + "=" + value);
  }
  return CheckName(name, value);
}

}  // namespace

Result<protocol::SubscribePictures> PicturesOf(const Url& url) {
  protocol::SubscribePictures pictures;
  pictures.width = pictures.height = 640;
  for (const auto& [name, value] : url.values) {
    // The limits of the wire, because the result becomes a message: "name=value".
    if (name.size() + value.size() + 1 > protocol::kMaxNameBytes) {
      return Status(StatusCode::kInvalidArgument,
                    "name and value have " + std::to_string(name.size() + value.size() + 1) +
                        " bytes with '='; the limit is 255",
                    name);
    }
    FURROW_RETURN_IF_ERROR(Set(name, value, &pictures));
  }
  if (pictures.settings.size() > protocol::kMaxPictureSettings) {
    return Status(StatusCode::kInvalidArgument,
                  std::to_string(pictures.settings.size()) + " settings; the limit is 128");
  }
  return pictures;
}

}  // namespace furrow::server
