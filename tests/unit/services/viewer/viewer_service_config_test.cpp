// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/viewer_service_config.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include "services/viewer/listen_address.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::viewer {
namespace {

TEST(ListenAddress, IsAnAddressAndAPort) {
  EXPECT_EQ(parse_listen_address("8080")->url(), "http://127.0.0.1:8080/");
  EXPECT_EQ(parse_listen_address("localhost:1")->url(), "http://127.0.0.1:1/");
  EXPECT_EQ(parse_listen_address("[::1]:8080")->url(), "http://[::1]:8080/");
  EXPECT_TRUE(parse_listen_address("[::1]:8080")->is_loopback());
  EXPECT_FALSE(parse_listen_address("0.0.0.0:8080")->is_loopback());
  for (const char* text :
       {"", ":", "x", "8080x", "127.0.0.1:", "127.0.0.1:70000", "robot:8080", "-1", "127.0.0.1:-5", ":8080"})
    EXPECT_FALSE(parse_listen_address(text)) << text;
}

class AccessTokenTest : public ::testing::Test {
 protected:
  std::string token_of_file(const std::string& content, const std::string& listen) {
    const auto file = folder_ / "token";
    std::ofstream(file) << content;
    ViewerServiceConfig config;
    config.listen = listen;
    config.token_file = file;
    return access_token(config);
  }
  test::TemporaryFolder folder_;
};

TEST_F(AccessTokenTest, OthersThanThisMachineNeedOne) {
  ViewerServiceConfig config;
  EXPECT_EQ(access_token(config), "");
  config.listen = "0.0.0.0:8080";
  EXPECT_THROW(access_token(config), config::ConfigError);
  EXPECT_EQ(token_of_file("0123456789abcdef\n", "0.0.0.0:8080"), "0123456789abcdef");
}

TEST_F(AccessTokenTest, IsLongAndPlain) {
  for (const char* text :
       {"", "short", "0123456789abcde\n", "0123456789abcdef g", "0123456789abcdef&x=1", "0123456789abcdé0"})
    EXPECT_THROW(token_of_file(text, "127.0.0.1:8080"), config::ConfigError) << text;
  ViewerServiceConfig config;
  config.token_file = folder_ / "none";
  EXPECT_THROW(access_token(config), config::ConfigError);
}

}  // namespace
}  // namespace rds::viewer
