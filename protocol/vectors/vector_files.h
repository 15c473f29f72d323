// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <span>
#include <string>

namespace furrow::protocol::vectors {

// The files of a folder of vectors: name and content.
using Files = std::map<std::string, std::string>;

// Compares the files with those of the folder and prints every difference. Returns the exit code.
inline int CheckFiles(const std::filesystem::path& folder, const Files& files) {
  int wrong = 0;
  for (const auto& [name, content] : files) {
    std::ifstream in(folder / name, std::ios::binary);
    const std::string found{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    if (found == content) continue;
    std::cerr << name << (in.is_open() ? ": differs from the encoder's output\n" : ": missing\n");
    ++wrong;
  }
  std::cout << files.size() << " files compared, " << wrong << " faults\n";
  return wrong == 0 ? 0 : 1;
}

// Writes the files into the folder. Returns the exit code.
inline int WriteFiles(const std::filesystem::path& folder, const Files& files) {
  for (const auto& [name, content] : files) {
    std::ofstream out(folder / name, std::ios::binary);
    if (!(out << content << std::flush)) {
      std::cerr << (folder / name).string() << ": cannot write the file\n";
      return 1;
    }
  }
  return 0;
}

// The main function of `program`, which makes vectors: [--check] FOLDER. `make` returns the files.
template <class Make>
int MakeOrCheck(const char* program, std::span<char* const> arguments, const Make& make) {
  const bool check = arguments.size() == 3 && std::strcmp(arguments[1], "--check") == 0;
  if (!check && arguments.size() != 2) {
    std::cerr << "usage: " << program << " [--check] FOLDER\n";
    return 2;
  }
  return check ? CheckFiles(arguments[2], make()) : WriteFiles(arguments[1], make());
}

}  // namespace furrow::protocol::vectors
