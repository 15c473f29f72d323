// SPDX-License-Identifier: Apache-2.0
// MakeHuman's targets.npz: indices of a target are in range, and so are the sizes of arrays. The
// archive's checksums stop most changes, so the arrays are also read alone.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "authoring/import/makehuman/formats/mhtarget.h"
#include "authoring/import/makehuman/formats/npy.h"
#include "authoring/import/makehuman/formats/npz.h"

namespace {

using namespace furrow::authoring;

void CheckArray(std::string_view bytes) {
  const auto array = ParseNpy(bytes, "fuzz.npy");
  if (!array.ok()) return;
  for (std::size_t i = 0; i < array->num_values(); ++i) {
    if (array->At(i) < -32768 || array->At(i) > 65535) std::abort();
  }
}

void CheckTarget(std::string_view index, std::string_view vector) {
  constexpr std::size_t kVertices = 100;
  const auto target = ParseMhTargetArrays(index, vector, "fuzz.npz", kVertices);
  if (!target.ok()) return;
  if (target->vertices.size() != target->offsets.size()) std::abort();
  for (const std::uint32_t vertex : target->vertices) {
    if (vertex >= kVertices) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  CheckArray(bytes);
  const std::size_t half = bytes.find("\x93NUMPY", 1);
  if (half != std::string_view::npos) CheckTarget(bytes.substr(0, half), bytes.substr(half));
  const auto archive = NpzArchive::Open(std::string(bytes), "fuzz.npz");
  if (!archive.ok()) return 0;
  std::string last;
  archive->ForEachName([&](const std::string& name) {
    auto entry = archive->Read(name);
    if (!entry.ok()) return;
    CheckArray(*entry);
    CheckTarget(last, *entry);
    last = std::move(*entry);
  });
  return 0;
}
