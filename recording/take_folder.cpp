// SPDX-License-Identifier: Apache-2.0
#include "recording/take_folder.h"

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "base/status.h"

namespace furrow::recording {
namespace {

constexpr int kMaxSameName = 100000;

// A name like "take-20260514T093000Z".
std::string NameAt(std::uint64_t now_ns) {
  const auto seconds = static_cast<std::time_t>(now_ns / 1'000'000'000);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char text[40];
  std::strftime(text, sizeof text, "take-%Y%m%dT%H%M%SZ", &utc);
  return text;
}

}  // namespace

Status CheckTakeFolder(const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::absolute(folder, error);
  // MakeFolder() creates what is missing below the first folder that exists.
  std::filesystem::path present = whole;
  while (!std::filesystem::exists(present, error) && present.has_relative_path()) {
    present = present.parent_path();
  }
  std::string why;
  if (!std::filesystem::is_directory(present, error)) {
    why = present.string() + " is not a folder";
  } else if (access(present.c_str(), W_OK | X_OK) != 0) {
    why = std::generic_category().message(errno);
    if (present != whole) why = present.string() + ": " + why;
  }
  if (why.empty()) return {};
  const char* const what =
      present == whole ? "cannot write in the folder: " : "cannot create the folder: ";
  return {StatusCode::kIo, what + why, folder.string()};
}

Result<std::unique_ptr<TakeFolder>> TakeFolder::Open(TakeFolderOptions options,
                                                     std::uint64_t now_ns) {
  std::unique_ptr<TakeFolder> folder(new TakeFolder(std::move(options)));
  FURROW_RETURN_IF_ERROR(folder->MakeFolder());
  FURROW_RETURN_IF_ERROR(folder->Begin(now_ns));
  return folder;
}

std::unique_ptr<TakeFolder> TakeFolder::Failed(TakeFolderOptions options, Status failure) {
  std::unique_ptr<TakeFolder> folder(new TakeFolder(std::move(options)));
  folder->failure_ = std::move(failure);
  return folder;
}

Status TakeFolder::MakeFolder() const {
  std::error_code error;
  if (!options_.folder.empty()) std::filesystem::create_directories(options_.folder, error);
  if (!error) return {};
  return {StatusCode::kIo, "cannot create the folder: " + error.message(),
          options_.folder.string()};
}

// The first free name. A requested name of the first file is returned even if it exists, so that
// TakeWriter::Create() reports the error.
std::filesystem::path TakeFolder::NextPath(std::uint64_t now_ns) const {
  const bool is_named = !options_.name.empty();
  const std::string stem = is_named ? options_.name.stem().string() : NameAt(now_ns);
  const std::string extension = is_named ? options_.name.extension().string() : ".mcap";
  std::filesystem::path path = options_.folder / (stem + extension);
  if (is_named && num_files_ == 0) return path;
  std::error_code error;
  // Bounded, so that a folder full of equal names ends in an error of Create().
  for (int i = 2; std::filesystem::exists(path, error) && i < kMaxSameName; ++i)
    path = options_.folder / (stem + "_" + std::to_string(i) + extension);
  return path;
}

Status TakeFolder::Begin(std::uint64_t now_ns) {
  path_ = NextPath(now_ns);
  auto take = TakeWriter::Create(path_, options_.rig_json);
  FURROW_RETURN_IF_ERROR(take);
  if (take_ != nullptr) earlier_messages_ += take_->num_messages();
  take_ = *std::move(take);
  has_new_rig_ = false;
  begun_ns_ = now_ns;
  ++num_files_;
  FURROW_RETURN_IF_ERROR(WriteDeclarations(now_ns));
  // Not counted towards rotate_bytes, or else large skeletons would rotate files forever.
  begun_bytes_ = take_->bytes_written();
  return {};
}

// Every file is complete in itself, so it repeats the declarations of live subjects, stamped with
// its own start.
Status TakeFolder::WriteDeclarations(std::uint64_t now_ns) {
  for (const auto& [subject, state] : subjects_) {
    for (const auto& [kind, declaration] : {std::pair(TakeKind::kSkeleton, &state.skeleton),
                                            std::pair(TakeKind::kNames, &state.names)}) {
      if (declaration->payload.empty()) continue;
      TakeStamp stamp = declaration->stamp;
      stamp.log_time_ns = now_ns;
      FURROW_RETURN_IF_ERROR(take_->Write(kind, subject, stamp, declaration->payload));
    }
  }
  return {};
}

Status TakeFolder::Remember(Status status) {
  if (!status.ok() && failure_.ok()) failure_ = status;
  return status;
}

Status TakeFolder::RotateIfDue(std::uint64_t now_ns) {
  const bool large =
      options_.rotate_bytes > 0 && take_->bytes_written() - begun_bytes_ >= options_.rotate_bytes;
  const bool old =
      options_.rotate_ns > 0 && now_ns > begun_ns_ && now_ns - begun_ns_ >= options_.rotate_ns;
  if (!large && !old && !has_new_rig_ && !take_->is_full()) return {};
  FURROW_RETURN_IF_ERROR(take_->Close());
  return Begin(now_ns);
}

bool TakeFolder::IsRepeated(TakeKind kind, std::string_view subject, const TakeStamp& stamp,
                            std::span<const std::uint8_t> payload) {
  auto state = subjects_.find(subject);
  if (state == subjects_.end())
    state = subjects_.emplace(std::string(subject), SubjectState()).first;
  Declaration& last = kind == TakeKind::kSkeleton ? state->second.skeleton : state->second.names;
  // Channels belong to a session, so a new session declares again.
  if (last.stamp.session == stamp.session && std::ranges::equal(last.payload, payload)) return true;
  last = {stamp, {payload.begin(), payload.end()}};
  return false;
}

Status TakeFolder::Write(TakeKind kind, std::string_view subject, const TakeStamp& stamp,
                         std::span<const std::uint8_t> payload) {
  const bool declares = kind == TakeKind::kSkeleton || kind == TakeKind::kNames;
  if (!failure_.ok()) {
    if (declares) (void)IsRepeated(kind, subject, stamp, payload);  // for the file of Resume()
    return failure_;
  }
  // Rotate before remembering the declaration. Otherwise the new file would contain it twice.
  if (Status status = RotateIfDue(stamp.log_time_ns); !status.ok()) return Remember(status);
  if (declares && IsRepeated(kind, subject, stamp, payload)) return {};
  return Remember(take_->Write(kind, subject, stamp, payload));
}

Status TakeFolder::WriteDatagram(const DatagramSender& sender, std::uint64_t log_time_ns,
                                 std::span<const std::uint8_t> bytes) {
  if (!failure_.ok()) return failure_;
  if (Status status = RotateIfDue(log_time_ns); !status.ok()) return Remember(status);
  return Remember(take_->WriteDatagram(sender, log_time_ns, bytes));
}

void TakeFolder::Forget(std::string_view subject) {
  if (const auto found = subjects_.find(subject); found != subjects_.end()) subjects_.erase(found);
}

void TakeFolder::SetRig(std::string_view rig_json) {
  if (options_.rig_json == rig_json) return;
  options_.rig_json = rig_json;
  has_new_rig_ = true;
  for (auto& [name, state] : subjects_) state.names = {};
}

Status TakeFolder::Resume(std::uint64_t now_ns) {
  if (failure_.ok()) return {};
  if (take_ != nullptr) (void)take_->Close();  // its error is known
  const std::filesystem::path failed = path_;
  const int files = num_files_;
  const std::uint64_t messages = num_messages();
  // Somebody may have removed the folder meanwhile, to free space.
  Status status = MakeFolder();
  if (status.ok()) status = Begin(now_ns);
  const bool has_begun = status.ok();
  if (has_begun) status = take_->Flush();
  if (status.ok()) {
    failure_ = {};
    return status;
  }
  // NextPath() chose a free name, so the file is this one's own.
  std::error_code ignored;
  if (has_begun) std::filesystem::remove(path_, ignored);
  path_ = failed;
  num_files_ = files;
  earlier_messages_ = messages - (take_ == nullptr ? 0 : take_->num_messages());
  return status;
}

Result<bool> TakeFolder::LeaveLostFile(std::uint64_t now_ns) {
  if (!failure_.ok() || take_ == nullptr || take_->is_at_its_path()) return false;
  (void)take_->Close();  // nobody finds it
  Status status = MakeFolder();
  if (status.ok()) status = Begin(now_ns);
  if (!status.ok()) return Remember(std::move(status));
  return true;
}

bool TakeFolder::RemoveIfEmpty() const {
  if (num_messages() > 0) return false;
  std::error_code ignored;
  if (take_ != nullptr) std::filesystem::remove(path_, ignored);
  return true;
}

Status TakeFolder::Flush() {
  if (!failure_.ok()) return failure_;
  return Remember(take_->Flush());
}

Status TakeFolder::Close() {
  const Status status = take_ == nullptr ? Status() : take_->Close();
  return failure_.ok() ? status : failure_;
}

}  // namespace furrow::recording
