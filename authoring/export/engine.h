// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace furrow::authoring {

// What an export is for. kGeneric: glTF's conventions and portable GLSL.
enum class Engine { kGeneric, kUnity, kUnreal, kGodot, kBlender, kThree };

// The conventions of an engine.
struct EngineTraits {
  Engine engine = Engine::kGeneric;
  std::string_view name;    // of --for: "unity"
  std::string_view title;   // "Unity"
  bool green_down = false;  // the green of normal maps points down in the picture (DirectX)
  int bits = 8;             // of a channel of a normal map, unless the user chooses
};

// All engines, in the order of Engine.
[[nodiscard]] std::span<const EngineTraits> Engines();
[[nodiscard]] const EngineTraits& TraitsOf(Engine engine);

// The name of a wrinkle weight where names have only ASCII letters, digits and underscores:
// "furrow_brow_l_squash" for "brow_l.squash". Two weights may get the same name.
[[nodiscard]] std::string PropertyName(std::string_view weight);

// The name of the material parameter, in the engine, that takes a weight. Unity, three.js and plain
// GLSL take an array in the order of the weights, so it is the array's name there.
[[nodiscard]] std::string ParameterName(Engine engine, std::string_view weight);

// A name for code: letters, digits and underscores, and never a digit first ("skin_2").
[[nodiscard]] std::string Identifier(std::string_view name);

}  // namespace furrow::authoring
