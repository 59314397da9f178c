// SPDX-License-Identifier: Apache-2.0
// Keyframes beside a tracker whose offer comes late, or never.
#include "common/keyframe_transfer/keyframe_source.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/bus/bus_test_support.hpp"

namespace rds::keyframe_transfer {
namespace {

using namespace std::chrono_literals;
using rds_msgs::msg::KeyFrameImages;

class LateOffer : public testing::Test {
 protected:
  [[nodiscard]] KeyframeSource<KeyFrameImages> make_source() {
    return {context_, topics::kMapper,
            [this](auto callback) {
              return topics::subscribe(*reader_, topics::kKeyframeImages, topics::kMapper, callback);
            },
            [](const auto&) {}, [] { return true; }};
  }
  void offer_from_another_machine() {
    rds_msgs::msg::TransferOffer offer;
    offer.instance(7);
    offer.host(1);
    offer.map_epoch(42);
    offers_.write(offer);
  }
  /// For so long. @return whether the raw keyframes had no reader meanwhile
  bool nobody_reads(std::chrono::milliseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < end) {
      if (raw_.matched() > 0) return false;
      std::this_thread::sleep_for(20ms);
    }
    return true;
  }

  std::unique_ptr<bus::Participant> tracker_ = bus::join(bus::Vendor::kFastDds, "tracker");
  bus::Publisher<KeyFrameImages> raw_ =
      topics::advertise(*tracker_, topics::kKeyframeImages, topics::kTracker);
  bus::Publisher<rds_msgs::msg::TransferOffer> offers_ =
      topics::advertise(*tracker_, topics::kTransferOffers, topics::kTracker);
  std::unique_ptr<bus::Participant> reader_ = bus::join(bus::Vendor::kFastDds, "mapper");
  service::Diagnostics diagnostics_;
  service::ServiceContext context_{"rds-mapper", *reader_, diagnostics_};
};

TEST_F(LateOffer, IsWaitedFor) {
  const auto source = make_source();
  EXPECT_TRUE(nobody_reads(3500ms));
  offer_from_another_machine();
  EXPECT_TRUE(nobody_reads(2500ms));
}

TEST_F(LateOffer, WhatNobodyOffersIsTakenFromItsTopic) {
  const auto source = make_source();
  EXPECT_TRUE(bus::eventually([&] { return raw_.matched() == 1; }));
  offer_from_another_machine();
  EXPECT_TRUE(bus::eventually([&] { return raw_.matched() == 0; })) << "after all it is another machine";
}

}  // namespace
}  // namespace rds::keyframe_transfer
