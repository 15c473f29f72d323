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
};

// Gives up what a daemon does not need, so that a fault in it is worth less to an attacker, for the
// calling thread and for all threads that it starts from now on:
//
// - It gains no privileges by running a program (PR_SET_NO_NEW_PRIVS).
// - It has no capabilities, except that of opening ports below 1024.
// - It leaves no core dump, which would hold keys and tokens. This concerns the whole process.
// - Where the kernel has Landlock (5.13), it reads and writes only `allowed`, and runs no programs.
// - It makes only the system calls that it needs; see FilterSystemCalls().
//
// Nothing of this can be undone. Returns what holds now, for the log.
[[nodiscard]] std::string Confine(const Confinement& allowed);

}  // namespace furrow::server
