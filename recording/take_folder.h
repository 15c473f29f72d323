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
  std::filesystem::path folder;    // made where it is absent; empty: the current one
  std::filesystem::path name;      // of the first file; empty: by the time it begins
  std::uint64_t rotate_bytes = 0;  // a file ends when it has grown to this; 0: never
  std::uint64_t rotate_ns = 0;     // and when it covers so much time; 0: never
  std::string rig_json;            // attached to every file; may be empty
};

// A recording without an end: takes in a folder, one after the other, each complete in itself.
//
// - Files are named by the time they begin, "take-20260514T093000Z.mcap", "_2" and so on where that
//   is taken; or "name.mcap", "name_2.mcap" and so on. Nothing is ever overwritten.
// - Every file begins with the skeletons and names of the subjects that are there.
// - The same skeleton or names again, as senders repeat them, are written once a file and session.
// - After an error (a full disk) all further calls return it, and the file stays readable.
class TakeFolder {
 public:
  // Errors: kIo (also where the named file exists).
  [[nodiscard]] static Result<std::unique_ptr<TakeFolder>> Open(TakeFolderOptions options,
                                                                std::uint64_t now_ns);

  [[nodiscard]] Status Write(TakeKind kind, std::string_view subject, const TakeStamp& stamp,
                             std::span<const std::uint8_t> payload);
  [[nodiscard]] Status WriteDatagram(const DatagramSender& sender, std::uint64_t log_time_ns,
                                     std::span<const std::uint8_t> bytes);
  // The subject has left: the next file does not begin with it.
  void Forget(std::string_view subject);

  [[nodiscard]] Status Flush();
  [[nodiscard]] Status Close();

  // The file that is being written.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] int num_files() const { return num_files_; }
  // In all files, with what each begins with; repeated declarations are not.
  [[nodiscard]] std::uint64_t num_messages() const {
    return earlier_messages_ + take_->num_messages();
  }

 private:
  struct Declaration {
    TakeStamp stamp;
    std::vector<std::uint8_t> payload;  // empty: none yet
  };
  struct SubjectState {
    Declaration skeleton;
    Declaration names;
  };

  explicit TakeFolder(TakeFolderOptions options) : options_(std::move(options)) {}
  [[nodiscard]] Status Begin(std::uint64_t now_ns);
  [[nodiscard]] std::filesystem::path NextPath(std::uint64_t now_ns) const;
  [[nodiscard]] Status RotateIfDue(std::uint64_t now_ns);
  [[nodiscard]] Status Remember(Status status);
  // True where this is what the subject's last declaration said.
  [[nodiscard]] bool IsRepeated(TakeKind kind, std::string_view subject, const TakeStamp& stamp,
                                std::span<const std::uint8_t> payload);

  TakeFolderOptions options_;
  std::unique_ptr<TakeWriter> take_;
  std::filesystem::path path_;
  std::uint64_t begun_ns_ = 0;
  std::uint64_t begun_bytes_ = 0;  // what the file begins with does not count toward its end
  int num_files_ = 0;
  std::uint64_t earlier_messages_ = 0;  // in the files before
  std::map<std::string, SubjectState, std::less<>> subjects_;
  Status failure_;
};

}  // namespace furrow::recording
