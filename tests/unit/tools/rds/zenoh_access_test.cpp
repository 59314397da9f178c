// SPDX-License-Identifier: Apache-2.0
// What a participant on Zenoh in a secured domain asks of the others; zenoh_secured_test.py has processes.
#include "common/bus/zenoh/zenoh_access.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/bus/zenoh/zenoh_settings.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/rds/secure/secure_folder.hpp"

namespace rds::bus::detail {
namespace {

using nlohmann::json;
using ::testing::Contains;

class SecuredZenoh : public ::testing::Test {
 protected:
  SecuredZenoh() {
    const auto made = secure::make_secure_folder(
        place_ / "secured", {.validity = secure::ten_years(std::chrono::system_clock::now())});
    EXPECT_TRUE(made);
  }
  [[nodiscard]] Credentials of(const std::string& identity) const {
    return read_credentials(place_ / "secured", identity).value();
  }
  /// The key expressions that a certificate's name may send with such a message.
  static std::vector<std::string> sent_by(const json& rules, const std::string& name,
                                          const std::string& message) {
    std::vector<std::string> keys;
    for (const json& rule : rules.at("rules")) {
      const auto messages = rule.at("messages").get<std::vector<std::string>>();
      if (!rule.at("id").get<std::string>().starts_with(name + "_") || rule.at("flows") != json{"ingress"})
        continue;
      if (std::ranges::find(messages, message) == messages.end()) continue;
      for (const json& key : rule.at("key_exprs")) keys.push_back(key);
    }
    return keys;
  }

  test::TemporaryFolder place_;
};

TEST_F(SecuredZenoh, OnlyAnOperatorCommandsAndAViewer) {
  const json rules = ZenohAccess(of("tracker")).rules();
  EXPECT_EQ(rules.at("default_permission"), "deny");
  for (const json& subject : rules.at("subjects")) {
    const std::string name = subject.at("id");
    EXPECT_EQ(subject.at("cert_common_names"), json{name});
    for (const char* message : {"put", "reply"}) {
      const auto keys = sent_by(rules, name, message);
      EXPECT_EQ(std::ranges::count(keys, "**"), name == "router" ? 1 : 0) << name;
      EXPECT_EQ(std::ranges::count(keys, "*/rds/command/**"), name == "operator" || name == "viewer" ? 1 : 0)
          << name;
    }
  }
}

TEST_F(SecuredZenoh, PatternsAreZenohs) {
  const json rules = ZenohAccess(of("tracker")).rules();
  EXPECT_THAT(sent_by(rules, "camera", "put"), Contains("*/camera/**"));
  EXPECT_THAT(sent_by(rules, "mapper", "put"), Contains("*/rds/map/chunks/**"));
  EXPECT_THAT(sent_by(rules, "mapper", "put"), Contains("*/rds/map/full/**/@adv/**"));
  EXPECT_THAT(sent_by(rules, "reader", "query"), Contains("*/rds/map/**/@adv/**"));
}

TEST_F(SecuredZenoh, OnesOwnPermissionsAreCheckedBefore) {
  const ZenohAccess access(of("reader"));
  EXPECT_NO_THROW(access.check("rds/map/full", false));
  EXPECT_NO_THROW(access.check("rds/map/requests", true));
  EXPECT_THROW(access.check("rds/map/full", true), BusError);
  EXPECT_THROW(access.check("rds/command", true), BusError);
  EXPECT_THROW(access.check("camera/color/image_raw", false), BusError);
}

TEST_F(SecuredZenoh, EveryLinkIsEncrypted) {
  const ZenohAccess access(of("mapper"));
  const json here = json::parse(zenoh_settings({.node_name = "n", .loopback_only = true}, &access));
  EXPECT_EQ(here.at("listen").at("endpoints"), json{"tls/127.0.0.1:0"});
  const json link = here.at("transport").at("link");
  EXPECT_EQ(link.at("protocols"), json{"tls"});
  EXPECT_EQ(link.at("tls").at("enable_mtls"), true);
  const json there =
      json::parse(zenoh_settings({.node_name = "n", .peers = {"10.0.0.7", "tls/robot:1"}}, &access));
  EXPECT_EQ(there.at("connect").at("endpoints"), (json{"tls/10.0.0.7:7447", "tls/robot:1"}));
  EXPECT_THROW((void)zenoh_settings({.node_name = "n", .peers = {"tcp/robot:1"}}, &access), BusError);
  EXPECT_EQ(json::parse(zenoh_router_settings({"[::]:7447"}, {"nas"}, &access)).at("connect").at("endpoints"),
            json{"tls/nas:7447"});
}

TEST_F(SecuredZenoh, AListOfAnotherAuthorityIsRefused) {
  const auto foreign = secure::make_secure_folder(
      place_ / "foreign", {.validity = secure::ten_years(std::chrono::system_clock::now())});
  ASSERT_TRUE(foreign);
  std::filesystem::copy_file(place_ / "foreign/access.p7s", place_ / "secured/access.p7s",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THROW(ZenohAccess access(of("tracker")), BusError);
  std::filesystem::remove(place_ / "secured/access.p7s");
  EXPECT_THROW(ZenohAccess access(of("tracker")), BusError);
}

}  // namespace
}  // namespace rds::bus::detail
