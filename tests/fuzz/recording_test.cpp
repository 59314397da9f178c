// SPDX-License-Identifier: Apache-2.0
// Spoiled bags, as files: what opens a recording or copies a bag does not crash, whatever is in them, and
// what it takes is bounded.
#include <fstream>

#include <gmock/gmock.h>

#include "tests/fuzz/bag_seeds.hpp"
#include "tests/fuzz/feed.hpp"
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

/// A bag that keeps nothing.
class Nowhere : public recording::BagWriter {
 public:
  tl::expected<std::size_t, std::string> add_topic(const recording::BagTopic&) override { return topics_++; }
  Result write(std::size_t, const recording::BagMessage&) override { return {}; }
  Result flush() override { return {}; }
  Result finish() override { return {}; }

 private:
  std::size_t topics_ = 0;
};

/// Whether a file of three frames is as good as new.
bool is_whole(const fs::path& file) {
  const auto opened = recording::open_recording(file);
  if (!opened) {
    EXPECT_THAT(opened.error(), testing::HasSubstr("a."));
    return false;
  }
  bool all = opened->recording->frames().size() == 3;
  for (const auto& frame : opened->recording->frames())
    all = opened->recording->load(frame).has_value() && all;
  return all && opened->notes.find("torn") == std::string::npos;
}

/// Copies what can be read of it, as `rds convert` does.
void copy(const fs::path& file) {
  const auto bag = recording::open_bag(file);
  if (!bag) return;
  Nowhere nowhere;
  const auto copied = recording::copy_bag(**bag, nowhere);
  if (!copied) {
    EXPECT_THAT(copied.error(), testing::HasSubstr("a."));
  }
}

class Bags : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Forms, Bags, testing::Values("mcap", "db3"),
                         [](const auto& instance) { return instance.param; });

TEST_P(Bags, OfAnyone) {
  const test::TemporaryFolder folder;
  const fs::path file = folder / (std::string("a.") + GetParam());
  feed(10, bag_seeds(folder.path(), GetParam()), bound, [&](const Bytes& bytes) {
    fs::remove(file);  // a file system may write at once what takes the place of a file cut to nothing
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    copy(file);
    return is_whole(file);
  });
}

}  // namespace
}  // namespace rds::fuzz
