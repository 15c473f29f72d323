// SPDX-License-Identifier: Apache-2.0
// Confinement cannot be undone, so every test confines a child process.
#include "server/machine/confine.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <future>
#include <string>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/epoll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/temporary_folder.h"

namespace furrow::server {
namespace {

// What a child found out. The names make failures readable.
enum Finding {
  kConfined = 0,
  kNoLandlock = 10,
  kWrong = 11,
};

// Runs `check` in a confined child. Returns its result. `checks_files`: without Landlock, it is not
// run.
int InChild(const Confinement& allowed, const std::function<int()>& check, bool checks_files) {
  const pid_t child = fork();
  if (child == 0) {
    const std::string held = Confine(allowed);
    (void)FinishConfinement();
    const bool has_landlock = held.find("Landlock is unavailable") == std::string::npos;
    if (checks_files && !has_landlock) _exit(kNoLandlock);
    if (held.find("no new privileges") == std::string::npos) _exit(kWrong);
    _exit(check());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

// 0: the file can be opened; else the error.
int Open(const std::filesystem::path& path, int flags) {
  const int file = open(path.c_str(), flags | O_CLOEXEC, 0600);
  if (file < 0) return errno;
  close(file);
  return 0;
}

class ConfineTest : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"read", "write", "other"}) {
      std::filesystem::create_directories(folder.path() / name);
      ASSERT_EQ(Open(folder.path() / name / "file", O_CREAT | O_WRONLY), 0);
    }
    allowed = {.read = {folder.path() / "read", folder.path() / "absent"},
               .write = {folder.path() / "write"}};
  }
  void Expect(const std::function<int()>& check) {
    const int found = InChild(allowed, check, /*checks_files=*/true);
    if (found == kNoLandlock) GTEST_SKIP() << "this kernel has no Landlock";
    EXPECT_EQ(found, kConfined);
  }
  [[nodiscard]] std::filesystem::path File(const char* of) const {
    return folder.path() / of / "file";
  }

  TemporaryFolder folder;
  Confinement allowed;
};

TEST_F(ConfineTest, OnlyTheListedFilesCanBeReadAndWritten) {
  Expect([this] {
    if (Open(File("read"), O_RDONLY) != 0) return 1;
    if (Open(File("read"), O_WRONLY) != EACCES) return 2;
    if (Open(folder.path() / "read" / "new", O_CREAT | O_WRONLY) != EACCES) return 3;
    if (Open(File("write"), O_RDWR) != 0) return 4;
    if (Open(folder.path() / "write" / "new", O_CREAT | O_WRONLY) != 0) return 5;
    if (Open(File("other"), O_RDONLY) != EACCES) return 6;
    if (Open("/etc/passwd", O_RDONLY) != EACCES) return 7;
    if (unlink(File("other").c_str()) == 0) return 8;
    if (rename(File("write").c_str(), (folder.path() / "write" / "moved").c_str()) != 0) return 9;
    return 0;
  });
}

TEST_F(ConfineTest, NoProgramCanBeRun) {
  allowed.read.emplace_back("/");
  const auto check = [] {
    execl("/bin/true", "true", nullptr);
    return errno == EACCES || errno == ENOSYS ? 0 : 1;
  };
  EXPECT_EQ(InChild(allowed, check, /*checks_files=*/false), kConfined);
}

TEST_F(ConfineTest, ThreadsInheritIt) {
  Expect([this] {
    int found = 1;
    std::thread([&] { found = Open(File("other"), O_RDONLY) == EACCES ? 0 : 2; }).join();
    return found;
  });
}

// Libraries start threads before helper programs have run.
TEST_F(ConfineTest, RunningThreadsRunNoProgramsEither) {
  const pid_t child = fork();
  if (child == 0) {
    (void)Confine({.read = {"/"}, .write = {}, .run = {"/"}});
    std::promise<void> confined;
    int found = 1;
    std::thread former([&] {
      confined.get_future().wait();
      found = syscall(SYS_fork) == -1 && errno == ENOSYS ? 0 : 2;
    });
    const std::string held = FinishConfinement();
    confined.set_value();
    former.join();
    _exit(held.find("no programs") == std::string::npos ? 3 : found);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST_F(ConfineTest, ProgramsRunUntilItIsFinished) {
  const pid_t child = fork();
  if (child == 0) {
    (void)Confine({.read = {}, .write = {}, .run = {"/usr", "/bin", "/lib", "/lib64"}});
    const pid_t program = fork();
    if (program == 0) {
      execl("/bin/true", "true", nullptr);
      _exit(1);
    }
    int status = 0;
    if (waitpid(program, &status, 0) != program || status != 0) _exit(1);
    (void)FinishConfinement();
    execl("/bin/true", "true", nullptr);
    _exit(errno == EACCES || errno == ENOSYS ? 0 : 2);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST_F(ConfineTest, ThereAreNoPrivilegesAndNoCoreDumps) {
  const auto check = [] {
    if (prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0) != 1) return 1;
    rlimit cores{1, 1};
    if (getrlimit(RLIMIT_CORE, &cores) != 0 || cores.rlim_max != 0) return 2;
    // Becoming another user needs a capability, also for root.
    if (geteuid() == 0 && seteuid(1) == 0) return 3;
    return 0;
  };
  EXPECT_EQ(InChild(allowed, check, /*checks_files=*/false), kConfined);
}

// The kernel refuses it, whoever asks.
bool IsForbidden(long result) { return result == -1 && errno == ENOSYS; }

TEST_F(ConfineTest, OnlyTheNeededSystemCallsCanBeMade) {
  const auto check = [] {
    if (!IsForbidden(syscall(SYS_fork))) return 1;
#ifndef __SANITIZE_ADDRESS__  // its leak checker stops all threads by ptrace
    if (!IsForbidden(syscall(SYS_ptrace, 0, 0, 0, 0))) return 2;
#endif
    if (!IsForbidden(unshare(CLONE_NEWUSER))) return 3;
    if (!IsForbidden(syscall(SYS_io_uring_setup, 1, nullptr))) return 4;
    if (!IsForbidden(syscall(SYS_bpf, 0, nullptr, 0))) return 5;
    if (!IsForbidden(syscall(SYS_clone, CLONE_NEWUSER | SIGCHLD, nullptr))) return 6;
    if (!IsForbidden(socket(AF_PACKET, SOCK_RAW, 0))) return 7;
    if (!IsForbidden(kill(getppid(), 0))) return 8;
    return 0;
  };
  EXPECT_EQ(InChild(allowed, check, /*checks_files=*/false), kConfined);
}

TEST_F(ConfineTest, ThreadsSocketsAndClocksGoOnWorking) {
  const auto check = [] {
    bool ran = false;
    std::thread([&ran] { ran = true; }).join();
    if (!ran) return 1;
    const int udp = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const int tcp = socket(AF_INET6, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (udp < 0 || (tcp < 0 && errno == ENOSYS)) return 2;
    sockaddr_in any{};
    any.sin_family = AF_INET;
    if (bind(udp, reinterpret_cast<const sockaddr*>(&any), sizeof(any)) != 0) return 3;
    if (epoll_create1(EPOLL_CLOEXEC) < 0) return 4;
    timespec time{};
    if (clock_gettime(CLOCK_MONOTONIC, &time) != 0) return 5;
    void* const code =
        mmap(nullptr, 4096, PROT_READ | PROT_WRITE | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return code == MAP_FAILED ? 6 : 0;  // software renderers compile their shaders
  };
  EXPECT_EQ(InChild(allowed, check, /*checks_files=*/false), kConfined);
}

}  // namespace
}  // namespace furrow::server
