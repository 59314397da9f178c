// SPDX-License-Identifier: Apache-2.0
// A link of 20 Mbit/s, that pictures alone would need four times, and one that loses a frame in a hundred:
// what comes of them, and of the small messages beside them, on each bus. Prints a line for each.
#include <cstdlib>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/hosts/host_network.hpp"
#include "tests/support/bus/vendors.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr int kRateMbit = 20;
constexpr int kPictures = 100;
constexpr int kSmall = 500;

class NarrowLink : public ::testing::TestWithParam<std::string> {
 protected:
  /// What the two ends say of pictures and small messages that go over a link; printed.
  static json send_over(const Link& link) {
    const HostNetwork network({"a", "b"}, link);
    const auto peer = [&](const std::string& host, const std::string& mode, const std::string& other) {
      return network.on(host, {RDS_NARROW_PEER, mode, GetParam(), "7", network.address(other)});
    };
    Process reader(peer("b", "read", "a"));
    Process writer(peer("a", "write", "b"));
    EXPECT_EQ(writer.wait(60s), 0) << writer.standard_error();
    EXPECT_EQ(reader.wait(60s), 0) << reader.standard_error();
    json line = json::parse(reader.standard_output());
    line.update(json::parse(writer.standard_output()));
    std::cout << GetParam() << " " << line << std::endl;
    RecordProperty("figures", line.dump());
    return line;
  }
};

TEST_P(NarrowLink, CarriesPicturesBesideSmallMessages) {
  if (const std::string reason = HostNetwork::why_not(); !reason.empty()) GTEST_SKIP() << reason;
  const json line = send_over({.rate_mbit = kRateMbit});
  if (GetParam() != "zenoh") return;  // what DDS does there is only told
  EXPECT_GE(line["pictures"], kPictures / 5);
  EXPECT_GE(line["small"], kSmall * 98 / 100);
  EXPECT_LE(line["small_p50_ms"], 100.0);  // DDS' are at half a second
  EXPECT_LE(line["small_p99_ms"], 400.0);  // on a quiet machine below 100: README
}

TEST_P(NarrowLink, ThatLosesFramesCarriesPicturesAsWell) {
  if (const std::string reason = HostNetwork::why_not(); !reason.empty()) GTEST_SKIP() << reason;
  const json line = send_over({.impairment = {.loss = 0.01}});
  if (GetParam() != "zenoh") return;  // datagrams of 65 kB: docs/decisions/large-topics-between-machines.md
  EXPECT_GE(line["pictures"], kPictures * 9 / 10);
  EXPECT_GE(line["small"], kSmall * 98 / 100);
}

INSTANTIATE_TEST_SUITE_P(On, NarrowLink, ::testing::ValuesIn(all_vendor_names()), given_name);

}  // namespace
}  // namespace rds::test
