// SPDX-License-Identifier: Apache-2.0
// Parsing and checking of requests: Host and Origin, URL, query.
#include <gtest/gtest.h>

#include "server/http/pictures/picture_query.h"
#include "server/http/request/request_guard.h"
#include "server/http/request/url.h"

namespace furrow::server {
namespace {

TEST(RequestGuard, NumericHostsAndLocalhostAreAllowed) {
  const RequestGuard guard(HttpConfig{});
  for (const char* host :
       {"localhost", "LOCALHOST:7480", "127.0.0.1:7480", "[::1]:7480", "[::1]", "192.168.0.7:80"}) {
    EXPECT_EQ(guard.Check(host, ""), "") << host;
  }
  for (const char* host : {"", "evil.example", "evil.example:7480", "localhost.evil.example",
                           "127.0.0.1.evil.example", "[::1"}) {
    EXPECT_NE(guard.Check(host, ""), "") << host;
  }
}

TEST(RequestGuard, OriginMustMatchHost) {
  HttpConfig config;
  config.allow_hosts = {"stage.lan"};
  config.allow_origins = {"https://context.example"};
  const RequestGuard guard(config);
  EXPECT_EQ(guard.Check("localhost:7480", "http://localhost:7480"), "");
  EXPECT_EQ(guard.Check("stage.lan:7480", "http://stage.lan:7480"), "");
  EXPECT_EQ(guard.Check("localhost:7480", "https://context.example"), "");
  EXPECT_NE(guard.Check("localhost:7480", "http://localhost:3000"), "");
  EXPECT_NE(guard.Check("localhost:7480", "http://evil.example"), "");
  EXPECT_NE(guard.Check("localhost:7480", "null"), "");
  // DNS rebinding: Origin and Host agree, but the name is foreign.
  EXPECT_NE(guard.Check("evil.example:7480", "http://evil.example:7480"), "");
}

TEST(Url, PathAndQueryAreDecoded) {
  const auto url = ParseUrl("/api/explain?weight=brow_l.squash&subject=%C3%85nna+1&flag&a=1&a=2");
  ASSERT_TRUE(url.has_value());
  EXPECT_EQ(url->path, "/api/explain");
  EXPECT_EQ(url->Value("subject"), "\u00c5nna 1");
  EXPECT_EQ(url->Value("weight"), "brow_l.squash");
  EXPECT_EQ(url->Value("flag"), "");
  EXPECT_EQ(url->Value("a"), "2");
  EXPECT_EQ(url->values.size(), 5u);
}

TEST(Url, InvalidTargetsAreRejected) {
  for (const char* target : {"", "api", "*", "/%", "/%4", "/%zz", "/?a=%", "/?%g1=1"}) {
    EXPECT_FALSE(ParseUrl(target).has_value()) << target;
  }
  EXPECT_TRUE(ParseUrl("/%41").has_value());
  EXPECT_TRUE(ParseUrl("/?&&").has_value());
}

TEST(PictureQuery, ReadsItsFieldsAndPassesSettingsOn) {
  const auto url = ParseUrl("/mjpeg?camera=eyes&width=320&rate=12.5&shading=skin&wrinkles=off");
  const auto pictures = PicturesOf(*url);
  ASSERT_TRUE(pictures.ok());
  EXPECT_EQ(pictures->camera_preset, "eyes");
  EXPECT_EQ(pictures->width, 320);
  EXPECT_EQ(pictures->height, 640);
  EXPECT_EQ(pictures->max_rate_hz, 12.5f);
  EXPECT_EQ(pictures->settings, (std::vector<std::string>{"shading=skin", "wrinkles=off"}));
}

TEST(PictureQuery, NumbersOutOfRangeNameTheirField) {
  for (const char* query : {"width=0", "width=5000", "width=x", "width=", "width=12x"}) {
    const auto pictures = PicturesOf(*ParseUrl(std::string("/mjpeg?") + query));
    ASSERT_FALSE(pictures.ok()) << query;
    EXPECT_EQ(pictures.status().where(), "width");
  }
  EXPECT_FALSE(PicturesOf(*ParseUrl("/mjpeg?rate=nan")).ok());
  EXPECT_FALSE(PicturesOf(*ParseUrl("/mjpeg?quality=0")).ok());
}

TEST(PictureQuery, UnknownNamesAreErrorsWithTheirField) {
  for (const auto& [query, field] :
       {std::pair("view=sideways", "view"), std::pair("camera=behind", "camera"),
        std::pair("shading=oil", "shading"), std::pair("subsurface.width=99", "subsurface.width"),
        std::pair("colour=red", "colour")}) {
    const auto pictures = PicturesOf(*ParseUrl(std::string("/mjpeg?width=32&") + query));
    ASSERT_FALSE(pictures.ok()) << query;
    EXPECT_EQ(pictures.status().code(), StatusCode::kInvalidArgument) << query;
    EXPECT_EQ(pictures.status().where(), field);
    EXPECT_NE(pictures.status().what(), "") << query;
  }
  EXPECT_TRUE(PicturesOf(*ParseUrl("/mjpeg?camera=&view=normal&subject=anybody")).ok());
}

}  // namespace
}  // namespace furrow::server
