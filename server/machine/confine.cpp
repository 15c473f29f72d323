// SPDX-License-Identifier: Apache-2.0
#include "server/machine/confine.h"

#include <cerrno>
#include <cstdint>
#include <cstring>

#include <fcntl.h>
#include <linux/capability.h>
#include <linux/landlock.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "server/machine/syscall_filter.h"

namespace furrow::server {
namespace {

constexpr std::uint64_t kRead = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t kWrite = LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_DIR |
                                 LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_MAKE_DIR |
                                 LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_MAKE_SOCK |
                                 LANDLOCK_ACCESS_FS_MAKE_FIFO | LANDLOCK_ACCESS_FS_MAKE_SYM;
// What the first version of Landlock knows; all of it is forbidden unless a rule allows it.
constexpr std::uint64_t kHandled = kRead | kWrite | LANDLOCK_ACCESS_FS_EXECUTE |
                                   LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_BLOCK;
// The rights that concern files; the kernel refuses the others in a rule for a file.
constexpr std::uint64_t kOfFiles = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE;

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] bool ok() const { return number_ >= 0; }

 private:
  const int number_;
};

// glibc has no functions for these system calls.
Descriptor CreateRuleset() {
  landlock_ruleset_attr attributes{};
  attributes.handled_access_fs = kHandled;
  return Descriptor(
      static_cast<int>(syscall(SYS_landlock_create_ruleset, &attributes, sizeof(attributes), 0)));
}

bool Allow(const Descriptor& ruleset, const std::filesystem::path& path, std::uint64_t access) {
  const Descriptor parent(open(path.c_str(), O_PATH | O_CLOEXEC));
  if (!parent.ok()) return errno == ENOENT || errno == EACCES || errno == ENOTDIR;
  struct stat found {};
  if (fstat(parent.number(), &found) != 0) return false;
  landlock_path_beneath_attr rule{};
  rule.allowed_access = S_ISDIR(found.st_mode) ? access : access & kOfFiles;
  rule.parent_fd = parent.number();
  return syscall(SYS_landlock_add_rule, ruleset.number(), LANDLOCK_RULE_PATH_BENEATH, &rule, 0) ==
         0;
}

// Returns why it was not possible; empty: it was.
std::string ConfineFiles(const Confinement& allowed) {
  const Descriptor ruleset = CreateRuleset();
  if (!ruleset.ok()) return std::strerror(errno);
  for (const auto& path : allowed.read) {
    if (!Allow(ruleset, path, kRead)) return path.string() + ": " + std::strerror(errno);
  }
  for (const auto& path : allowed.write) {
    if (!Allow(ruleset, path, kRead | kWrite)) return path.string() + ": " + std::strerror(errno);
  }
  if (syscall(SYS_landlock_restrict_self, ruleset.number(), 0) != 0) return std::strerror(errno);
  return {};
}

bool DropCapabilities() {
  __user_cap_header_struct header{};
  header.version = _LINUX_CAPABILITY_VERSION_3;
  __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3] = {};
  if (syscall(SYS_capget, &header, data) != 0) return false;
  for (auto& each : data) each.inheritable = 0;
  const std::uint32_t kept = 1u << CAP_NET_BIND_SERVICE;
  data[0].effective &= kept;
  data[0].permitted &= kept;
  data[1].effective = data[1].permitted = 0;
  return syscall(SYS_capset, &header, data) == 0;
}

}  // namespace

std::string Confine(const Confinement& allowed) {
  std::string held;
  const auto add = [&held](const std::string& what) { held += (held.empty() ? "" : ", ") + what; };
  // Landlock requires it of threads without capabilities.
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0) add("no new privileges");
  const rlimit none{0, 0};
  if (setrlimit(RLIMIT_CORE, &none) == 0) add("no core dumps");
  const std::string why = ConfineFiles(allowed);
  if (why.empty()) add("no programs, no files but its own");
  if (DropCapabilities()) add("no capabilities");
  const std::string unfiltered = FilterSystemCalls();  // last: it forbids the calls above
  if (unfiltered.empty()) add("only the system calls that it needs");
  if (!why.empty()) held += "; all files, because Landlock is unavailable: " + why;
  if (!unfiltered.empty())
    held += "; all system calls, because seccomp is unavailable: " + unfiltered;
  return held;
}

}  // namespace furrow::server
