// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "recording/take_writer.h"

namespace furrow::recording {

struct TakeFolderOptions {
  std::filesystem::path folder;    // created if absent; empty: the current folder
  std::filesystem::path name;      // of the first file; empty: its start time
  std::uint64_t rotate_bytes = 0;  // start the next file at this size; 0: never
  std::uint64_t rotate_ns = 0;     // start the next file after this time; 0: never
  std::string rig_json;            // attached to every file; may be empty
};

// Whether this user may record in the folder, which need not exist. Creates nothing. Errors: kIo.
[[nodiscard]] Status CheckTakeFolder(const std::filesystem::path& folder);

// An open-ended recording: a folder of consecutive takes, each complete in itself.
//
// - Files are named by their start time, "take-20260514T093000Z.mcap", or "name.mcap". If the name
//   exists, "_2", "_3" and so on are appended. No file is ever overwritten.
// - Every file begins with the skeletons and weight names of the current subjects.
// - Senders repeat skeletons and names. Repetitions are written once per file and session.
// - After an error (a full disk), all later calls return the same error until Resume(). The file
// stays
//   readable. Declarations are remembered meanwhile.
class TakeFolder {
 public:
  // Creates the folder and the first file. Errors: kIo (also if `options.name` exists).
  [[nodiscard]] static Result<std::unique_ptr<TakeFolder>> Open(TakeFolderOptions options,
                                                                std::uint64_t now_ns);
  // A folder whose first file could not be created because of `failure`: as after that error, until
  // Resume() creates the file.
  [[nodiscard]] static std::unique_ptr<TakeFolder> Failed(TakeFolderOptions options,
                                                          Status failure);

  // Writes a message or datagram (see TakeWriter), first into a new file if a rotation is due by
  // size or log time, or if the file is full.
  [[nodiscard]] Status Write(TakeKind kind, std::string_view subject, const TakeStamp& stamp,
                             std::span<const std::uint8_t> payload);
  [[nodiscard]] Status WriteDatagram(const DatagramSender& sender, std::uint64_t log_time_ns,
                                     std::span<const std::uint8_t> bytes);
  // After an error that is not of the file, such as lack of memory: as after an error of the file.
  void Fail(const Status& failure) { (void)Remember(failure); }
  // Call it when a subject leaves: later files do not begin with its skeleton.
  void Forget(std::string_view subject);

  // The rig of the weights has changed: the next message begins a new file, to which it is
  // attached.
  // All names are to be declared again.
  void SetRig(std::string_view rig_json);

  // After an error: finishes the failed file as far as possible and begins the next one, in the
  // folder, which is created again if it was removed. Errors: kIo; then no new file is left behind,
  // and this object stays as it was.
  [[nodiscard]] Status Resume(std::uint64_t now_ns);

  // Passes all messages to the operating system.
  [[nodiscard]] Status Flush();
  // Begins the next file if the current one was removed or renamed. Returns true if it was. Errors:
  // those of Flush().
  [[nodiscard]] Result<bool> LeaveLostFile(std::uint64_t now_ns);
  // Removes the file if nothing was written, and returns true. Call it after Close().
  bool RemoveIfEmpty() const;
  // Finishes the current file. Nothing can be written afterwards.
  [[nodiscard]] Status Close();

  // The current file.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] int num_files() const { return num_files_; }
  // The error that all calls return until Resume().
  [[nodiscard]] const Status& failure() const { return failure_; }
  // Messages in all files, including those that each file begins with, without repetitions.
  [[nodiscard]] std::uint64_t num_messages() const {
    return earlier_messages_ + (take_ == nullptr ? 0 : take_->num_messages());
  }

 private:
  struct Declaration {
    TakeStamp stamp;
    std::vector<std::uint8_t> payload;  // empty if there is none yet
  };
  struct SubjectState {
    Declaration skeleton;
    Declaration names;
  };

  explicit TakeFolder(TakeFolderOptions options) : options_(std::move(options)) {}
  [[nodiscard]] Status MakeFolder() const;
  [[nodiscard]] Status Begin(std::uint64_t now_ns);
  [[nodiscard]] Status WriteDeclarations(std::uint64_t now_ns);
  [[nodiscard]] std::filesystem::path NextPath(std::uint64_t now_ns) const;
  [[nodiscard]] Status RotateIfDue(std::uint64_t now_ns);
  [[nodiscard]] Status Remember(Status status);
  // Whether this equals the subject's last declaration. Remembers it if not.
  [[nodiscard]] bool IsRepeated(TakeKind kind, std::string_view subject, const TakeStamp& stamp,
                                std::span<const std::uint8_t> payload);

  TakeFolderOptions options_;
  std::unique_ptr<TakeWriter> take_;  // null: there is no file yet, and `failure_` says why
  std::filesystem::path path_;
  std::uint64_t begun_ns_ = 0;
  std::uint64_t begun_bytes_ = 0;  // size of what the file begins with, which rotate_bytes ignores
  bool has_new_rig_ = false;       // the present file has another one
  int num_files_ = 0;
  std::uint64_t earlier_messages_ = 0;  // in earlier files
  std::map<std::string, SubjectState, std::less<>> subjects_;
  Status failure_;
};

}  // namespace furrow::recording
