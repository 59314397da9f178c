// SPDX-License-Identifier: Apache-2.0
#include "common/service/process/printable.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace rds::service {
namespace {

TEST(Printable, KeepsTextAndWritesEverythingElseAsNumbers) {
  EXPECT_EQ(printable("rgb8"), "rgb8");
  EXPECT_EQ(printable("Küche 猫"), "Küche 猫");
  EXPECT_EQ(printable("\xFF\xFF"), "\\xFF\\xFF");
  EXPECT_EQ(printable(std::string_view("a\n\x1B[31m\0b", 8)), "a\\x0A\\x1B[31m\\x00");
  EXPECT_EQ(printable("\\xFF"), "\\x5CxFF");
}

TEST(Printable, TakesNoSequenceThatIsNotUtf8) {
  EXPECT_EQ(printable("\xC0\xAF"), "\\xC0\\xAF");          // overlong
  EXPECT_EQ(printable("\xED\xA0\x80"), "\\xED\\xA0\\x80");  // a surrogate
  EXPECT_EQ(printable("\xE7\x8C"), "\\xE7\\x8C");          // cut off
  EXPECT_EQ(printable("\xF5\x80\x80\x80"), "\\xF5\\x80\\x80\\x80");
}

TEST(Printable, CutsWhatIsTooLong) {
  const std::string shown = printable(std::string(1 << 20, 'x'), 10);
  EXPECT_EQ(shown, "xxxxxxxxxx... (1048576 bytes)");
}

TEST(Printable, AnyBytesMakeValidJson) {
  for (int first = 0; first < 256; ++first)
    for (int second = 0; second < 256; ++second) {
      const std::string text{static_cast<char>(first), static_cast<char>(second), 'a'};
      EXPECT_NO_THROW((void)nlohmann::json(printable(text)).dump()) << first << ' ' << second;
    }
}

}  // namespace
}  // namespace rds::service
