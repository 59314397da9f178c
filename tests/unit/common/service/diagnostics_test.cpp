// SPDX-License-Identifier: Apache-2.0
#include "common/service/diagnostics.hpp"

#include <gmock/gmock.h>

namespace rds::service {
namespace {

using ::testing::Contains;
using ::testing::Pair;

TEST(LatencyWindow, TellsQuantilesOfTheNewestDurations) {
  LatencyWindow window;
  EXPECT_EQ(window.quantile_ms(0.5), 0);
  for (int i = 0; i < 2000; ++i) window.add_ms(1000);
  for (int i = 1; i <= 512; ++i) window.add_ms(i);
  EXPECT_NEAR(window.quantile_ms(0.5), 256, 1.0);
  EXPECT_NEAR(window.quantile_ms(0.99), 507, 1.0);
}

TEST(Diagnostics, ReportsCountersGaugesAndRejections) {
  Diagnostics diagnostics;
  diagnostics.counter("frames") += 3;
  diagnostics.gauge("waiting", [] { return 7U; });
  diagnostics.reject("rds/boxes", Rejection::kOutdated, "of epoch 1");
  diagnostics.reject("rds/boxes", Rejection::kOutdated, "of epoch 2");
  EXPECT_THAT(diagnostics.figures(), Contains(Pair("frames", "3")));
  EXPECT_THAT(diagnostics.figures(), Contains(Pair("waiting", "7")));
  EXPECT_THAT(diagnostics.figures(), Contains(Pair("rejected rds/boxes: outdated", "2")));
  EXPECT_EQ(diagnostics.rejected(), 2U);
}

TEST(Diagnostics, KeepsNothingOfWhatOthersWrite) {
  Diagnostics diagnostics;
  diagnostics.reject("camera", Rejection::kInvalid, "encoding 0");
  const auto before = diagnostics.figures();
  for (int i = 1; i < 1000; ++i)
    diagnostics.reject("camera", Rejection::kInvalid, "encoding " + std::to_string(i));
  ASSERT_EQ(diagnostics.figures().size(), before.size());
  EXPECT_THAT(diagnostics.figures(), Contains(Pair("rejected camera: invalid", "1000")));
}

}  // namespace
}  // namespace rds::service
