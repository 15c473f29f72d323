// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/picture_streams.h"

#include <set>

#include <gtest/gtest.h>

#include "render/request/frame_request.h"

namespace furrow::server {
namespace {

RenderJob JobFor(std::uint64_t subject, std::initializer_list<std::uint64_t> subscriptions) {
  RenderJob job;
  job.subject = subject;
  for (const std::uint64_t subscription : subscriptions) {
    job.tickets.push_back({.subscription = subscription, .acknowledges = true});
  }
  return job;
}

TEST(PictureStreams, AViewerKeepsItsStream) {
  PictureStreams streams;
  const auto first = streams.Find(JobFor(7, {1}));
  EXPECT_NE(first.stream, 0u);
  EXPECT_EQ(first.scale, 1.0f);
  EXPECT_EQ(streams.Find(JobFor(7, {1})).stream, first.stream);
}

TEST(PictureStreams, ViewersAndSubjectsShareNoStream) {
  PictureStreams streams;
  std::set<std::uint64_t> numbers;
  for (const std::uint64_t subscription : {1, 2, 3}) {
    for (const std::uint64_t subject : {7, 8, 7}) {
      EXPECT_TRUE(numbers.insert(streams.Find(JobFor(subject, {subscription})).stream).second);
    }
  }
}

TEST(PictureStreams, ASharedPictureContinuesTheStreamThatWasUsedLast) {
  PictureStreams streams;
  const auto first = streams.Find(JobFor(7, {3}));
  EXPECT_EQ(streams.Find(JobFor(7, {5, 3})).stream, first.stream) << "5 has none";
  const auto second = streams.Find(JobFor(7, {5}));
  EXPECT_NE(second.stream, first.stream);
  // The two viewers are not always ready at the same time.
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(streams.Find(JobFor(7, {3, 5})).stream, second.stream);
    EXPECT_EQ(streams.Find(JobFor(7, {5})).stream, second.stream);
  }
}

TEST(PictureStreams, ASharedPictureContinuesNoneOfAnotherSubject) {
  PictureStreams streams;
  const auto first = streams.Find(JobFor(7, {3}));
  const auto other = streams.Find(JobFor(8, {5}));
  EXPECT_EQ(streams.Find(JobFor(7, {3, 5})).stream, first.stream);
  EXPECT_EQ(streams.Find(JobFor(8, {5})).stream, other.stream);
}

// They would never get the refined picture.
TEST(PictureStreams, ViewersThatAcknowledgeNothingGetFullPictures) {
  PictureStreams streams;
  RenderJob job = JobFor(7, {1, 2});
  job.tickets.back().acknowledges = false;
  EXPECT_EQ(streams.Find(job).stream, 0u);
  EXPECT_EQ(streams.Find(job).scale, 1.0f);
  EXPECT_EQ(streams.num_streams(), 0u);
}

TEST(PictureStreams, PreparationsAreApart) {
  PictureStreams streams;
  RenderJob preparation = JobFor(0, {});
  EXPECT_EQ(streams.Find(preparation).stream, 0u);
  EXPECT_EQ(streams.Find(preparation).scale, 1.0f);
  preparation.stream = PictureStreams::kPreparation;
  EXPECT_EQ(streams.Find(preparation).stream, PictureStreams::kPreparation);
  EXPECT_LT(streams.Find(preparation).scale, 1.0f);
  EXPECT_NE(streams.Find(JobFor(0, {1})).stream, PictureStreams::kPreparation);
}

TEST(PictureStreams, TheirNumberIsBounded) {
  PictureStreams streams;
  const auto kept = streams.Find(JobFor(7, {1}));
  for (std::uint64_t subscription = 2; subscription < 500; ++subscription) {
    (void)streams.Find(JobFor(7, {subscription}));
    ASSERT_EQ(streams.Find(JobFor(7, {1})).stream, kept.stream) << "used again and again";
    ASSERT_LE(streams.num_streams(), PictureStreams::kMaxStreams);
  }
}

// The renderer works all the time.
void Draw(PictureStreams* streams, std::uint64_t stream, Time work, Time* now) {
  *now += work;
  streams->OnDrawn(stream, *now, *now);
}

TEST(PictureStreams, StreamsThatShareASlowRendererAllGetSmaller) {
  PictureStreams streams;
  Time now{0};
  for (int i = 0; i < 10; ++i) {
    for (const std::uint64_t viewer : {1, 2}) {
      Draw(&streams, streams.Find(JobFor(7, {viewer})).stream, PictureScale::kTarget, &now);
    }
  }
  EXPECT_LT(streams.Find(JobFor(7, {1})).scale, 1.0f);
  EXPECT_LT(streams.Find(JobFor(7, {2})).scale, 1.0f);
}

TEST(PictureStreams, ARareSmallPictureIsNotBlamedForTheWorkOfOthers) {
  PictureStreams streams;
  Time now{0};
  for (int i = 0; i < 300; ++i) {
    const std::uint64_t busy = streams.Find(JobFor(7, {1})).stream;
    Draw(&streams, busy, 2 * PictureScale::kTarget, &now);
    if (i % 3 != 0) continue;
    const std::uint64_t rare = streams.Find(JobFor(7, {2})).stream;
    Draw(&streams, rare, PictureScale::kTarget / 8, &now);
  }
  EXPECT_EQ(streams.Find(JobFor(7, {1})).scale, render::kMinScale);
  EXPECT_EQ(streams.Find(JobFor(7, {2})).scale, 1.0f);
}

TEST(PictureStreams, PicturesWithoutAStreamHaveTheirPart) {
  PictureStreams streams;
  Time now{0};
  for (int i = 0; i < 20; ++i) {
    Draw(&streams, streams.Find(JobFor(7, {1})).stream, PictureScale::kTarget / 4, &now);
    Draw(&streams, 0, 2 * PictureScale::kTarget, &now);
  }
  EXPECT_EQ(streams.Find(JobFor(7, {1})).scale, 1.0f) << "its own size would not help";
  for (int i = 0; i < 20; ++i) {
    Draw(&streams, streams.Find(JobFor(7, {1})).stream, PictureScale::kTarget, &now);
    Draw(&streams, 0, PictureScale::kTarget, &now);
  }
  EXPECT_LT(streams.Find(JobFor(7, {1})).scale, 1.0f);
}

}  // namespace
}  // namespace furrow::server
