// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/shape_program.h"

#include <limits>

#include <gtest/gtest.h>

namespace furrow::wrinkle {
namespace {

const std::vector<std::string> kProgramStream = {"jawOpen", "browInnerUp", "tongueOut"};
const std::vector<std::string> kFace = {"BrowInnerUp", "cheekPuff", "jawopen"};

TEST(ShapeProgram, ShapesTakeTheCoefficientsOfTheirNames) {
  const ShapeProgram program = ShapeProgram::ByName(kProgramStream, kFace);
  EXPECT_FALSE(program.empty());
  std::vector<float> weights(3, 9.0f);
  ASSERT_EQ(program.Run(std::vector<float>{0.25f, 0.5f, 1.0f}, weights), JobStatus::kOk);
  EXPECT_EQ(weights, (std::vector<float>{0.5f, 0.0f, 0.25f}));
}

TEST(ShapeProgram, MissingCoefficientsAreZero) {
  const ShapeProgram program = ShapeProgram::ByName(kProgramStream, kFace);
  std::vector<float> weights(3, 9.0f);
  ASSERT_EQ(program.Run(std::vector<float>{0.25f}, weights), JobStatus::kOk);
  EXPECT_EQ(weights, (std::vector<float>{0.0f, 0.0f, 0.25f}));
}

TEST(ShapeProgram, AStreamWithoutTheFacesNamesMovesNothing) {
  EXPECT_TRUE(ShapeProgram::ByName({}, kFace).empty());
  EXPECT_TRUE(ShapeProgram::ByName(kProgramStream, {}).empty());
}

TEST(ShapeProgram, FailuresChangeNothing) {
  const ShapeProgram program = ShapeProgram::ByName(kProgramStream, kFace);
  std::vector<float> weights(3, 9.0f);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(program.Run(std::vector<float>{nan}, weights), JobStatus::kNonFinite);
  EXPECT_EQ(weights, std::vector<float>(3, 9.0f));
  std::vector<float> two(2, 9.0f);
  EXPECT_EQ(program.Run(std::vector<float>{0.5f}, two), JobStatus::kSizeMismatch);
  EXPECT_EQ(two, std::vector<float>(2, 9.0f));
}

using Formulas = std::vector<std::pair<std::size_t, ShapeFormula>>;

ShapeInput InputFrom(ShapeInput::From from, std::uint32_t index,
                     ShapeInput::Use use = ShapeInput::Use::kValue) {
  return {.from = from, .use = use, .index = index};
}

TEST(ShapeProgram, AddsUpProductsOfShapedInputs) {
  using From = ShapeInput::From;
  using Use = ShapeInput::Use;
  const ShapeInput a = InputFrom(From::kBlendShape, 0, Use::kClamped);
  const ShapeInput rest = InputFrom(From::kBlendShape, 1, Use::kRest);
  ShapeInput tent = InputFrom(From::kShape, 2, Use::kTent);
  tent.before = 0.0f;
  tent.at = 0.5f;
  tent.after = 0.75f;
  const std::vector<ShapeFormula> steps = {
      {.sum = {{0.5f, {a, rest}}, {0.25f, {a}}}, .clamped = true, .at_most = {}}};
  const Formulas shapes = {
      {2, SameAs(InputFrom(From::kStep, 0))},
      {0, {.sum = {{1.0f, {tent}}}, .clamped = false, .at_most = {}}},
      {1, {.sum = {{3.0f, {a}}}, .clamped = true, .at_most = InputFrom(From::kShape, 2)}}};
  const auto program = ShapeProgram::Create(4, steps, shapes);
  ASSERT_TRUE(program.ok()) << program.status().ToString();
  std::vector<float> weights(4, 9.0f);
  ASSERT_EQ(program->Run(std::vector<float>{0.8f, 0.5f}, weights), JobStatus::kOk);
  // 0.5 * 0.8 * (1 - 0.5) + 0.25 * 0.8 = 0.4, which is 0.8 up the tent's left side.
  EXPECT_FLOAT_EQ(weights[2], 0.4f);
  EXPECT_FLOAT_EQ(weights[0], 0.8f);
  EXPECT_FLOAT_EQ(weights[1], 0.4f);
  EXPECT_EQ(weights[3], 0.0f);
  ASSERT_EQ(program->Run(std::vector<float>{7.0f, -3.0f}, weights), JobStatus::kOk);
  EXPECT_FLOAT_EQ(weights[2], 0.75f);
  EXPECT_FLOAT_EQ(weights[0], 0.0f);
}

TEST(ShapeProgram, FadesByTheMeanOfItsInputs) {
  using From = ShapeInput::From;
  using Use = ShapeInput::Use;
  ShapeFormula squint = SameAs(InputFrom(From::kBlendShape, 0));
  squint.fade = ShapeFade{.share = 0.8f,
                          .by = {InputFrom(From::kBlendShape, 1, Use::kClamped),
                                 InputFrom(From::kBlendShape, 2, Use::kClamped)}};
  const auto program = ShapeProgram::Create(1, {}, Formulas{{0, squint}});
  ASSERT_TRUE(program.ok()) << program.status().ToString();
  const auto run = [&](std::vector<float> coefficients) {
    std::vector<float> weights(1);
    EXPECT_EQ(program->Run(coefficients, weights), JobStatus::kOk);
    return weights[0];
  };
  EXPECT_EQ(run({0.3f, 0.0f, 0.0f}), 0.3f) << "to the bit";
  EXPECT_FLOAT_EQ(run({1.0f, 1.0f, 0.0f}), 0.6f);
  EXPECT_FLOAT_EQ(run({1.0f, 5.0f, 1.0f}), 0.2f);
  squint.fade->share = 1.5f;
  EXPECT_EQ(ShapeProgram::Create(1, {}, Formulas{{0, squint}}).status().code(),
            StatusCode::kInvalidArgument);
  squint.fade = ShapeFade{.share = 1.0f, .by = {InputFrom(From::kShape, 0)}};
  EXPECT_EQ(ShapeProgram::Create(1, {}, Formulas{{0, squint}}).status().code(),
            StatusCode::kInvalidArgument)
      << "reads itself";
  squint.fade->by.clear();
  EXPECT_EQ(ShapeProgram::Create(1, {}, Formulas{{0, squint}}).status().code(),
            StatusCode::kInvalidArgument);
}

// A rule stops the blink, so the squint stays; the corrective of both sees what is drawn.
TEST(ShapeProgram, FadesFollowTheRulesAndCorrectivesTheFades) {
  using From = ShapeInput::From;
  using Use = ShapeInput::Use;
  ShapeFormula squint = SameAs(InputFrom(From::kBlendShape, 1));
  squint.fade = ShapeFade{.share = 0.8f, .by = {InputFrom(From::kShape, 0, Use::kClamped)}};
  ShapeFormula both;
  both.sum = {{.gain = 1.0f, .product = {InputFrom(From::kShape, 0), InputFrom(From::kShape, 1)}}};
  both.is_corrective = true;
  const Formulas formulas = {{0, SameAs(InputFrom(From::kBlendShape, 0))},
                             {2, SameAs(InputFrom(From::kBlendShape, 2))},
                             {1, squint},
                             {3, both}};
  auto program = ShapeProgram::Create(4, {}, formulas);
  ASSERT_TRUE(program.ok()) << program.status().ToString();
  const std::vector<ShapeRule> rules = {{.shape = 2, .limits = {ShapeRule::Limits::kBlock}}};
  const std::vector<ShapeRule::Group> groups = {ShapeRule::kBlinks, ShapeRule::kNoGroup,
                                                ShapeRule::kNoGroup, ShapeRule::kNoGroup};
  program->SetRules({rules, groups});
  const auto run = [&](std::vector<float> coefficients) {
    std::vector<float> weights(4);
    EXPECT_EQ(program->Run(coefficients, weights), JobStatus::kOk);
    return weights;
  };
  const std::vector<float> free = run({1, 1, 0});
  EXPECT_FLOAT_EQ(free[1], 0.2f);
  EXPECT_FLOAT_EQ(free[3], 0.2f);
  const std::vector<float> stopped = run({1, 1, 1});
  EXPECT_EQ(stopped[0], 0.0f);
  EXPECT_EQ(stopped[1], 1.0f);
  EXPECT_EQ(stopped[3], 0.0f);
  EXPECT_EQ(ShapeProgram::Create(4, {}, Formulas{{0, both}}).status().code(),
            StatusCode::kInvalidArgument);
  both.sum = {};
  EXPECT_FALSE(ShapeProgram::Create(2, {}, Formulas{{0, both}, {1, {}}}).ok()) << "not last";
}

TEST(ShapeProgram, RejectsFormulasThatReadWhatComesLater) {
  using From = ShapeInput::From;
  const ShapeFormula step = SameAs(InputFrom(From::kStep, 0));
  EXPECT_FALSE(ShapeProgram::Create(1, std::vector{step}, {}).ok());
  EXPECT_FALSE(ShapeProgram::Create(2, {}, Formulas{{0, SameAs(InputFrom(From::kShape, 1))}}).ok());
  EXPECT_FALSE(ShapeProgram::Create(1, {}, Formulas{{1, {}}}).ok());
  EXPECT_FALSE(ShapeProgram::Create(1, {}, Formulas{{0, {}}, {0, {}}}).ok());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  ShapeFormula gain = SameAs({});
  gain.sum[0].gain = nan;
  EXPECT_FALSE(ShapeProgram::Create(1, {}, Formulas{{0, gain}}).ok());
  ShapeInput tent{.use = ShapeInput::Use::kTent, .before = 0.5f, .at = 0.5f, .after = 1.0f};
  EXPECT_FALSE(ShapeProgram::Create(1, {}, Formulas{{0, SameAs(tent)}}).ok());
  const std::vector<ShapeFormula> many(ShapeProgram::kMaxSteps + 1);
  EXPECT_EQ(ShapeProgram::Create(1, many, {}).status().code(), StatusCode::kLimit);
}

}  // namespace
}  // namespace furrow::wrinkle
