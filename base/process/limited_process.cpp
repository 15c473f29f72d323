// SPDX-License-Identifier: Apache-2.0
#include "base/process/limited_process.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/process/descriptor.h"

namespace furrow {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMemoryCanBeLimited = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer)
constexpr bool kMemoryCanBeLimited = false;
#else
constexpr bool kMemoryCanBeLimited = true;
#endif
#else
constexpr bool kMemoryCanBeLimited = true;
#endif

constexpr rlim_t kMaxDescriptors = 16;
constexpr std::size_t kMaxErrorText = 300;

Status SystemStatus(const std::string& what, int error) {
  return {StatusCode::kIo, what + ": " + std::generic_category().message(error)};
}

// A process whose own standard streams are closed gets their numbers for new files. Then dup2() in
// the child would replace one of them by another, so such a file gets a higher number.
Descriptor AboveStandardStreams(int descriptor) {
  Descriptor file(descriptor);
  if (descriptor < 0 || descriptor > STDERR_FILENO) return file;
  return Descriptor(fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
}

// A file that no other process can open: it never has a name, or loses it at once.
Descriptor NamelessFile() {
  std::error_code ignored;
  const fs::path folder = fs::temp_directory_path(ignored);
  const int file = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0) return AboveStandardStreams(file);
  std::string name = (folder / "furrow-XXXXXX").string();  // for file systems without O_TMPFILE
  const int named = mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) unlink(name.c_str());
  return AboveStandardStreams(named);
}

