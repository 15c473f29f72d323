// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/command.h"

#include <charconv>
#include <map>
#include <sstream>

namespace furrow::cli {

void AddSkeletonMap(CLI::App& command, std::string& value) {
  command.add_option("--skeleton-map", value,
                     "Map of the recording's joint names, by name (cmu, mixamo, vrm, ...) or file "
                     "(default: the best match of the shipped maps)");
}

void AddShapeMap(CLI::App& command, std::string& value) {
  command.add_option("--shape-map", value,
                     "Map of the recording's blend-shape names, by name (arkit, vrm0, cc4, ...) or "
                     "file (default: the best match of the shipped maps)");
}

void AddBvhOptions(CLI::App& command, motion::LoadOptions& options) {
  command
      .add_option_function<std::string>(
          "--bvh-positions",
          [&options](const std::string& word) {
            options.bvh_positions = *motion::ParseBvhPositions(word);
          },
          "Position channels of a BVH joint: channels (they replace its OFFSET), add (to the "
          "OFFSET), offsets (ignored except for roots) or auto (channels, unless they would "
          "collapse the body)")
      ->check(CLI::Validator(
          [](std::string& word) {
            return motion::ParseBvhPositions(word)
                       ? std::string()
                       : "'" + word + "' is not one of " + motion::kBvhPositionsWords;
          },
          "auto|channels|offsets|add"))
      ->type_name("")
      ->default_str("auto");
  const std::map<std::string, motion::UpAxis> axes{
      {"auto", motion::UpAxis::kAuto}, {"y", motion::UpAxis::kY}, {"z", motion::UpAxis::kZ}};
  AddChoice(command, "--up-axis", options.up_axis, axes,
            "Axis that points up in a BVH file: auto, y or z");
}

void AddReadOptions(CLI::App& command, motion::LoadOptions& options) {
  command
      .add_option(
          "--animation", options.animation,
          "Animation of a glTF, FBX or Collada file, by name or number from 0 (default: the "
          "first)")
      ->type_name("NAME|INDEX");
  command
      .add_option(
          "--rest-frame", options.rest_frame,
          "Frame to take as the rest pose, counted from 0; the performer stands upright and "
          "faces +Z there (default: the rest pose of the file)")
      ->check(Within(0, 1e9));
  AddBvhOptions(command, options);
}

// The limits are those of the wire (protocol::kMinImageSize, kMaxImageSize).
bool ParseSize(const std::string& text, int* width, int* height) {
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, *width);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != 'x') return false;
  const auto second = std::from_chars(first.ptr + 1, end, *height);
  const auto in_range = [](int value) { return value >= 16 && value <= 4096; };
  return second.ec == std::errc() && second.ptr == end && in_range(*width) && in_range(*height);
}

CLI::Validator SizeValidator() {
  return {[](std::string& text) {
            int width = 0;
            int height = 0;
            if (ParseSize(text, &width, &height)) return std::string();
            return "'" + text + "' is not WIDTHxHEIGHT with both in 16..4096, such as 640x480";
          },
          "WxH"};
}

CLI::Validator Within(double least, double most) {
  const std::string range = CLI::Range(least, most).get_description();
  std::ostringstream words;
  words << least << " to " << most;
  return {[least, most, said = words.str()](std::string& text) {
            double number = 0.0;
            // NaN fails both comparisons; CLI::Range would accept it.
            const bool is_number = CLI::detail::lexical_cast(text, number);
            if (is_number && number >= least && number <= most) return std::string();
            return "'" + text + "' is not a number from " + said;
          },
          range};
}

void AddTokenFile(CLI::App& command, std::string& value) {
  command.add_option("--token", value,
                     "File with a connect token, as 'furrow token new' makes it (default: none).\n"
                     "Over UDP it encrypts");
}

void AddSecurityOptions(CLI::App& command, SecurityFlags& flags) {
  AddTokenFile(command, flags.token);
  command.add_flag("--tls", flags.tls, "Use TLS over TCP; the system's authorities are trusted");
  command
      .add_option("--tls-authority", flags.tls_files.authority,
                  "Use TLS, and trust these authorities, or this certificate of the daemon (PEM)")
      ->type_name("FILE");
  command
      .add_option("--tls-certificate", flags.tls_files.certificate,
                  "Use TLS, and show this certificate to a daemon that asks for one (PEM)")
      ->type_name("FILE");
  command
      .add_option("--tls-key", flags.tls_files.key,
                  "Private key of --tls-certificate (default: in the same file)")
      ->type_name("FILE");
  command.add_flag("--token-in-clear", flags.token_in_clear,
                   "Send the token over plain TCP to other computers, where everybody on the way\n"
                   "can read it (default: refuse)");
}

}  // namespace furrow::cli
