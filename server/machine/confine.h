// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace furrow::server {

// What a confined thread may still do with files. Folders include all that is below them; paths
// that do not exist are left out.
struct Confinement {
  std::vector<std::filesystem::path> read;   // files and folders
  std::vector<std::filesystem::path> write;  // folders, and devices; readable, too
  std::vector<std::filesystem::path> run;    // programs, until FinishConfinement()
};

// Gives up what a daemon does not need, so that a fault in it is worth less to an attacker. There
// are two steps, and nothing of them can be undone. Each returns what holds now, for the log.
//
// The first step holds for the calling thread and for all threads that it starts from now on, so
// call it before the process has any other thread:
//
// - It gains no privileges by running a program (PR_SET_NO_NEW_PRIVS).
// - It has no capabilities, except that of opening ports below 1024.
// - It leaves no core dump, which would hold keys and tokens. This concerns the whole process.
// - Where the kernel has Landlock (5.13), it reads, writes and runs only what is `allowed`.
[[nodiscard]] std::string Confine(const Confinement& allowed);

// The second step, once helper programs have run:
//
// - All threads of the process, also those of libraries and drivers, make only the system calls
//   that a daemon needs, and so run no programs; see FilterSystemCalls().
// - Where the kernel has Landlock, the calling thread runs no programs in any case.
[[nodiscard]] std::string FinishConfinement();

}  // namespace furrow::server
