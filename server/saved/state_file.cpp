// SPDX-License-Identifier: Apache-2.0
#include "server/saved/state_file.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/process/descriptor.h"
#include "protocol/secure/crypto/secret.h"

namespace furrow::server {
namespace {

constexpr int kSizeSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;

Status Failed(const std::string& what) {
  return {StatusCode::kIo, what + ": " + std::strerror(errno)};
}

// Moves all bytes between the file, from `place` on, and memory. `call`: pread() or pwrite().
template <class Byte, class Call>
bool MoveAll(Call call, int file, std::span<Byte> bytes, std::size_t place = 0) {
  while (!bytes.empty()) {
    const ssize_t size = call(file, bytes.data(), bytes.size(), static_cast<off_t>(place));
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return false;
    place += static_cast<std::size_t>(size);
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
  return true;
}

bool Wipe(int file, std::size_t size) {
  constexpr std::size_t kPiece = std::size_t{64} << 10;
  const std::vector<std::uint8_t> zeros(std::min(size, kPiece));
  for (std::size_t place = 0; place < size; place += zeros.size()) {
    const auto piece = std::span(zeros).first(std::min(size - place, zeros.size()));
    if (!MoveAll(pwrite, file, piece, place)) return false;
  }
  return true;
}

}  // namespace

Result<int> MakeStateFile(std::span<const std::uint8_t> bytes) {
  Descriptor file(memfd_create("furrow-sessions", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!file.ok()) return Failed("cannot make a file in memory");
  if (!MoveAll(pwrite, file.get(), bytes) || fcntl(file.get(), F_ADD_SEALS, kSizeSeals) != 0) {
    return Failed("cannot write the file in memory");
  }
  return file.Release();
}

Result<std::vector<std::uint8_t>> TakeStateFile(int number) {
  const Descriptor file(number);
  // Only a file in memory has seals. With them, its size cannot change while it is read.
  const int seals = fcntl(number, F_GET_SEALS);
  struct stat info {};
  if (seals < 0 || (seals & kSizeSeals) != kSizeSeals || fstat(number, &info) != 0) {
    return Status(StatusCode::kIo, "not a sealed file in memory");
  }
  const auto size = static_cast<std::size_t>(info.st_size);
  if (size > kMaxStateBytes) return Status(StatusCode::kLimit, "the file in memory is too large");
  std::vector<std::uint8_t> bytes(size);
  const bool is_read = MoveAll(pread, number, std::span(bytes));
  if (!Wipe(number, size) || !is_read) {
    protocol::secure::Wipe(bytes);
    return Failed("cannot read and wipe the file in memory");
  }
  return bytes;
}

void DestroyStateFile(int number) {
  const Descriptor file(number);
  struct stat info {};
  if (fstat(number, &info) == 0) (void)Wipe(number, static_cast<std::size_t>(info.st_size));
}

}  // namespace furrow::server
