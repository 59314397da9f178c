// SPDX-License-Identifier: Apache-2.0
#include <thread>

#include <gtest/gtest.h>

#include "common/service/peers/peers.hpp"
#include "common/topics/topics.hpp"
#include "tests/support/test_domain.hpp"

namespace rds::service {
namespace {

using namespace std::chrono_literals;
using rds_msgs::msg::ServiceStatus;
namespace Role = rds_msgs::msg::ServiceStatus_Constants;

class Followed : public ::testing::Test {
 protected:
  static std::unique_ptr<bus::Participant> join(const std::string& name) {
    return bus::Participant::create(
        {.domain = test::test_domain(), .node_name = name, .loopback_only = true});
  }
  /// Returns when the follower has heard it.
  void tell(std::uint64_t instance, std::uint8_t role) {
    ServiceStatus status;
    status.service("rds-tracker");
    status.instance(instance);
    status.role(role);
    publisher_.write(status);
    for (int i = 0; i < 1000 && !(role == Role::ACTIVE ? seen_.is_there(instance) : seen_.has_left(instance));
         ++i)
      std::this_thread::sleep_for(10ms);
    std::this_thread::sleep_for(50ms);
  }

  std::unique_ptr<bus::Participant> services_ = join("services");
  bus::Publisher<ServiceStatus> publisher_ =
      services_->advertise<ServiceStatus>(topics::kServiceStatus.name, bus::kLatchedEvery);
  std::unique_ptr<bus::Participant> reader_ = join("reader");
  Peers seen_{*reader_};
  FollowedWriter followed_{*reader_, kTracker};
};

TEST_F(Followed, AStrangerIsRefusedWhileTheOneThatIsFollowedIsThere) {
  tell(1, Role::ACTIVE);
  EXPECT_TRUE(followed_.accept(1, false));
  EXPECT_FALSE(followed_.accept(2, false));
  EXPECT_TRUE(followed_.accept(1, false));
  tell(2, Role::ACTIVE);
  EXPECT_FALSE(followed_.accept(2, false));
}

TEST_F(Followed, WhoLeavesIsReplacedAtOnce) {
  tell(1, Role::ACTIVE);
  EXPECT_TRUE(followed_.accept(1, false));
  tell(1, Role::STOPPED);
  EXPECT_TRUE(followed_.accept(2, false));
  EXPECT_FALSE(followed_.accept(1, false)) << "now the second is followed";
}

TEST_F(Followed, WhoGoesOnWithTheSameMapIsTakenAtOnce) {
  tell(1, Role::ACTIVE);
  EXPECT_TRUE(followed_.accept(1, true));
  EXPECT_FALSE(followed_.accept(3, true)) << "no service";
  tell(2, Role::ACTIVE);
  EXPECT_TRUE(followed_.accept(2, true));
}

TEST_F(Followed, AmongWritersThatAreNoServicesWhoGoesOnWithTheSameMapIsTakenAtOnce) {
  EXPECT_TRUE(followed_.accept(7, true));
  EXPECT_TRUE(followed_.accept(8, true));
}

TEST_F(Followed, AStrangerIsRefusedWhileAServiceOfTheKindIsThereThatHasNotSpoken) {
  tell(1, Role::ACTIVE);
  EXPECT_FALSE(followed_.accept(7, false));
  EXPECT_TRUE(followed_.accept(1, false));
}

TEST_F(Followed, AServiceGoesBeforeAWriterThatIsNone) {
  EXPECT_TRUE(followed_.accept(7, false)) << "nobody else is there";
  EXPECT_FALSE(followed_.accept(8, false));
  tell(1, Role::ACTIVE);
  EXPECT_TRUE(followed_.accept(1, false));
  EXPECT_FALSE(followed_.accept(7, false));
}

TEST_F(Followed, WhoIsSilentForLongIsReplaced) {
  EXPECT_TRUE(followed_.accept(7, false));
  EXPECT_FALSE(followed_.accept(8, false));
  std::this_thread::sleep_for(Peers::kGoneAfter + 200ms);
  EXPECT_TRUE(followed_.accept(8, false));
}

}  // namespace
}  // namespace rds::service
