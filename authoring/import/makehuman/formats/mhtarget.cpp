// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/mhtarget.h"

#include <cmath>
#include <optional>

#include "authoring/import/makehuman/formats/npy.h"
#include "base/files.h"
#include "base/numbers.h"
#include "base/text.h"
#include "base/text_cursor.h"

namespace furrow::authoring {
namespace {

constexpr float kMaxOffset = 1000.0f;
constexpr float kArrayUnit = 1e-3f;  // decimetres

Status CheckArrays(const NpyArray& index, const NpyArray& vector, std::string_view source) {
  if (index.type != "<u2" || index.shape.size() != 1)
    return {StatusCode::kSchema, "the indices are not one row of uint16", std::string(source)};
  const std::size_t count = index.num_values();
  const bool empty = count == 0 && vector.num_values() == 0;
  const bool three = vector.shape.size() == 2 && vector.shape[1] == 3;
  if (vector.type != "<i2" || (!empty && !(three && vector.shape[0] == count)))
    return {StatusCode::kSchema, "the offsets are not three int16 per index", std::string(source)};
  return {};
}

Status ParseIndex(std::string_view word, std::size_t num_base, const TextCursor& cursor,
                  std::uint32_t* index) {
  const std::optional<long> value = ToInteger(word);
  if (!value) return cursor.Error(StatusCode::kParse, Quoted(word) + " is not a vertex index");
  if (*value < 0 || static_cast<std::size_t>(*value) >= num_base)
    return cursor.Error(StatusCode::kInvalidArgument, "vertex index " + std::string(word) +
                                                          " is out of range; the base mesh has " +
                                                          Counted(num_base, "vertex", "vertices"));
  *index = static_cast<std::uint32_t>(*value);
  return {};
}

Status ParseOffset(std::string_view word, const TextCursor& cursor, float* offset) {
  const std::optional<float> value = ToFloat(word);
  if (!value) return cursor.Error(StatusCode::kParse, Quoted(word) + " is not a number");
  if (!std::isfinite(*value))
    return cursor.Error(StatusCode::kNonFinite, Quoted(word) + " is not finite");
  if (!(std::abs(*value) < kMaxOffset))
    return cursor.Error(StatusCode::kLimit, Quoted(word) + " is not in (-1000, 1000)");
  *offset = *value;
  return {};
}

}  // namespace

Result<MhTarget> ParseMhTarget(std::string_view text, std::string_view source,
                               std::size_t num_base_vertices) {
  if (IsGitLfsPointer(text))
    return Status(StatusCode::kUnsupported, "the file is a Git LFS pointer, not a target",
                  std::string(source), "run 'git lfs pull' in the data folder");
  TextCursor cursor(text, source);
  MhTarget target;
  std::string_view line;
  std::vector<std::string_view> words;
  while (cursor.NextLine(&line)) {
    SplitWords(line, &words);
    if (words.empty()) continue;
    if (words.size() != 4)
      return cursor.Error(StatusCode::kParse,
                          "a line needs a vertex index and three numbers; it "
                          "has " +
                              Counted(words.size(), "word"));
    if (target.vertices.size() >= num_base_vertices)
      return cursor.Error(StatusCode::kLimit,
                          "the file has more lines than the base mesh has "
                          "vertices");
    std::uint32_t index = 0;
    glm::vec3 offset{0.0f};
    FURROW_RETURN_IF_ERROR(ParseIndex(words[0], num_base_vertices, cursor, &index));
    for (int axis = 0; axis < 3; ++axis) {
      FURROW_RETURN_IF_ERROR(
          ParseOffset(words[static_cast<std::size_t>(axis) + 1], cursor, &offset[axis]));
    }
    target.vertices.push_back(index);
    target.offsets.push_back(offset);
  }
  return target;
}

Result<MhTarget> ParseMhTargetArrays(std::string_view index_npy, std::string_view vector_npy,
                                     std::string_view source, std::size_t num_base_vertices) {
  const Result<NpyArray> index = ParseNpy(index_npy, source);
  FURROW_RETURN_IF_ERROR(index);
  const Result<NpyArray> vector = ParseNpy(vector_npy, source);
  FURROW_RETURN_IF_ERROR(vector);
  FURROW_RETURN_IF_ERROR(CheckArrays(*index, *vector, source));
  if (index->num_values() > num_base_vertices)
    return Status(StatusCode::kLimit, "the target has more vertices than the base mesh",
                  std::string(source));
  MhTarget target;
  for (std::size_t i = 0; i < index->num_values(); ++i) {
    const long vertex = index->At(i);
    if (static_cast<std::size_t>(vertex) >= num_base_vertices)
      return Status(StatusCode::kInvalidArgument,
                    "vertex index " + std::to_string(vertex) +
                        " is out of range; the base mesh has " +
                        Counted(num_base_vertices, "vertex", "vertices"),
                    std::string(source));
    target.vertices.push_back(static_cast<std::uint32_t>(vertex));
    target.offsets.push_back(
        kArrayUnit * glm::vec3(vector->At(3 * i), vector->At(3 * i + 1), vector->At(3 * i + 2)));
  }
  return target;
}

void ApplyMhTarget(const MhTarget& target, float weight, std::span<glm::vec3> positions) {
  for (std::size_t i = 0; i < target.vertices.size(); ++i) {
    positions[target.vertices[i]] += weight * target.offsets[i];
  }
}

}  // namespace furrow::authoring
