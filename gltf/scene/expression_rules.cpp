// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/expression_rules.h"

#include <optional>
#include <utility>

#include <tiny_gltf.h>

#include "base/ascii.h"
#include "base/text.h"
#include "gltf/document/json_value.h"
#include "gltf/limits.h"
#include "gltf/scene/expression_list.h"

namespace furrow::gltf {
namespace {

using tinygltf::Value;

ExpressionRule RuleOf(const std::string& name, const Value& from) {
  ExpressionRule rule{.shape = CutText(name, kMaxNameBytes)};
  const Value& binary = Member(from, "isBinary");
  rule.is_binary = binary.IsBool() && binary.Get<bool>();
  for (std::size_t i = 0; i < kOverrideNames.size(); ++i) {
    const std::string how = TextOf(Member(from, kOverrideNames[i]));
    if (how == "block") rule.overrides[i] = ExpressionRule::Override::kBlock;
    if (how == "blend") rule.overrides[i] = ExpressionRule::Override::kBlend;
  }
  return rule;
}

// The members that only kRulesExtra has.
void ReadOwnMembers(const Value& from, ExpressionRule* rule) {
  rule->contains = CutText(TextOf(Member(from, "contains")), kMaxNameBytes);
  const Value& gaze = Member(from, "gaze");
  if (gaze.IsObject()) rule->gaze = ReadGazeRange(gaze);
}

// The range of a preset for looking; nullopt for other expressions.
std::optional<VrmLookAt::Range> GazeOf(const VrmLookAt& look_at, const std::string& preset) {
  if (EqualsIgnoreCase(preset, "lookUp")) return look_at.up;
  if (EqualsIgnoreCase(preset, "lookDown")) return look_at.down;
  // Each moves both eyes, one of them towards the nose; VRM uses the outer range.
  const bool aside = EqualsIgnoreCase(preset, "lookLeft") || EqualsIgnoreCase(preset, "lookRight");
  return aside ? std::optional(look_at.outer) : std::nullopt;
}

class RuleReader {
 public:
  explicit RuleReader(Document* document)
      : document_(*document), look_at_(ReadVrmLookAtExpressions(*document)) {}

  std::vector<ExpressionRule> Run() {
    const tinygltf::Model& model = document_.model();
    const std::vector<ExpressionObject> expressions = ListExpressions(document_);
    for (const ExpressionObject& expression : expressions) ReadExpression(expression);
    if (expressions.empty() && !model.scenes.empty()) {
      ReadList(Member(model.scenes.front().extras, kRulesExtra));
    }
    if (surplus_ > 0) {
      document_.Warn("extensions.VRM",
                     Counted(surplus_, "ignored rule", "ignored rules") + " of expressions");
    }
    return std::move(rules_);
  }

 private:
  void ReadExpression(const ExpressionObject& expression) {
    ExpressionRule rule = RuleOf(expression.name, *expression.json);
    if (look_at_ && expression.is_preset) rule.gaze = GazeOf(*look_at_, expression.name);
    Add(std::move(rule));
  }

  void ReadList(const Value& list) {
    if (!list.IsArray()) return;
    for (std::size_t i = 0; i < list.ArrayLen(); ++i) {
      const Value& entry = list.Get(static_cast<int>(i));
      ExpressionRule rule = RuleOf(TextOf(Member(entry, "shape")), entry);
      ReadOwnMembers(entry, &rule);
      Add(std::move(rule));
    }
  }

  void Add(ExpressionRule rule) {
    if (rule.does_nothing() || rule.shape.empty()) return;
    if (rules_.size() == kMaxVrmNodes) {
      ++surplus_;
      return;
    }
    rules_.push_back(std::move(rule));
  }

  Document& document_;
  std::optional<VrmLookAt> look_at_;  // by expressions
  std::vector<ExpressionRule> rules_;
  std::size_t surplus_ = 0;
};

}  // namespace

std::vector<ExpressionRule> ReadExpressionRules(Document* document) {
  return RuleReader(document).Run();
}

}  // namespace furrow::gltf
