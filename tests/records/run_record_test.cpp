// SPDX-License-Identifier: Apache-2.0
// `rds run --record`: all that the services say is in the file, from the first frame on.
#include <map>

#include <gmock/gmock.h>

#include "tests/integration/run_support.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/recording/bag/bag.hpp"

namespace rds::test {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;
using testing::Key;
using testing::Not;

constexpr int kFrames = 25;

/// Messages by topic.
std::map<std::string, int> counted(const fs::path& file) {
  std::map<std::string, int> counts;
  const auto bag = recording::open_bag(file);
  EXPECT_TRUE(bag) << bag.error();
  if (!bag) return counts;
  const auto scan = (*bag)->scan([&](const auto& topic, const auto&, const auto&) { ++counts[topic.name]; });
  EXPECT_TRUE(scan && scan->fault.empty());
  return counts;
}

class RunRecord : public testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] ProcessResult run_with(const std::string& record) const {
    return run(
        recording_of_a_room().folder, place_ / "out",
        {"--rate", "max", "--no-dynamics", "--frames", std::to_string(kFrames), "--bus", GetParam(), record},
        std::chrono::seconds(120));
  }
  TemporaryFolder place_;
};
INSTANTIATE_TEST_SUITE_P(Vendors, RunRecord, testing::ValuesIn(all_vendor_names()), given_name);

TEST_P(RunRecord, KeepsAllOutputsBesideTheResults) {
  const auto result = run_with("--record");
  ASSERT_EQ(result.status, 0) << result.standard_error;
  const auto counts = counted(place_ / "out/outputs.mcap");
  for (const char* of_each_frame : {"/rds/tracking_state", "/rds/predicted_boxes", "/rds/features"})
    EXPECT_THAT(counts, Contains(std::pair(std::string(of_each_frame), kFrames)));
  EXPECT_THAT(counts, Contains(Key("/rds/map/info")));
  EXPECT_THAT(counts, Contains(Key("/diagnostics")));
  EXPECT_THAT(counts, Not(Contains(Key("/camera/color/image_raw"))));
}

TEST_P(RunRecord, WritesTheFileThatIsNamedButNotOverAnother) {
  const fs::path file = place_ / "mine.mcap";
  write_text(file, "mine");
  const auto refused = run_with("--record=" + file.string());
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.standard_error, HasSubstr("mine.mcap: is there already; --force overwrites it"));
  EXPECT_EQ(read_text(file), "mine");
  EXPECT_EQ(run_with("--record=" + (place_ / "mine.txt").string()).status, 2);
}

}  // namespace
}  // namespace rds::test
