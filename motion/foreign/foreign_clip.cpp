// SPDX-License-Identifier: Apache-2.0
#include "motion/foreign/foreign_clip.h"

#include <cmath>
#include <utility>

#include "base/numbers.h"
#include "base/process/helper_call.h"
#include "base/text.h"

namespace furrow::motion {
namespace {

constexpr ProcessLimits kLimits = {.max_memory_bytes = std::size_t{1} << 30,
                                   .max_cpu_seconds = 60,
                                   .max_seconds = 180,
                                   .max_output_bytes = std::size_t{1} << 30};

// A note is a word and its values: "animation 1.25 Walk", "warning ...".
constexpr std::string_view kAnimation = "animation";
constexpr std::string_view kWarning = "warning";

void ReadNote(std::string_view note, ClipReport* report) {
  const std::string_view word = TakeToken(&note);
  if (word == kWarning) {
    report->warnings.emplace_back(note.substr(std::min<std::size_t>(note.size(), 1)));
  } else if (word == kAnimation) {
    double seconds = 0.0;
    if (!TryParseNumber(TakeToken(&note), &seconds)) return;
    report->animations.push_back(
        {std::string(note.substr(std::min<std::size_t>(note.size(), 1))), seconds});
  }
}

}  // namespace

std::vector<std::string> NotesOf(const ClipReport& report) {
  std::vector<std::string> notes;
  for (const auto& [name, seconds] : report.animations) {
    std::string note = std::string(kAnimation) + " ";
    AppendFixed(std::isfinite(seconds) ? seconds : 0.0, 6, &note);
    notes.push_back(note + " " + name);
  }
  for (const std::string& warning : report.warnings)
    notes.push_back(std::string(kWarning) + " " + warning);
  return notes;
}

Result<std::string> ForeignClipToGlb(std::string_view bytes, const std::string& extension,
                                     const std::string& animation, ClipReport* report) {
  std::vector<std::string> arguments = {"clip", extension};
  if (!animation.empty()) arguments.push_back(animation);
  Result<HelperReply> reply = CallHelper("furrow-assimp", arguments, bytes, kLimits);
  FURROW_RETURN_IF_ERROR(reply);
  for (const std::string& note : reply->notes) ReadNote(note, report);
  return std::move(reply->payload);
}

}  // namespace furrow::motion
