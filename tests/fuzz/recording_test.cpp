// SPDX-License-Identifier: Apache-2.0
// Spoiled bags, as files: what opens a recording does not crash, whatever is in them, and what it takes is
// bounded.
#include <fstream>

#include <gmock/gmock.h>

#include "tests/fuzz/feed.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/recording/conversion.hpp"
#include "tools/recording/open_recording.hpp"

namespace rds::fuzz {
namespace {

namespace fs = std::filesystem;

/// Messages and pictures of the seeds (9 kB each), and what opens files.
constexpr std::size_t kMemoryOfSmallThings = std::size_t{4} << 20;

std::size_t bound(std::size_t bytes) {
  return kMemoryOfSmallThings + 16 * bytes;
}

class Bags : public testing::TestWithParam<const char*> {
 protected:
  /// A recording of three frames as a bag of this form.
  Bytes example() const {
    test::make_small_dataset(folder_ / "tum", 3);
    auto writer = recording::make_bag_writer(file(), mcap::Compression::kLz4).value();
    EXPECT_TRUE(recording::write_bag(*recording::open_recording(folder_ / "tum")->recording, *writer));
    writer.reset();
    const std::string bytes = test::read_text(file());
    return {bytes.begin(), bytes.end()};
  }
  [[nodiscard]] fs::path file() const { return folder_ / (std::string("a.") + GetParam()); }

  test::TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Forms, Bags, testing::Values("mcap", "db3"),
                         [](const auto& instance) { return instance.param; });

TEST_P(Bags, OfAnyone) {
  feed(1, {example()}, bound, [this](const Bytes& bytes) {
    std::ofstream(file(), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    const auto opened = recording::open_recording(file());
    if (!opened) {
      EXPECT_THAT(opened.error(), testing::HasSubstr("a."));
      return false;
    }
    bool all = true;
    for (const auto& frame : opened->recording->frames())
      all = opened->recording->load(frame).has_value() && all;
    return all && opened->recording->frames().size() == 3 && opened->notes.find("torn") == std::string::npos;
  });
}

}  // namespace
}  // namespace rds::fuzz