std::string ReadBack(const Descriptor& file, std::size_t offset, std::size_t size) {
  std::string bytes(size, '\0');
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got =
        pread(file.get(), bytes.data() + done, size - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

std::size_t SizeOf(const Descriptor& file) {
  struct stat info = {};
  return fstat(file.get(), &info) == 0 ? static_cast<std::size_t>(info.st_size) : 0;
}

// The child of one call. A child that still runs when the object goes away is killed.
class Child {
 public:
  explicit Child(const ProcessLimits& limits)
      : limits_(limits), deadline_(Clock::now() + std::chrono::seconds(limits.max_seconds)) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

  Status Start(const fs::path& program, std::span<const std::string> arguments) {
    int ends[2] = {-1, -1};
    // A socket instead of a pipe: writing to an ended child must not raise SIGPIPE.
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
      return SystemStatus("no socket for the program's input", errno);
    }
    input_ = AboveStandardStreams(ends[0]);
    const Descriptor child_input = AboveStandardStreams(ends[1]);
    output_ = NamelessFile();
    errors_ = NamelessFile();
    if (!input_.ok() || !child_input.ok() || !output_.ok() || !errors_.ok()) {
      return SystemStatus("no temporary file for the program's output", errno);
    }
    FURROW_RETURN_IF_ERROR(Spawn(program, arguments, child_input));
    return Limit();
  }

  // Sends the input and closes it. A child may end before it has read everything.
  Status Feed(std::string_view input) {
    while (!input.empty()) {
      pollfd ready = {input_.get(), POLLOUT, 0};
      const int left = Milliseconds();
      if (left <= 0) return TimeIsUp();
      if (poll(&ready, 1, left) <= 0) continue;
      const ssize_t sent =
          send(input_.get(), input.data(), input.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (sent > 0) {
        input.remove_prefix(static_cast<std::size_t>(sent));
      } else if (errno != EINTR && errno != EAGAIN) {
        break;
      }
    }
    input_.Close();
    return {};
  }

  // Waits for the child's end and returns its output.
  Result<std::string> Finish() {
    int end = 0;
    FURROW_RETURN_IF_ERROR(Wait(&end));
    if (WIFSIGNALED(end)) return EndBySignal(WTERMSIG(end));
    if (WEXITSTATUS(end) != 0) return Failure(WEXITSTATUS(end));
    const std::size_t size = SizeOf(output_);
    if (size > limits_.max_output_bytes) return OutputTooLarge();
    return ReadBack(output_, 0, size);
  }

 private:
  Status Spawn(const fs::path& program, std::span<const std::string> arguments,
               const Descriptor& child_input) {
    std::string name = program.string();
    std::vector<std::string> copies(arguments.begin(), arguments.end());
    std::vector<char*> argv = {name.data()};
    for (std::string& argument : copies) argv.push_back(argument.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, child_input.get(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, output_.get(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, errors_.get(), STDERR_FILENO);
    posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
    posix_spawn_file_actions_addchdir_np(&files, "/");
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t all, none;
    sigfillset(&all);
    sigemptyset(&none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    const int error = posix_spawn(&pid_, name.c_str(), &files, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    if (error == 0) return {};
    pid_ = 0;
    return SystemStatus("cannot start the program", error).At(name);
  }

  // From outside, because posix_spawn() cannot set limits. The child waits for its input meanwhile.
  Status Limit() {
    const rlim_t cpu = limits_.max_cpu_seconds;
    const struct {
      __rlimit_resource resource;
      rlimit value;
    } all[] = {
        {RLIMIT_CORE, {0, 0}},
        {RLIMIT_NOFILE, {kMaxDescriptors, kMaxDescriptors}},
        {RLIMIT_FSIZE, {limits_.max_output_bytes, limits_.max_output_bytes}},
        {RLIMIT_CPU, {cpu, cpu + 1}},  // SIGXCPU, then SIGKILL
        {RLIMIT_AS, {limits_.max_memory_bytes, limits_.max_memory_bytes}},
    };
    for (const auto& [resource, value] : all) {
      if (resource == RLIMIT_AS && !kMemoryCanBeLimited) continue;
      if (prlimit(pid_, resource, &value, nullptr) != 0) {
        return SystemStatus("cannot limit the program", errno);
      }
    }
    return {};
  }

  [[nodiscard]] int Milliseconds() const {
    return static_cast<int>(
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline_ - Clock::now()).count());
  }

  Status Wait(int* end) {
    // The pause grows to 10 ms: short conversions end at once, long ones cost nothing.
    for (int pause = 1;; pause = std::min(2 * pause, 10)) {
      const pid_t ended = waitpid(pid_, end, WNOHANG);
      if (ended == pid_) {
        pid_ = 0;
        return {};
      }
      if (ended < 0 && errno != EINTR) return SystemStatus("the program's end is lost", errno);
      if (Milliseconds() <= 0) return TimeIsUp();
      poll(nullptr, 0, pause);
    }
  }

  [[nodiscard]] Status TimeIsUp() const {
    return {StatusCode::kLimit,
            "converting the file takes more than " + std::to_string(limits_.max_seconds) + " s"};
  }
  [[nodiscard]] Status OutputTooLarge() const {
    return {StatusCode::kLimit, "the converted file has more than " +
                                    std::to_string(limits_.max_output_bytes >> 20) + " MiB"};
  }

  [[nodiscard]] Status EndBySignal(int signal) const {
    if (signal == SIGXFSZ) return OutputTooLarge();
    if (signal == SIGXCPU || signal == SIGKILL) {
      return {StatusCode::kLimit, "converting the file takes more than " +
                                      std::to_string(limits_.max_cpu_seconds) +
                                      " s of processor time or too much memory"};
    }
    return {StatusCode::kParse, "converting the file crashed (signal " + std::to_string(signal) +
                                    "): the file is damaged"};
  }

  // The last line of standard error says why, for example that a library is missing.
  [[nodiscard]] Status Failure(int code) const {
    const std::size_t size = SizeOf(errors_);
    const std::size_t shown = std::min(size, kMaxErrorText);
    std::string text = ReadBack(errors_, size - shown, shown);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    text.erase(0, text.rfind('\n') + 1);
    for (char& c : text) c = c >= 0x20 && c < 0x7f ? c : '?';
    return {StatusCode::kIo, "the converting program failed with exit code " +
                                 std::to_string(code) + (text.empty() ? "" : ": " + text)};
  }

  const ProcessLimits& limits_;
  const Clock::time_point deadline_;
  pid_t pid_ = 0;
  Descriptor input_;
  Descriptor output_;
  Descriptor errors_;
};

}  // namespace

Result<std::string> RunLimited(const fs::path& program, std::span<const std::string> arguments,
                               std::string_view input, const ProcessLimits& limits) {
  Child child(limits);
  FURROW_RETURN_IF_ERROR(child.Start(program, arguments));
  FURROW_RETURN_IF_ERROR(child.Feed(input));
  return child.Finish();
}

}  // namespace furrow
