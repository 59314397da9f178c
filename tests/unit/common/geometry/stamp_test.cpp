// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/stamp.hpp"

#include <gtest/gtest.h>

namespace rds::geometry {
namespace {

TEST(Stamp, ReadsEveryDigit) {
  EXPECT_EQ(parse_stamp_ns("1305031229.528748"), 1305031229528748000);
  EXPECT_EQ(parse_stamp_ns("1305031229.528748123"), 1305031229528748123);
  EXPECT_EQ(parse_stamp_ns("1.0"), 1000000000);
  EXPECT_EQ(parse_stamp_ns("7"), 7000000000);
  EXPECT_EQ(parse_stamp_ns("0.000000001"), 1);
}

TEST(Stamp, RoundsTheTenthDecimal) {
  EXPECT_EQ(parse_stamp_ns("1.0000000014"), 1000000001);
  EXPECT_EQ(parse_stamp_ns("1.0000000015"), 1000000002);
  EXPECT_EQ(parse_stamp_ns("1.9999999999"), 2000000000);
}

TEST(Stamp, RefusesWhatIsNoStamp) {
  for (const char* text :
       {"", ".", ".5", "-1.0", "1e9", "nan", "1.2.3", "1,5", " 1", "2147483648", "99999999999999999999"})
    EXPECT_FALSE(parse_stamp_ns(text)) << text;
}

TEST(Stamp, WritesWhatItRead) {
  for (const char* text :
       {"1305031229.528748", "1.066667", "0.000000", "12.000000001", "2147483647.999999999"})
    EXPECT_EQ(format_stamp(parse_stamp_ns(text).value()), text);
}

TEST(Stamp, GivesTheDoubleNearestToTheText) {
  EXPECT_EQ(stamp_seconds(1305031229528748000), 1305031229.528748);
  EXPECT_EQ(stamp_seconds(1066667000), 1.066667);
}

}  // namespace
}  // namespace rds::geometry
