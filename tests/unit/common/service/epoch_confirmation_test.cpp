// SPDX-License-Identifier: Apache-2.0
#include "common/service/peers/epoch_confirmation.hpp"

#include <gtest/gtest.h>

namespace rds::service {
namespace {

TEST(EpochConfirmation, TakesTwoMessagesOfOneWriter) {
  EpochConfirmation another;
  EXPECT_FALSE(another.confirm(7, 42, 1));
  EXPECT_FALSE(another.confirm(7, 42, 1)) << "the same message again";
  EXPECT_FALSE(another.confirm(8, 42, 2)) << "somebody else";
  EXPECT_FALSE(another.confirm(7, 42, 2));
  EXPECT_TRUE(another.confirm(7, 42, 3));
  EXPECT_TRUE(another.confirm(7, 42, 3)) << "it stays so";
  EXPECT_FALSE(another.confirm(7, 43, 4)) << "and another epoch begins anew";
}

TEST(EpochConfirmation, BeginsAnewWhereTheKnownEpochGoesOn) {
  EpochConfirmation another;
  EXPECT_FALSE(another.confirm(7, 0, 1));
  another.deny();
  EXPECT_FALSE(another.confirm(7, 0, 2));
}

}  // namespace
}  // namespace rds::service
