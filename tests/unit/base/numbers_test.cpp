// SPDX-License-Identifier: Apache-2.0
#include "base/numbers.h"

#include <clocale>
#include <limits>
#include <locale>
#include <string>

#include <gtest/gtest.h>

namespace furrow {
namespace {

TEST(ParseNumber, TakesWhatExportersWrite) {
  const std::pair<const char*, double> kCases[] = {
      {"0", 0.0},          {"-0.0", 0.0},    {".0083333", 0.0083333}, {"-.5", -0.5},
      {"5.", 5.0},         {"+1.25", 1.25},  {"1e-3", 0.001},         {"1.5E+2", 150.0},
      {"-17.0000", -17.0}, {"1e-9999", 0.0}, {"00012", 12.0}};
  for (const auto& [text, expected] : kCases) {
    const Result<double> number = ParseNumber(text, "f:1");
    ASSERT_TRUE(number.ok()) << text;
    EXPECT_DOUBLE_EQ(*number, expected) << text;
  }
}

// Beyond a double's range on either side, written in every way.
TEST(ParseNumber, TellsTheTinyFromTheHuge) {
  const std::string zeros(400, '0');
  for (const std::string& tiny : {"0." + zeros + "1", "-0." + zeros + "1e+20", "." + zeros + "7",
                                  std::string("-1e-99999999999999999999"), "1" + zeros + "e-999"}) {
    const Result<double> number = ParseNumber(tiny, "f:1");
    ASSERT_TRUE(number.ok()) << tiny;
    EXPECT_EQ(*number, 0.0) << tiny;
  }
  for (const std::string& huge : {"1" + zeros, "-1" + zeros + ".5e-20", std::string("0.1e+999"),
                                  std::string("1e99999999999999999999"), "0." + zeros + "1e999"}) {
    EXPECT_EQ(ParseNumber(huge, "f:1").status().code(), StatusCode::kNonFinite) << huge;
  }
}

TEST(ParseNumber, RefusesWithAReason) {
  const std::pair<const char*, StatusCode> kCases[] = {{"nan", StatusCode::kNonFinite},
                                                       {"-inf", StatusCode::kNonFinite},
                                                       {"NaN", StatusCode::kNonFinite},
                                                       {"infinity", StatusCode::kNonFinite},
                                                       {"-1.#IND", StatusCode::kNonFinite},
                                                       {"1.#QNAN0", StatusCode::kNonFinite},
                                                       {"1e999", StatusCode::kNonFinite},
                                                       {"1e39", StatusCode::kNonFinite},
                                                       {"", StatusCode::kParse},
                                                       {"+", StatusCode::kParse},
                                                       {"+-1", StatusCode::kParse},
                                                       {"1.2.3", StatusCode::kParse},
                                                       {"12a", StatusCode::kParse},
                                                       {"0x10", StatusCode::kParse},
                                                       {"1,5", StatusCode::kParse},
                                                       {"--1", StatusCode::kParse}};
  for (const auto& [text, code] : kCases) {
    const Result<double> number = ParseNumber(text, "take.bvh:7");
    ASSERT_FALSE(number.ok()) << text;
    EXPECT_EQ(number.status().code(), code) << text;
    EXPECT_EQ(number.status().where(), "take.bvh:7");
    double value = 0.0;
    EXPECT_FALSE(TryParseNumber(text, &value)) << text;
  }
  EXPECT_NE(ParseNumber("1,5", "f:1").status().todo(), "");
}

TEST(AppendFixed, DropsTrailingZerosAndTheSignOfZero) {
  const auto text = [](double value, int decimals) {
    std::string out;
    AppendFixed(value, decimals, &out);
    return out;
  };
  EXPECT_EQ(text(1.5, 6), "1.5");
  EXPECT_EQ(text(-0.0000001, 6), "0");
  EXPECT_EQ(text(100.0, 6), "100");
  EXPECT_EQ(text(100.0, 0), "100");
  EXPECT_EQ(text(-12.3456789, 6), "-12.345679");
  EXPECT_EQ(text(1e300, 6).size(), 301u);
}

TEST(AppendShortest, ReadsBackEqual) {
  for (const float value : {0.1f, 1.0f / 3.0f, 1e-30f, std::numeric_limits<float>::max()}) {
    std::string out;
    AppendShortest(value, &out);
    const Result<double> number = ParseNumber(out, "");
    ASSERT_TRUE(number.ok()) << out;
    EXPECT_EQ(static_cast<float>(*number), value);
  }
}

struct Comma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

// The process's locale must not matter, neither reading nor writing: C++'s, ...
TEST(Number, IgnoresTheGlobalLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale(), new Comma));
  const Result<double> number = ParseNumber("1234.5", "");
  std::string text;
  AppendFixed(1234.5, 3, &text);
  std::locale::global(before);
  ASSERT_TRUE(number.ok());
  EXPECT_EQ(*number, 1234.5);
  EXPECT_EQ(text, "1234.5");
}

// ... and C's.
TEST(Number, IgnoresTheCLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  const char* found = nullptr;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8", "de_DE"}) {
    if (found == nullptr) found = std::setlocale(LC_ALL, name);
  }
  if (found == nullptr) GTEST_SKIP() << "no locale with a decimal comma is installed";
  const Result<double> number = ParseNumber("1.5", "");
  std::string text;
  AppendFixed(2.5, 3, &text);
  AppendShortest(0.25f, &text);
  std::setlocale(LC_ALL, before.c_str());
  ASSERT_TRUE(number.ok());
  EXPECT_EQ(*number, 1.5);
  EXPECT_EQ(text, "2.50.25");
}

}  // namespace
}  // namespace furrow
