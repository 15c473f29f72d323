// SPDX-License-Identifier: Apache-2.0
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "base/files.h"
#include "base/text.h"
#include "client/cli/commands/commands.h"
#include "client/cli/common/endpoint.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/standard_output.h"
#include "client/cli/receive/receive_events.h"
#include "client/cli/render/picture_settings.h"
#include "render/renderer.h"

namespace furrow::cli {
namespace {

struct FramesOptions {
  SubscriptionOptions listen;
  std::string out;
  std::string size = "640x640";
  int quality = 85;
  protocol::SubscribePictures request;
};

// Writes each picture to DIR/<sequence>.<ext>, or all to standard output.
class PictureFiles {
 public:
  PictureFiles(const FramesOptions& options, client::Subscriber& subscriber)
      : subscriber_(subscriber), out_(options.out), left_(options.listen.frames) {}

  bool operator()(const client::Event& event) {
    if (event.kind != client::Event::Kind::kPicture) return true;
    const protocol::ImageFrame& picture = subscriber_.picture();
    if (picture.age_us > 0) return true;  // weights decay without a new pose
    Status status;
    if (out_ == "-") {
      status = WriteStandardOutput(picture.bytes);
    } else {
      char name[32];
      std::snprintf(name, sizeof name, "%06" PRIu32 ".%s", event.header.sequence,
                    picture.format == protocol::ImageFormat::kJpeg ? "jpg" : "png");
      status = WriteFileAtomically(std::filesystem::path(out_) / name, AsText(picture.bytes),
                                   Flush::kNone);
    }
    if (!status.ok()) {
      // The callback can only stop the loop, so it keeps the exit code.
      failure_ = Fail(status);
      return false;
    }
    return --left_ != 0;
  }

  [[nodiscard]] int failure() const { return failure_; }

 private:
  client::Subscriber& subscriber_;
  std::string out_;
  std::int64_t left_;  // pictures to receive; 0: unlimited
  int failure_ = kDone;
};

int Frames(const FramesOptions& options) {
  const auto address =
      ParseHost(options.listen.host, {.rate = true, .security = options.listen.security});
  if (!address) return kUsage;
  if (options.out != "-") {
    std::error_code error;
    std::filesystem::create_directories(options.out, error);
    if (error) return Fail({StatusCode::kIo, error.message(), options.out});
  }
  int exit_code = kDone;
  // Pictures need TCP.
  auto transport =
      OpenTransport(*address, client::TransportKind::kTcp, options.listen.once, &exit_code);
  if (!transport) return exit_code;
  client::Subscriber subscriber(std::move(transport), "furrow frames " FURROW_VERSION);
  protocol::SubscribePictures request = options.request;
  ApplyAddress(*address, request);
  int width = 0;
  int height = 0;
  (void)ParseSize(options.size, &width, &height);  // checked while parsing
  request.width = static_cast<std::uint16_t>(width);
  request.height = static_cast<std::uint16_t>(height);
  request.quality = static_cast<std::uint8_t>(options.quality);
  subscriber.Subscribe(request);
  PictureFiles files(options, subscriber);
  exit_code = ReceiveEvents(subscriber, std::ref(files));
  return files.failure() != kDone ? files.failure() : exit_code;
}

}  // namespace

void AddFrames(CLI::App& app, Action& action) {
  auto options = std::make_shared<FramesOptions>();
  CLI::App* command =
      app.add_subcommand("frames", "Receive pictures of a subject, drawn by the daemon");
  AddSubscriptionOptions(*command, options->listen, options->request, "pictures",
                         "as many as the daemon can draw");
  command
      ->add_option("--out", options->out,
                   "Folder for the pictures, <sequence>.jpg or .png; - for standard output")
      ->required();
  command->add_option("--size", options->size, "Width and height in pixels, 16 to 4096 each")
      ->check(SizeValidator())
      ->capture_default_str();
  const std::map<std::string, protocol::ImageFormat> formats{{"jpeg", protocol::ImageFormat::kJpeg},
                                                             {"png", protocol::ImageFormat::kPng}};
  AddChoice(*command, "--format", options->request.format, formats, "Picture format");
  command->add_option("--quality", options->quality, "JPEG quality in percent")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command
      ->add_option("--view", options->request.view, "View: " + std::string(InfoOf("view").allowed))
      ->capture_default_str();
  command->add_option("--camera", options->request.camera_preset,
                      "Camera: " + render::ListCameraPresets() + " (default: face)");
  command->callback([options, &action] { action = [options] { return Frames(*options); }; });
}

}  // namespace furrow::cli
