// SPDX-License-Identifier: Apache-2.0
#include "server/machine/syscall_filter.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <string_view>

#include <sched.h>
#include <seccomp.h>
#include <sys/socket.h>

namespace furrow::server {
namespace {

// By what they serve. The libraries below the daemon use them: libc, OpenSSL, spdlog, Mesa and
// other drivers. Names that an architecture or an older libseccomp does not know are left out.
constexpr std::string_view kMemory =
    "brk get_mempolicy madvise mbind membarrier memfd_create mincore mlock mlock2 mlockall "
    "mmap mmap2 mprotect mremap msync munlock munlockall munmap pkey_alloc pkey_free "
    "pkey_mprotect set_mempolicy shmat shmctl shmdt shmget";
// No fork() and no execve(). clone() has conditions below; libc calls it where clone3() fails.
constexpr std::string_view kThreads =
    "arch_prctl exit exit_group futex futex_time64 futex_waitv get_robust_list getcpu getpgid "
    "getpgrp getpid getppid getpriority getsid gettid kcmp prctl restart_syscall rseq "
    "rt_sigaction rt_sigpending rt_sigprocmask rt_sigreturn rt_sigsuspend rt_sigtimedwait "
    "rt_sigtimedwait_time64 sched_get_priority_max sched_get_priority_min sched_getaffinity "
    "sched_getattr sched_getparam sched_getscheduler sched_rr_get_interval sched_setaffinity "
    "sched_setattr sched_setparam sched_setscheduler sched_yield set_robust_list "
    "set_thread_area set_tid_address setpriority sigaltstack sigreturn tgkill";
constexpr std::string_view kClocks =
    "clock_getres clock_getres_time64 clock_gettime clock_gettime64 clock_nanosleep "
    "clock_nanosleep_time64 getitimer gettimeofday nanosleep setitimer time timer_create "
    "timer_delete timer_getoverrun timer_gettime timer_gettime64 timer_settime "
    "timer_settime64 timerfd_create timerfd_gettime timerfd_gettime64 timerfd_settime "
    "timerfd_settime64 times";
constexpr std::string_view kFiles =
    "_llseek access chdir chmod close close_range copy_file_range creat dup dup2 dup3 "
    "faccessat faccessat2 fadvise64 fadvise64_64 fallocate fchdir fchmod fchmodat fcntl "
    "fcntl64 fdatasync flock fstat fstat64 fstatat64 fstatfs fstatfs64 fsync ftruncate "
    "ftruncate64 getcwd getdents getdents64 inotify_add_watch inotify_init inotify_init1 "
    "inotify_rm_watch link linkat lseek lstat lstat64 mkdir mkdirat newfstatat open openat "
    "openat2 pread64 preadv preadv2 pwrite64 pwritev pwritev2 read readahead readlink "
    "readlinkat readv rename renameat renameat2 rmdir sendfile sendfile64 splice stat stat64 "
    "statfs statfs64 statx symlink symlinkat sync_file_range syncfs truncate truncate64 umask "
    "unlink unlinkat utime utimensat utimensat_time64 utimes write writev";
constexpr std::string_view kEvents =
    "epoll_create epoll_create1 epoll_ctl epoll_pwait epoll_pwait2 epoll_wait eventfd "
    "eventfd2 pipe pipe2 poll ppoll ppoll_time64 pselect6 pselect6_time64 select signalfd "
    "signalfd4";
constexpr std::string_view kSockets =
    "accept accept4 bind connect getpeername getsockname getsockopt listen recv recvfrom "
    "recvmmsg recvmmsg_time64 recvmsg send sendmmsg sendmsg sendto setsockopt shutdown "
    "socketpair";
constexpr std::string_view kProcess =
    "capget capset getegid getegid32 geteuid geteuid32 getgid getgid32 getgroups getgroups32 "
    "getrandom getresgid getresuid getrlimit getrusage getuid getuid32 ioctl prlimit64 "
    "setrlimit sysinfo ugetrlimit uname";
#ifdef __SANITIZE_ADDRESS__  // the leak checker stops all threads with it
constexpr std::string_view kDebugging = "ptrace wait4 waitid";
#else
constexpr std::string_view kDebugging;
#endif

constexpr int kSocketFamilies[] = {AF_UNIX, AF_INET, AF_INET6, AF_NETLINK};
constexpr scmp_datum_t kNamespaces = CLONE_NEWNS | CLONE_NEWCGROUP | CLONE_NEWUTS | CLONE_NEWIPC |
                                     CLONE_NEWUSER | CLONE_NEWPID | CLONE_NEWNET;

// 0, or the negated error of libseccomp.
int Allow(scmp_filter_ctx filter, std::string_view names) {
  while (!names.empty()) {
    const std::size_t end = std::min(names.find(' '), names.size());
    const int number = seccomp_syscall_resolve_name(std::string(names.substr(0, end)).c_str());
    names.remove_prefix(std::min(end + 1, names.size()));
    if (number == __NR_SCMP_ERROR) continue;
    const int error = seccomp_rule_add(filter, SCMP_ACT_ALLOW, number, 0);
    if (error != 0) return error;
  }
  return 0;
}

int AllowAll(scmp_filter_ctx filter) {
  int error = 0;
  for (const std::string_view names :
       {kMemory, kThreads, kClocks, kFiles, kEvents, kSockets, kProcess, kDebugging}) {
    if (error == 0) error = Allow(filter, names);
  }
  for (const int family : kSocketFamilies) {
    if (error != 0) break;
    error = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(socket), 1,
                             SCMP_A0(SCMP_CMP_EQ, static_cast<scmp_datum_t>(family)));
  }
  if (error == 0) {
    error = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(clone), 1,
                             SCMP_A0(SCMP_CMP_MASKED_EQ, kNamespaces, 0));
  }
  return error;
}

}  // namespace

std::string FilterSystemCalls() {
  const auto release = [](scmp_filter_ctx each) { seccomp_release(each); };
  const std::unique_ptr<void, decltype(release)> filter(seccomp_init(SCMP_ACT_ERRNO(ENOSYS)),
                                                        release);
  if (filter == nullptr) return "out of memory";
  int error = AllowAll(filter.get());
  // A binary search instead of one comparison after the other, for kernels that do not remember
  // which calls are always allowed (before 5.11).
  if (error == 0) error = seccomp_attr_set(filter.get(), SCMP_FLTATR_CTL_OPTIMIZE, 2);
  // All threads of the process get the filter, also those of libraries and drivers.
  if (error == 0) error = seccomp_attr_set(filter.get(), SCMP_FLTATR_CTL_TSYNC, 1);
  if (error == 0) error = seccomp_load(filter.get());
  return error == 0 ? std::string() : std::strerror(-error);
}

}  // namespace furrow::server
