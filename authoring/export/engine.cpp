// SPDX-License-Identifier: Apache-2.0
#include "authoring/export/engine.h"

#include <array>
#include <cstddef>

namespace furrow::authoring {
namespace {

// Godot, Unity, Blender and three.js follow OpenGL: green points up. Unreal follows DirectX.
// Engines compress normal maps to 8 bits at import; Blender keeps 16.
constexpr std::array<EngineTraits, 6> kEngines = {{
    {Engine::kGeneric, "generic", "any engine", false, 16},
    {Engine::kUnity, "unity", "Unity", false, 8},
    {Engine::kUnreal, "unreal", "Unreal Engine", true, 8},
    {Engine::kGodot, "godot", "Godot", false, 8},
    {Engine::kBlender, "blender", "Blender", false, 16},
    {Engine::kThree, "three", "three.js", false, 8},
}};

bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

// Replaces all other characters by '_'.
std::string LettersAndDigits(std::string_view name) {
  std::string text(name);
  for (char& c : text) {
    if (!IsDigit(c) && !IsLetter(c)) c = '_';
  }
  return text;
}

}  // namespace

std::span<const EngineTraits> Engines() { return kEngines; }

const EngineTraits& TraitsOf(Engine engine) { return kEngines[static_cast<std::size_t>(engine)]; }

std::string PropertyName(std::string_view weight) { return "furrow_" + LettersAndDigits(weight); }

std::string ParameterName(Engine engine, std::string_view weight) {
  switch (engine) {
    case Engine::kUnity: return "_FurrowWeights";
    case Engine::kUnreal: return std::string(weight);
    case Engine::kGodot:
    case Engine::kBlender: return PropertyName(weight);
    case Engine::kGeneric:
    case Engine::kThree: break;
  }
  return "furrowWeights";
}

std::string Identifier(std::string_view name) {
  std::string text = LettersAndDigits(name);
  if (text.empty() || IsDigit(text.front())) text.insert(0, "_");
  return text;
}

}  // namespace furrow::authoring
