// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/expression_rules.h"

#include <optional>
#include <string_view>
#include <utility>

#include <tiny_gltf.h>

#include "base/ascii.h"
#include "base/text.h"
#include "gltf/document/json_value.h"
#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

using tinygltf::Value;

std::string StringOf(const Value& value) {
  return value.IsString() ? value.Get<std::string>() : std::string();
}

ExpressionRule RuleOf(const std::string& name, const Value& from) {
  ExpressionRule rule{.shape = CutText(name, kMaxNameBytes)};
  const Value& binary = Member(from, "isBinary");
  rule.is_binary = binary.IsBool() && binary.Get<bool>();
  for (std::size_t i = 0; i < kOverrideNames.size(); ++i) {
    const std::string how = StringOf(Member(from, kOverrideNames[i]));
    if (how == "block") rule.overrides[i] = ExpressionRule::Override::kBlock;
    if (how == "blend") rule.overrides[i] = ExpressionRule::Override::kBlend;
  }
  return rule;
}

// The members that only kRulesExtra has.
void ReadOwnMembers(const Value& from, ExpressionRule* rule) {
  rule->contains = CutText(StringOf(Member(from, "contains")), kMaxNameBytes);
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
    if (const auto found = model.extensions.find("VRMC_vrm"); found != model.extensions.end()) {
      ReadVersion1(Member(found->second, "expressions"));
    } else if (const auto old = model.extensions.find("VRM"); old != model.extensions.end()) {
      ReadVersion0(Member(Member(old->second, "blendShapeMaster"), "blendShapeGroups"));
    } else if (!model.scenes.empty()) {
      ReadList(Member(model.scenes.front().extras, kRulesExtra));
    }
    if (surplus_ > 0) {
      document_.Warn("extensions.VRM",
                     Counted(surplus_, "ignored rule", "ignored rules") + " of expressions");
    }
    return std::move(rules_);
  }

 private:
  void ReadVersion0(const Value& groups) {
    if (!groups.IsArray()) return;
    for (std::size_t i = 0; i < groups.ArrayLen(); ++i) {
      const Value& group = groups.Get(static_cast<int>(i));
      const std::string preset = StringOf(Member(group, "presetName"));
      const bool is_custom = preset.empty() || preset == "unknown";
      ExpressionRule rule = RuleOf(is_custom ? StringOf(Member(group, "name")) : preset, group);
      if (look_at_ && !is_custom) rule.gaze = GazeOf(*look_at_, preset);
      Add(std::move(rule));
    }
  }

  void ReadVersion1(const Value& expressions) {
    for (const char* kind : {"preset", "custom"}) {
      const Value& named = Member(expressions, kind);
      if (!named.IsObject()) continue;
      for (const std::string& name : named.Keys()) {
        ExpressionRule rule = RuleOf(name, named.Get(name));
        if (look_at_ && kind == std::string_view("preset")) rule.gaze = GazeOf(*look_at_, name);
        Add(std::move(rule));
      }
    }
  }

  void ReadList(const Value& list) {
    if (!list.IsArray()) return;
    for (std::size_t i = 0; i < list.ArrayLen(); ++i) {
      const Value& entry = list.Get(static_cast<int>(i));
      ExpressionRule rule = RuleOf(StringOf(Member(entry, "shape")), entry);
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
