// SPDX-License-Identifier: Apache-2.0
#include "server/machine/confine.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <linux/capability.h>
#include <linux/landlock.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "base/process/descriptor.h"
#include "server/machine/syscall_filter.h"

namespace furrow::server {
namespace {

constexpr std::uint64_t kRead = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
// Since the third version of Landlock; older headers lack it.
constexpr std::uint64_t kTruncate = std::uint64_t{1} << 14;
// In the first version of Landlock, nothing moves from folder to folder (REFER).
constexpr std::uint64_t kWrite = LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_DIR |
                                 LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_MAKE_DIR |
                                 LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_MAKE_SOCK |
                                 LANDLOCK_ACCESS_FS_MAKE_FIFO | LANDLOCK_ACCESS_FS_MAKE_SYM |
                                 LANDLOCK_ACCESS_FS_REFER | kTruncate;
constexpr std::uint64_t kRun = LANDLOCK_ACCESS_FS_EXECUTE;
// All of it is forbidden unless a rule allows it.
constexpr std::uint64_t kHandled =
    kRead | kWrite | kRun | LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_BLOCK;
// The rights that concern files; the kernel refuses the others in a rule for a file.
constexpr std::uint64_t kOfFiles =
    LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE | kRun | kTruncate;

// glibc has no functions for these system calls.
Descriptor CreateRuleset(std::uint64_t handled) {
  landlock_ruleset_attr attributes{};
  attributes.handled_access_fs = handled;
  return Descriptor(
      static_cast<int>(syscall(SYS_landlock_create_ruleset, &attributes, sizeof(attributes), 0)));
}

// What this kernel's version of Landlock can forbid; it refuses a ruleset that handles more.
std::uint64_t KnownAccess() {
  const long version =
      syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  std::uint64_t known = ~std::uint64_t{0};
  if (version < 2) known &= ~std::uint64_t{LANDLOCK_ACCESS_FS_REFER};
  if (version < 3) known &= ~kTruncate;
  return known;
}

bool Restrict(const Descriptor& ruleset) {
  return syscall(SYS_landlock_restrict_self, ruleset.get(), 0) == 0;
}

bool Allow(const Descriptor& ruleset, const std::filesystem::path& path, std::uint64_t access) {
  const Descriptor parent(open(path.c_str(), O_PATH | O_CLOEXEC));
  if (!parent.ok()) return errno == ENOENT || errno == EACCES || errno == ENOTDIR;
  struct stat found {};
  if (fstat(parent.get(), &found) != 0) return false;
  landlock_path_beneath_attr rule{};
  rule.allowed_access = S_ISDIR(found.st_mode) ? access : access & kOfFiles;
  rule.parent_fd = parent.get();
  return syscall(SYS_landlock_add_rule, ruleset.get(), LANDLOCK_RULE_PATH_BENEATH, &rule, 0) == 0;
}

// Returns why it was not possible; empty: it was.
std::string ConfineFiles(const Confinement& allowed) {
  const std::uint64_t known = KnownAccess();
  const Descriptor ruleset = CreateRuleset(kHandled & known);
  if (!ruleset.ok()) return std::strerror(errno);
  for (const auto& [paths, access] :
       {std::pair(&allowed.read, kRead), std::pair(&allowed.write, kRead | kWrite),
        std::pair(&allowed.run, kRead | kRun)}) {
    for (const auto& path : *paths) {
      if (!Allow(ruleset, path, access & known)) return path.string() + ": " + std::strerror(errno);
    }
  }
  return Restrict(ruleset) ? std::string() : std::strerror(errno);
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
  add(why.empty() ? "no files but its own" : "all files, because Landlock is unavailable: " + why);
  if (DropCapabilities()) add("no capabilities");
  return held;
}

std::string FinishConfinement() {
  const Descriptor no_programs = CreateRuleset(kRun);
  const bool forbidden = no_programs.ok() && Restrict(no_programs);
  const std::string why = FilterSystemCalls();
  if (why.empty()) return "no programs, only the system calls that it needs";
  return std::string(forbidden ? "no programs in the main thread, " : "") +
         "all system calls, because seccomp is unavailable: " + why;
}

}  // namespace furrow::server
