// SPDX-License-Identifier: Apache-2.0
#include "server/http/metrics/trace_json.h"

#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace furrow::server {
namespace {

using Json = nlohmann::ordered_json;

PoseTrace SomeTrace() {
  PoseTrace trace{.subject = "ann", .sequence = 4'000'000'000u};
  trace.received = Time{1'000};
  trace.accepted = Time{1'100};
  trace.solving = Time{1'200};
  trace.solved = Time{1'500};
  trace.published = Time{1'600};
  trace.sent = Time{2'000};
  trace.batch = 3;
  return trace;
}

// The spans by name. A test against the names and types of opentelemetry/proto/trace/v1.
std::map<std::string, Json> SpansOf(const Json& otlp) {
  std::map<std::string, Json> spans;
  std::set<std::string> ids;
  for (const Json& span : otlp["resourceSpans"][0]["scopeSpans"][0]["spans"]) {
    EXPECT_EQ(span["traceId"].get<std::string>().size(), 32u);
    EXPECT_EQ(span["spanId"].get<std::string>().size(), 16u);
    EXPECT_NE(span["spanId"], "0000000000000000") << "an invalid id";
    EXPECT_TRUE(ids.insert(span["spanId"].get<std::string>()).second);
    EXPECT_LE(std::stoull(span["startTimeUnixNano"].get<std::string>()),
              std::stoull(span["endTimeUnixNano"].get<std::string>()));
    std::string name = span["name"].get<std::string>();
    // Stages of a picture have names of their own in this map.
    if (span.contains("parentSpanId") && spans.contains("picture") &&
        span["parentSpanId"] == spans["picture"]["spanId"]) {
      name = "picture/" + name;
    }
    spans[name] = span;
  }
  return spans;
}

TEST(TraceJson, HasASpanForEachStage) {
  const TraceClock clock{Time{5'000}, Time{1'700'000'000'000'005'000}};
  const Json otlp = ToOtlp(SomeTrace(), clock, 0xABC);
  const auto spans = SpansOf(otlp);
  EXPECT_EQ(spans.size(), 6u);
  EXPECT_EQ(spans.at("pose")["startTimeUnixNano"], "1700000000000001000");
  EXPECT_EQ(spans.at("pose")["endTimeUnixNano"], "1700000000000002000");
  EXPECT_FALSE(spans.at("pose").contains("parentSpanId"));
  EXPECT_EQ(spans.at("solve")["startTimeUnixNano"], "1700000000000001200");
  EXPECT_EQ(spans.at("solve")["endTimeUnixNano"], "1700000000000001500");
  EXPECT_EQ(spans.at("solve")["parentSpanId"], spans.at("pose")["spanId"]);
  EXPECT_EQ(spans.at("solve")["attributes"][0]["value"]["intValue"], "3");
  EXPECT_EQ(spans.at("pose")["attributes"][0]["value"]["stringValue"], "ann");
  EXPECT_EQ(spans.at("pose")["attributes"][1]["value"]["intValue"], "4000000000");
  const Json& resource = otlp["resourceSpans"][0]["resource"]["attributes"];
  EXPECT_EQ(resource[0]["value"]["stringValue"], "furrowd");
}

TEST(TraceJson, HasThePictureAndItsStages) {
  PoseTrace trace = SomeTrace();
  trace.picture = PoseTrace::Picture{.sequence = 7,
                                     .submitted = Time{1'600},
                                     .taken = Time{3'000},
                                     .drawn = Time{9'000},
                                     .encoded = Time{9'500},
                                     .sent = Time{9'600},
                                     .width = 640,
                                     .height = 400};
  const auto spans = SpansOf(ToOtlp(trace, {Time{0}, Time{0} + std::chrono::hours(1)}, 1));
  EXPECT_EQ(spans.size(), 11u);
  EXPECT_EQ(spans.at("picture")["parentSpanId"], spans.at("pose")["spanId"]);
  EXPECT_EQ(spans.at("picture/draw")["endTimeUnixNano"], "3600000009000");
  EXPECT_EQ(spans.at("picture/encode")["startTimeUnixNano"], "3600000009000");
}

TEST(TraceJson, TracesHaveIdsOfTheirOwn) {
  PoseTrace later = SomeTrace();
  later.received = Time{1'001};
  const auto id = [](const PoseTrace& trace, std::uint64_t session) {
    return SpansOf(ToOtlp(trace, {}, session)).at("pose")["traceId"];
  };
  EXPECT_EQ(id(SomeTrace(), 1), id(SomeTrace(), 1));
  EXPECT_NE(id(SomeTrace(), 1), id(later, 1));
  EXPECT_NE(id(SomeTrace(), 1), id(SomeTrace(), 2));
}

}  // namespace
}  // namespace furrow::server
