// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace furrow::server {

// Leaves all threads of the process, and those that they start, the system calls that a daemon
// needs: its files, sockets, threads, clocks and devices (seccomp). The kernel answers all
// others as a kernel does that lacks them (ENOSYS). So a fault in the daemon reaches less of the
// kernel: no programs, no debugging of other processes, no mounts, no namespaces, no kernel
// modules, no BPF, no io_uring, no keys of the kernel, and sockets only of IPv4, IPv6, Unix and
// netlink.
//
// This cannot be undone. The calling thread must have given up new privileges
// (PR_SET_NO_NEW_PRIVS). Returns why it was not possible; empty: it holds now.
[[nodiscard]] std::string FilterSystemCalls();

}  // namespace furrow::server
