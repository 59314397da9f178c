// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/web/request.hpp"

#include <gmock/gmock.h>

#include "services/viewer/page/page_files.hpp"

namespace rds::viewer {
namespace {

TEST(Target, IsAPathAndATokenAlone) {
  EXPECT_EQ(parse_target("/")->path, "/");
  EXPECT_EQ(parse_target("/vendor/three/three.module.js")->path, "/vendor/three/three.module.js");
  EXPECT_EQ(parse_target("/socket?token=aB-3_")->token, "aB-3_");
  EXPECT_EQ(parse_target("/?")->token, "");
  for (const std::string target :
       {"", "app.js", "/../etc/passwd", "/a/../b", "/..", "/%2e%2e/x", "//host", "/a\\b", "/a b",
        "http://127.0.0.1/", "*", "/?x=1", "/?token=a&b=c", "/?token=%41", "/\xc3\xa4"})
    EXPECT_FALSE(parse_target(target)) << target;
  EXPECT_FALSE(parse_target("/" + std::string(kMostTargetBytes, 'a')));
  EXPECT_FALSE(parse_target(std::string("/a\0b", 4)));
}

TEST(PageFiles, AreThoseOfThePageAlone) {
  EXPECT_TRUE(find_page_file("/")->bytes.starts_with("<!doctype html>"));
  EXPECT_EQ(find_page_file("/app.js")->content_type, "text/javascript; charset=utf-8");
  EXPECT_GT(find_page_file("/vendor/three/three.core.js")->bytes.size(), 1'000'000U);
  EXPECT_FALSE(find_page_file("/app"));
  EXPECT_FALSE(find_page_file("/viewer.yaml"));
}

TEST(Access, OnLoopbackTheNameHasToBeThisMachines) {
  const AccessRules rules{.loopback = true, .token = {}, .allowed_origins = {}};
  for (const char* host : {"localhost:8080", "127.0.0.1:8080", "[::1]:8080", "localhost", "[::1]"})
    EXPECT_TRUE(is_own_host(host, rules)) << host;
  for (const char* host :
       {"", "evil.example:8080", "127.0.0.1.evil.example", "localhost.evil:8080", "10.0.0.7:8080"})
    EXPECT_FALSE(is_own_host(host, rules)) << host;
  EXPECT_TRUE(is_own_host("robot.local:8080",
                          {.loopback = false, .token = "0123456789abcdef", .allowed_origins = {}}));
}

TEST(Access, ABrowsersPageIsThisOneOrAnAllowedOne) {
  const AccessRules rules{.loopback = true, .token = {}, .allowed_origins = {"https://lichtblick.example"}};
  Request request{
      .target = "/socket", .host = "127.0.0.1:8080", .origin = "", .authorization = "", .protocols = ""};
  EXPECT_TRUE(is_allowed_origin(request, rules)) << "no browser";
  for (const char* origin : {"http://127.0.0.1:8080", "https://lichtblick.example"}) {
    request.origin = origin;
    EXPECT_TRUE(is_allowed_origin(request, rules)) << origin;
  }
  for (const char* origin :
       {"http://127.0.0.1:8081", "http://127.0.0.1", "null", "https://evil.example", "file://"}) {
    request.origin = origin;
    EXPECT_FALSE(is_allowed_origin(request, rules)) << origin;
  }
}

TEST(Access, TheTokenIsInTheQueryOrTheHeader) {
  const AccessRules rules{.loopback = false, .token = "0123456789abcdef", .allowed_origins = {}};
  Request request;
  EXPECT_FALSE(has_token(request, {"/socket", ""}, rules));
  EXPECT_FALSE(has_token(request, {"/socket", "0123456789abcdeX"}, rules));
  EXPECT_FALSE(has_token(request, {"/socket", "0123456789abcde"}, rules));
  EXPECT_TRUE(has_token(request, {"/socket", "0123456789abcdef"}, rules));
  request.authorization = "Bearer 0123456789abcdef";
  EXPECT_TRUE(has_token(request, {"/metrics", ""}, rules));
  request.authorization = "0123456789abcdef";
  EXPECT_FALSE(has_token(request, {"/metrics", ""}, rules));
}

TEST(Protocol, IsTheFirstThatIsKnown) {
  EXPECT_EQ(choose_protocol("a, foxglove.websocket.v1 ,foxglove.sdk.v1",
                            {"foxglove.sdk.v1", "foxglove.websocket.v1"}),
            "foxglove.websocket.v1");
  EXPECT_EQ(choose_protocol("", {"a"}), "");
  EXPECT_EQ(choose_protocol(",,,", {"a"}), "");
}

}  // namespace
}  // namespace rds::viewer
