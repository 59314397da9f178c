// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/lifecycle.hpp"

#include <gmock/gmock.h>

namespace rds::service {
namespace {

using ::testing::ElementsAre;

class LifecycleTest : public ::testing::Test {
 protected:
  std::vector<std::string> labels_from_here() {
    std::vector<std::string> labels;
    for (const LifecycleTransition& t : life.available()) labels.emplace_back(t.label);
    return labels;
  }
  /// Begins and ends it. @return whether it is there.
  bool carry_out(const std::string& label, bool succeeds = true) {
    if (!life.begin(0, label)) return false;
    life.end(succeeds);
    return true;
  }

  std::vector<std::string> told;
  Lifecycle life{[this](const LifecycleEvent& e) {
    told.push_back(std::string(e.start.label) + " " + e.label + " " + e.goal.label);
  }};
};

TEST_F(LifecycleTest, BeginsUnconfiguredWhereAManagerBringsItUp) {
  Lifecycle managed([](const LifecycleEvent&) {}, kUnconfigured);
  managed.set_paused(true);
  EXPECT_EQ(managed.state(), kUnconfigured) << "the worker pauses until it is activated";
  for (const char* label : {"configure", "activate"}) {
    ASSERT_TRUE(managed.begin(0, label)) << label;
    managed.end(true);
  }
  EXPECT_EQ(managed.state(), kActive);
}

TEST_F(LifecycleTest, GoesThroughAllStatesAsRclcppNodesDo) {
  EXPECT_EQ(life.state(), kActive) << "services need nobody who configures them";
  EXPECT_THAT(labels_from_here(), ElementsAre("deactivate", "shutdown"));
  EXPECT_TRUE(carry_out("deactivate"));
  EXPECT_THAT(labels_from_here(), ElementsAre("cleanup", "activate", "shutdown"));
  EXPECT_TRUE(carry_out("cleanup"));
  EXPECT_THAT(labels_from_here(), ElementsAre("configure", "shutdown"));
  EXPECT_TRUE(carry_out("configure"));
  EXPECT_EQ(life.state(), kInactive);
  EXPECT_TRUE(carry_out("activate"));
  EXPECT_EQ(life.state(), kActive);
  EXPECT_TRUE(carry_out("shutdown"));
  EXPECT_EQ(life.state(), kFinalized);
  EXPECT_TRUE(labels_from_here().empty());
}

TEST_F(LifecycleTest, RefusesWhatIsNoTransitionFromHere) {
  for (const auto* label : {"activate", "cleanup", "configure", "", "fly"})
    EXPECT_FALSE(carry_out(label)) << label;
  EXPECT_FALSE(life.begin(6, "")) << "the shutdown of an inactive node";
  EXPECT_FALSE(life.begin(200, "deactivate")) << "an id goes before a label";
  EXPECT_EQ(life.state(), kActive);
  EXPECT_TRUE(told.empty());
}

TEST_F(LifecycleTest, CarriesOutOneTransitionAtATime) {
  ASSERT_TRUE(life.begin(4, ""));
  EXPECT_STREQ(life.state().label, "deactivating");
  EXPECT_FALSE(life.begin(7, "")) << "nothing else meanwhile";
  life.set_paused(true);  // by the transition itself
  life.end(true);
  life.end(true);
  EXPECT_THAT(told,
              ElementsAre("active deactivate deactivating", "deactivating transition_success inactive"));
}

TEST_F(LifecycleTest, StaysWhereATransitionFails) {
  EXPECT_TRUE(carry_out("deactivate", false));
  EXPECT_EQ(life.state(), kActive);
  EXPECT_EQ(told.back(), "deactivating transition_failure active");
}

TEST_F(LifecycleTest, FollowsWhoPausesAndResumesOtherwise) {
  life.set_paused(false);
  EXPECT_TRUE(told.empty());
  life.set_paused(true);
  EXPECT_EQ(life.state(), kInactive);
  carry_out("cleanup");
  life.set_paused(false);
  EXPECT_EQ(life.state(), kActive);
  EXPECT_EQ(told.front(), "active deactivate inactive");
  EXPECT_EQ(told.back(), "unconfigured activate active");
}

}  // namespace
}  // namespace rds::service
