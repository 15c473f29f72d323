// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/mhclo.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/numbers.h"
#include "base/status.h"
#include "base/text.h"
#include "base/text_cursor.h"

namespace furrow::authoring {
namespace {

// Reads a garment line by line. Every index is checked against the base mesh, so fitting needs no
// checks.
class MhcloParser {
 public:
  MhcloParser(std::string_view text, std::string_view source, std::size_t num_base)
      : cursor_(text, source), source_(source), num_base_(num_base) {
    garment_.deleted.assign(num_base, false);
  }

  Result<Mhclo> Run() {
    std::string_view line;
    while (cursor_.NextLine(&line)) {
      SplitWords(line, &words_);
      if (words_.empty()) continue;
      FURROW_RETURN_IF_ERROR(Statement());
    }
    if (garment_.obj_file.empty())
      return Status(StatusCode::kSchema, "the file has no line 'obj_file'", std::string(source_));
    if (garment_.vertices.empty())
      return Status(StatusCode::kSchema, "the file lists no vertices after 'verts'",
                    std::string(source_));
    return std::move(garment_);
  }

 private:
  enum class Section { kHeader, kVertices, kDeleted, kOther };

  Status Statement() {
    const std::string_view word = words_.front();
    if (word == "verts") return Enter(Section::kVertices);
    if (word == "delete_verts") return Enter(Section::kDeleted);
    const bool number = ToFloat(word).has_value();
    if (number && section_ == Section::kVertices) return Vertex();
    if (number && section_ == Section::kDeleted) return Deleted();
    if (number)
      return section_ == Section::kOther
                 ? Status()
                 : Error(StatusCode::kParse, "expected a keyword such as 'verts', found a number");
    if (word == "weights") return Enter(Section::kOther);
    return Keyword(word);  // does not end the section
  }

  Status Enter(Section section) {
    section_ = section;
    return {};
  }

  Status Keyword(std::string_view word) {
    if (word == "name" && words_.size() > 1) garment_.name = std::string(words_[1]);
    if (word == "obj_file") return ObjFile();
    if (word == "x_scale") return Scale(0);
    if (word == "y_scale") return Scale(1);
    if (word == "z_scale") return Scale(2);
    if (word == "material" && words_.size() > 1) Material();
    if (word == "z_depth" && words_.size() > 1) {
      const std::optional<long> depth = ToInteger(words_[1]);
      if (depth) garment_.z_depth = static_cast<int>(std::clamp(*depth, -1000l, 1000l));
    }
    return {};  // tag, basemesh, ...: not used
  }

  // File names may contain blanks.
  void Material() {
    garment_.material.assign(words_[1]);
    for (std::size_t i = 2; i < words_.size(); ++i) {
      garment_.material += ' ';
      garment_.material += words_[i];
    }
  }

  Status Error(StatusCode code, std::string what) const {
    return cursor_.Error(code, std::move(what));
  }

  // A path would let a garment read files outside its folder.
  Status ObjFile() {
    if (words_.size() != 2 || words_[1].find_first_of("/\\") != std::string_view::npos ||
        words_[1] == "..")
      return Error(StatusCode::kSchema, "obj_file must be one file name without a folder");
    garment_.obj_file = std::string(words_[1]);
    return {};
  }

  Status BaseIndex(std::string_view word, std::uint32_t* index) const {
    const std::optional<long> value = ToInteger(word);
    if (!value) return Error(StatusCode::kParse, Quoted(word) + " is not a vertex index");
    if (*value < 0 || static_cast<std::size_t>(*value) >= num_base_)
      return Error(StatusCode::kInvalidArgument, "vertex index " + std::string(word) +
                                                     " is out of range; the base mesh has " +
                                                     Counted(num_base_, "vertex", "vertices"));
    *index = static_cast<std::uint32_t>(*value);
    return {};
  }

  Status Number(std::string_view word, float* number) const {
    const std::optional<float> value = ToFloat(word);
    if (!value) return Error(StatusCode::kParse, Quoted(word) + " is not a number");
    if (!std::isfinite(*value))
      return Error(StatusCode::kNonFinite, Quoted(word) + " is not finite");
    *number = *value;
    return {};
  }

