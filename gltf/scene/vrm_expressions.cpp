// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/vrm_expressions.h"

#include <algorithm>
#include <utility>

#include <tiny_gltf.h>

#include "base/text.h"
#include "gltf/document/json_value.h"
#include "gltf/limits.h"
#include "gltf/scene/expression_list.h"

namespace furrow::gltf {
namespace {

using tinygltf::Value;

class Reader {
 public:
  explicit Reader(Document* document) : document_(*document) {}

  Result<std::vector<VrmExpression>> Run() {
    const std::vector<ExpressionObject> list = ListExpressions(document_);
    if (list.size() > kMaxVrmNodes) {
      return Status(StatusCode::kLimit,
                    "more than " + std::to_string(kMaxVrmNodes) + " expressions", "extensions.VRM");
    }
    for (const ExpressionObject& expression : list) {
      FURROW_RETURN_IF_ERROR(Read(expression));
    }
    Warn();
    return std::move(expressions_);
  }

 private:
  Status Read(const ExpressionObject& from) {
    const bool is_vrm1 = from.version == ExpressionObject::Version::kVrm1;
    present_ = {from.name, {}};
    const Value& binds = Member(*from.json, is_vrm1 ? "morphTargetBinds" : "binds");
    for (std::size_t k = 0; k < LengthOf(binds); ++k) {
      const Value& bind = binds.Get(static_cast<int>(k));
      AddBind(is_vrm1 ? MeshOfNode(Member(bind, "node")) : IndexOf(Member(bind, "mesh")), bind,
              is_vrm1 ? 1.0 : 0.01);  // VRM 0.x states percent
    }
    return End();
  }

  static int IndexOf(const Value& value) { return value.IsInt() ? value.GetNumberAsInt() : -1; }

  [[nodiscard]] int MeshOfNode(const Value& node) const {
    const auto& nodes = document_.model().nodes;
    const int index = IndexOf(node);
    const bool exists = index >= 0 && index < static_cast<int>(nodes.size());
    return exists ? nodes[static_cast<std::size_t>(index)].mesh : -1;
  }

  void AddBind(int mesh, const Value& bind, double scale) {
    const Value& index = Member(bind, "index");
    const Value& weight = Member(bind, "weight");
    const int target = index.IsInt() ? index.GetNumberAsInt() : -1;
    const bool exists = mesh >= 0 && mesh < static_cast<int>(document_.num_meshes()) &&
                        target >= 0 &&
                        static_cast<std::size_t>(target) < document_.NumMorphTargets(mesh);
    if (!exists) {
      ++num_missing_;
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

  void Warn() {
    if (num_missing_ == 0) return;
    document_.Warn("extensions.VRM", Counted(num_missing_, "ignored bind", "ignored binds") +
                                         " of expressions to morph targets that do not exist");
  }

  Document& document_;
  VrmExpression present_;
  std::vector<VrmExpression> expressions_;
  std::size_t binds_ = 0;
  std::size_t num_missing_ = 0;  // binds of targets that do not exist
};

}  // namespace

Result<std::vector<VrmExpression>> ReadVrmExpressions(Document* document) {
  return Reader(document).Run();
}

}  // namespace furrow::gltf
