// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/hosts/hosts_file.hpp"

#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include "common/config/config_reader.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/rds/hosts/compose_files.hpp"

namespace rds::hosts {
namespace {

using ::testing::HasSubstr;

const std::string kThree =
    "domain: 7\n"
    "machines:\n"
    "  robot: {address: 10.0.0.1, services: [tracker]}\n"
    "  desk: {services: [detector, transformer]}\n"
    "  nas: {address: nas.local, services: [mapper, loop-closer]}\n";

class HostsFileTest : public testing::Test {
 protected:
  HostsFile read(const std::string& text) {
    test::write_text(folder_ / "hosts.yaml", text);
    return read_hosts_file(folder_ / "hosts.yaml");
  }
  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const config::ConfigError& e) {
      return e.what();
    }
    return "";
  }
  test::TemporaryFolder folder_;
};

TEST_F(HostsFileTest, SaysWhichServiceRunsWhere) {
  const HostsFile hosts = read(kThree);
  EXPECT_EQ(hosts.domain, 7);
  EXPECT_EQ(hosts.machine("robot"), (Machine{"robot", "10.0.0.1", {"rds-tracker"}}));
  EXPECT_EQ(hosts.machine("desk"), (Machine{"desk", "desk", {"rds-detector", "rds-transformer"}}));
  EXPECT_EQ(hosts.machine("nas"), (Machine{"nas", "nas.local", {"rds-loop-closer", "rds-mapper"}}));
  EXPECT_EQ(hosts.services().size(), 5U);
  EXPECT_EQ(hosts.peers_of("desk"), "10.0.0.1,nas.local");
}

TEST_F(HostsFileTest, NamesEverythingThatIsWrong) {
  const std::string sentences = refusal(
      "domian: 7\n"
      "machines:\n"
      "  a,b: {address: 'x,y', services: [tracker, tractor]}\n"
      "  c: {service: [mapper], services: [tracker]}\n");
  for (const char* part : {"domian: unknown key", "machines.a,b: a,b, expected a name of",
                           "machines.a,b.address: x,y, expected a name or an IPv4 address",
                           "machines.a,b.services: tractor, expected tracker, detector,",
                           "machines.c.services: tracker, expected each service once",
                           "machines.c.service: unknown key"})
    EXPECT_THAT(sentences, HasSubstr(part));
  EXPECT_THAT(refusal("machines: {a: {services: [mapper]}}"), HasSubstr("expected a machine with the tracker"));
  EXPECT_THAT(refusal(""), HasSubstr("expected a machine with the tracker"));
  EXPECT_THAT(refusal("machines: [a, b]"), HasSubstr("expected a map"));
  EXPECT_THAT(refusal("machines: {a: 3}"), HasSubstr("expected a map"));
}

TEST_F(HostsFileTest, FindsThisMachineByTheNameThatIsGiven) {
  const HostsFile hosts = read(kThree);
  EXPECT_EQ(this_machine(hosts, "nas"), "nas");
  try {
    this_machine(hosts, "laptop");
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "machine 'laptop': expected one of the hosts file: robot, desk, nas");
  }
}

TEST_F(HostsFileTest, BecomesAComposeOverrideOfEachMachine) {
  const HostsFile hosts = read(kThree);
  const YAML::Node robot = YAML::Load(compose_override(hosts, "robot", "hosts.yaml"))["services"];
  EXPECT_EQ(robot["tracker"]["environment"]["RDS_PEERS"].as<std::string>(), "desk,nas.local");
  EXPECT_EQ(robot["player"]["environment"]["ROS_DOMAIN_ID"].as<std::string>(), "7");
  EXPECT_EQ(robot["mapper"]["profiles"][0].as<std::string>(), "elsewhere");
  const YAML::Node nas = YAML::Load(compose_override(hosts, "nas", "hosts.yaml"))["services"];
  EXPECT_EQ(nas["loop-closer"]["environment"]["RDS_PEERS"].as<std::string>(), "10.0.0.1,desk");
  for (const char* elsewhere : {"tracker", "detector", "transformer", "player"})
    EXPECT_TRUE(nas[elsewhere]["profiles"]) << elsewhere;
}

}  // namespace
}  // namespace rds::hosts