  Status Scale(std::size_t axis) {
    if (words_.size() < 4)
      return Error(StatusCode::kParse, "a scale needs two vertex indices and a length");
    Mhclo::Scale scale;
    FURROW_RETURN_IF_ERROR(BaseIndex(words_[1], &scale.first));
    FURROW_RETURN_IF_ERROR(BaseIndex(words_[2], &scale.second));
    FURROW_RETURN_IF_ERROR(Number(words_[3], &scale.extent));
    // FitGarment() divides by it.
    if (!(std::abs(scale.extent) > 1e-6f))
      return Error(StatusCode::kSchema,
                   "the length of a scale must be more than 0.000001 or less than -0.000001");
    garment_.scales[axis] = scale;
    return {};
  }

  // Nine numbers. A single number places the vertex exactly on that base vertex.
  Status Vertex() {
    Mhclo::GarmentVertex vertex;
    if (words_.size() != 1 && words_.size() < 9)
      return Error(StatusCode::kParse,
                   "a vertex needs 1 or 9 numbers; the line has " + std::to_string(words_.size()));
    FURROW_RETURN_IF_ERROR(BaseIndex(words_[0], &vertex.base[0]));
    if (words_.size() == 1) {
      vertex.base[1] = vertex.base[2] = vertex.base[0];
      vertex.weights = {1.0f, 0.0f, 0.0f};
      garment_.vertices.push_back(vertex);
      return {};
    }
    for (std::size_t i = 1; i < 3; ++i) {
      FURROW_RETURN_IF_ERROR(BaseIndex(words_[i], &vertex.base[i]));
    }
    for (std::size_t i = 0; i < 3; ++i) {
      FURROW_RETURN_IF_ERROR(Number(words_[3 + i], &vertex.weights[i]));
      float& offset = vertex.offset[static_cast<int>(i)];
      FURROW_RETURN_IF_ERROR(Number(words_[6 + i], &offset));
    }
    garment_.vertices.push_back(vertex);
    return {};
  }

  // "12 15 - 18 20": single vertices and inclusive ranges.
  Status Deleted() {
    for (std::size_t i = 0; i < words_.size(); ++i) {
      std::uint32_t first = 0;
      FURROW_RETURN_IF_ERROR(BaseIndex(words_[i], &first));
      std::uint32_t last = first;
      if (i + 1 < words_.size() && words_[i + 1] == "-") {
        if (i + 2 >= words_.size())
          return Error(StatusCode::kParse,
                       "the range that starts at " + std::to_string(first) + " has no end");
        FURROW_RETURN_IF_ERROR(BaseIndex(words_[i + 2], &last));
        if (last < first)
          return Error(StatusCode::kInvalidArgument, "the range " + std::to_string(first) + " - " +
                                                         std::to_string(last) +
                                                         " ends before it starts");
        i += 2;
      }
      for (std::uint32_t vertex = first; vertex <= last; ++vertex) garment_.deleted[vertex] = true;
    }
    return {};
  }

  TextCursor cursor_;
  std::string_view source_;
  std::size_t num_base_;
  std::vector<std::string_view> words_;
  Section section_ = Section::kHeader;
  Mhclo garment_;
};

}  // namespace

Result<Mhclo> ParseMhclo(std::string_view text, std::string_view source,
                         std::size_t num_base_vertices) {
  return MhcloParser(text, source, num_base_vertices).Run();
}

std::vector<glm::vec3> FitGarment(const Mhclo& garment, std::span<const glm::vec3> base) {
  glm::vec3 scale(1.0f);
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<Mhclo::Scale>& reference = garment.scales[static_cast<std::size_t>(axis)];
    if (!reference) continue;
    scale[axis] =
        std::abs(base[reference->first][axis] - base[reference->second][axis]) / reference->extent;
  }
  std::vector<glm::vec3> fitted;
  fitted.reserve(garment.vertices.size());
  for (const Mhclo::GarmentVertex& vertex : garment.vertices) {
    glm::vec3 position = vertex.offset * scale;
    for (std::size_t i = 0; i < 3; ++i) position += vertex.weights[i] * base[vertex.base[i]];
    fitted.push_back(position);
  }
  return fitted;
}

}  // namespace furrow::authoring
