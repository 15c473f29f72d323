// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/vrm_expressions.h"

#include <algorithm>
#include <utility>

#include <tiny_gltf.h>

#include "base/text.h"
#include "gltf/document/json_value.h"
#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

using tinygltf::Value;

std::size_t LengthOf(const Value& value) { return value.IsArray() ? value.ArrayLen() : 0; }

std::string TextOf(const Value& value) {
  return value.IsString() ? value.Get<std::string>() : std::string();
}

// What the expressions of a file say and this reader does not do.
struct Ignored {
  std::size_t missing_targets = 0;
  std::size_t materials = 0;
};

class Reader {
 public:
  explicit Reader(Document* document) : document_(*document) {}

  Result<std::vector<VrmExpression>> Run() {
    const auto& extensions = document_.model().extensions;
    if (const auto found = extensions.find("VRMC_vrm"); found != extensions.end()) {
      FURROW_RETURN_IF_ERROR(ReadVersion1(Member(found->second, "expressions")));
    } else if (const auto old = extensions.find("VRM"); old != extensions.end()) {
      FURROW_RETURN_IF_ERROR(
          ReadVersion0(Member(Member(old->second, "blendShapeMaster"), "blendShapeGroups")));
    }
    Warn();
    return std::move(expressions_);
  }

 private:
  Status ReadVersion0(const Value& groups) {
    FURROW_RETURN_IF_ERROR(CheckCount(LengthOf(groups), "VRM.blendShapeMaster.blendShapeGroups"));
    for (std::size_t i = 0; i < LengthOf(groups); ++i) {
      const Value& group = groups.Get(static_cast<int>(i));
      const std::string preset = TextOf(Member(group, "presetName"));
      Begin(preset.empty() || preset == "unknown" ? TextOf(Member(group, "name")) : preset);
      ignored_.materials += LengthOf(Member(group, "materialValues"));
      const Value& binds = Member(group, "binds");
      for (std::size_t k = 0; k < LengthOf(binds); ++k) {
        const Value& bind = binds.Get(static_cast<int>(k));
        const Value& mesh = Member(bind, "mesh");
        AddBind(mesh.IsInt() ? mesh.GetNumberAsInt() : -1, bind, 0.01);  // percent
      }
      FURROW_RETURN_IF_ERROR(End());
    }
    return {};
  }

  Status ReadVersion1(const Value& expressions) {
    for (const char* kind : {"preset", "custom"}) {
      const Value& named = Member(expressions, kind);
      if (!named.IsObject()) continue;
      const std::vector<std::string> names = named.Keys();
      FURROW_RETURN_IF_ERROR(CheckCount(names.size(), std::string("VRMC_vrm.expressions.") + kind));
      for (const std::string& name : names) {
        FURROW_RETURN_IF_ERROR(ReadExpression1(name, named.Get(name)));
      }
    }
    return {};
  }

  Status ReadExpression1(const std::string& name, const Value& from) {
    Begin(name);
    ignored_.materials += LengthOf(Member(from, "materialColorBinds")) +
                          LengthOf(Member(from, "textureTransformBinds"));
    const Value& binds = Member(from, "morphTargetBinds");
    const auto& nodes = document_.model().nodes;
    for (std::size_t k = 0; k < LengthOf(binds); ++k) {
      const Value& bind = binds.Get(static_cast<int>(k));
      const Value& node = Member(bind, "node");
      const int index = node.IsInt() ? node.GetNumberAsInt() : -1;
      const bool exists = index >= 0 && index < static_cast<int>(nodes.size());
      AddBind(exists ? nodes[static_cast<std::size_t>(index)].mesh : -1, bind, 1.0);
    }
    return End();
  }

  void Begin(const std::string& name) { present_ = {CutText(name, kMaxNameBytes), {}}; }

  void AddBind(int mesh, const Value& bind, double scale) {
    const Value& index = Member(bind, "index");
    const Value& weight = Member(bind, "weight");
    const int target = index.IsInt() ? index.GetNumberAsInt() : -1;
    const bool exists = mesh >= 0 && mesh < static_cast<int>(document_.num_meshes()) &&
                        target >= 0 &&
                        static_cast<std::size_t>(target) < document_.NumMorphTargets(mesh);
    if (!exists) {
      ++ignored_.missing_targets;
      return;
    }
    const double full = weight.IsNumber() ? scale * weight.GetNumberAsDouble() : 1.0;
    const auto limited = static_cast<float>(std::clamp(full, 0.0, 1.0));
    if (limited > 0.0f) present_.binds.push_back({mesh, target, limited});
  }

  Status End() {
    binds_ += present_.binds.size();
    if (binds_ > kMaxVrmBinds) {
      return {StatusCode::kLimit,
              "the expressions have more than " + std::to_string(kMaxVrmBinds) + " binds",
              "extensions.VRM"};
    }
    if (!present_.name.empty() && !present_.binds.empty()) {
      expressions_.push_back(std::move(present_));
    }
    return {};
  }

  static Status CheckCount(std::size_t count, const std::string& field) {
    if (count <= kMaxVrmNodes) return {};
    return {StatusCode::kLimit, "more than " + std::to_string(kMaxVrmNodes) + " entries",
            "extensions." + field};
  }

  void Warn() {
    const auto warn = [&](std::size_t count, const char* one, const char* many, const char* what) {
      if (count > 0) document_.Warn("extensions.VRM", Counted(count, one, many) + what);
    };
    warn(ignored_.missing_targets, "ignored bind", "ignored binds",
         " of expressions to morph targets that do not exist");
    warn(ignored_.materials, "ignored bind", "ignored binds",
         " of expressions to colours or textures of materials; to show such an expression, bind a "
         "morph target that moves a mesh with the other colour or texture out of the face");
  }

  Document& document_;
  VrmExpression present_;
  std::vector<VrmExpression> expressions_;
  std::size_t binds_ = 0;
  Ignored ignored_;
};

}  // namespace

Result<std::vector<VrmExpression>> ReadVrmExpressions(Document* document) {
  return Reader(document).Run();
}

}  // namespace furrow::gltf
