// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/far/terms.hpp"

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.hpp"
#include "tools/rds/run/far/usage.hpp"

namespace rds::run {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const hosts::HostsFile kHosts{0,
                              {{"robot", "robot", {"rds-tracker"}},
                               {"desk", "desk", {"rds-detector", "rds-transformer"}},
                               {"nas", "nas", {"rds-loop-closer", "rds-mapper"}}}};

class Terms : public testing::Test {
 protected:
  std::string refusal(const std::string& terms, const std::string& machine) {
    try {
      accept_terms(terms, kHosts.machine(machine), folder_.path(), there_);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  }
  test::TemporaryFolder folder_;
  RunOptions here_;
  RunOptions there_ = [] {
    RunOptions options;
    options.here.emplace();
    return options;
  }();
};

TEST_F(Terms, TellAnotherMachineWhatTheCommandLineSays) {
  test::write_text(folder_ / "mine.yaml", "mapper: {resolution: 0.1}\n");
  here_.rate = 0;
  here_.model = "nanodet";
  here_.config = folder_ / "mine.yaml";
  here_.poses = "truth.txt";
  EXPECT_EQ(refusal(terms_of(here_, kHosts, "nas", "1"), "nas"), "");
  EXPECT_TRUE(there_.lockstep());
  EXPECT_EQ(there_.model, "nanodet");
  EXPECT_EQ(test::read_text(there_.config), "mapper: {resolution: 0.1}\n");
  EXPECT_THAT(there_.here->services, ElementsAre("rds-mapper")) << "with given poses there is no loop closer";
}

TEST_F(Terms, AreRefusedWhereAMachineCannotKeepThem) {
  EXPECT_THAT(refusal(terms_of(here_, kHosts, "nas", "1"), "desk"),
              HasSubstr("the hosts file of desk has rds-detector, rds-transformer there"));
  there_.map = "saved";
  EXPECT_THAT(refusal(terms_of(here_, kHosts, "nas", "1"), "nas"), HasSubstr("--map: not expected here"));
  EXPECT_EQ(refusal(terms_of(here_, kHosts, "desk", "1"), "desk"), "");
  there_.map.clear();
  here_.map = "saved";
  EXPECT_THAT(refusal(terms_of(here_, kHosts, "nas", "1"), "nas"), HasSubstr("--map: expected here too"));
  for (const char* torn : {"", "{}", R"({"services": 3})", "[1"})
    EXPECT_THAT(refusal(torn, "nas"), HasSubstr("another version of rds?")) << torn;
}

TEST_F(Terms, NeedAMachineForEachServiceAndFilesWhereTheyAreRead) {
  EXPECT_NO_THROW(check_placement(here_, kHosts, kHosts.machine("robot")));
  here_.detections = "boxes.jsonl";
  EXPECT_THROW(check_placement(here_, kHosts, kHosts.machine("robot")), std::runtime_error);
  here_.detections.clear();
  const hosts::HostsFile alone{0, {{"robot", "robot", {"rds-tracker", "rds-mapper"}}}};
  EXPECT_THROW(check_placement(here_, alone, alone.machine("robot")), std::runtime_error);
  here_.dynamics = false;
  here_.poses = "truth.txt";
  EXPECT_NO_THROW(check_placement(here_, alone, alone.machine("robot")));
}

TEST(Usage, IsTheSameOnAnotherMachine) {
  const auto usage = usage_from_json(usage_to_json({{"rds-mapper", {1.5, 200, 1, {139}}}}));
  EXPECT_DOUBLE_EQ(usage.at("rds-mapper").cpu_s, 1.5);
  EXPECT_EQ(usage.at("rds-mapper").peak_bytes, 200U);
  EXPECT_EQ(usage.at("rds-mapper").restarts, 1);
  EXPECT_THAT(usage.at("rds-mapper").failures, ElementsAre(139));
  for (const char* torn : {"", "[", R"({"rds-mapper": {}})", R"({"rds-mapper": 3})"})
    EXPECT_THROW(usage_from_json(torn), std::runtime_error) << torn;
}

}  // namespace
}  // namespace rds::run
