// SPDX-License-Identifier: Apache-2.0
// Every setting must have an effect.
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/renderer.h"
#include "render/settings/named_settings.h"
#include "render/settings/setting_table.h"
#include "tests/unit/render/wrinkle_cache_scene.h"

namespace furrow::render {
namespace {

// A change of a setting, and the other settings that make it visible.
struct Case {
  const char* value = nullptr;  // null: OtherValues()
  std::vector<const char*> circumstances = {};
};

const std::map<std::string_view, Case>& Cases() {
  const std::vector<const char*> bright = {"bloom.strength=1", "exposure=3"};
  const std::vector<const char*> from_behind = {"lights.turn_degrees=180"};
  const std::vector<const char*> displaced = {"displacement.enabled=on"};
  static const std::map<std::string_view, Case> cases{
      {"mask_mode", {"dynamic"}},
      {"tone_map", {nullptr, {"exposure=3"}}},
      {"shadow.filter", {nullptr, {"shadow.lamp_mm=1000"}}},
      {"shadow.resolution", {"128"}},
      {"shadow.lamp_mm", {nullptr, {"shadow.filter=pcss"}}},
      {"subsurface.samples", {nullptr, {"subsurface.method=burley"}}},
      {"translucency.enabled", {nullptr, from_behind}},
      {"translucency.strength", {nullptr, from_behind}},
      {"translucency.scale", {nullptr, from_behind}},
      {"displacement.strength", {nullptr, displaced}},
      {"displacement.edge_pixels", {nullptr, displaced}},
      {"displacement.max_level", {"2", {"displacement.enabled=on", "displacement.edge_pixels=1"}}},
      {"bloom.strength", {"1", {"exposure=3"}}},
      {"bloom.threshold", {nullptr, bright}},
      {"bloom.radius", {nullptr, bright}},
  };
  return cases;
}

// Settings that change the cost of a picture, or artefacts that this picture does not have. Other
// tests cover them.
bool IsOfCost(std::string_view name) {
  return name == "wrinkle_maps.cache" || name == "specular.table" ||
         name == "translucency.shrink_mm" || name.starts_with("detail.");
}

// Settings that need a thin part, or an object in front of another.
bool IsOfSheets(std::string_view name) {
  return name.starts_with("translucency.") || name.starts_with("shadow.");
}

// Values other than the current one: all other words and choices, or the more distant end of a
// number's range.
std::vector<std::string> OtherValues(const SettingInfo& info, const Settings& settings) {
  using Kind = SettingInfo::Kind;
  const std::string now = GetSetting(info.name, settings);
  if (info.kind == Kind::kSwitch) return {now == "on" ? "off" : "on"};
  if (info.kind == Kind::kColour) return {"0.9,0.2,0.1"};
  if (info.kind == Kind::kViews) return {"albedo,depth"};
  if (!info.choices.empty()) {
    std::vector<std::string> others = info.choices;
    std::erase(others, now);
    return others;
  }
  const float value = std::stof(now);
  const float other = info.high - value > value - info.low ? info.high : info.low;
  return {info.kind == Kind::kCount ? std::to_string(static_cast<int>(other))
                                    : std::to_string(other)};
}

class SettingEffectTest : public test::WrinkleCacheTest {
 protected:
  SettingEffectTest() {
    for (wrinkle::WrinkleMap& map : head_.rig.wrinkle_maps) map.height = "cavity";
    subject_ = test::Subject(head_);
    renderer_ = test::Expect(Renderer::Create(head_));
    Randomise(true);
  }
  // A slab of 4 mm that light passes through, and a patch that casts a shadow on it.
  void MakeSheets() {
    const auto flat = [](float, float) { return 0.0f; };
    head_ = test::MakePlane(16, flat, {flat});
    head_.materials[0].double_sided = true;
    head_.materials[0].thickness = 0.002f;
    head_.meshes.push_back(head_.meshes[0]);
    for (character::Vertex& vertex : head_.meshes[1].vertices) vertex.position.z -= 0.004f;
    head_.meshes.push_back(head_.meshes[0]);
    for (character::Vertex& vertex : head_.meshes[2].vertices) {
      vertex.position = 0.3f * vertex.position + glm::vec3(0.0f, 0.0f, 0.1f);
    }
    subject_ = test::Subject(head_);
    renderer_ = test::Expect(Renderer::Create(head_));
    camera_ = test::Expect(renderer_->Preset("face"));
  }
  Image DrawWith(const Settings& settings, float nearer) {
    Camera camera = camera_;
    camera.fov_y_degrees /= nearer;
    FrameRequest request = test::RequestOf(subject_, camera, View::kFinal, 128);
    request.settings = settings;
    return test::Expect(renderer_->Render(request));
  }
  void ExpectToMatter(const SettingInfo& info) {
    Settings settings;
    settings.shading = Shading::kSkin;
    settings.anti_aliasing.samples = 1;
    const auto found = Cases().find(info.name);
    const Case with = found != Cases().end() ? found->second : Case();
    for (const char* change : with.circumstances) {
      ASSERT_TRUE(SetSetting(change, &settings).ok()) << change;
    }
    // Skin scatters over a few millimetres, which must cover several pixels for all taps of a
    // kernel.
    const float nearer = info.name.starts_with("subsurface.") ? 6.0f : 1.0f;
    const Image before = DrawWith(settings, nearer);
    const std::vector<std::string> values =
        with.value != nullptr ? std::vector<std::string>{with.value} : OtherValues(info, settings);
    for (const std::string& value : values) {
      Settings changed = settings;
      const Status status = SetSetting(info.name, value, &changed);
      ASSERT_TRUE(status.ok()) << status.ToString();
      EXPECT_FALSE(DrawWith(changed, nearer).rgb == before.rgb)
          << info.name << "=" << value << " changes nothing";
    }
  }
};

TEST_F(SettingEffectTest, EverySettingChangesThePicture) {
  for (const SettingInfo& info : AllSettings()) {
    if (!IsOfCost(info.name) && !IsOfSheets(info.name)) ExpectToMatter(info);
  }
  MakeSheets();
  for (const SettingInfo& info : AllSettings()) {
    if (!IsOfCost(info.name) && IsOfSheets(info.name)) ExpectToMatter(info);
  }
}

}  // namespace
}  // namespace furrow::render
