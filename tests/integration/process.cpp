// SPDX-License-Identifier: Apache-2.0
#include "process.h"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace furrow::testing_net {

namespace {

constexpr int kFirstPassed = 3;

// In the child, before the program starts.
void BecomeService(const Process::Service& service) {
  if (!service.notify_socket.empty()) ::setenv("NOTIFY_SOCKET", service.notify_socket.c_str(), 1);
  if (service.sockets.empty()) return;
  std::vector<int> copies;  // out of the way of the final numbers
  for (const int each : service.sockets) copies.push_back(::fcntl(each, F_DUPFD_CLOEXEC, 100));
  for (std::size_t i = 0; i < copies.size(); ++i) {
    ::dup2(copies[i], kFirstPassed + static_cast<int>(i));
  }
  ::setenv("LISTEN_PID", std::to_string(::getpid()).c_str(), 1);
  ::setenv("LISTEN_FDS", std::to_string(copies.size()).c_str(), 1);
  ::setenv("LISTEN_FDNAMES", service.names.c_str(), 1);
}

}  // namespace

Process::Process(std::vector<std::string> command, const Service& service) {
  std::array<int, 2> out{};
  std::array<int, 2> errors{};
  if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(errors.data(), O_CLOEXEC) != 0) return;
  std::vector<char*> args;
  for (std::string& word : command) args.push_back(word.data());
  args.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ == 0) {
    ::dup2(out[1], STDOUT_FILENO);
    ::dup2(errors[1], STDERR_FILENO);
    BecomeService(service);
    ::execv(args[0], args.data());
    ::_exit(127);
  }
  ::close(out[1]);
  ::close(errors[1]);
  out_ = out[0];
  errors_ = errors[0];
}

Process::~Process() {
  if (pid_ > 0) {
    Signal(SIGKILL);
    Wait();
  }
  ::close(out_);
  CloseErrors();
}

void Process::CloseErrors() {
  if (errors_ >= 0) ::close(errors_);
  errors_ = -1;
}

std::optional<std::string> Process::ReadLine() {
  std::size_t end = 0;
  while ((end = buffer_.find('\n')) == std::string::npos) {
    std::array<char, 4096> bytes;
    const ssize_t size = ::read(out_, bytes.data(), bytes.size());
    if (size <= 0) return std::nullopt;
    buffer_.append(bytes.data(), static_cast<std::size_t>(size));
  }
  std::string line = buffer_.substr(0, end);
  buffer_.erase(0, end + 1);
  return line;
}

void Process::Signal(int signal) const { ::kill(pid_, signal); }

int Process::Wait() {
  int status = 0;
  ::waitpid(pid_, &status, 0);
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string Process::ReadErrors() {
  std::string text;
  std::array<char, 4096> bytes;
  ssize_t size = 0;
  while ((size = ::read(errors_, bytes.data(), bytes.size())) > 0) {
    text.append(bytes.data(), static_cast<std::size_t>(size));
  }
  return text;
}

std::string FindProgram(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path candidate = std::filesystem::path(folder) / name;
    if (::access(candidate.c_str(), X_OK) == 0) return candidate.string();
  }
  return {};
}

std::vector<std::string> FurrowdCommand(const std::vector<std::string>& more) {
  std::vector<std::string> command = {FURROW_BINARY_DIR "/bin/furrowd",
                                      "--rig",
                                      FURROW_SOURCE_DIR "/rig/rigs/arkit.json",
                                      "--no-render",
                                      "--http",
                                      "0"};
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

}  // namespace furrow::testing_net
