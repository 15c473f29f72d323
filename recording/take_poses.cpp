// SPDX-License-Identifier: Apache-2.0
#include "recording/take_poses.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "motion/limits.h"
#include "wrinkle/ascii.h"

namespace furrow::recording {
namespace {

using protocol::DecodeStatus;

constexpr std::size_t kMaxPoseBytes = std::size_t{2} << 30;
constexpr char kExtension[] = ".mcap";

std::string Join(const std::set<std::string, std::less<>>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

bool EndsInMcap(std::string_view text) {
  return text.size() > std::string_view(kExtension).size() &&
         wrinkle::EqualsIgnoreCase(text.substr(text.size() - 5), kExtension);
}

Status NoPoses(const TakeReader& take, std::string_view subject,
               const std::set<std::string, std::less<>>& names) {
  const std::string here = names.empty() ? "nobody" : Join(names);
  return {StatusCode::kNotFound,
          subject.empty() ? "the take has no poses"
                          : "there are no poses of '" + std::string(subject) + "', but of " + here,
          take.path().string()};
}

void Warn(motion::ClipReport* report, const TakeReader& take, std::size_t count,
          const std::string& what) {
  if (report == nullptr || count == 0) return;
  report->warnings.push_back(take.path().string() + ": " + std::to_string(count) + " " + what);
}

// Everybody who has poses.
Result<std::set<std::string, std::less<>>> SubjectsOf(TakeReader& take) {
  std::set<std::string, std::less<>> names;
  Status status = take.ForEach([&](const TakeMessage& message) {
    if (message.kind == TakeKind::kPose && !names.contains(message.subject))
      names.emplace(message.subject);
    return true;
  });
  if (!status.ok()) return status;
  return names;
}

}  // namespace

bool TakePoses::Add(const TakeMessage& message) {
  const TakeStamp& stamp = message.stamp;
  if (!times_.empty()) {
    std::int64_t step = stamp.capture_time_us - last_.capture_time_us;
    if (stamp.session != last_.session || step <= 0) {
      step = static_cast<std::int64_t>((stamp.log_time_ns - last_.log_time_ns) / 1000);
    }
    elapsed_us_ += std::max<std::int64_t>(step, 1);
  }
  last_ = stamp;
  times_.push_back(static_cast<double>(elapsed_us_) * 1e-6);
  bytes_.insert(bytes_.end(), message.payload.begin(), message.payload.end());
  ends_.push_back(bytes_.size());
  return bytes_.size() <= kMaxPoseBytes && times_.size() <= motion::kMaxFrames;
}

Result<TakePoses> TakePoses::Load(TakeReader& take, std::string_view subject,
                                  motion::ClipReport* report) {
  const auto names = SubjectsOf(take);
  if (!names.ok()) return names.status();
  if (names->empty() || (!subject.empty() && !names->contains(subject)))
    return NoPoses(take, subject, *names);
  if (subject.empty() && names->size() > 1) {
    return Status(StatusCode::kInvalidArgument, "the take has several subjects: " + Join(*names),
                  take.path().string(),
                  "name one: " + take.path().filename().string() + "#" + *names->begin());
  }
  const std::string name(subject.empty() ? *names->begin() : subject);
  TakePoses poses;
  bool has_offer = false;
  bool fits = true;
  std::size_t unreadable = 0;
  std::size_t foreign = 0;
  Status status = take.ForEach([&](const TakeMessage& message) {
    if (message.subject != name) return true;
    if (message.kind == TakeKind::kSkeleton && !has_offer) {
      has_offer = protocol::Decode(message.View(), poses.offer_) == DecodeStatus::kOk;
      if (!has_offer) ++unreadable;
    } else if (message.kind == TakeKind::kPose) {
      if (protocol::Decode(message.View(), poses.checked_) != DecodeStatus::kOk) {
        ++unreadable;
      } else if (!has_offer || poses.checked_.skeleton_hash != poses.offer_.skeleton_hash ||
                 poses.checked_.num_joints != poses.offer_.joints.size() ||
                 poses.checked_.num_blend_shapes != poses.offer_.blend_shape_names.size()) {
        ++foreign;
      } else {
        fits = poses.Add(message);
      }
    }
    return fits;
  });
  if (!status.ok()) return status;
  if (!fits) {
    return Status(StatusCode::kLimit, "too many poses to hold at once", take.path().string(),
                  "record with --rotate-seconds for shorter files");
  }
  Warn(report, take, unreadable, "messages of '" + name + "' cannot be read and are left out");
  Warn(report, take, foreign,
       "poses of '" + name + "' are of another skeleton than its first and are left out");
  for (const std::string& text : take.file().warnings())
    if (report != nullptr) report->warnings.push_back(text);
  if (poses.size() == 0) return NoPoses(take, name, *names);
  return poses;
}

void TakePoses::Get(std::size_t index, protocol::PoseFrame* pose) const {
  const std::size_t begin = index == 0 ? 0 : ends_[index - 1];
  const protocol::MessageView view{
      {}, protocol::MessageKind::kPose, std::span(bytes_).subspan(begin, ends_[index] - begin)};
  if (protocol::Decode(view, *pose) != DecodeStatus::kOk) *pose = {};
}

bool IsTakePath(const std::string& path) {
  std::string file;
  std::string subject;
  SplitTakePath(path, &file, &subject);
  return EndsInMcap(file);
}

void SplitTakePath(const std::string& path, std::string* file, std::string* subject) {
  *file = path;
  subject->clear();
  std::error_code error;
  if (std::filesystem::exists(path, error)) return;
  for (std::size_t hash = path.find('#'); hash != std::string::npos;
       hash = path.find('#', hash + 1)) {
    if (!EndsInMcap(std::string_view(path).substr(0, hash))) continue;
    *file = path.substr(0, hash);
    *subject = path.substr(hash + 1);
    return;
  }
}

}  // namespace furrow::recording
