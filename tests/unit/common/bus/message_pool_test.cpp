// SPDX-License-Identifier: Apache-2.0
#include "common/bus/message_pool.hpp"

#include <gtest/gtest.h>

#include "std_msgs/msg/Header.h"

namespace rds::bus::detail {
namespace {

using std_msgs::msg::Header;

TEST(MessagePool, UsesAMessageAgain) {
  MessagePool pool(type_ops<Header>());
  std::shared_ptr<void> message = pool.get();
  const void* first = message.get();
  message.reset();
  EXPECT_EQ(pool.get().get(), first);
}

TEST(MessagePool, MessagesOutliveItAndItsType) {
  TypeOps type = type_ops<Header>();
  std::shared_ptr<void> message = MessagePool(type).get();
  type.destroy = [](void*) { ADD_FAILURE() << "a type was asked that may be gone"; };
  message.reset();
}

}  // namespace
}  // namespace rds::bus::detail
